"""Sequential quadratic programming for programmes of few unknowns and many limits, nearly all of them slack.

Each step minimises a quadratic model of the Lagrangian, whose curvature is learned from its gradients (BFGS, damped),
within a trust region and the limits' linear models. Where these have no point in common, every limit yields at a price,
which rises until they are satisfied or none can be brought nearer. A step is judged by the objective and the price of
all breaches; where the limits' curvature spoils one, a second one makes up for it. Quadratic programmes go to DAQP.
[Nocedal, Wright, Numerical optimization, 2006, ch. 18; Byrd, Nocedal, Waltz, Optim. Methods Softw. 23 (2008), 197;
Arnstroem, Bemporad, Axehill, IEEE Trans. Autom. Control 67 (2022), 4362]
"""

from collections.abc import Mapping
from functools import cached_property
from typing import Any, NamedTuple, Protocol

import numpy as np

from tvimdesign.base.deadline import Deadline
from tvimdesign.simulation.working_cycle.symbols import ca
from tvimdesign.solve.nlp.problem_parts import Array, Point
from tvimdesign.solve.nlp.solver_run import ITERATIONS_OVER, NO_DESIGN, NO_MODULE, NO_STEP, SOLVED, TIME_OVER

MOST_ITERATIONS = 100
FIRST_PRICE, DEAREST, DEARER = 10.0, 1e5, 5.0
"""Price of a breach in the objective's unit: at first, the last that is raised, and by what factor."""
SHARE, STILL = 0.1, 1e-3
"""Share of what could be taken off the breaches that a step may leave; share of them below which that is nothing."""
STATIONARY, SETTLED = 5e-7, 1e-9
"""Slope of the Lagrangian at an optimum, and the fall of the objective that is still expected there."""
FLAT, FLATTEST, STEEPEST = 1e-2, 1e-5, 1e4
"""Curvature before any is known, what is added to it, and the largest that is believed, for multipliers up to one."""
CREEP, PATIENCE = 1e-7, 5
"""Change of a feasible objective that is next to none; steps in a row without more that end a run."""
SLACKS = 16
SAME = 1e-9  # Difference of slopes and rooms up to which two limits are one
SHORT = 1e-6  # Step along which gradients change by too little to learn from
FIRST_RADIUS, LARGEST, LEAST = 1.0, 10.0, 1e-8
GOOD, FAIR, LITTLE, POOR = 0.75, 0.25, 0.1, 0.01
"""Shares of the expected gain: from the first on the region grows, below the second it shrinks, below the third a
second step is tried, and below the last a step is taken back."""
ROUNDING = 1e-14
_DAMPED = 0.2  # Least curvature along a step after an update, as a share of that before
_QP: dict[str, Any] = {"error_on_fail": False, "daqp": {"primal_tol": 1e-11, "dual_tol": 1e-12, "iter_limit": 2000}}


class Programme(Protocol):
    """A nonlinear programme that a solver can be given."""

    def at(self, x: Array) -> Point:
        """Evaluate the programme at a point: objective, gradient, rows of the constraints and their Jacobian."""


class Step(NamedTuple):
    """Solution of a quadratic programme."""

    by: Array
    toll: float  # Toll of what is left of the breaches, to first order
    of_limits: Array  # Multipliers
    of_bounds: Array

    @property
    def length(self) -> float:
        """Return the largest change of an unknown."""
        return float(np.max(np.abs(self.by), initial=0.0))


def toll(breaches: Array) -> float:
    """Return what breaches cost: each itself, and half its square."""
    return float(np.sum(breaches) + 0.5 * breaches @ breaches)


