"""Feasibility screen: a small problem tells early if any design within some ends satisfies the static limits.

The limits of arithmetic alone need no working cycle: they are a few dozen functions of the free numbers. What violates
those violates all. Designs all over the ranges that keep them say where to look before a study is infeasible.

Searches that begin at a few starts can end in a valley in which some limits cannot be met, though they can elsewhere.
Source: R. Storn, K. Price, Differential evolution, Journal of Global Optimization 11 (1997) 341-359, by scipy.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from tvimdesign.base.interrupts import raise_pending
from tvimdesign.solve.batch.batch_model import Kernel
from tvimdesign.solve.nlp.constraints import ALGEBRAIC_TOLERANCE, on_cycle
from tvimdesign.solve.nlp.decision_vector import DecisionVector, ExtendedProblem
from tvimdesign.solve.nlp.mixture import shared
from tvimdesign.solve.nlp.problem import Problem
from tvimdesign.solve.nlp.problem_parts import Parameters
from tvimdesign.solve.nlp.solver_run import NO_DESIGN, Array, Ends
from tvimdesign.solve.nlp.sqp import SqpSolver
from tvimdesign.solve.optimizer.optimizer import Optimizer

NOWHERE = 1e3  # Violation of each limit at a point without a module


class FeasibilityScreen:
    """The arithmetic limits of one problem, and the least by which they are broken within some ends."""

    def __init__(self, optimizer: Optimizer) -> None:
        """Write the problem of these limits, in which nothing is minimised; nothing is solved yet."""
        limits = [limit for limit in optimizer.problem.limits if not on_cycle(optimizer.table, limit.output)]
        problem = Problem(optimizer.model, optimizer.free, limits, (), mixtures=optimizer.mixtures)
        self._optimizer, self._problem, self._vector = optimizer, problem, DecisionVector(problem, optimizer.model)
        parameters = Parameters(optimizer.model.start, np.zeros(0), np.zeros((0, 0)))
        self._programme = ExtendedProblem(problem, parameters)
        self._outputs = Kernel(problem.outputs)

    @cached_property
    def _solver(self) -> SqpSolver:
        problem = self._problem
        sizes = problem.unknown_count, problem.row_count, problem.equation_count
        return SqpSolver(*sizes, ALGEBRAIC_TOLERANCE, feasible=True)

    def broken(self, inputs: Array) -> float:
        """Return the largest violation of a limit at some inputs, as a share of scale; infinite without geometry."""
        residuals = self._residuals(self._unknowns(inputs)[:, None])
        return float(np.max(residuals, initial=-np.inf)) if np.all(np.isfinite(residuals)) else np.inf

    def worst(self, unknowns: Array) -> Array:
        """Return the largest violation by each design, a column of the free numbers' unknowns each.

        Shares of records count by what they are of their sum.
        """
        points = np.array(unknowns)
        for mixture in self._optimizer.mixtures:
            places = [place for place, free in enumerate(self._optimizer.free) if free.name in mixture.shares]
            points[places] = np.apply_along_axis(shared, 0, points[places])
        worst: Array = np.max(self._residuals(points), axis=0, initial=-1.0)  # there may be no limit
        return np.nan_to_num(worst, nan=NOWHERE, posinf=NOWHERE)

    def inputs(self, unknowns: Array) -> Array:
        """Return the inputs of the study's start with the free numbers in their places."""
        numbers = zip(self._optimizer.free, unknowns, strict=True)
        return self._optimizer.model.inputs({free.name: free.to_value(unknown) for free, unknown in numbers})

    def _unknowns(self, inputs: Array) -> Array:
        index = self._optimizer.model.index
        return np.array([free.to_unknown(inputs[index[free.name]]) for free in self._optimizer.free])

    def _residuals(self, unknowns: Array) -> Array:
        """Return the limits' residuals, a row each, at the free numbers' unknowns, a column a design.

        Margins for what spreads are left out.
        """
        model, problem, count = self._optimizer.model, self._problem, unknowns.shape[1]
        inputs = np.repeat(model.start[:, None], count, axis=1)
        for free, row in zip(problem.free, unknowns, strict=True):
            inputs[model.index[free.name]] = free.to_value(row)
        cycle = np.full((len(model.switch_names), count), np.nan)  # read by none of them
        values = self._outputs(np.concatenate([inputs, cycle]))
        residuals = [limit.residual(values[problem.wanted.index(limit.output)]) for limit in problem.limits]
        return np.array(residuals).reshape(len(residuals), count)

    def impossible(self, within: Mapping[str, Ends], begins: Sequence[Array]) -> bool:
        """Return whether searches from some inputs all end where no step brings the limits nearer, within some ends.

        Raises KeyboardInterrupt if an interrupt ended one.
        """
        return all(self._status(within, begin) == NO_DESIGN for begin in begins)

    def _status(self, within: Mapping[str, Ends], begin: Array) -> str:
        """Return how a search for a point that satisfies the limits ends."""
        raise_pending()
        optimizer, count = self._optimizer, len(self._problem.limits)
        lower, upper = self._vector.bounds(within)
        least, largest = optimizer.with_room_where_decided(np.zeros(len(optimizer.mixtures)), within)
        self._solver(
            self._programme, optimizer.deadline, x0=self._unknowns(begin), lbx=lower, ubx=upper,
            lbg=np.append(least, np.full(count, -np.inf)), ubg=np.append(largest, np.zeros(count)),
        )  # fmt: skip
        return str(self._solver.stats()["return_status"])


