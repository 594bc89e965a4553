"""The account of a solution: simulated and checked again outside the solver, and what holds it with what that costs.

Where the active limits stay the same, the optimum is an implicit function of where they stand.
Source: Fiacco, Introduction to Sensitivity and Stability Analysis in Nonlinear Programming (1983), ch. 3.
"""

from collections.abc import Collection, Iterable, Mapping
from copy import copy
from dataclasses import replace
from typing import Literal, TypeAlias

import numpy as np

from tvimdesign.device import Path, Table
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import resolve_study
from tvimdesign.solve.nlp import constraints
from tvimdesign.solve.nlp.constraints import Constraint
from tvimdesign.solve.nlp.problem_parts import Objective
from tvimdesign.solve.nlp.solution import ActiveConstraint, Solution, Start
from tvimdesign.solve.nlp.solver_run import FLAT_GOAL, OPTIMAL, Array, Derivatives, Run, meaning
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import Range, Study

Place: TypeAlias = tuple[Literal["row", "upper", "lower"], int]
"""Thing that moves: a row of the problem's constraints, or an end of the range of one of its unknowns."""

_FAINT = 1e-6  # Multiplier below which a limit presses on nothing, however near it is
_DEPENDENT = 1e-10  # Singular value, as a share of the greatest, below which rows depend on each other
_UNDETERMINED = 1e-6  # Share of an output's gradient that may be left over where the optimum determines the output


class Response:
    """Change of each minimised output, at one optimum, when limits are eased."""

    def __init__(self, optimizer: Optimizer, run: Run) -> None:
        """Linearise the optimality conditions of a converged run."""
        self._optimizer, self._run = optimizer, run
        derivatives = optimizer.derivatives(run)
        self._values = derivatives.values
        self._decided = self._decisions()
        tied = optimizer.problem.tied(self._run.multipliers * self._pressing(derivatives), derivatives.rows)
        along = self._along(derivatives, tied)
        self._places, rows = self._active(derivatives, along, tied)
        self._tangled = _tangled(rows)
        self._adjoints = self._solve(derivatives, along, rows)

    def sensitivity(self, places: Iterable[Place]) -> dict[str, float]:
        """Share of each minimised output that easing all the places by one saves, per unit; none where undetermined."""
        moved = [self._places.index(place) for place in places if place in self._places]
        if any(self._tangled[i] for i in moved):
            return {}
        return {
            name: float(np.sum(-self._adjoints[name][moved])) / abs(value)
            for name, value in self._values.items()
            if name in self._adjoints and value != 0.0
        }

    def _decisions(self) -> list[int]:
        """Places among the unknowns of what the optimiser decides: free numbers not held to a listed size, currents."""
        held = self._run.start.choices
        free = [i for i, number in enumerate(self._optimizer.free) if number.name not in held]
        currents = [range(place.start, place.stop) for _, place in self._optimizer.vector.places_of_currents()]
        return free + [i for places in currents for i in places]

    def _pressing(self, derivatives: Derivatives) -> Array:
        """Which rows press on the optimum."""
        every = zip(self._run.multipliers, -derivatives.rows, strict=True)
        return np.array([self._presses(multiplier, room) for multiplier, room in every])

    def _along(self, derivatives: Derivatives, tied: list[int]) -> Array:
        """Derivatives of all unknowns by the decisions, the equations kept."""
        problem = self._optimizer.problem
        fixed = set(range(len(problem.free))) - set(self._decided)
        follow = [i for i in range(problem.unknown_count) if i not in fixed and i not in set(self._decided)]
        rows = [*range(len(problem.free_currents)), *tied]  # the sums of shares move none of the times
        along = np.zeros((problem.unknown_count, len(self._decided)))
        along[self._decided, range(len(self._decided))] = 1.0
        if follow:
            by = derivatives.jacobian[rows]
            along[follow] = -np.linalg.solve(by[:, follow], by[:, self._decided])
        return along

    def _active(self, derivatives: Derivatives, along: Array, tied: list[int]) -> tuple[list[Place], Array]:
        """Return every place that presses on the optimum, and its derivatives by the decisions."""
        run, problem = self._run, self._optimizer.problem
        places: list[Place] = [
            ("row", i)
            for i in range(problem.equation_count, len(derivatives.rows))
            if i not in tied and self._presses(run.multipliers[i], -derivatives.rows[i])
        ]
        rows = list(derivatives.jacobian[[i for _, i in places]] @ along) if places else []
        lower, upper = self._optimizer.vector.bounds(run.within)
        for i in np.flatnonzero(np.isfinite(lower) | np.isfinite(upper)):
            multiplier, value = run.bound_multipliers[i], run.unknowns[i]
            if lower[i] == upper[i]:
                continue
            if self._presses(multiplier, upper[i] - value):
                places.append(("upper", int(i)))
                rows.append(along[i])
            elif self._presses(-multiplier, value - lower[i]):
                places.append(("lower", int(i)))
                rows.append(-along[i])
        return places, np.array(rows).reshape(len(places), along.shape[1])

    @staticmethod
    def _presses(multiplier: float, room: float) -> bool:
        """Return whether a limit is active: it presses, and has no more room than that."""
        return bool(multiplier > max(room, _FAINT))

    def _solve(self, derivatives: Derivatives, along: Array, rows: Array) -> dict[str, Array]:
        """Derivative of each minimised output by every active place, of those the optimum determines."""
        count, active = along.shape[1], len(rows)
        curvature = along.T @ derivatives.hessian @ along
        system = np.block([[curvature, rows.T], [rows, np.zeros((active, active))]])
        responses = {}
        for name, gradient in derivatives.gradients.items():
            right = np.concatenate([along.T @ gradient, np.zeros(active)])
            adjoint = np.linalg.lstsq(system, right, rcond=_DEPENDENT)[0]
            if np.linalg.norm(system @ adjoint - right) <= _UNDETERMINED * np.linalg.norm(right):
                responses[name] = adjoint[count:]
        return responses


