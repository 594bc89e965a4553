"""The lightest designs of one study over the torque that is held and the time of a full cycle, cell by cell.

Every cell is a pair of bounds on one problem that is built once. The walk begins at the study's own optimum, goes up
and down the torques, and from the lightest design of each to shorter cycles and to the torques beside. Where a search
has no design, steps are halved. A cell is empty where the fastest or softest design of its torque misses it, or a
search for it, or for less, ends at limits.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

from tvimdesign.base.errors import InfeasibleError
from tvimdesign.solve.nlp.problem_parts import Bound, Objective
from tvimdesign.solve.nlp.solver_run import OPTIMAL, Progress, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.pareto.tradeoff import ONE_POINT, Failure, Point, Tradeoff
from tvimdesign.solve.search import optimize
from tvimdesign.study import Study, given

TORQUE, CYCLE, MASS, ENERGY, HOT = "holding_torque", "cycle_time", "module_mass", "cycle_energy", "joint_stiffness@hot"
TRADED = (TORQUE, CYCLE, MASS, ENERGY, HOT)
EMPTY, UNANSWERED = "empty", "unanswered"
_SIDE = 1e-3  # Weight of what is not asked for: of two designs alike in mass the faster, and the one of less energy
_STEP = 0.03  # Least step, a logarithm of torque or time
_NAMED = 3  # Limits that are named where a cell is empty
_MOST_MISS = 1e3
"""Miss of a search that ends at limits: larger than a design's, less than that of one which does not end."""


@dataclass(frozen=True)
class MapCell:
    """Answer for a torque to be held [N*m] and a longest cycle [s]."""

    torque: float
    cycle: float
    status: str  # `optimal`, `empty`, or `unanswered`
    values: dict[str, float] = field(default_factory=dict)
    """Inputs and outputs of the design, SI; of an empty cell those of the design that comes nearest."""
    limits: tuple[str, ...] = ()
    """Limits with the largest multipliers: what makes the design heavier, or the cell empty."""


def map_of(
    study: Study, torques: Sequence[float], cycles: Sequence[float], softness: float, progress: Progress
) -> list[MapCell]:
    """Return a cell for each torque and longest cycle.

    `softness` is the most stiffness [N*m/rad] of the soft joint over the torque asked [N*m].
    """
    built: list[tuple[Optimizer, list[Run]]] = []
    progress("the lightest design")
    try:
        solution = optimize(
            study, keep=lambda optimizer, runs: built.append((optimizer, runs)), objectives=_traded(study), checked=True
        )
    except InfeasibleError as error:
        return [MapCell(torque, cycle, EMPTY, limits=(str(error),)) for torque in torques for cycle in cycles]
    if solution.status != OPTIMAL:
        ended = solution.conflict_set
        limits = tuple(side.text for side in ended.sides[:_NAMED]) if ended else (solution.status,)
        status = EMPTY if ended else UNANSWERED
        return [MapCell(torque, cycle, status, limits=limits) for torque in torques for cycle in cycles]
    return _Walk(Tradeoff(study, solution, *built[0], progress), softness, sorted(cycles, reverse=True)).over(torques)


def _traded(study: Study) -> tuple[str, ...]:
    """Return what is traded, and the parts whose least is the torque: each is bounded, as their least has kinks."""
    table, given_options = study.table, given(study)
    parts = [name for name in table.output(TORQUE).least_of if table.output(name).exists(given_options)]
    return (*TRADED, *parts)


@dataclass(frozen=True)
class _Ask:
    """Torque [N*m] and longest cycle [s] of a cell."""

    torque: float
    cycle: float = math.inf

    def halfway(self, other: _Ask) -> _Ask:
        """Return the geometric mean of two of the same cycle or torque."""
        return _Ask(math.sqrt(self.torque * other.torque), math.sqrt(self.cycle * other.cycle))

    def apart(self, other: _Ask) -> float:
        """Return the logarithm of the ratio in which two differ."""
        cycles = math.log(self.cycle / other.cycle) if math.isfinite(self.cycle) else 0.0
        return max(abs(math.log(self.torque / other.torque)), abs(cycles))


@dataclass
class _Row:
    """Designs of a torque [N*m]: one for each cycle that is reached, the longest first."""

    torque: float
    near: Point  # Design that comes nearest to the next cycle
    designs: list[Point] = field(default_factory=list)
    status: str = OPTIMAL  # Status of the cells without a design, once they are answered
    at_limits: bool = False  # True if a search for the next cycle ended at limits


