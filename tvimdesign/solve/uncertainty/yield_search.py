"""Best design for a requested yield: margins from modules drawn at random, in rounds.

At a design, modules are drawn from the tolerances. What they come to at a design nearby follows from the first order
of both, so that few designs are drawn. Each limit that holds the design, or that too many modules break,
is tightened by one and the same quantile of its own residual, the least with which the share asked for would keep all
limits together if residuals moved as a whole. The optimum is then sought again, warm, and modules are drawn anew.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.errors import SimulationError, TimeOverError
from tvimdesign.base.units import format_quantity
from tvimdesign.solve.nlp.constraints import ALGEBRAIC_TOLERANCE
from tvimdesign.solve.nlp.problem_parts import Objective
from tvimdesign.solve.nlp.solution import same_optimum
from tvimdesign.solve.nlp.solver_run import MARGINS, Array, Ends, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.uncertainty.yields import Drawn, Yields, yields_of

ROUNDS, MOST_ROUNDS, PREDICTIONS = 4, 8, 5
"""Designs whose modules are drawn, how many at most while each of them keeps more than those before, and at most how
many between two of them are predicted from the last one's."""
_SETTLED, _SHORT = 0.02, 0.005
"""Change of a margin, in standard deviations of what it is for, below which it is settled: where the yield is reached,
and where it is short of that.
"""
_MEDIAN, _DEVIATION = 0.5, 0.8413
"""Shares of a normal distribution up to its middle, and up to one standard deviation beyond."""
PRESSING = 1e-6  # Multiplier from which on a limit holds the design, objectives a share of its scale
_UNKNOWN = 0.1
"""Step of a margin, as a share of its limit's scale, where too many modules never come to its output at all."""
_NO_ROOM = 0.05  # Share of a step of the margins that counts as none
SHAKES, MANY_SHAKES, _SHAKE = 1, 8, 0.2
"""Designs beside one that bears nothing of a step: at first, and where no yield is reached so; and how far off they are
at most, as a share of each range. About one in four leads on."""
_GAIN = 1e-3  # Share of the objective that margins which are larger than the yield needs must be worth to be given back
_AIM = 0.05  # Share of what may be lost that is aimed to be kept, so that margins which are settled do reach the yield


@dataclass(frozen=True)
class Robust:
    """A converged design, its margins, and its yield over the modules drawn."""

    run: Run
    margins: dict[str, float]  # By limit [shares of its scale]
    share: float
    reached: bool  # True if that is as many as asked, to the lower end of its interval of 95 %
    plausible: bool = True  # True if enough plausible cases satisfy each limit


def reach_yield(
    optimizer: Optimizer, run: Run, within: Mapping[str, Ends], share: float, objective: Objective | None = None,
    shakes: int = SHAKES,
) -> Robust:  # fmt: skip
    """Seek the optimum `within` ends again from a converged run, until `share` of the modules is feasible.

    Returns the best design that reaches it, else the one that most modules keep; its margins stay with the optimizer.
    Raises TimeOverError where the time is over before modules are drawn of the first.
    """
    candidates: list[Robust] = []
    yields, aim = yields_of(optimizer), share + _AIM * (1.0 - share)
    model, table = optimizer.model, optimizer.table
    sizes = [
        f"{name} {format_quantity(run.inputs[model.index[name]], table.unit(name))}"
        for name, (low, high) in within.items() if low == high
    ]  # fmt: skip
    which = f", with {', '.join(sizes)}" if sizes else ""
    for number in range(MOST_ROUNDS):
        optimizer.progress(f"simulating modules with random deviations{which}")
        if number >= ROUNDS and candidates[-1].share <= max(candidate.share for candidate in candidates[:-1]):
            break
        try:
            drawn = yields.compared(run.inputs, share, optimizer.deadline)
        except TimeOverError:
            if not candidates:
                raise
            optimizer.deadline.leave_out(MARGINS)
            break
        margins = dict(optimizer.margins)
        candidates.append(Robust(run, margins, drawn.together.share, drawn.together.low >= share))
        multipliers = pressing(optimizer, run)
        moves = _moves(drawn, aim, margins, multipliers, optimizer.floors, room_of(optimizer, run))
        gain = -sum(multipliers.get(name, 0.0) * move for name, move in moves.items())
        if not moves or (candidates[-1].reached and gain < _GAIN * abs(run.start.objective)) or _no_better(candidates):
            break
        at_first = "with the margins so far" if any(margins.values()) else "without margins"
        before = f"after round {number} of margins" if number else at_first
        optimizer.progress(
            f"adding tolerance margins{which}: yield {drawn.together.share:.1%} {before}, target {share:.0%}"
        )
        following = _settled(optimizer, yields, run, drawn, within, aim, objective, moves, shakes)
        if following is run:
            if optimizer.deadline.passed:
                optimizer.deadline.leave_out(MARGINS)
            break
        run = following
    best = min(
        candidates,
        key=lambda candidate: (
            not candidate.reached,
            candidate.run.start.objective if candidate.reached else -candidate.share,
        ),
    )
    optimizer.margins = best.margins
    return best