def _tangled(rows: Array) -> list[bool]:
    """Which rows depend on one another: such limits share a multiplier as they like, so none has a price of its own."""
    directions, sizes, _ = np.linalg.svd(rows)
    rank = int(np.sum(sizes > _DEPENDENT * max(sizes, default=0.0)))
    return [bool(part) for part in np.any(np.abs(directions[:, rank:]) > _UNDETERMINED, axis=1)]


CYCLE_TOLERANCE = 2e-3
"""Share by which a limit on a row that depends on a switch may be broken: a search's steps against the simulation's."""


_SLEW_STEP = 1e-4
SAME_CURRENT = 1e-4  # Share of the range within which a current counts as at its end


def verify_optimum(optimizer: Optimizer, run: Run, starts: tuple[Start, ...], seconds: dict[str, float]) -> Solution:
    """Simulate and check a run's design again, and say what holds it."""
    cycle = optimizer.simulator.run(run.inputs, run.current_profiles)
    values = optimizer.model.values(run.inputs, cycle.values)
    response = Response(optimizer, run) if run.start.converged else None
    limits = _active_constraints(optimizer, run, values, response)
    feasible = all(is_met(limit, values[limit.output], optimizer.table) for limit in optimizer.problem.limits)
    ended = all(np.isfinite(cycle.values[event]) for event in optimizer.problem.events)
    if run.start.converged:
        status = OPTIMAL if feasible else "converged, but a check outside the solver fails"
        status = status if ended else "converged, but the switch does not end within `horizon`"
        status = FLAT_GOAL if status == OPTIMAL and _goal_flat(optimizer, run, starts) else status
    else:
        status = f"not converged: {meaning(run.start.status).words}"
    return Solution(
        status=status, feasible=feasible, model=optimizer.model, inputs=run.inputs,
        current_profiles=run.current_profiles, cycle=cycle, values=values,
        objective=sum(w * values[n] / optimizer.reference[n] for n, w in optimizer.study.minimize.items()),
        starts=starts,
        held=(*limits, *_active_bounds(optimizer, run, response), *_active_currents(optimizer, run, response)),
        reference={name: optimizer.reference[name] for name in optimizer.study.minimize}, seconds=seconds,
    )  # fmt: skip


