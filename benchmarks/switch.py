"""One switch simulated by tvimdesign and by scipy's solvers on the same equations, side by side at the same accuracy.

Every solver finds the same four times: near face, mean and far face at the target temperature, and the joint soft. Each
of scipy's gets the loosest tolerance at which its times are as accurate as asked, measured against a solution that
is far tighter; tvimdesign's runs as shipped. All run in turn, so that what else the machine does hits all alike.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from quick import Quick
from scipy.integrate import solve_ivp

from tvimdesign.device import table_for
from tvimdesign.device.core import thermal_stack
from tvimdesign.device.core.impedance import warm_structure
from tvimdesign.device.shear import layer_heat
from tvimdesign.device.table import Module
from tvimdesign.physics.heat_flow import heat
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.symbols import ca
from tvimdesign.study import given, read_study

Array = NDArray[np.float64]
EVENTS = ("near_face_time", "mean_time", "far_face_time", "softening_time")
STUDY = Path(__file__).resolve().parents[1] / "studies/paper_reconstructed.yaml"
LADDER = [10.0 ** (-0.5 * k) for k in range(4, 25)]  # relative tolerances from 1e-2 to 1e-12


@dataclass(frozen=True)
class Equations:
    """Initial-value problem in one form or another, as scipy takes it."""

    start: Array
    rates: Callable[[float, Array], Any]
    gaps: Callable[[float, Array], Any]
    """What each of EVENTS waits for: it rises, and the event is where it passes zero."""
    jacobian: Callable[[float, Array], Any] | None = None
    sparsity: Array | None = None


@dataclass(frozen=True)
class Contender:
    """One way to simulate a switch; `solve` takes a relative tolerance."""

    name: str
    solve: Callable[[float], Array]


SETTLED = (
    "stack", "pcl_rheology", "structure_compliances", "structure_softening", "clamped_loss_factor",
    "lossless_compliance", "spring_stiffness", "pcl_depth", "heater_form", "pad_wall", "heater_along", "plate_to_edge",
    "uneven_sideways", "cold_end", "edge_length", "air_beside", "plate_slenderness", "pcl_area", "column_shares",
    "branch_scale",
)  # fmt: skip
"""What the joint's impedance at an instant needs to know of the module."""
AT_AN_INSTANT = (
    layer_heat.edge_drops, layer_heat.layer_surroundings, layer_heat.end_places, layer_heat.end_profile,
    layer_heat.layer_temperatures, thermal_stack.rheology_now, thermal_stack.slice_moduli,
    thermal_stack.column_compliances, thermal_stack.layer_moduli, thermal_stack.layer_stiffness_now,
    warm_structure.parts_now, warm_structure.support_now, thermal_stack.branch_now, thermal_stack.impedance_now,
)  # fmt: skip


def written_by_hand(model: DeviceFunctions, sparse: bool) -> Equations:
    """Write the equations as a user of numpy and scipy would: floats through `physics.heat`, a state as an array."""
    numbers = {name: float(value) for name, value in zip(model.names, model.start, strict=True)}
    known = {**model.words, **numbers, "rotor_cells": int(numbers["rotor_cells"])}
    values = model.table.evaluate(known, [*SETTLED, "layer_polar_moment", "joint_impedance@hot"])
    stack, moment = values["stack"], values["layer_polar_moment"]
    target, soft = numbers["target_temperature"], numbers["softening_band"] * values["joint_impedance@hot"]
    current, frequency, phase = numbers["current"], numbers["frequency@hot"], model.phases["softening"].phase

    def rates(_: float, state: Array) -> Any:
        return heat.rates(state, stack, current)

    def gaps(_: float, state: Array) -> list[Any]:
        now = heat.profile(state, stack)
        m = Module(
            phase=phase, stack_profile=now, stack_now=stack, frequency_now=frequency, moment_now=moment, **values
        )
        for function in AT_AN_INSTANT:
            setattr(m, function.__name__, function(m))
        mean = np.mean(now.cells)
        return [now.near - target, mean - target, now.far - target, np.log(soft / m.impedance_now)]

    start = np.asarray(model.phases["softening"].initial(model.start)).ravel()
    return Equations(start, rates, gaps, sparsity=_pattern(model) if sparse else None)


def compiled(model: DeviceFunctions) -> Equations:
    """Hand scipy tvimdesign's own compiled right-hand side, exact Jacobian and its events."""
    phase = model.phases["softening"]
    state, inputs = ca.SX.sym("state", phase.state_size), ca.SX.sym("inputs", len(model.names))
    current = inputs[model.index["current"]]
    rates = phase.rates(state, current, inputs)
    waits = phase.watch(EVENTS)(state, current, inputs)
    slope = ca.densify(ca.jacobian(rates, state))
    return Equations(
        np.asarray(phase.initial(model.start)).ravel(),
        *(
            _called(Quick(ca.Function(name, [state, inputs], [expression])), model.start)
            for name, expression in (("rates", rates), ("gaps", waits), ("jacobian", slope))
        ),
    )


