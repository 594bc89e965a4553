"""An optimum sought again where its times, simulated, are not those that the optimiser's few points in time gave.

Each limit on what a cycle supplies is moved by what the two differ, until the simulated design keeps it and the optimum
lies no further within it than it has to.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tvimdesign.errors import SimulationError
from tvimdesign.solve.account import SWITCH_TOLERANCE
from tvimdesign.solve.goal import Goal
from tvimdesign.solve.limits import on_switch
from tvimdesign.solve.optimizer import Optimizer
from tvimdesign.solve.run import Ends, Run

ROUNDS = 3
_PRESSING = 1e-6
"""Multiplier from which on a limit holds the design, objectives a share of its scale."""


def corrected(optimizer: Optimizer, run: Run, within: Mapping[str, Ends]) -> Run:
    """The optimum `within` ends whose simulated design keeps the limits on its switch: the run as it is where it does.

    Returns the first run where no round leads to another optimum; the check that follows then says what it breaks.
    """
    wanted, first, found = dict(optimizer.margins), run, run
    for _ in range(ROUNDS):
        off = _off(optimizer, found, wanted)
        if not off:
            return found
        optimizer.progress("moving the limits on times by what the simulation says")
        optimizer.margins = {
            name: optimizer.margins.get(name, 0.0) + off.get(name, 0.0) for name in {**optimizer.margins, **off}
        }
        found = again(optimizer, found, within)
        if not found.start.converged:
            break
    if found.start.converged and not _off(optimizer, found, wanted):
        return found
    optimizer.margins = wanted
    return first


def _off(optimizer: Optimizer, run: Run, wanted: Mapping[str, float]) -> dict[str, float]:
    """By limit, how far the simulated design is beyond its margin, shares of the limit's scale: broken, or kept by more
    than the optimum needs. Empty where nothing is off by more than the tolerance, and where the switch does not end.
    """
    problem, model = optimizer.problem, optimizer.model
    limits = [limit for limit in problem.limits if on_switch(optimizer.table, limit.output)]
    if not limits or not run.start.converged:
        return {}
    try:
        switch = problem.simulated(optimizer.simulator, run.inputs, run.drives)
    except SimulationError:
        return {}
    values = model.some_values([limit.output for limit in limits], run.inputs, switch.values)
    if not all(np.isfinite(value) for value in values.values()):
        return {}
    holding = pressing(optimizer, run)
    beyond = {limit.name: float(limit.residual(values[limit.output])) + wanted.get(limit.name, 0.0) for limit in limits}
    return {
        name: share for name, share in beyond.items()
        if share > SWITCH_TOLERANCE or (name in holding and -share > SWITCH_TOLERANCE)
    }  # fmt: skip


def pressing(optimizer: Optimizer, run: Run) -> set[str]:
    """The limits that hold a design."""
    first, limits = optimizer.problem.equation_count, optimizer.problem.limits
    of_limits = run.multipliers[first : first + len(limits)]
    return {limit.name for limit, multiplier in zip(limits, of_limits, strict=True) if multiplier > _PRESSING}


def again(optimizer: Optimizer, run: Run, within: Mapping[str, Ends], goal: Goal | None = None) -> Run:
    """The optimum with other margins, warm from the one before and else from its inputs."""
    found = optimizer.solve(within, warm=run, goal=goal)
    return found if found.start.converged else optimizer.solve(within, begin=run.inputs, goal=goal)