class QuadraticProgramme:
    """Quadratic programmes of one size. Where limits yield, the worst do each by its own slack, the others by one.

    Arguments stay in memory: CasADi would take five times as long to convert them.
    """

    def __init__(self, unknowns: int, limits: int, slacks: int = 0) -> None:
        self._unknowns, self._slacks = unknowns, slacks
        size = unknowns + slacks
        shapes = {"h": ca.Sparsity.dense(size, size), "a": ca.Sparsity.dense(limits, size)}
        solver: Any = ca.conic("step", "daqp", shapes, _QP)
        self._memory, self._run = solver.buffer()
        given = {name: np.zeros(solver.numel_in(i)) for i, name in enumerate(solver.name_in())}
        results = {name: np.zeros(solver.numel_out(i)) for i, name in enumerate(solver.name_out())}
        for set_array, arrays in ((self._memory.set_arg, given), (self._memory.set_res, results)):
            for i, values in enumerate(arrays.values()):
                if values.size:
                    set_array(i, values.data)
        self._given, self._results = given, results
        self._hessian, self._slopes = given["h"].reshape(size, size), given["a"].reshape(size, limits)
        given["lba"][:], given["ubx"][unknowns:] = -np.inf, np.inf

    def solve(
        self, curvature: Array, gradient: Array | float, slopes: Array, room: Array, ends: tuple[Array, Array],
        price: float = 0.0,
    ) -> Step | None:  # fmt: skip
        """Return the step within its ends of least model, and price of breaches; None where there is none."""
        given, n = self._given, self._unknowns
        self._hessian[:n, :n], given["g"][:n], given["uba"][:] = curvature, gradient, room
        self._hessian[np.arange(n), np.arange(n)] += FLATTEST
        self._slopes[:n] = slopes.T
        given["lbx"][:n], given["ubx"][:n] = ends
        if self._slacks:
            own = np.minimum(np.argsort(np.argsort(room)), self._slacks - 1)
            self._slopes[n:] = np.where(own == np.arange(self._slacks)[:, None], -1.0, 0.0)
            slacks = np.arange(n, n + self._slacks)
            self._hessian[slacks, slacks] = given["g"][n:] = price
        self._run()
        if not self._memory.stats()["success"]:
            return None
        x, of_limits, of_bounds = (self._results[name].copy() for name in ("x", "lam_a", "lam_x"))
        breaches = np.maximum(slopes @ x[:n] - room, 0.0) if self._slacks else np.zeros(0)
        return Step(x[:n], toll(breaches), of_limits, of_bounds[:n])


class SqpSolver:
    """Solver of programmes of so many unknowns and rows, each given with its run."""

    def __init__(
        self, unknowns: int, rows: int, equations: int, tolerance: float, most: int = MOST_ITERATIONS, *,
        feasible: bool = False,
    ) -> None:  # fmt: skip
        """Take sizes; the first rows are `equations`, the others have no lower bound.

        A breach up to the `tolerance` counts as none. Runs take `most` iterations and end, with `feasible`, at the
        first point that satisfies the limits.
        """
        self.rows, self.equations = rows, equations
        self.plain = QuadraticProgramme(unknowns, rows + equations)
        self._unknowns = unknowns
        self.tolerance, self.most, self.feasible = tolerance, most, feasible
        self._stats: dict[str, Any] = {}

    @cached_property
    def elastic(self) -> QuadraticProgramme:
        """The quadratic programme whose limits yield."""
        limits = self.rows + self.equations
        return QuadraticProgramme(self._unknowns, limits, min(SLACKS, limits))

    def stats(self) -> dict[str, Any]:
        """Return how the last run ended, as nlpsol does."""
        return self._stats

    def __call__(self, programme: Programme, deadline: Deadline, *, x0: Array, **ends: Array) -> dict[str, Any]:
        """Return where a search from x0 ends, as nlpsol does; `ends` are its bounds of unknowns and rows."""
        search = _Search(self, programme, ends)
        status = search.run(np.asarray(x0), deadline)
        self._stats = {
            "success": status == SOLVED, "return_status": status, "iter_count": search.iterations,
        }  # fmt: skip
        here, of_limits = search.here, np.zeros(self.rows + self.equations)
        of_bounds = np.zeros(len(here.x))
        if search.last is not None:
            of_limits, of_bounds = search.last.of_limits, search.last.of_bounds
        for i in np.flatnonzero(of_limits > 0.0):  # a limit that is written twice presses once with each
            apart = np.max(
                np.abs(np.column_stack([here.slopes, here.passed]) - [*here.slopes[i], here.passed[i]]), axis=1
            )
            of_limits[apart < SAME] = np.mean(of_limits[apart < SAME])
        of_rows = of_limits[: self.rows].copy()
        of_rows[: self.equations] -= of_limits[self.rows :]
        return {"x": here.x, "f": here.point.objective, "lam_g": of_rows, "lam_x": of_bounds}


