"""Exact derivatives of a module's outputs by its variables, the working cycle included.

Arithmetic rows are differentiated as they are. Times, energies and steady states follow from the equations of the cycle
by the implicit function theorem: with F(y, x) = 0, dy/dx = -(dF/dy)^-1 dF/dx; a peak is the sample that is greatest.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.errors import SimulationError
from tvimdesign.base.units import from_si
from tvimdesign.device import FirstOscillation, Table
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule
from tvimdesign.simulation.working_cycle.trajectory import Cycle
from tvimdesign.solve.nlp.problem import Problem
from tvimdesign.solve.nlp.transcription import guess

Array = NDArray[np.float64]

FINER = 4
"""Time elements for each of the study's where derivatives are told: with twelve the exponents of the paper's modules
are within 0.02 % of a simulation's differences, of a thin layer at 2 A within 0.4 %; where blocks freeze a cell at a
time, within 6 %."""
_STEPS = 200
_CLOSE = 1e-10
"""Newton's last step, in unknowns that are of the order of one."""
_LEAST_SHARE = 1e-3
"""Share of a step below which it is taken as it is."""
_NOTHING = 1e-4
"""Value, in the unit people read it in, below which a share of it means nothing: a gap that is closed."""


_STEP = "the outputs were differentiated"


@dataclass(frozen=True)
class OutputSensitivity:
    """What one variable does to one output, all else the same."""

    output: str
    variable: str
    derivative: float
    """SI over SI."""
    logarithmic: float | None
    """d ln output / d ln variable; None where one is nothing, or a temperature or what is left to one: their zero is
    a convention."""
    per_hundredth: float
    """What a hundredth more of the variable adds to the output, SI."""


@dataclass(frozen=True)
class OutputSensitivities:
    """What every variable does to every output at one design; rows `outputs`, columns `variables`."""

    outputs: tuple[str, ...]
    variables: tuple[str, ...]
    values: Array
    at: Array
    derivatives: Array
    left_out: tuple[str, ...]
    """Outputs that never happen in this design, or hang on a current that follows a profile."""


def output_sensitivities(
    resolved: ResolvedModule, elements: int, cells: int, wanted: Sequence[str], by: Sequence[str] | None = None,
    deadline: Deadline = NEVER,
) -> OutputSensitivities:  # fmt: skip
    """Differentiate the wanted outputs by every variable of the module, or `by` some inputs.

    Raises SimulationError, TimeOverError.
    """
    model = DeviceFunctions(resolved.table, resolved.values, resolved.points, cells)
    simulator = Simulator(model)
    cycle = simulator.run(model.start, resolved.current_profiles, deadline=deadline)
    names = [n for n in wanted if not isinstance(resolved.table.quantity(n), FirstOscillation)]
    supplied = {name: _supplied_behind(model, name) for name in names}
    lost = _lost(model, cycle, set(resolved.current_profiles))
    kept = [name for name in names if not supplied[name] & lost]
    variables = by or [row.name for row in resolved.table.inputs if _is_variable(resolved, model, row.name)]
    variables = [name for name in variables if name not in resolved.replaced]
    needed = sorted({one for name in kept for one in supplied[name]})
    place = [model.index[name] for name in variables]
    of_cycle = np.zeros((len(model.switch_names), len(place)))
    if needed:
        of_cycle = _cycle_by_inputs(simulator, cycle, needed, place, elements, deadline)
    inputs, seen = ca.MX.sym("inputs", len(model.names)), ca.MX.sym("cycle", len(model.switch_names))
    outputs = model.outputs(kept)(inputs, seen)
    function = ca.Function("by", [inputs, seen], [outputs, ca.jacobian(outputs, inputs), ca.jacobian(outputs, seen)])
    # What nothing wanted depends on may be infinite; its derivative is a structural zero and it is never read.
    numbers = np.array([cycle.values[name] if name in needed else 1.0 for name in model.switch_names])
    values, by_inputs, by_switch = (np.asarray(ca.DM(one).full()) for one in function(model.start, numbers))
    left_out = tuple(name for name in names if name not in kept)
    derivatives = by_inputs[:, place] + by_switch @ of_cycle
    return OutputSensitivities(tuple(kept), tuple(variables), values.ravel(), model.start[place], derivatives, left_out)


def entries(found: OutputSensitivities, resolved: ResolvedModule) -> list[OutputSensitivity]:
    """One record for each output and variable, in the order of the table."""
    records = []
    table = resolved.table
    sizes = [_has_size(table.unit(name), value) for name, value in zip(found.variables, found.at, strict=True)]
    for i, output in enumerate(found.outputs):
        has_size = _has_size(table.unit(output), found.values[i])
        for j, variable in enumerate(found.variables):
            derivative = float(found.derivatives[i, j])
            share = derivative * float(found.at[j] / found.values[i]) if has_size and sizes[j] else None
            records.append(
                OutputSensitivity(output, variable, derivative, share, 0.01 * float(found.at[j]) * derivative)
            )
    return records


def _has_size(unit: str, value: float) -> bool:
    return unit not in ("degC", "K") and abs(from_si(value, unit)) > _NOTHING


def _is_variable(resolved: ResolvedModule, model: DeviceFunctions, name: str) -> bool:
    """What a study may vary and this module has; a count is no variable."""
    row = resolved.table.quantity(name)
    return name in model.index and getattr(row, "variable", False) and not getattr(row, "integer", False)


