"""The lightest designs of one study over the torque that is held and the time of a full cycle, cell by cell.

Every cell is a pair of bounds on one problem that is built once. The walk begins at the study's own optimum, goes up
and down the torques, and from the lightest design of each torque to the fastest. A cell is empty where the search from
its neighbour has no design of the torque, or where the fastest design takes longer.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from tvimdesign.base.errors import InfeasibleError
from tvimdesign.solve.nlp.problem_parts import Bound, Objective
from tvimdesign.solve.nlp.solver_run import OPTIMAL, Progress, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.pareto.tradeoff import ONE_POINT, Failure, Point, Tradeoff
from tvimdesign.solve.search import optimize
from tvimdesign.study import Study

TORQUE, CYCLE, MASS, ENERGY, HOT = "holding_torque", "cycle_time", "module_mass", "cycle_energy", "joint_stiffness@hot"
TRADED = (TORQUE, CYCLE, MASS, ENERGY, HOT)
EMPTY, UNANSWERED = "empty", "unanswered"
_SIDE = 1e-3
"""Weight of what is not asked for: of two designs alike in mass the faster, and the one of less energy."""
_NAMED = 3
"""Limits that are named where a cell is empty."""


@dataclass(frozen=True)
class MapCell:
    """Answer for a torque to be held [N*m] and a longest cycle [s]."""

    torque: float
    cycle: float
    status: str
    """`optimal`, `empty`, or `unanswered`."""
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
            study, keep=lambda optimizer, runs: built.append((optimizer, runs)), objectives=TRADED, checked=True
        )
    except InfeasibleError as error:
        return [MapCell(torque, cycle, EMPTY, limits=(str(error),)) for torque in torques for cycle in cycles]
    if solution.status != OPTIMAL:
        ended = solution.conflict_set
        limits = tuple(side.text for side in ended.sides[:_NAMED]) if ended else (solution.status,)
        status = EMPTY if ended else UNANSWERED
        return [MapCell(torque, cycle, status, limits=limits) for torque in torques for cycle in cycles]
    return _Walk(Tradeoff(study, solution, *built[0], progress), softness, sorted(cycles, reverse=True)).over(torques)


class _Walk:
    """The walk over one problem."""

    def __init__(self, trade: Tradeoff, softness: float, cycles: Sequence[float]) -> None:
        self._trade, self._softness, self._cycles = trade, softness, cycles
        self._fastest: Point | None = None

    def over(self, torques: Sequence[float]) -> list[MapCell]:
        """Walk down from the torque that the lightest design holds, then up."""
        first = self._trade.optimum
        held = first.values[TORQUE]
        down = sorted((torque for torque in torques if torque <= held), reverse=True)
        up = sorted(torque for torque in torques if torque > held)
        return [*self._along(down, first, {HOT: 1.0}), *self._along(up, first, {TORQUE: -1.0})]

    def _along(self, torques: Sequence[float], near: Point, furthest: dict[str, float]) -> list[MapCell]:
        """Return the cells of torques, each sought from the one before; beyond a torque without a design is none.

        Without a last design that limits end, what is left stays unanswered: a failed search proves nothing.

        `furthest` is the objective of the last design on the way, softest or strongest, which its limits end.
        """
        cells: list[MapCell] = []
        for place, torque in enumerate(torques):
            lightest = self._sought({MASS: 1.0}, near, f"{torque:g} N*m", *self._bounds(torque))
            if isinstance(lightest, Failure):
                end = self._sought(
                    furthest, near, f"the last before {torque:g} N*m", *self._end_bounds(torque, furthest)
                )
                if isinstance(end, Point):
                    lightest = self._sought({MASS: 1.0}, end, f"{torque:g} N*m", *self._bounds(torque))
            if isinstance(lightest, Failure):
                left = torques[place:]
                status, limits = (EMPTY, self._limits(end)) if isinstance(end, Point) else (UNANSWERED, ())
                return [*cells, *(MapCell(t, c, status, near.values, limits) for t in left for c in self._cycles)]
            near = lightest
            cells += self._faster(torque, lightest)
        return cells

    def _faster(self, torque: float, near: Point) -> list[MapCell]:
        """Return the cells of a torque, from the longest cycle to the shortest, started at the lightest design."""
        cells: list[MapCell] = []
        for place, cycle in enumerate(self._cycles):
            if near.values[CYCLE] > cycle:
                answer, left = self._within(torque, cycle, near), self._cycles[place:]
                if isinstance(answer, Failure):
                    return [*cells, *(MapCell(torque, c, UNANSWERED, near.values) for c in left)]
                if answer.values[CYCLE] > cycle * (1.0 + ONE_POINT):
                    limits = self._limits(answer)
                    return [*cells, *(MapCell(torque, c, EMPTY, answer.values, limits) for c in left)]
                near = answer
            cells.append(MapCell(torque, cycle, OPTIMAL, near.values, self._limits(near)))
        return cells

    def _within(self, torque: float, cycle: float, near: Point) -> Point | Failure:
        """Return the lightest design of a longest cycle; the fastest design where none ends in time."""
        within = (*self._bounds(torque), self._bound(CYCLE, 1.0, cycle))
        where = f"{torque:g} N*m in {cycle:g} s"
        answer = self._sought({MASS: 1.0}, near, where, *within)
        if isinstance(answer, Point):
            return answer
        for begin in filter(None, (near, self._fastest)):
            answer = self._sought({CYCLE: 1.0}, begin, f"fastest for {torque:g} N*m", *self._bounds(torque))
            if isinstance(answer, Point):
                break
        if isinstance(answer, Failure):
            return answer
        self._fastest = answer
        if answer.values[CYCLE] <= cycle:
            again = self._sought({MASS: 1.0}, answer, where, *within)
            return again if isinstance(again, Point) else answer
        return answer

    def _sought(self, least: dict[str, float], near: Point, where: str, *bounds: Bound) -> Point | Failure:
        side = {name: _SIDE for name in (MASS, CYCLE, ENERGY) if name not in least}
        self._trade.progress(where)
        return self._trade.beside(near, Objective(self._trade.weights({**least, **side}), bounds), where)

    def _end_bounds(self, torque: float, furthest: dict[str, float]) -> tuple[Bound, ...]:
        """Return the bounds of a torque without the one on what is sought."""
        holds, soft = self._bounds(torque)
        return (soft,) if TORQUE in furthest else (holds,)

    def _bounds(self, torque: float) -> tuple[Bound, Bound]:
        return self._bound(TORQUE, -1.0, -torque), self._bound(HOT, 1.0, self._softness * torque)

    def _bound(self, name: str, factor: float, limit: float) -> Bound:
        size = self._trade.reference[name]
        return Bound({name: factor / size}, limit / size)

    def _limits(self, point: Point) -> tuple[str, ...]:
        return tuple(text for text, price in self._trade.prices(point).items() if price > 0.0)[:_NAMED]
