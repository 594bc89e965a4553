"""A robust optimum: how far within its limits a design must stay so that modules that spread keep them.

Limits on algebraic outputs stay inside by expressions of the problem itself (`reserves`). Times, energies and peaks
follow from the working cycle; their spread comes from its exact derivatives at the optimum found, which is then sought
again. Where a yield is asked for, modules drawn at random correct what deviations alone say of an output that is no
normal one.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule
from tvimdesign.solve.nlp import spread
from tvimdesign.solve.nlp.constraints import on_cycle
from tvimdesign.solve.nlp.objective import Objective
from tvimdesign.solve.nlp.solver_run import Ends, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.sensitivity.output_sensitivity import output_sensitivities
from tvimdesign.solve.uncertainty.contributors import contributors_of
from tvimdesign.solve.uncertainty.yields import yields_of

ROUNDS = 6
_SETTLED = 1e-3
"""Change of a margin, as a share of its limit's scale, below which it is settled."""
_PRESSING = 1e-6
"""Multiplier from which on a limit holds the design, objectives a share of its scale."""


def settle(optimizer: Optimizer, run: Run, within: Mapping[str, Ends], objective: Objective | None = None) -> Run:
    """Seek the optimum `within` ends again until limits on what the cycle supplies are kept as robustly as the others,
    and where a yield is asked for until so many modules keep each limit.

    Returns the last run, converged or not; without such limits, the run as it is.
    """
    run = _settled(optimizer, run, within, objective)
    assert optimizer.study.robust is not None
    share = optimizer.study.robust.share
    return run if share is None else _reached(optimizer, run, within, objective, share)


def _settled(optimizer: Optimizer, run: Run, within: Mapping[str, Ends], objective: Objective | None) -> Run:
    """By deviations: margins of the limits on what the cycle supplies."""
    for _ in range(ROUNDS):
        if not run.start.converged:
            return run
        margins = _margins(optimizer, run)
        before = optimizer.margins
        optimizer.margins = margins
        _tell_what_is_not(optimizer, margins)
        if all(abs(value - before.get(name, 0.0)) < _SETTLED for name, value in margins.items()):
            return run
        optimizer.progress("staying within the limits on times by what they spread")
        run = _again(optimizer, run, within, objective)
    return run


def _reached(
    optimizer: Optimizer, run: Run, within: Mapping[str, Ends], objective: Objective | None, share: float
) -> Run:
    """By modules drawn: a limit that fewer keep gets what they miss it by for a margin; one that holds the design and
    that more keep gives back what it has too much.
    """
    for _ in range(ROUNDS):
        if not run.start.converged:
            return run
        drawn = yields_of(optimizer).at(run.inputs)
        beyond = drawn.beyond(share)
        pressing = _pressing(optimizer, run)
        moved = {
            name: value for name, value in beyond.items()
            if value > _SETTLED or (value < -_SETTLED and name in pressing)
        }  # fmt: skip
        if not moved:
            return run
        if not all(np.isfinite(value) for value in moved.values()):  # a time that never comes in too many modules
            return run
        optimizer.progress("staying within the limits by what modules drawn at random miss them by")
        optimizer.margins = {name: optimizer.margins.get(name, 0.0) + moved.get(name, 0.0)
                             for name in {**optimizer.margins, **moved}}  # fmt: skip
        run = _again(optimizer, run, within, objective)
    return run


def _pressing(optimizer: Optimizer, run: Run) -> set[str]:
    """The limits that hold a design."""
    first, limits = optimizer.problem.equation_count, optimizer.problem.limits
    of_limits = run.multipliers[first : first + len(limits)]
    return {limit.name for limit, multiplier in zip(limits, of_limits, strict=True) if multiplier > _PRESSING}


def _again(optimizer: Optimizer, run: Run, within: Mapping[str, Ends], objective: Objective | None) -> Run:
    """The optimum with other margins, warm from the one before and else from its inputs."""
    found = optimizer.solve(within, warm=run, objective=objective)
    return found if found.start.converged else optimizer.solve(within, begin=run.inputs, objective=objective)


def _tell_what_is_not(optimizer: Optimizer, margins: dict[str, float]) -> None:
    """Name the limits whose spread is not known: they are kept as drawn, no more."""
    timed = (limit for limit in optimizer.problem.limits if on_cycle(optimizer.table, limit.output))
    names = [limit.name for limit in timed if limit.name not in margins]
    if names:
        optimizer.progress(f"not robust, as a current follows a profile: {', '.join(names)}")


def _margins(optimizer: Optimizer, run: Run) -> dict[str, float]:
    """How far within the limits on times, energies and peaks to stay at a run's design."""
    study = optimizer.study
    assert study.robust is not None
    limits = [limit for limit in optimizer.problem.limits if on_cycle(optimizer.table, limit.output)]
    if not limits:
        return {}
    model = optimizer.model
    numbers = {name: float(run.inputs[i]) for name, i in model.index.items()}
    resolved = ResolvedModule(study, {**numbers, **model.words}, run.current_profiles)
    contributors = contributors_of(resolved)
    names = [contributor.name for contributor in contributors]
    options = study.solver
    wanted = list(dict.fromkeys(limit.output for limit in limits))
    exact = output_sensitivities(resolved, options.elements, options.cells, wanted, names)
    known = [contributors[names.index(name)] for name in exact.variables]
    deviations = dict(zip(exact.outputs, spread.shares(known, exact.derivatives)[0], strict=True))
    return {limit.name: study.robust.sigma * float(deviations.get(limit.output, np.nan)) / limit.scale
            for limit in limits if limit.output in deviations}  # fmt: skip
