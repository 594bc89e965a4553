"""Feasibility screen: a small problem tells early if any design within some ends satisfies the static limits.

The limits of arithmetic alone need no working cycle: they are a few dozen functions of the free numbers. What violates
those violates all. Designs all over the ranges that keep them say where to look before a study is infeasible.

Searches that begin at a few starts can end in a valley in which some limits cannot be met, though they can elsewhere.
For this reason two of 200 random studies were reported infeasible; eighty random designs held a feasible one.
Source: R. Storn, K. Price, Differential evolution, Journal of Global Optimization 11 (1997) 341-359, by scipy.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.base.interrupts import raise_pending
from tvimdesign.engine.tape import Tape
from tvimdesign.simulation.working_cycle.symbols import ca
from tvimdesign.solve.nlp.constraints import ALGEBRAIC_TOLERANCE, on_cycle
from tvimdesign.solve.nlp.mixture import shared
from tvimdesign.solve.nlp.solver_run import NO_DESIGN, Array, Ends
from tvimdesign.solve.nlp.sqp import SqpSolver
from tvimdesign.solve.optimizer.optimizer import Optimizer

NOWHERE = 1e3  # Violation of each limit at a point without a module


class _Rows(NamedTuple):
    """Limits at a point."""

    objective: float
    gradient: Array
    rows: Array
    jacobian: Array


class FeasibilityScreen:
    """The arithmetic limits of one problem, and the least by which they are broken within some ends."""

    def __init__(self, optimizer: Optimizer) -> None:
        """Write the problem; nothing is solved yet."""
        self._optimizer = optimizer
        self._unknowns = ca.MX.sym("free", len(optimizer.free))
        limits = self._residuals(self._unknowns)
        self._count = limits.numel()
        self._at: Any = ca.Function("residuals", [self._unknowns], [limits]).expand()
        self._sums = optimizer.problem.shares_less_one(self._inputs(self._unknowns))

    def _inputs(self, unknowns: Any) -> Any:
        """Return the study's inputs with the free numbers in their places (MX)."""
        return self._optimizer.problem.with_unknowns(ca.MX(ca.DM(self._optimizer.model.start)), unknowns)

    @cached_property
    def _rows(self) -> Tape:
        """Record the sums of mixtures' shares less one, and the limits' residuals."""
        rows = ca.vertcat(self._sums, self._at(self._unknowns))
        return Tape.of_function(ca.Function("rows", [self._unknowns], [ca.densify(rows)]).expand())

    @cached_property
    def _solver(self) -> SqpSolver:
        equations = len(self._optimizer.mixtures)
        sizes = len(self._optimizer.free), equations + self._count, equations
        return SqpSolver(*sizes, ALGEBRAIC_TOLERANCE, feasible=True)

    def at(self, x: Array) -> _Rows:
        """Evaluate the limits at some unknowns; nothing is minimised."""
        ((rows, slopes),) = self._rows.tangents([x], [np.eye(len(x))])
        return _Rows(0.0, np.zeros(len(x)), rows, slopes)

    def broken(self, inputs: Array) -> float:
        """Return the largest violation of a limit at some inputs, as a share of scale; infinite without geometry."""
        optimizer = self._optimizer
        unknowns = [free.to_unknown(inputs[optimizer.model.index[free.name]]) for free in optimizer.free]
        residuals = np.asarray(self._at(unknowns)).ravel()
        return float(np.max(residuals, initial=-np.inf)) if np.all(np.isfinite(residuals)) else np.inf

    def worst(self, unknowns: Array) -> Array:
        """Return the largest violation by each design, a column of the free numbers' unknowns each.

        Shares of records count by what they are of their sum.
        """
        points = np.array(unknowns)
        for mixture in self._optimizer.mixtures:
            places = [place for place, free in enumerate(self._optimizer.free) if free.name in mixture.shares]
            points[places] = np.apply_along_axis(shared, 0, points[places])
        residuals = np.asarray(self._at(points)).reshape(self._count, points.shape[1])  # there may be no limit
        worst: Array = np.max(residuals, axis=0, initial=-1.0)
        return np.nan_to_num(worst, nan=NOWHERE, posinf=NOWHERE)

    def _residuals(self, unknowns: Any) -> Any:
        """Those of the arithmetic limits at the free numbers' unknowns; margins for what spreads are left out."""
        problem, model = self._optimizer.problem, self._optimizer.model
        limits = [limit for limit in problem.limits if not on_cycle(self._optimizer.table, limit.output)]
        wanted = list(dict.fromkeys(limit.output for limit in limits))
        if not wanted:
            return ca.MX(0, 1)
        values = model.outputs(wanted)(
            self._inputs(unknowns), np.full(len(model.switch_names), np.nan)
        )  # read by none of them
        return ca.vertcat(*(limit.residual(values[wanted.index(limit.output)]) for limit in limits))

    def impossible(self, within: Mapping[str, Ends], begins: Sequence[Array]) -> bool:
        """Return whether searches from some inputs all end where no step brings the limits nearer, within some ends.

        Raises KeyboardInterrupt if an interrupt ended one.
        """
        return all(self._status(within, begin) == NO_DESIGN for begin in begins)

    def _status(self, within: Mapping[str, Ends], begin: Array) -> str:
        """Return how a search for a point that satisfies the limits ends."""
        raise_pending()
        optimizer, count = self._optimizer, len(self._optimizer.free)
        lower, upper = (ends[:count] for ends in optimizer.vector.bounds(within))
        start = np.array([free.to_unknown(begin[optimizer.model.index[free.name]]) for free in optimizer.free])
        least, largest = optimizer.with_room_where_decided(np.zeros(len(optimizer.mixtures)), within)
        self._solver(
            self, optimizer.deadline, x0=start, lbx=lower, ubx=upper,
            lbg=np.append(least, np.full(self._count, -np.inf)), ubg=np.append(largest, np.zeros(self._count)),
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
    return _inputs_at(optimizer, points[:, best]), float(worst[best])


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
    return _inputs_at(optimizer, answer.x), float(answer.fun)


def _inputs_at(optimizer: Optimizer, unknowns: Array) -> Array:
    """Return the inputs of the study's start with the free numbers in their places."""
    inputs: Array = optimizer.model.start.copy()
    for free, unknown in zip(optimizer.free, unknowns, strict=True):
        inputs[optimizer.model.index[free.name]] = free.to_value(unknown)
    return inputs
