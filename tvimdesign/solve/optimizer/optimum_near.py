"""The optimum of a study near known values, as while a limit, a range, a weight or a fixed number of it moves."""

from collections.abc import Mapping
from dataclasses import dataclass

from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.solve.optimizer.optimizer import Optimizer

AT_END = 1e-4  # Share of the range, or of a limit's scale, within which a number counts as at its end
_PRESSES = 1e-6  # Multiplier over the objective above which a limit costs something


@dataclass(frozen=True)
class NearOptimum:
    """An optimum and its active constraints."""

    run: Run
    active: tuple[str, ...]
    """Limits that press, by name (`holding_torque >=`), each with the requirement it is part of, if it is of one."""
    ends: dict[str, str]  # Variables that press against an end of their range: `lower` or `upper`

    @property
    def converged(self) -> bool:
        """Return the solver's verdict that this is an optimum."""
        return self.run.start.converged


def optimum_near(optimizer: Optimizer, near: Mapping[str, float], *, or_start: bool = False) -> NearOptimum:
    """Return the optimum of a problem from some values [SI] of its free numbers, put into their ranges.

    If there is none and with `or_start`, it is looked for from the study's start.
    """
    known = [free for free in optimizer.free if free.name in near]
    inside = {free.name: min(max(near[free.name], free.lower), free.upper) for free in known}
    run = optimizer.solve(begin=optimizer.model.inputs(inside), near=True)
    if or_start and not run.start.converged:
        run = optimizer.solve()
    first, least = optimizer.problem.equation_count, _PRESSES * abs(run.start.objective or 1.0)
    prices = run.multipliers[first : first + len(optimizer.problem.limits)]
    active = [limit.name for limit, price in zip(optimizer.problem.limits, prices, strict=True) if price > least]
    ends = {}
    for free, price in zip(optimizer.free, run.bound_multipliers, strict=False):
        value = run.inputs[optimizer.model.index[free.name]]
        room = AT_END * (free.upper - free.lower)
        if price > least and value >= free.upper - room:
            ends[free.name] = "upper"
        elif price < -least and value <= free.lower + room:
            ends[free.name] = "lower"
    return NearOptimum(run, tuple(active), ends)