def _goal_flat(optimizer: Optimizer, run: Run, starts: tuple[Start, ...]) -> bool:
    """Return whether the objective has no derivative by any unknown, where the search ended and at all starts."""
    if not optimizer.free and not optimizer.currents:
        return False
    parameters = optimizer.parameters(Objective(optimizer.study.minimize))
    if np.any(optimizer.problem.at(run.unknowns, parameters).gradient):
        return False
    begins = [optimizer.guess(optimizer.model.inputs(start.begin)) for start in starts]
    return not any(np.any(optimizer.problem.at(unknowns, parameters).gradient) for unknowns in begins)


def _active(
    optimizer: Optimizer, run: Run, limit: Constraint, residual: float, price: float, sensitivity: dict[str, float],
    *, where: str = "", held: str = "",
) -> ActiveConstraint:  # fmt: skip
    """Return a limit as it holds the design; `price` is what a scale of it costs, in the objective's unit."""
    return ActiveConstraint(
        name=f"{limit.name}{where}", output=limit.output,
        text=f"{constraints.in_words(limit, optimizer.table)}{held}", residual=float(residual),
        scale=limit.scale, absolute=limit.absolute, shadow_price=float(price) / (run.start.objective or 1.0),
        step=limit.step, origin=limit.origin, sensitivity=sensitivity,
    )  # fmt: skip


def _savings(response: Response | None, places: list[Place], per_scale: float = 1.0) -> dict[str, float]:
    """Return the saving of each minimised output, in percent, if places are eased by a hundredth of a scale."""
    savings = response.sensitivity(places) if response else {}
    return {name: share * per_scale for name, share in savings.items()}


def _active_constraints(
    optimizer: Optimizer, run: Run, values: dict[str, float], response: Response | None
) -> list[ActiveConstraint]:
    limits, first = optimizer.problem.limits, optimizer.problem.equation_count
    prices = run.multipliers[first : first + len(limits)]
    return [
        _active(
            optimizer, run, limit, limit.residual(values[limit.output]), price, _savings(response, [("row", first + i)])
        )
        for i, (limit, price) in enumerate(zip(limits, prices, strict=True))
    ]


_ENDS: tuple[tuple[Literal["upper", "lower"], Literal["<=", ">="], float], ...]
_ENDS = (("upper", "<=", 1.0), ("lower", ">=", -1.0))
"""Ends of a range, each with the sense of its limit and the sign of its multiplier."""


def _active_bounds(optimizer: Optimizer, run: Run, response: Response | None) -> list[ActiveConstraint]:
    """Return the active ends of ranges; a listed size has no end to move."""
    active = []
    for i, free in enumerate(optimizer.free):
        if not isinstance(optimizer.study.vary[free.name], Range):
            continue
        value = run.inputs[optimizer.model.index[free.name]]
        for end, sense, sign in _ENDS:
            bound = free.upper if end == "upper" else free.lower
            limit = constraints.make_constraint(optimizer.table, free.name, sense, bound, "vary")
            per_scale = float(limit.scale / abs(value if free.logarithmic else free.reference))
            price = max(sign * float(run.bound_multipliers[i]), 0.0) * per_scale
            savings = _savings(response, [(end, i)], per_scale)
            active.append(_active(optimizer, run, limit, limit.residual(value), price, savings))
    return active


