"""Searches studies that differ in fixed numbers alone, each from one optimum: in any order, on any process.

A common reference divides the outputs that they minimise. A study alone divides each output by its value at its own
start. Of two studies with the same weights one would then pay less for a second than the other, because it was drawn
slower.
"""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from tvimdesign.base.errors import InfeasibleError, InputError, TimeOverError, TvimError
from tvimdesign.device import Input, Table
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.discrete.discrete_choices import discrete_sizes
from tvimdesign.solve.nlp.mixture import discrete_records
from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.nlp.solver_run import OPTIMAL, Progress, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.optimizer.verify_optimum import verify_optimum
from tvimdesign.solve.search import Keep, optimize
from tvimdesign.study import Study, given

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


class AnchoredSearch:
    """Finds the optimum of a study from that of its anchor, the same study with some numbers at a value of its own.

    A study is searched from every start as usual where more than fixed numbers differ from the anchor, where something
    is chosen from a list, where the anchor has no design, and where the warm solve ends without an optimum. What is
    found hangs on the study and the anchor alone, not on what was searched before.
    """

    def __init__(self, anchor: Study, followed: Collection[str], normal: Study) -> None:
        """Set up without solving. `followed` are the numbers that differ between the studies, by name or path.

        All studies' outputs are divided by those of the study `normal` at its start, so that all minimise the same.
        """
        self._anchor_study = _with_fixed(anchor, followed)
        self._followed, self._normal = tuple(followed), normal

    def find(
        self,
        study: Study,
        progress: Progress = lambda _: None,
        keep: Keep = lambda *_: None,
        objectives: Sequence[str] = (),
    ) -> tuple[Solution, bool]:
        """Return a study's best design and whether the anchor's optimum alone led there. Raise as `optimize` does."""
        solution = self._warm(study, study.table) if self._followed else None
        if solution:
            return solution, True
        return optimize(study, progress, self._reference, keep, objectives), False

    def as_optimize(
        self, study: Study, progress: Progress, _: dict[str, float] | None, keep: Keep, objectives: Sequence[str]
    ) -> Solution:
        """Solve in place of `optimize`, with one reference for all studies here."""
        return self.find(study, progress, keep, objectives)[0]

    @cached_property
    def _reference(self) -> dict[str, float] | None:
        return common([at_its_start(self._normal)]) if self._normal.vary else None

    @cached_property
    def _anchor(self) -> dict[str, float] | None:
        """The free numbers at the anchor's optimum; None where it has none."""
        optima: list[Run] = []

        def remember(_: Optimizer, runs: list[Run]) -> None:
            optima.extend(run for run in runs if run.start.converged)

        try:
            optimize(self._anchor_study, reference=self._reference, keep=remember)
        except (InfeasibleError, InputError, TimeOverError):
            return None
        return min(optima, key=lambda run: run.start.objective).start.end if optima else None

    def _warm(self, study: Study, table: Table) -> Solution | None:
        """Return the optimum sought from the anchor's; None if that is impossible or no optimum results."""
        if _problem(study, table) != _problem(self._anchor_study, table):
            return None
        has_lists = discrete_sizes(study, table).names or len(discrete_records(study, table)) > 1
        if has_lists or study.robust or study.profile.pieces():
            return None
        if self._anchor is None:
            return None
        optimizer = Optimizer(study, self._reference)
        run = optimum_near(optimizer, self._anchor).run
        if not run.start.converged:
            return None
        solution = verify_optimum(optimizer, run, (run.start,), optimizer.seconds)
        return solution if solution.status == OPTIMAL else None


def _with_fixed(study: Study, followed: Collection[str]) -> Study:
    """Return the study with some of what it varies fixed at its start."""
    free = [name for name in followed if name in study.vary]
    if not free:
        return study
    starts = given(study)
    vary = {name: allowed for name, allowed in study.vary.items() if name not in free}
    return study.model_copy(update={"vary": vary, "module": {**study.module, **{name: starts[name] for name in free}}})


def _problem(study: Study, table: Table) -> dict[str, Any]:
    """Return a study's data without its name and its fixed numbers."""
    shape = {name: value for name, value in study.module.items() if not _is_number(name, table)}
    points = tuple(study.operating_points)
    data = study.model_dump(exclude={"name", "description", "module", "operating_points", "write", "tolerances"})
    return {**data, "module": shape, "points": points}


def _is_number(name: str, table: Table) -> bool:
    row = table.quantity(name)
    return isinstance(row, Input) and not row.integer


Values = Mapping[str, float]


def at_its_start(study: Study) -> dict[str, float] | None:
    """Return the minimised outputs of a study as drawn, SI; None if it cannot be simulated."""
    table = study.table
    try:
        model = DeviceFunctions(table, given(study), tuple(study.operating_points), study.solver.cells)
        values = model.values(model.start, Simulator(model).run(model.start).values)
    except TvimError:
        return None
    horizon = float(model.start[model.index["horizon"]])
    return {name: values[name] if math.isfinite(values[name]) else horizon for name in study.minimize}


def common(starts: Sequence[Values | None]) -> dict[str, float]:
    """Geometric mean of every output over the studies, whatever their order; of nothing but zeros, one."""
    known = [values for values in starts if values is not None]
    names = dict.fromkeys(name for values in known for name in values)
    sizes = {name: [abs(values[name]) for values in known if values[name] != 0.0] for name in names}
    return {name: math.exp(math.fsum(map(math.log, of)) / len(of)) if of else 1.0 for name, of in sizes.items()}
