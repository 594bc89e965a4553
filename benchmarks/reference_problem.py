"""The problem that all optimisers of `optimum.py` are given: one study, and its equations as plain functions.

Every contender gets the same compiled equations from here; what differs is how the optimiser gets them, how the
switch is integrated, and where derivatives come from.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray
from quick import Quick

from tvimdesign.simulation.working_cycle.device_functions import STRUCTURES, DeviceFunctions
from tvimdesign.simulation.working_cycle.symbols import ca
from tvimdesign.solve.nlp.constraints import impossible
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Study, read_study

Array = NDArray[np.float64]
STUDY = Path(__file__).with_name("reference.yaml")
LONGEST = 3600.0  # s, how long any contender simulates at most
SIZES = {
    "wire_diameter": {"catalog": "music_wire_gauge", "from": "1.2 mm", "to": "3.2 mm"},
    "coil_count": {"from": 3, "to": 8, "step": 0.25},
    "spring_pairs": {"from": 1, "to": 2},
    "arc_count": {"from": 3, "to": 5},
}
"""What can be had in sizes only: 17 wires, 21 counts of quarter coils, and so on, 2,142 combinations."""


def study(cells: int | None = None) -> Study:
    """Return the reference study, with another count of cells if requested."""
    read = read_study(STUDY)
    solver = read.solver.model_copy(update={"cells": cells or read.solver.cells})
    return read.model_copy(update={"solver": solver})


def study_of_sizes() -> Study:
    """Return the reference study with wire, coils, springs and arcs listed; all else may be any."""
    tree = yaml.safe_load(STUDY.read_text(encoding="utf-8"))
    tree["vary"] |= SIZES
    with TemporaryDirectory() as folder:
        file = Path(folder) / STUDY.name
        file.write_text(yaml.safe_dump(tree), encoding="utf-8")
        return read_study(file)


@dataclass(frozen=True)
class Heat:
    """The switch of one design as an initial-value problem."""

    start: Array
    rates: Callable[[float, Array], Array]
    jacobian: Callable[[float, Array], Array]
    gap: Callable[[float, Array], float]
    """What the switch waits for: it rises through zero."""


class Reference:
    """The study's functions: algebra (objective and residuals given the time), and the heat equation."""

    def __init__(self, sought: Study) -> None:
        """Compile them once; no contender is charged for it but tvimdesign, which builds its own."""
        self.optimizer = Optimizer(sought)
        model, problem = self.optimizer.model, self.optimizer.problem
        self.model, self.limits, self.free = model, problem.limits, self.optimizer.free
        self.places = [model.index[free.name] for free in self.free]
        self.lower, self.upper = (np.array([getattr(free, end) for free in self.free]) for end in ("lower", "upper"))
        self.begin = model.start[self.places]
        self.weights = {name: w / self.optimizer.reference[name] for name, w in sought.minimize.items()}
        (self.event,) = problem.events
        self.phase = model.phases["softening"]
        self._state, self._inputs = ca.SX.sym("state", self.phase.state_size), ca.SX.sym("inputs", len(model.names))
        self.current = model.index["current"]
        self._algebra = Quick(self.algebra(model))
        self._heat = self._heat_functions()

    def algebra(self, model: DeviceFunctions) -> Any:
        """Return the function (inputs, time) -> objective, then every limit's residual, kept where <= 0."""
        wanted = list(dict.fromkeys([*self.weights, *(limit.output for limit in self.limits)]))
        time = ca.SX.sym("time")
        cycle = ca.vertcat(*(time if name == self.event else np.nan for name in model.switch_names))
        values = model.outputs(wanted)(self._inputs, cycle)
        objective = sum(weight * values[wanted.index(name)] for name, weight in self.weights.items())
        rows = [limit.residual(values[wanted.index(limit.output)]) for limit in self.limits]
        return ca.Function("algebra", [self._inputs, time], [ca.vertcat(objective, *rows)])

    def written_again(self) -> DeviceFunctions:
        """Return the model as symbols of CasADi's own arrays, with nothing written: how its users write equations."""
        known = self.model
        given = {**dict(zip(known.names, known.start.tolist(), strict=True)), **known.words}
        STRUCTURES.forget()
        return DeviceFunctions(known.table, given, known.points, known.cells)

    def _heat_functions(self) -> tuple[Quick, Quick, Quick]:
        profile = self._inputs[self.current]
        rates = self.phase.rates(self._state, profile, self._inputs)
        gap = self.phase.watch([self.event])(self._state, profile, self._inputs)
        slope = ca.densify(ca.jacobian(rates, self._state))
        arguments = [self._state, self._inputs]
        rates_of, slope_of, gap_of = (
            Quick(ca.Function(name, arguments, [value]))
            for name, value in (("rates", rates), ("slope", slope), ("gap", gap))
        )
        return rates_of, slope_of, gap_of

    def inputs(self, design: Array) -> Array:
        """Return the device's inputs with the eight variables at a design."""
        inputs = self.model.start.copy()
        inputs[self.places] = design
        return inputs

    def heat(self, design: Array) -> Heat:
        """Return the initial-value problem of a design."""
        inputs = self.inputs(design)
        start = np.asarray(self.phase.initial(inputs)).ravel()
        rates, slope, gap = self._heat
        return Heat(
            start,
            lambda _, state: rates(state, inputs),
            lambda _, state: slope(state, inputs),
            lambda _, state: float(gap(state, inputs)[0]),
        )

    def rows(self, design: Array, time: float) -> Array:
        """Objective, then the residuals."""
        return self._algebra(self.inputs(design), np.array([time])).ravel()

    def random_starts(self, count: int) -> list[Array]:
        """Designs drawn evenly in the logarithms between the bounds, the same for every contender.

        Where there is no such module, or its switch never ends, another one is drawn: no contender gets further there.
        """
        random = np.random.default_rng(1)
        low, high = np.log(self.lower), np.log(self.upper)
        starts: list[Array] = []
        while len(starts) < count:
            design = np.exp(random.uniform(low, high))
            if self._is_one(design):
                starts.append(design)
        return starts

    def _is_one(self, design: Array) -> bool:
        inputs, known = self.inputs(design), self.optimizer.multistart.cycle
        if not np.all(np.isfinite(self.rows(design, 1.0))):
            return False
        if impossible(self.model.values(inputs, known), self.model.table):
            return False  # no layer, or one of less than nothing: nothing of it can be simulated
        cycle = self.optimizer.simulator.run(inputs, phases=["softening"])
        return bool(np.isfinite(cycle.values[self.event]))