def _settled(
    optimizer: Optimizer, yields: Yields, run: Run, drawn: Drawn, within: Mapping[str, Ends], aim: float,
    objective: Objective | None, moves: Mapping[str, float], shakes: int,
) -> Run:  # fmt: skip
    """Return the optimum whose margins fit its predicted modules; the run itself if there is none."""
    first = run
    for _ in range(PREDICTIONS):
        following = tightened(optimizer, run, within, objective, moves, shakes if run is first else 0)
        if following is None:
            break
        settled, run = same_optimum(run.start, following.start), following
        if settled:
            break
        try:
            predicted = yields.beside(run.inputs, first.inputs, drawn)
        except SimulationError:
            break
        active, room = pressing(optimizer, run), room_of(optimizer, run)
        moves = _moves(predicted, aim, optimizer.margins, active, optimizer.floors, room)
        if not moves:
            break
    return run


def tightened(
    optimizer: Optimizer, run: Run, within: Mapping[str, Ends], objective: Objective | None, moves: Mapping[str, float],
    shakes: int = SHAKES,
) -> Run | None:  # fmt: skip
    """Return the optimum with moved margins, or with the largest share of the moves that a design nearby bears.

    Where the design itself bears none of them, one a little beside it may.
    """
    margins, random = dict(optimizer.margins), np.random.default_rng(optimizer.study.solver.seed)
    for attempt in range(1 + shakes):
        unknowns = optimizer.vector.shaken(run.unknowns, within, _SHAKE, random) if attempt else run.unknowns
        optimizer.margins = margins
        tried = optimizer.solve(within, unknowns=unknowns, objective=objective, moves=moves, near=True)
        taken = max((optimizer.margins.get(name, 0.0) - margins.get(name, 0.0)) / move for name, move in moves.items())
        if tried.start.converged and taken > _NO_ROOM:
            return tried
    if shakes and not optimizer.deadline.passed:
        # The share may stop at a kink near none, where the whole step has an optimum of its own.
        optimizer.margins = {name: margins.get(name, 0.0) + moves.get(name, 0.0) for name in {**margins, **moves}}
        tried = optimizer.solve(within, begin=run.inputs, objective=objective, near=True)
        if tried.start.converged:
            return tried
    optimizer.margins = margins
    return None


def _no_better(candidates: Sequence[Robust]) -> bool:
    """Return whether the last round but one reached the yield, and the last misses it or ends at the same objective."""
    if len(candidates) < 2 or not candidates[-2].reached:
        return False
    before, last = candidates[-2:]
    return not last.reached or same_optimum(before.run.start, last.run.start)


def _moves(
    drawn: Drawn,
    share: float,
    margins: Mapping[str, float],
    active: Collection[str],
    floors: Mapping[str, float] | None = None,
    room: Mapping[str, float] | None = None,
) -> dict[str, float]:
    """By how much to move the margin of each limit; empty where all are settled.

    A limit that holds the design, or has a margin, gives back what it has too much, down to its floor or zero. One that
    needs more gets it beyond the `room` that it has: less would not move the design.
    """
    ordered = np.sort(np.where(np.isnan(drawn.residuals), np.inf, drawn.residuals), axis=1)
    before = np.array([margins.get(limit.name, 0.0) for limit in drawn.limits])
    may_give = np.array([limit.name in active for limit in drawn.limits]) | (before > 0.0)
    first, last = 0, drawn.residuals.shape[1] - 1
    while first < last:
        middle = (first + last) // 2
        if drawn.within(_shifts(ordered, middle, may_give)).low >= share:
            last = middle
        else:
            first = middle + 1
    shifts = np.where(np.isinf(shifts := _shifts(ordered, last, may_give)), _UNKNOWN, shifts)
    used = np.array([(room or {}).get(limit.name, 0.0) for limit in drawn.limits])
    after = np.where(shifts > 0.0, np.maximum(before, used), before) + shifts
    moved = np.maximum(after, [(floors or {}).get(limit.name, 0.0) for limit in drawn.limits]) - before
    middle, beyond = (ordered[:, int(share_of * (ordered.shape[1] - 1))] for share_of in (_MEDIAN, _DEVIATION))
    settled = _SETTLED if drawn.together.low >= share else _SHORT
    deviations = np.where(np.isinf(beyond), _UNKNOWN, beyond - middle)
    unsettled = np.abs(moved) > settled * deviations + ALGEBRAIC_TOLERANCE
    holding = np.array([limit.name in active for limit in drawn.limits], dtype=bool)
    if not np.any(unsettled & (holding | (moved > 0.0))):
        return {}
    return {drawn.limits[i].name: float(moved[i]) for i in np.flatnonzero(unsettled)}


def _shifts(ordered: Array, place: int, may_give: NDArray[np.bool_]) -> Array:
    """Return the fall of each limit's residual that so many modules need; it may rise where the limit has room."""
    beyond = ordered[:, place]
    return np.where(may_give, beyond, np.maximum(beyond, 0.0))


def pressing(optimizer: Optimizer, run: Run) -> dict[str, float]:
    """Return the active limits of a design by name, with their multipliers, the largest first."""
    first, limits = optimizer.problem.equation_count, optimizer.problem.limits
    of_limits = run.multipliers[first : first + len(limits)].tolist()
    active = [(limit.name, value) for limit, value in zip(limits, of_limits, strict=True) if value > PRESSING]
    return dict(sorted(active, key=lambda limit: -limit[1]))


def room_of(optimizer: Optimizer, run: Run) -> dict[str, float]:
    """Return how far within each limit a design is, by name [shares of its scale]."""
    problem = optimizer.problem
    problem.grids = run.grids
    rows = problem.at(run.unknowns, optimizer.parameters(Objective(optimizer.study.minimize))).rows
    return {limit.name: -float(row) for limit, row in zip(problem.limits, rows[problem.equation_count :], strict=False)}