class _Way(NamedTuple):
    """Way by short steps: its last design, what no design reached, if anything, and whether that ended at limits."""

    near: Point
    end: _Ask | None = None
    at_limits: bool = False


class _Walk:
    """The walk over one problem."""

    def __init__(self, trade: Tradeoff, softness: float, cycles: Sequence[float]) -> None:
        self._trade, self._softness, self._cycles = trade, softness, cycles
        self._parts = [name for name in trade.reference if name not in TRADED]
        self._followed: set[tuple[float, float, int]] = set()

    def over(self, torques: Sequence[float]) -> list[MapCell]:
        """Walk to every torque, to shorter cycles, across from the torques beside, and from the fastest designs."""
        held = self._trade.optimum.values[TORQUE]
        down = self._along(sorted((torque for torque in torques if torque <= held), reverse=True))
        rows = [*reversed(down), *self._along(sorted(torque for torque in torques if torque > held))]
        reached = [row for row in rows if row.status == OPTIMAL]
        for row in reached:
            self._shorten(row)
        beside = [*pairwise(reached), *pairwise(reached[::-1])]
        while any(self._follow(*rows) for rows in beside) or any(self._hurry(row) for row in reached):
            pass
        return [self._cell(row, place) for row in rows for place in range(len(self._cycles))]

    def _along(self, torques: Sequence[float]) -> list[_Row]:
        """Return a row for each torque; those beyond a torque without a design are as that one is."""
        rows: list[_Row] = []
        near = self._trade.optimum
        here = _Ask(near.values[TORQUE])
        for place, torque in enumerate(torques):
            near, status = self._at_torque(near, here, _Ask(torque))
            if status != OPTIMAL:
                return [*rows, *(_Row(beyond, near, status=status) for beyond in torques[place:])]
            here = _Ask(torque)
            rows.append(_Row(torque, near))
            self._take(rows[-1], near)
        return rows

    def _at_torque(self, near: Point, here: _Ask, there: _Ask) -> tuple[Point, str]:
        """Walk to the lightest design of a torque; return the last design on the way, and the torque's status.

        Torques below are ended by the least soft stiffness. Its search begins within all limits, and so ends more
        surely than one for a design that there is not.
        """
        way = self._steps(near, here, there)
        if way.end is None:
            return way.near, OPTIMAL
        near, begin, end = way.near, way.near, way.end
        if there.torque < here.torque:
            softest = self._sought(near, there, HOT, cold=True)
            if isinstance(softest, Point):
                if self._miss(softest, there) > ONE_POINT:
                    return near, EMPTY
                begin, end = softest, there
        answer = self._sought(begin, end, MASS, cold=True)
        if isinstance(answer, Failure):
            return near, EMPTY if way.at_limits or answer.infeasible else UNANSWERED
        return (answer, OPTIMAL) if end == there else self._at_torque(answer, end, there)

    def _shorten(self, row: _Row) -> None:
        """Walk from the last design of a row to shorter cycles."""
        while (there := self._next(row)) is not None:
            way = self._steps(row.near, _Ask(row.torque, row.near.values[CYCLE]), there)
            if way.end is not None:
                row.near, row.at_limits = way.near, way.at_limits
                return
            self._take(row, way.near)

    def _follow(self, row: _Row, other: _Row) -> bool:
        """Walk to the next cycle of a row from the row beside, if that reaches it; return whether this does."""
        there, question = self._next(row), (row.torque, other.torque, len(row.designs))
        if there is None or len(other.designs) <= len(row.designs) or question in self._followed:
            return False
        self._followed.add(question)
        way = self._steps(other.designs[len(row.designs)], _Ask(other.torque, there.cycle), there)
        if way.end is not None:
            row.at_limits |= way.at_limits
            return False
        self._take(row, way.near)
        self._shorten(row)
        return True

    def _hurry(self, row: _Row) -> bool:
        """Answer the next cycle of a row by the fastest design of its torque; return whether that reaches it."""
        there = self._next(row)
        if there is None or row.status != OPTIMAL:
            return False
        fastest = self._sought(row.near, there, CYCLE, cold=not row.at_limits)
        if isinstance(fastest, Failure):
            row.status = EMPTY if row.at_limits or fastest.infeasible else UNANSWERED
            return False
        if self._miss(fastest, there) > ONE_POINT:
            row.status, row.near = EMPTY, min(row.near, fastest, key=lambda point: self._miss(point, there))
            return False
        lightest = self._sought(fastest, there, MASS, cold=True)
        self._take(row, lightest if isinstance(lightest, Point) else fastest)
        self._shorten(row)
        return True

    def _next(self, row: _Row) -> _Ask | None:
        """Return what the first cell without a design asks for."""
        return _Ask(row.torque, self._cycles[len(row.designs)]) if len(row.designs) < len(self._cycles) else None

    def _take(self, row: _Row, point: Point) -> None:
        """Put a design into the cells that it is the first to reach."""
        row.near, row.status, row.at_limits = point, OPTIMAL, False
        while (there := self._next(row)) is not None and self._miss(point, there) <= ONE_POINT:
            row.designs.append(point)

    def _steps(self, near: Point, here: _Ask, there: _Ask) -> _Way:
        """Walk from the design of one cell to another's by warm searches, and halve steps that lead to no design."""
        began, step, end, at_limits = here, there, there, False
        while step == there or here.apart(step) >= _STEP:
            answer = self._sought(near, step, MASS)
            if isinstance(answer, Failure):
                end, at_limits = step, at_limits or answer.infeasible
            elif step == there:
                return _Way(answer)
            else:
                near, here = answer, step
            step = here.halfway(end)
        if here != began and not at_limits:  # the first steps were too long
            return self._steps(near, here, there)
        return _Way(near, end, at_limits)

    def _sought(self, near: Point, ask: _Ask, least: str, *, cold: bool = False) -> Point | Failure:
        """Seek the design with the least of an output from one nearby, then from the nearest of any cell."""
        nearest = min(self._trade.points, key=lambda point: self._miss(point, ask))
        answer = self._from(near, ask, least, cold=cold)
        reached = isinstance(answer, Point) and self._miss(answer, ask) <= ONE_POINT
        if reached or self._miss(nearest, ask) >= self._miss(near, ask):
            return answer
        other = self._from(nearest, ask, least, cold=cold)
        return min(answer, other, key=lambda end: self._miss(end, ask))

    def _from(self, point: Point, ask: _Ask, least: str, *, cold: bool) -> Point | Failure:
        """Seek the lightest design that is asked for, or the fastest or softest of its torque, from one point."""
        where = f"{ask.torque:.3g} N*m in {ask.cycle:.3g} s"
        self._trade.progress(where)
        weights = {**dict.fromkeys((MASS, CYCLE, ENERGY), _SIDE), least: 1.0}
        objective = Objective(self._trade.weights(weights), self._bounds(ask, least))
        return self._trade.beside(point, objective, where, cold=cold)

    def _miss(self, answer: Point | Failure, ask: _Ask) -> float:
        """Return the logarithm by which a design misses what is asked; without a design, what is larger than any."""
        if isinstance(answer, Failure):
            return _MOST_MISS if answer.infeasible else math.inf
        torque, hot, cycle = (answer.values[name] for name in (TORQUE, HOT, CYCLE))
        return math.log(max(ask.torque / torque, hot / (self._softness * ask.torque), cycle / ask.cycle))

    def _bounds(self, ask: _Ask, least: str) -> list[Bound]:
        """Return the bounds on each part of the torque, and on the soft stiffness and the cycle but for the `least`."""
        most = {HOT: self._softness * ask.torque, CYCLE: ask.cycle}
        held = [self._bound(part, -1.0, -ask.torque) for part in self._parts]
        within = [name for name in most if name != least and math.isfinite(most[name])]
        return [*held, *(self._bound(name, 1.0, most[name]) for name in within)]

    def _bound(self, name: str, factor: float, limit: float) -> Bound:
        size = self._trade.reference[name]
        return Bound({name: factor / size}, limit / size)

    def _cell(self, row: _Row, place: int) -> MapCell:
        """Return the answer of a cell, by the place of its cycle."""
        reached = place < len(row.designs)
        point = row.designs[place] if reached else row.near
        limits = tuple(text for text, price in self._trade.prices(point).items() if price > 0.0)[:_NAMED]
        return MapCell(row.torque, self._cycles[place], OPTIMAL if reached else row.status, point.values, limits)
