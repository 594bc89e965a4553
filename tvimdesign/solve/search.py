"""Searches a study's design space: every start, every listed size and record, the best of them accounted for."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

from tvimdesign.catalog import Catalog
from tvimdesign.device import Input, Table
from tvimdesign.errors import InputError
from tvimdesign.solve.account import account
from tvimdesign.solve.optimizer import Array, Optimizer, Progress, Run
from tvimdesign.solve.reach import refuse_unreachable
from tvimdesign.solve.solution import Constant, Solution, Start
from tvimdesign.study import Options, Study
from tvimdesign.units import format_quantity

MAX_COMBINATIONS = 500


def optimize(
    study: Study,
    catalog: Catalog,
    table: Table,
    progress: Progress = lambda _: None,
    reference: dict[str, float] | None = None,
    keep: Callable[[Optimizer], None] = lambda _: None,
) -> Solution:
    """Find the best design of a study: every start, every listed choice. Raises InputError, InfeasibleError.

    `reference` are the values the minimised outputs are divided by: those of the study's start unless given.
    `keep` is handed the problem, with its solvers, that the best design came from.
    """
    refuse_unreachable(study, catalog, table)
    sizes = _listed_sizes(study, table)
    records = _record_choices(study, table)
    runs = study.solver.starts + len(sizes)
    if len(sizes) * len(records) > MAX_COMBINATIONS:
        raise InputError(
            f"vary: {len(sizes) * len(records)} combinations of listed choices; the limit is {MAX_COMBINATIONS}; "
            f"narrow a list with from and to"
        )
    best: tuple[Optimizer, Run] | None = None
    constant: Constant | None = None
    starts: list[Start] = []
    seconds = {"set_up": 0.0, "solve": 0.0}
    for choice in records:
        optimizer = Optimizer(_with_records(study, choice), catalog, table, runs, reference, progress)
        reference = optimizer.reference
        stepping_stone = SteppingStone(optimizer)
        for run, size in _runs(optimizer, stepping_stone, sizes, progress):
            relaxed = bool(sizes) and not size
            run.start = replace(run.start, number=len(starts), choices={**choice, **size}, relaxed=relaxed)
            starts.append(run.start)
            if relaxed:
                continue
            if best is None or _order(run.start) < _order(best[1].start):
                best, constant = (optimizer, run), stepping_stone.found()
        seconds = {key: seconds[key] + optimizer.seconds[key] for key in seconds}
    assert best is not None  # there is always one combination and one start
    if study.robust:
        best = _robust(*best, starts)
    keep(best[0])
    return replace(account(*best, tuple(starts), seconds), constant=constant)


def _robust(optimizer: Optimizer, run: Run, starts: list[Start]) -> tuple[Optimizer, Run]:
    """The best run, sought again so that limits on times, too, are kept by modules that spread; told as its start."""
    from tvimdesign.solve.reserves import settle

    sizes = {name: float(value) for name, value in run.start.choices.items() if name in optimizer.model.index}
    found = settle(optimizer, run, sizes)
    begun = run.start
    found.start = replace(found.start, number=begun.number, choices=begun.choices, begin=begun.begin)
    starts[begun.number] = found.start
    return optimizer, found


class SteppingStone:
    """The same problem with constant currents: solved first, it is where a search for profiles begins, and what
    they are held against."""

    def __init__(self, optimizer: Optimizer) -> None:
        """Nothing to do where no current follows a profile."""
        self.optimizer = optimizer.with_constant_currents()
        self.best: Run | None = None

    def beyond(self, begin: Array) -> Array:
        """Inputs of the optimum with constant currents from a start; the start itself where there is none."""
        if self.optimizer is None:
            return begin
        run = self.optimizer.solve(begin=begin)
        if not run.start.converged:
            return begin
        if self.best is None or run.start.objective < self.best.start.objective:
            self.best = run
        return run.inputs

    def found(self) -> Constant | None:
        """The best optimum with constant currents, simulated; None where there is none."""
        if self.optimizer is None or self.best is None:
            return None
        switch = self.optimizer.simulator.run(self.best.inputs)
        values = self.optimizer.model.values(self.best.inputs, switch.values)
        inputs = {name: float(self.best.inputs[i]) for name, i in self.optimizer.model.index.items()}
        return Constant(self.best.start.objective, {**inputs, **values})


def _runs(
    optimizer: Optimizer, stepping_stone: SteppingStone, sizes: list[dict[str, float]], progress: Progress
) -> Iterator[tuple[Run, dict[str, float]]]:
    """Every start, all free; where sizes are listed, then every combination of them, warm from the best start."""
    starts = optimizer.study.solver.starts
    best: Run | None = None
    for number, begin in enumerate(optimizer.begin_points()):
        progress(f"start {number + 1} of {starts}")
        run = optimizer.solve(begin=stepping_stone.beyond(begin))
        run.start = replace(run.start, begin=optimizer.free_values(begin))
        best = run if best is None or _order(run.start) < _order(best.start) else best
        yield run, {}
    for number, fixed in enumerate(sizes):
        progress(f"{_in_words(optimizer.table, fixed)} ({number + 1} of {len(sizes)})")
        run = optimizer.solve(fixed, warm=best if best and best.start.converged else None)
        if not run.start.converged:
            run = optimizer.solve(fixed)
        yield run, fixed


def _in_words(table: Table, sizes: Mapping[str, float]) -> str:
    return ", ".join(f"{name} {format_quantity(value, table.unit(name))}" for name, value in sizes.items())


def _order(start: Start) -> tuple[bool, float]:
    return (not start.converged, start.objective)


def _listed_sizes(study: Study, table: Table) -> list[dict[str, float]]:
    """Every combination of the listed sizes of numbers; empty where none is listed."""
    listed = {
        name: vary.values
        for name, vary in study.vary.items()
        if isinstance(vary, Options) and isinstance(table.row(name), Input)
    }
    if not listed:
        return []
    return [
        {name: float(value) for name, value in zip(listed, combination, strict=True)}
        for combination in itertools.product(*listed.values())
    ]


def _record_choices(study: Study, table: Table) -> list[dict[str, str]]:
    """Every combination of the records and options a study lists."""
    listed = {
        name: [str(value) for value in vary.values]
        for name, vary in study.vary.items()
        if isinstance(vary, Options) and not isinstance(table.row(name), Input)
    }
    return [dict(zip(listed, combination, strict=True)) for combination in itertools.product(*listed.values())]


def _with_records(study: Study, records: Mapping[str, str]) -> Study:
    if not records:
        return study
    vary = {name: value for name, value in study.vary.items() if name not in records}
    return study.model_copy(update={"module": {**study.module, **records}, "vary": vary})