def _supplied_behind(model: DeviceFunctions, name: str) -> set[str]:
    above = {name.partition("@")[0], *model.table.ancestors(name)}
    return above & set(model.switch_names)


def _lost(model: DeviceFunctions, cycle: Cycle, driven: set[str]) -> set[str]:
    """Rows the cycle does not supply here: those that never happen, and those of or after a phase with a profile."""
    return {name for name, value in cycle.values.items() if not np.isfinite(value)} | behind_profiles(
        model.table, driven
    )


def behind_profiles(table: Table, driven: Collection[str]) -> set[str]:
    """The supplied rows of phases whose current follows a profile, and of phases that come after or are like them."""
    touched = set(driven)
    for phase in table.phases:
        if phase.after in touched or phase.like in touched:
            touched.add(phase.name)
    return {row.name for row in table.supplied if row.phase in touched}


def _cycle_by_inputs(
    simulator: Simulator, cycle: Cycle, needed: Sequence[str], inputs: Sequence[int], elements: int, deadline: Deadline
) -> Array:
    """Derivatives of what the cycle supplies by some of the inputs, from the equations the optimiser hands to IPOPT."""
    model = simulator.model
    problem = Problem(model, (), (), needed, elements)
    x, p = problem.function["x"], problem.function["p"]
    count, peaks = problem.equation_count, problem.peak_count
    equations, samples = problem.function["g"][:count], problem.function["g"][count:]
    deadline.check(_STEP)
    places = [model.switch_names.index(name) for name in needed]
    reached = problem.cycle[places]
    newton = ca.Function("newton", [x, p], [equations, ca.jacobian(equations, x)])
    given = np.concatenate([model.start, np.ones(len(needed))])
    unknowns = _solved(newton, _begin(problem, simulator, cycle), given, len(problem.peaks))
    deadline.check(_STEP)
    rows, by_x, by_p, ends_by_x, ends_by_p = ca.Function(
        "cycle", [x, p],
        [samples, *(ca.jacobian(problem.function["g"], one) for one in (x, p)),
         *(ca.jacobian(reached, one) for one in (x, p))],
    )(unknowns, given)  # fmt: skip
    tied = _greatest(np.asarray(rows).ravel(), by_x, count, len(problem.peaks)) if peaks else []
    kept = [*range(count), *tied]
    along = splu(_sparse(by_x)[kept].tocsc()).solve(_sparse(by_p)[kept][:, inputs].toarray())
    found = np.zeros((len(model.switch_names), len(inputs)))
    found[places] = _sparse(ends_by_p)[:, inputs].toarray() - _sparse(ends_by_x) @ along
    return found


def _begin(problem: Problem, simulator: Simulator, cycle: Cycle) -> Array:
    """The simulated cycle as unknowns: each event's block up to its own time, which may lie beyond its phase's end."""
    inputs, parts = problem.model.start, []
    for block in problem.blocks:
        phase, end = block.phase.phase, cycle.values[block.event]
        before = cycle.trajectories[phase.after].states[:, -1] if phase.after else None
        course = simulator.trace(phase.name, inputs, before, end)
        parts += [guess(course, problem.elements(phase.name)).ravel(order="F"), [np.log(end)]]
    parts += [cycle.balances[balance.phase] for balance in problem.balances]
    return np.concatenate([*parts, np.zeros(len(problem.peaks))])


def _solved(newton: Any, begin: Array, given: Array, peaks: int) -> Array:
    """Newton's method on the equations; the peaks, last among the unknowns, are not in them.

    A step is halved until the next one, by the same Jacobian, would be shorter: the residual says little where a layer
    freezes at a sharp edge. Source: Deuflhard, Newton Methods for Nonlinear Problems (2004), ch. 3.3, natural level
    functions.
    """
    found, last = begin.copy(), len(begin) - peaks
    rest, by_unknowns = newton(found, given)
    for _ in range(_STEPS):
        solve = splu(_sparse(by_unknowns)[:, :last].tocsc()).solve
        step, share = solve(np.asarray(rest).ravel()), 1.0
        if np.max(np.abs(step)) < _CLOSE:
            return found
        while True:
            trial = np.append(found[:last] - share * step, found[last:])
            rest, by_unknowns = newton(trial, given)
            beyond = solve(np.nan_to_num(np.asarray(rest).ravel(), nan=np.inf))
            if np.linalg.norm(beyond) <= (1.0 - share / 4.0) * np.linalg.norm(step) or share < _LEAST_SHARE:
                break
            share /= 2.0
        if not np.all(np.isfinite(np.asarray(rest))):
            break
        found = trial
    raise SimulationError("the cycle's equations could not be solved for derivatives; try more solver.elements")


def _greatest(samples: Array, by_x: Any, first: int, peaks: int) -> list[int]:
    """Row of the greatest sample of each peak; the peaks stand last among the unknowns, at zero."""
    columns = _sparse(by_x)[first:, -peaks:].toarray()
    return [first + int(max(np.flatnonzero(column), key=lambda i: samples[i])) for column in columns.T]


def _sparse(matrix: Any) -> csc_matrix:
    return csc_matrix(ca.DM(matrix).sparse())
