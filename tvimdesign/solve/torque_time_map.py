"""The lightest designs of one study over the torque that is held and the time of a full cycle, cell by cell.

Every cell is a pair of bounds on one problem that is built once. The walk begins at the study's own optimum, goes up
and down the torques, and from the lightest design of each torque to shorter cycles. Where a search has no design, steps
are halved. A cell is empty where the search next to it, from a design that is next to it, ends at limits.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from tvimdesign.base.errors import InfeasibleError
from tvimdesign.solve.nlp.problem_parts import Bound, Objective
from tvimdesign.solve.nlp.solver_run import OPTIMAL, Progress, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.pareto.tradeoff import Failure, Point, Tradeoff
from tvimdesign.solve.search import optimize
from tvimdesign.study import Study, given

TORQUE, CYCLE, MASS, ENERGY, HOT = "holding_torque", "cycle_time", "module_mass", "cycle_energy", "joint_stiffness@hot"
TRADED = (TORQUE, CYCLE, MASS, ENERGY, HOT)
EMPTY, UNANSWERED = "empty", "unanswered"
_SIDE = 1e-3
"""Weight of what is not asked for: of two designs alike in mass the faster, and the one of less energy."""
_STEP = 0.03
"""Least step, a logarithm of torque or time."""
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


class _Walk:
    """The walk over one problem."""

    def __init__(self, trade: Tradeoff, softness: float, cycles: Sequence[float]) -> None:
        self._trade, self._softness, self._cycles = trade, softness, cycles
        self._parts = [name for name in trade.reference if name not in TRADED]

    def over(self, torques: Sequence[float]) -> list[MapCell]:
        """Walk down from the torque that the lightest design holds, then up."""
        held = self._trade.optimum.values[TORQUE]
        down = sorted((torque for torque in torques if torque <= held), reverse=True)
        return [*self._along(down), *self._along(sorted(torque for torque in torques if torque > held))]

    def _along(self, torques: Sequence[float]) -> list[MapCell]:
        """Return the cells of torques; those beyond a torque without a design are as that one is."""
        cells: list[MapCell] = []
        near = self._trade.optimum
        here = _Ask(near.values[TORQUE])
        for place, torque in enumerate(torques):
            near, status = self._walked(near, here, _Ask(torque))
            if status != OPTIMAL:
                return [*cells, *(self._cell(t, c, status, near) for t in torques[place:] for c in self._cycles)]
            here = _Ask(torque)
            cells += self._faster(torque, near)
        return cells

    def _faster(self, torque: float, near: Point) -> list[MapCell]:
        """Return the cells of a torque, from the longest cycle to the shortest, started at the lightest design."""
        cells: list[MapCell] = []
        for place, cycle in enumerate(self._cycles):
            if near.values[CYCLE] > cycle:
                near, status = self._walked(near, _Ask(torque, near.values[CYCLE]), _Ask(torque, cycle))
                if status != OPTIMAL:
                    return [*cells, *(self._cell(torque, c, status, near) for c in self._cycles[place:])]
            cells.append(self._cell(torque, cycle, OPTIMAL, near))
        return cells

    def _walked(self, near: Point, here: _Ask, there: _Ask) -> tuple[Point, str]:
        """Walk from the design of one cell to another's; return the last design on the way, and the cell's status."""
        step, end = there, None
        while True:
            answer = self._lightest(near, step)
            if isinstance(answer, Point):
                near, here = answer, step
                if step == there:
                    return near, OPTIMAL
                if end is None:
                    step = there
                    continue
                step = here.halfway(end)
            else:
                end = step if answer.infeasible else end
                step = here.halfway(step)
            if here.apart(step) < _STEP:
                return near, EMPTY if end else UNANSWERED

    def _lightest(self, near: Point, ask: _Ask) -> Point | Failure:
        """Seek the lightest design from one nearby, then from the design of any cell that comes nearest."""
        answer = self._sought(near, ask)
        nearest = min(self._trade.found, key=lambda point: self._miss(point, ask))
        if isinstance(answer, Failure) and self._miss(nearest, ask) < self._miss(near, ask):
            return self._sought(nearest, ask)
        return answer

    def _sought(self, near: Point, ask: _Ask) -> Point | Failure:
        where = f"{ask.torque:.3g} N*m in {ask.cycle:.3g} s"
        self._trade.progress(where)
        weights = {MASS: 1.0, CYCLE: _SIDE, ENERGY: _SIDE}
        return self._trade.beside(near, Objective(self._trade.weights(weights), self._bounds(ask)), where)

    def _miss(self, point: Point, ask: _Ask) -> float:
        """Return the logarithm by which a design misses what is asked, at most zero where it meets that."""
        torque, hot, cycle = (point.values[name] for name in (TORQUE, HOT, CYCLE))
        return math.log(max(ask.torque / torque, hot / (self._softness * ask.torque), cycle / ask.cycle))

    def _bounds(self, ask: _Ask) -> tuple[Bound, ...]:
        held = [self._bound(part, -1.0, -ask.torque) for part in self._parts]
        within = [self._bound(CYCLE, 1.0, ask.cycle)] if math.isfinite(ask.cycle) else []
        return *held, self._bound(HOT, 1.0, self._softness * ask.torque), *within

    def _bound(self, name: str, factor: float, limit: float) -> Bound:
        size = self._trade.reference[name]
        return Bound({name: factor / size}, limit / size)

    def _cell(self, torque: float, cycle: float, status: str, point: Point) -> MapCell:
        limits = tuple(text for text, price in self._trade.prices(point).items() if price > 0.0)[:_NAMED]
        return MapCell(torque, cycle, status, point.values, limits)