_DRAWN, _DESIGNS = 12, 3  # Designs whose working cycle is simulated, and those of them that break their limits least
_GENERATIONS = 150
_EACH = 8  # Designs of a generation for each free number
_POINTS = 2048  # Points that are drawn where a whole evolution would take too long


def designs_all_over(optimizer: Optimizer, mixed: Callable[[Array], Array] = lambda inputs: inputs) -> list[Array]:
    """Inputs of some designs that keep the arithmetic limits, those first that break the others least, as simulated.

    Each is found from other random ones; there are none where none is. Where records are mixed, `mixed` puts shares
    into inputs. Raises KeyboardInterrupt where an interrupt came.
    """
    screen, seed = FeasibilityScreen(optimizer), optimizer.study.solver.seed
    designs: list[tuple[float, int, Array]] = []
    for number in range(_DRAWN):
        if optimizer.deadline.passed:
            break
        optimizer.progress(f"searching the whole ranges, {number + 1} of {_DRAWN}: no start satisfies the limits")
        inputs, worst = least_broken(optimizer, screen, seed + number, {})
        if not worst < 0.0:
            break
        inputs = mixed(inputs)
        designs.append((_broken(optimizer, inputs), number, inputs))
    return [inputs for _, _, inputs in sorted(designs, key=lambda design: design[:2])[:_DESIGNS]]


def _broken(optimizer: Optimizer, inputs: Array) -> float:
    """Return the largest violation of a limit by a simulated design; infinite if its switch never ends."""
    cycle = optimizer.multistart.trial(inputs)
    if cycle is None:
        return np.inf
    limits = optimizer.problem.limits
    values = optimizer.model.some_values(list(dict.fromkeys(limit.output for limit in limits)), inputs, cycle)
    worst = max((float(limit.residual(values[limit.output])) for limit in limits), default=0.0)
    return worst if np.isfinite(worst) else np.inf


def best_drawn(optimizer: Optimizer, screen: FeasibilityScreen, within: Mapping[str, Ends]) -> tuple[Array, float]:
    """Return the inputs of many random points that violate the arithmetic limits least, and the largest violation."""
    count = len(optimizer.free)
    lower, upper = (ends[:count, None] for ends in optimizer.vector.bounds(within))
    points = lower + np.random.default_rng(optimizer.study.solver.seed).random((count, _POINTS)) * (upper - lower)
    worst = screen.worst(points)
    best = int(np.argmin(worst))
    return screen.inputs(points[:, best]), float(worst[best])


def least_broken(
    optimizer: Optimizer, screen: FeasibilityScreen, seed: int, within: Mapping[str, Ends]
) -> tuple[Array, float]:
    """Run a differential evolution, some numbers within ends of their own.
    Return the inputs at its end and the largest violation of an arithmetic limit. It ends at the first feasible design.
    """
    from scipy.optimize import Bounds, OptimizeResult, differential_evolution  # a search that ends well needs no scipy

    count = len(optimizer.free)
    lower, upper = (ends[:count] for ends in optimizer.vector.bounds(within))

    def look(intermediate_result: OptimizeResult) -> None:
        raise_pending()
        if intermediate_result.fun < 0.0 or optimizer.deadline.passed:
            raise StopIteration

    def worst(unknowns: Array, *_: object) -> Any:
        return screen.worst(unknowns)

    answer = differential_evolution(
        worst, Bounds(lower, upper), maxiter=_GENERATIONS, popsize=_EACH, seed=seed,
        polish=False, tol=0.0, updating="deferred", vectorized=True, callback=look,
    )  # fmt: skip
    return screen.inputs(answer.x), float(answer.fun)
