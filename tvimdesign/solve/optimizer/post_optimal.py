"""Response of an optimum to a moved limit: the implicit function theorem on its optimality conditions.

Where the active limits stay the same, the optimum is an implicit function of where they stand.
Source: Fiacco, Introduction to Sensitivity and Stability Analysis in Nonlinear Programming (1983), ch. 3.
"""

from collections.abc import Iterable
from dataclasses import replace
from typing import Literal, TypeAlias

import numpy as np

from tvimdesign.solve.nlp.solver_run import Array, Derivatives, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer

Place: TypeAlias = tuple[Literal["row", "upper", "lower"], int]
"""What moves: a row of the problem's constraints, or an end of the range of one of its unknowns."""

_FAINT = 1e-6
"""Multiplier below which a limit presses on nothing, however near it is."""
_CLEAR = 100.0
"""Times the one of multiplier and room must be the other for a limit to be told as active, or as slack: their product
is the barrier where IPOPT ended."""
_DEPENDENT = 1e-10
"""Singular value, as a share of the greatest, below which rows depend on each other."""
_UNDETERMINED = 1e-6
"""Share of an output's gradient that may be left over where the optimum determines the output."""


class Response:
    """Change of each minimised output, at one optimum, when limits are eased."""

    def __init__(self, optimizer: Optimizer, run: Run) -> None:
        """Linearise the optimality conditions of a converged run."""
        self._optimizer, self._run = optimizer, run
        derivatives = optimizer.derivatives(run)
        if self._unclear(derivatives):
            derivatives = self._sharpened(derivatives)
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

    def _unclear(self, derivatives: Derivatives) -> bool:
        """Return whether some limit or bound is not clearly active: it hardly presses and has hardly any room.

        Where the objective is flat along a limit, one that is wrongly taken for slack changes every saving.
        """
        run, first = self._run, self._optimizer.problem.equation_count
        lower, upper = self._optimizer.vector.bounds(run.within)
        multipliers = np.concatenate([run.multipliers[first:], run.bound_multipliers, -run.bound_multipliers])
        room = np.concatenate([-derivatives.rows[first:], upper - run.unknowns, run.unknowns - lower])
        room = np.maximum(room, 0.0)
        likely = (multipliers > _FAINT) & (multipliers < _CLEAR * room)
        return bool(np.any(likely & (room < _CLEAR * multipliers)))

    def _sharpened(self, derivatives: Derivatives) -> Derivatives:
        """Derivatives where the same optimum is found more exactly; those there are where it is not."""
        run = self._optimizer.solve(self._run.within, warm=self._run, beginning="sharp")
        if not run.start.converged:
            return derivatives
        run.start = replace(run.start, choices=self._run.start.choices)
        self._run = run
        return self._optimizer.derivatives(run)

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
        """Return whether a limit is active: at IPOPT's end, multiplier times room is one small number for all."""
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