class _Here(NamedTuple):
    """A programme at a point."""

    x: Array
    point: Point
    passed: Array  # By how much each limit is passed
    slopes: Array
    toll: float  # Of its breaches; NaN where a limit or a slope is no number

    def gradient(self, multipliers: Array) -> Array:
        """Return the gradient of the Lagrangian."""
        return np.asarray(self.point.gradient + multipliers @ self.slopes)

    def merit(self, price: float) -> float:
        """Return the objective and the price of breaches; infinity where either is no number."""
        merit = self.point.objective + price * self.toll
        return merit if np.isfinite(merit) else np.inf


class _Search:
    """One run of the solver."""

    def __init__(self, solver: SqpSolver, programme: Programme, ends: Mapping[str, Array]) -> None:
        self._solver, self._programme, self._ends = solver, programme, ends
        self._price, self._radius, self.iterations = FIRST_PRICE, FIRST_RADIUS, 0
        self._curvature, self._learned = FLAT * np.eye(len(ends["lbx"])), False
        self._creeping = 0  # Steps in a row that hardly change anything
        self.here: _Here
        self.last: Step | None = None

    def run(self, x: Array, deadline: Deadline) -> str:
        """Return the status with which the search ends `here`; multipliers are those of the `last` step."""
        self.here = self._at(x)
        status = NO_MODULE if np.isinf(self.here.merit(1.0)) else ""
        while not status:
            self.iterations += 1
            step, nearest = self._step()
            if step is None:
                status = "" if self._learned else NO_STEP
                self._curvature, self._learned = FLAT * np.eye(len(x)), False
                continue
            self.last, stuck = step, False
            if nearest is not None and self.here.toll - nearest.toll <= STILL * self.here.toll:
                stuck = nearest.length < 0.999 * self._radius or self._radius >= FIRST_RADIUS
                self.last, self._radius = nearest, FIRST_RADIUS
            if stuck:
                status = NO_DESIGN
            elif self._stationary(step):
                status = SOLVED
            elif self.iterations >= self._solver.most:
                status = ITERATIONS_OVER
            elif deadline.passed:
                status = TIME_OVER
            elif self._creeping >= PATIENCE and self.here.toll == 0.0:
                status = SOLVED
            else:
                before = self.here.point.objective
                self._take(step)
                still = abs(self.here.point.objective - before) <= CREEP
                self._creeping = self._creeping + 1 if still and self.here.toll <= 10.0 * CREEP else 0
                if (self._solver.feasible and self.here.toll == 0.0) or self._radius < LEAST:
                    status = SOLVED if self.here.toll == 0.0 else NO_DESIGN
        return status

    def _at(self, x: Array) -> _Here:
        ends, first = self._ends, self._solver.equations
        x = np.clip(x, ends["lbx"], ends["ubx"])
        point = self._programme.at(x)
        passed = np.concatenate([point.rows - ends["ubg"], ends["lbg"][:first] - point.rows[:first]])
        slopes = np.concatenate([point.jacobian, -point.jacobian[:first]])
        breaches = np.maximum(passed, 0.0)
        if not np.all(np.isfinite(slopes)):
            return _Here(x, point, passed, slopes, np.nan)
        inside = np.max(breaches, initial=0.0) <= self._solver.tolerance
        return _Here(x, point, passed, slopes, 0.0 if inside else toll(breaches))

    def _within(self) -> tuple[Array, Array]:
        """Return the ends of a step: the region's, and the unknowns' bounds."""
        lower, upper = (self._ends[name] - self.here.x for name in ("lbx", "ubx"))
        return np.maximum(lower, -self._radius), np.minimum(upper, self._radius)

    def _step(self) -> tuple[Step | None, Step | None]:
        """Return a step within the limits' linear models, or at a price that leads about as near to them as any; and
        one that comes nearest, where none is within.
        """
        here, ends = self.here, self._within()
        arguments = here.slopes, -here.passed, ends
        step = self._solver.plain.solve(self._curvature, here.point.gradient, *arguments)
        if step is not None:
            self._price = max(self._price, 2.0 * float(np.max(np.abs(step.of_limits), initial=0.0)))
            return step, None
        nearest = self._solver.elastic.solve(np.zeros(self._curvature.shape), 0.0, *arguments, 1.0)
        if nearest is None:
            return None, None
        while True:
            step = self._solver.elastic.solve(self._curvature, here.point.gradient, *arguments, self._price)
            if step is None or self._price >= DEAREST:
                break
            if step.toll <= max(nearest.toll + SHARE * (here.toll - nearest.toll), self._solver.tolerance):
                break
            self._price *= DEARER
        return step, nearest if here.toll > 0.0 else None

    def _stationary(self, step: Step) -> bool:
        """Return whether a feasible point is an optimum, as far as steps can be computed."""
        here = self.here
        change = here.point.gradient @ step.by + 0.5 * step.by @ self._curvature @ step.by
        if here.toll == 0.0 and step.length <= LEAST:
            return True
        if here.toll > 0.0 or change < -SETTLED * (1.0 + abs(here.point.objective)):
            return False
        if step.length >= 0.999 * self._radius > SHORT:
            return False
        slope = here.gradient(step.of_limits) + step.of_bounds
        return bool(step.length <= SHORT or np.max(np.abs(slope)) <= STATIONARY)

    def _take(self, step: Step) -> None:
        """Go where a step leads, if that is better; fit region and curvature to what is there."""
        here, merit = self.here, self.here.merit(self._price)
        quadratic = here.point.gradient @ step.by + 0.5 * step.by @ self._curvature @ step.by
        expected = self._price * (here.toll - step.toll) - quadratic
        there = self._at(here.x + step.by)
        if np.isfinite(there.merit(1.0)) and not merit - there.merit(self._price) >= LITTLE * expected:
            there = self._bent(step, there, float(merit - POOR * expected))
        gained, noise = merit - there.merit(self._price), ROUNDING * (1.0 + abs(merit))
        if np.isfinite(gained):
            self._learn(there, step.of_limits)
        if gained >= POOR * expected or (abs(gained) <= noise and expected <= 10.0 * noise):
            if gained > GOOD * expected and step.length >= 0.999 * self._radius:
                self._radius = min(2.0 * self._radius, LARGEST)
            elif gained < FAIR * expected:
                self._radius = 0.5 * step.length
            self.here = there
        else:
            self._radius = 0.3 * step.length

    def _bent(self, step: Step, there: _Here, most: float) -> _Here:
        """Return where a second step leads, for limits whose curvature is that found at the end of the first; the
        first's end where its merit is better, or `most` is passed.
        """
        here = self.here
        room = here.slopes @ step.by - there.passed
        gradient, ends = here.point.gradient, self._within()
        again = self._solver.plain.solve(self._curvature, gradient, here.slopes, room, ends)
        if again is None:
            return there
        second = self._at(here.x + again.by)
        return second if second.merit(self._price) < min(there.merit(self._price), most) else there

    def _learn(self, there: _Here, multipliers: Array) -> None:
        """Let the curvature explain how the Lagrangian's gradient changes, as far as that is positive."""
        step, change = there.x - self.here.x, there.gradient(multipliers) - self.here.gradient(multipliers)
        along, square = float(step @ change), float(step @ step)
        if not np.max(np.abs(step), initial=0.0) > SHORT:
            return
        curvature = self._curvature
        if not self._learned and along > 0.0:
            curvature = np.eye(len(step)) * min(max(along / square, FLAT**2), STEEPEST)
        moved = curvature @ step
        before = float(step @ moved)
        if along < _DAMPED * before:
            share = (1.0 - _DAMPED) * before / (before - along)
            change = share * change + (1.0 - share) * moved
            along = float(step @ change)
        if change @ change <= STEEPEST * max(1.0, float(np.sum(np.abs(multipliers)))) * along:
            curvature = curvature + np.outer(change, change) / along - np.outer(moved, moved) / before
        self._curvature, self._learned = curvature, True
