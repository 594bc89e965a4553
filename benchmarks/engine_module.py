"""A study's module for the engine: the table's numbers as functions of the free numbers, and the engine on them."""

from __future__ import annotations

import numpy as np
from engine_joint import JointNumbers
from engine_network import HEAT_UNIT, SOFTENING, STEPS, Array, Assembler
from engine_phase import TIME, phase
from engine_steps import FAR, HOT, MEAN, NEAR, POWER, SOFT, THIRD, VOLTAGE, WATCHED
from quick import Quick

from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.symbols import symbols
from tvimdesign.solve.nlp.problem import Free

EVENTS = {"near_face": NEAR, "mean": MEAN, "far_face": FAR, "softening": SOFT}
PEAKS = {"peak_power": POWER, "peak_voltage": VOLTAGE, "peak_peltier_temperature": HOT}
"""Rows of what is watched, by event and by peak."""


class Module:
    """The softening of one study by the engine, as a function of the unknowns of its free numbers."""

    def __init__(self, model: DeviceFunctions, free: tuple[Free, ...], wanted: list[str], steps: float = STEPS) -> None:
        """Write the numbers of the network and their slopes; `wanted` are quantities that the cycle supplies."""
        self.model, self.free, self.wanted = model, free, wanted
        found = model.phases["softening"]
        self.unknowns = ca.SX.sym("unknowns", len(free))
        entries = ca.vertsplit(ca.SX(model.start))
        for i, one in enumerate(free):
            entries[model.index[one.name]] = one.to_value(self.unknowns[i])
        self.inputs = ca.vertcat(*entries)
        current = symbols(found._inputs)[model.index["current"]]
        self.event, self.rheology = EVENTS[model.words["response_criterion"]], np.zeros(0)
        finer = SOFTENING if self.event == SOFT else 1.0
        assembler = Assembler(found._stack, model.cells, current, finer * steps)
        self.target = 0.0 if self.event == SOFT else float(model.start[model.index["target_temperature"]])
        written, constants = assembler.numbers(), assembler.material()
        self.network = assembler.network()
        if self.event == SOFT:
            joint = JointNumbers(found, assembler)
            self.network = assembler.network(joint.column_shares, joint.fed_evenly)
            written = ca.vertcat(written, joint.numbers)
            (rheology,) = ca.Function("rheology", [found._inputs], [joint.constants]).call([model.start])
            self.rheology = np.asarray(rheology).ravel()
        q, material = ca.Function("numbers", [found._inputs], [written, constants]).call([self.inputs])
        self.material = np.asarray(ca.DM(material)).ravel()
        slopes = ca.densify(ca.horzcat(ca.jacobian(q, self.unknowns), ca.SX(q.numel(), 1)))
        self._numbers = Quick(ca.Function("numbers", [self.unknowns], [ca.cse(ca.horzcat(q, slopes).T)]))
        self.count = len(free) + 1
        self.evaluations = 0

    def run(self, unknowns: Array, tableau: Array = THIRD) -> tuple[Array, Array]:
        """Return what is wanted, and its slopes by the unknowns; NaN where the softening has no end."""
        self.evaluations += 1
        q, dq = self._last = self._split(unknowns)
        net, m = self.network, self.material
        y, s = np.full(net.nodes, m[9]), np.zeros((net.nodes, self.count))
        y[: net.cells] = m[10] / HEAT_UNIT
        ends, peaks = np.zeros(WATCHED + 1), np.zeros(WATCHED + 1)
        of_ends, of_peaks = np.zeros((WATCHED + 1, self.count)), np.zeros((WATCHED + 1, self.count))
        steps = -1
        if np.all(np.isfinite(q)) and np.all(q[: net.nodes] >= 0.0):
            steps = phase(
                y, s, q, dq, m, self.rheology, net, False, tableau, self.event, self.target, 1.0, ends, of_ends, peaks,
                of_peaks,
            )  # fmt: skip
        self.state = y, s
        if steps < 0:
            return np.full(len(self.wanted), np.nan), np.full((len(self.wanted), len(self.free)), np.nan)
        rows = [
            (ends[TIME], of_ends[TIME]) if one == "response_time" else self._peak(one, peaks, of_peaks)
            for one in self.wanted
        ]
        return np.array([value for value, _ in rows]), np.array([slope[:-1] for _, slope in rows])

    def _peak(self, name: str, peaks: Array, of_peaks: Array) -> tuple[float, Array]:
        if name == "peak_current":
            q, dq = self._last
            return q[self.network.layer + 6], dq[self.network.layer + 6]
        return peaks[PEAKS[name]], of_peaks[PEAKS[name]]

    def _split(self, unknowns: Array) -> tuple[Array, Array]:
        """Return the network's numbers and their slopes; a last column is that of a step's length."""
        both = self._numbers(unknowns).T
        return np.ascontiguousarray(both[:, 0]), np.ascontiguousarray(both[:, 1:])