def _active_currents(optimizer: Optimizer, run: Run, response: Response | None) -> list[ActiveConstraint]:
    """Return the active ends of a free current's range, all its nodes together, and the supply's slew."""
    active = []
    for current, place in optimizer.vector.places_of_currents():
        multipliers, shares = run.bound_multipliers[place], run.unknowns[place]
        for end, sense, sign in _ENDS:
            bound = current.upper if end == "upper" else current.lower
            limit = constraints.make_constraint(optimizer.table, current.row, sense, bound, "vary")
            beyond = sign * (shares - bound / current.upper)
            price = float(np.sum(np.maximum(sign * multipliers, 0.0))) * limit.scale / current.upper
            savings = _savings(
                response, [(end, i) for i in range(place.start, place.stop)], limit.scale / current.upper
            )
            at_it = f", at {int(np.sum(beyond >= -SAME_CURRENT))} of {current.nodes} moments of {current.phase}"
            active.append(
                _active(optimizer, run, limit, np.max(beyond), price, savings, where=f" in {current.phase}", held=at_it)
            )
    if optimizer.currents:
        slew = float(optimizer.model.start[optimizer.model.index["current_slew"]])
        limit = constraints.make_constraint(optimizer.table, "current_slew", "<=", slew, "module")
        steepest = max(profile.steepest for profile in run.current_profiles.values())
        active.append(_active(optimizer, run, limit, steepest / slew - 1.0, _price_of_slew(optimizer, run, slew), {}))
    return active


def _price_of_slew(optimizer: Optimizer, run: Run, slew: float) -> float:
    """Return the fall of the objective per share of slew: a difference of the Lagrangian, as ramps depend on it."""
    problem, parameters = optimizer.problem, optimizer.parameters(Objective(optimizer.study.minimize))
    values = []
    for share in (1.0 - _SLEW_STEP, 1.0 + _SLEW_STEP):
        other = copy(problem)
        other.free_currents = tuple(replace(current, slew=slew * share) for current in problem.free_currents)
        other.grids = run.grids
        other.forget()
        point = other.at(run.unknowns, parameters)
        values.append(point.objective + run.multipliers @ point.rows)
    return float(values[0] - values[1]) / (2.0 * _SLEW_STEP)


def happened(name: str, values: Mapping[str, float], table: Table) -> bool:
    """Return whether an output has a value: the peak of a phase that never started has none."""
    peaks = (need for need in table.output(name).needs if isinstance(table.quantity(need), Path))
    return not np.isnan(values[name]) and all(np.isfinite(values[peak]) for peak in peaks)


def is_met(limit: Constraint, value: float, table: Table) -> bool:
    """Return whether a value satisfies a limit, to the precision of its computation."""
    tolerance = CYCLE_TOLERANCE if constraints.on_cycle(table, limit.output) else constraints.ALGEBRAIC_TOLERANCE
    return bool(limit.residual(value) <= tolerance)


def exceeded(values: Mapping[str, float], table: Table) -> tuple[Constraint, ...]:
    """Return the ratings that a design exceeds; `values` holds every input and output in SI by full name."""
    return tuple(
        limit
        for limit in constraints.ratings_of(table)
        if happened(limit.output, values, table) and not is_met(limit, values[limit.output], table)
    )


def sorted_by_acceptance(names: Collection[str], accept: Collection[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Ratings exceeded, those that a study does not accept and those that it does."""
    return (tuple(name for name in names if name not in accept), tuple(name for name in names if name in accept))


def exceeded_at_start(study: Study) -> dict[str, float]:
    """Return the ratings that the start exceeds and the study does not accept: value (SI) by the rating's name.

    One working cycle is simulated. A rating that the study requires to be kept is left out. Raises SimulationError.
    """
    model = resolve_study(study).functions
    values = model.values(model.start, Simulator(model).run(model.start).values)
    required = {limit.output for limit in study.require if limit.sense == ">=" and limit.limit >= 0.0}
    names = (limit.output for limit in exceeded(values, study.table))
    return {name: values[name] for name in names if name not in required and name not in study.accept}