def _called(function: Quick, inputs: Array) -> Callable[[float, Array], Array]:
    """Return a function of (state, inputs) as scipy calls it; time plays no part."""
    return lambda _, state: function(state, inputs)


def _pattern(model: DeviceFunctions) -> Array:
    return np.asarray(ca.DM(model.phases["softening"].rates.jac_sparsity(0, 0), 1).full())


def by_scipy(equations: Equations, method: str) -> Callable[[float], Array]:
    """Event times by `solve_ivp`, which stops at the last of them."""
    options: dict[str, Any] = {}
    if equations.jacobian is not None:
        options["jac"] = equations.jacobian
    if equations.sparsity is not None:
        options["jac_sparsity"] = equations.sparsity
    latest: list[Any] = [None, None]

    def watched(which: int) -> Callable[[float, Array], float]:
        def gap(now: float, state: Array) -> float:
            if latest[0] != now:  # the four events ask one after the other for the same instant
                latest[:] = now, equations.gaps(now, state)
            return float(latest[1][which])

        gap.terminal = EVENTS[which] == "far_face_time"  # how scipy learns it
        return gap

    def solve(tolerance: float) -> Array:
        latest[0] = None
        solved = solve_ivp(
            equations.rates, (0.0, 600.0), equations.start, method=method, rtol=tolerance, atol=1e-2 * tolerance,
            events=[watched(i) for i in range(len(EVENTS))], **options,
        )  # fmt: skip
        return np.array([times[0] if len(times) else np.inf for times in solved.t_events])

    return solve


def by_tvimdesign(model: DeviceFunctions) -> Callable[[float], Array]:
    """Event times as the product finds them, with its own tolerance, energies and peaks included."""
    simulator = Simulator(model)

    def solve(_: float) -> Array:
        values = simulator.run(model.start, phases=["softening"]).values
        return np.array([values[name] for name in EVENTS])

    return solve


def settled(contender: Contender, reference: Array, wanted: float) -> float:
    """Loosest tolerance at which, and at the next tighter one, the worst of the times is as accurate as wanted."""
    for tolerance, tighter in pairwise(LADDER):
        if max(_error(contender.solve(t), reference) for t in (tolerance, tighter)) <= wanted:
            return tolerance
    return LADDER[-1]


def _error(times: Array, reference: Array) -> float:
    return float(np.max(np.abs(times / reference - 1.0)))


def clocked(contenders: list[tuple[Contender, float]], repeats: int) -> list[float]:
    """Median time [s] of each contender, all run in turn."""
    taken: list[list[float]] = [[] for _ in contenders]
    for _ in range(repeats):
        for times, (contender, tolerance) in zip(taken, contenders, strict=True):
            begin = time.perf_counter()
            contender.solve(tolerance)
            times.append(time.perf_counter() - begin)
    return [statistics.median(times) for times in taken]


def table(model: DeviceFunctions, wanted: float | None, repeats: int) -> str:
    """Compare at an accuracy of the event times; None is as accurate as tvimdesign."""
    machine = compiled(model)
    ours = Contender("tvimdesign", by_tvimdesign(model))
    others = [
        Contender("BDF, numpy", by_scipy(written_by_hand(model, sparse=False), "BDF")),
        Contender("BDF, numpy, sparsity given", by_scipy(written_by_hand(model, sparse=True), "BDF")),
        Contender("LSODA, numpy", by_scipy(written_by_hand(model, sparse=False), "LSODA")),
        Contender("BDF, compiled, exact Jacobian", by_scipy(machine, "BDF")),
        Contender("LSODA, compiled, exact Jacobian", by_scipy(machine, "LSODA")),
        Contender("Radau, compiled, exact Jacobian", by_scipy(machine, "Radau")),
    ]
    reference = by_scipy(machine, "LSODA")(1e-12)
    wanted = wanted or max(_error(ours.solve(0.0), reference), 1e-8)
    runs = [(ours, 0.0), *((contender, settled(contender, reference, wanted)) for contender in others)]
    medians = clocked(runs, repeats)
    lines = [
        f"{len(machine.start)} states, event times within {wanted:.0e}, median of {repeats}",
        f"{'solver':34}{'tolerance':>10}{'error':>10}{'ms':>9}{'times tvimdesign':>18}",
    ]
    for (contender, tolerance), median in zip(runs, medians, strict=True):
        reported = f"{tolerance:.0e}" if tolerance else "shipped"
        error = _error(contender.solve(tolerance), reference)
        lines.append(f"{contender.name:34}{reported:>10}{error:>10.0e}{1e3 * median:>9.1f}{median / medians[0]:>18.1f}")
    return "\n".join(lines)


def main() -> None:
    """Print the comparison; with --out write it too."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=7, help="runs of each solver")
    parser.add_argument("--out", type=Path, help="text file to write the tables to")
    chosen = parser.parse_args()
    study = read_study(STUDY)
    rows = table_for(study.mode)
    model = DeviceFunctions(rows, given(study), tuple(study.operating_points), study.solver.cells)
    text = "\n\n".join(table(model, wanted, chosen.repeats) for wanted in (None, 1e-4))
    print(text)
    if chosen.out:
        chosen.out.write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
