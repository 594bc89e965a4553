"""Designs all over the ranges that keep what depends on no working cycle: where to look before a study is infeasible.

Searches that begin at a few starts can end in a valley in which some limits cannot be kept, though they can elsewhere.
For this reason two of 200 random studies were reported infeasible; eighty random designs held a feasible one.
Source: R. Storn, K. Price, Differential evolution, Journal of Global Optimization 11 (1997) 341-359, by scipy.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from tvimdesign.base.interrupts import raise_pending
from tvimdesign.solve.infeasibility.feasibility_screen import FeasibilityScreen
from tvimdesign.solve.nlp.solver_run import Array, Ends
from tvimdesign.solve.optimizer.optimizer import Optimizer

_DRAWN, _DESIGNS = 12, 3
"""Designs whose working cycle is simulated, and those of them that break their limits least."""
_GENERATIONS = 150
_EACH = 8
"""Designs of a generation for each free number."""
_POINTS = 2048
"""Points that are drawn where a whole evolution would take too long."""


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
        inputs = _one_design(optimizer, screen, seed + number)
        if inputs is None:
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


def _one_design(optimizer: Optimizer, screen: FeasibilityScreen, seed: int) -> Array | None:
    """Return the first design of a differential evolution that satisfies the limits."""
    inputs, worst = least_broken(optimizer, screen, seed, {})
    return inputs if worst < 0.0 else None


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
