"""A study answered at every cell of a sweep, in this process or by workers, as a table with a result for each cell."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic

from tvimdesign.api import notebook
from tvimdesign.api.notebook import shown_progress
from tvimdesign.api.result import Result, StudyT
from tvimdesign.base.errors import InputError
from tvimdesign.base.units import pretty
from tvimdesign.report.output.command import Command
from tvimdesign.report.run.answered_study import answer_study
from tvimdesign.report.sweep.sweep_study import sweep_folder
from tvimdesign.study import StudyTree
from tvimdesign.sweep.answers import CellAnswers
from tvimdesign.sweep.plan import Cell as AskedCell
from tvimdesign.sweep.plan import CellAnswer, SweepPlan, plan_of
from tvimdesign.sweep.run_sweep import CellKeys, Executor
from tvimdesign.sweep.shards import SHARDS, Shards, columns, status_values

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

_WITH_DESIGN = {"evaluated", "optimal", "above_rating", "below_yield"}


@dataclass(frozen=True)
class Cell(Generic[StudyT]):
    """One study of a sweep: where it stands on the axes, how it ended, and why where it has no design."""

    at: Mapping[str, str]
    status: str
    reason: str
    _sweep: Sweep[StudyT] = field(repr=False)
    _texts: tuple[str, ...] = field(repr=False)

    @property
    def study(self) -> StudyT:
        """Return the cell's own study; run on its own, it is searched from every start."""
        return self._sweep.study_of(self._sweep.plan.cell_tree(self._texts))

    @cached_property
    def result(self) -> Result[StudyT] | None:
        """The cell's whole result, answered as in the sweep when it is first asked for; None without a design."""
        return self._sweep._result(self._texts) if self.status in _WITH_DESIGN else None


@dataclass(frozen=True)
class Sweep(Generic[StudyT]):
    """Every cell in its order: of a grid the last axis changes fastest."""

    plan: SweepPlan
    stored_cells: Sequence[CellAnswer]  # What each cell came to, in SI
    study_of: Callable[[StudyTree], StudyT]  # Makes the study of a cell
    folder: Path | None = None  # Where it is written; None if it is not written

    @property
    def warm_solves(self) -> int:
        """Return how many cells were optimised from the study's own optimum alone."""
        return sum(answer.warm for answer in self.stored_cells)

    def table(self, *names: str, verdicts: bool = False) -> pd.DataFrame:
        """Return a row a cell: where it stands, how it ended, and the named outputs; else those the study asks about.

        The status is that of the module as drawn. With `verdicts`, a column has the first line of each cell's screen,
        such as `Build it`; yield and intervals are computed for it, in some seconds a cell. Numbers are in the units of
        `tvimdesign rows`, which `table.attrs["units"]` has by column. Raises InputError for an output that the sweep
        did not keep.
        """
        import pandas as pd

        places = {name: place for place, name in enumerate(self.plan.columns)}
        if lacking := [name for name in names if name not in places]:
            raise InputError(f"{', '.join(lacking)}: not kept by this sweep; name it in `outputs=`")
        wanted = list(names) or [name for name in self.plan.study_outputs if name in places]
        listed = columns(self.plan)
        heads = [column.name for column in listed if column.kind in {"axis", "told"}]
        frame = pd.DataFrame([self._row(number, heads, wanted, places) for number in range(len(self))])
        if verdicts:
            results = (cell.result for cell in self)
            texts = [result.verdict if result else "" for result in results]
            frame.insert(list(frame.columns).index("status") + 1, "verdict", texts)
        frame.attrs["units"] = {column.name: column.unit for column in listed if column.kind == "axis"} | {
            name: self.plan.unit(name) for name in wanted
        }
        return frame

    def _row(self, number: int, heads: Sequence[str], wanted: Sequence[str], places: Mapping[str, int]) -> Any:
        answer = self.stored_cells[number]
        values = tuple(answer.values[places[name]] for name in wanted)
        values_shown = status_values(answer._replace(values=values), [self.plan.unit(name) for name in wanted])
        numbers = (math.nan if value is None else value for value in (*self.plan.axis_values(number), *values_shown))
        return dict(zip([*heads, *wanted], numbers, strict=True))

    def plot(self, name: str) -> Figure:
        """Draw an output over the first axis, a line for each value of the others; in a notebook it shows."""
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        table, (first, *others) = self.table(name), [axis.name for axis in self.plan.block.axes]
        figure = Figure(figsize=(6.0, 3.8), layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots()
        for at, line in table.groupby(others, sort=False) if others else [((), table)]:
            label = ", ".join(f"{other} {value:.4g}" if isinstance(value, float) else f"{other} {value}"
                              for other, value in zip(others, at, strict=True))  # fmt: skip
            axes.plot(line[first], line[name], marker="o", label=label)
        units = table.attrs["units"]
        axes.set(xlabel=_label(first, units[first]), ylabel=_label(name, units[name]))
        if others:
            axes.legend()
        return notebook.shown(figure)

    def _result(self, texts: tuple[str, ...]) -> Result[StudyT]:
        tree, plan = self.plan.cell_tree(texts), self.plan
        study = self.study_of(tree)
        if plan.task == "evaluate":
            return Result(answer_study(tree, lambda _: None, drawn_only=True), study)
        search = self._answers.search_of(texts)
        return Result(answer_study(tree, lambda _: None, search=search.as_optimize), study)

    @cached_property
    def _answers(self) -> CellAnswers:
        return CellAnswers(self.plan)

    def __len__(self) -> int:
        return len(self.stored_cells)

    def __getitem__(self, number: int) -> Cell[StudyT]:
        answer, texts = self.stored_cells[number], self.plan.texts(range(len(self))[number])
        names = [axis.name for axis in self.plan.block.axes]
        return Cell(dict(zip(names, texts, strict=True)), answer.status, answer.reason, self, texts)

    def __iter__(self) -> Iterator[Cell[StudyT]]:
        return (self[number] for number in range(len(self)))

    def _repr_html_(self) -> str:
        table = self.table()
        heads = [f"{name} [{pretty(unit)}]" if (unit := table.attrs["units"].get(name)) and unit != "1" else name
                 for name in table.columns]  # fmt: skip
        rows = [[f"{value:.4g}" if isinstance(value, float) else str(value) for value in row]
                for row in table.itertuples(index=False)]  # fmt: skip
        return notebook.heading("Sweep", f"{len(self)} cells") + notebook.grid(heads, rows)


def _label(name: str, unit: str) -> str:
    shown = pretty(unit or "1")
    return f"{name.replace('_', ' ')} ({shown})" if shown else name.replace("_", " ")


def swept(
    tree: StudyTree, study_of: Callable[[StudyTree], StudyT], progress: bool, out: str | os.PathLike[str] | None,
    where: Executor, *, overwrite: bool,
) -> Sweep[StudyT]:  # fmt: skip
    """Answer a study at every cell of its sweep: here, or by workers that keep what they find in the folder `out`.

    Raises InputError for no sweep, StudyError for what cannot be set.
    """
    plan = plan_of(tree)
    with shown_progress(progress) as say:
        if out is None:
            return Sweep(plan, _here(plan, say), study_of)
        command = Command(Path(out), overwrite=overwrite, resume=not overwrite, keep=SHARDS, progress=say)
        sweep_folder(plan, where, command, plots=False)
        keys = CellKeys(plan)
        every = (keys.key(plan.texts(number)) for number in range(plan.count))
        return Sweep(plan, list(Shards(Path(out), plan.columns).cells(every)), study_of, Path(out))


def _here(plan: SweepPlan, say: Any) -> list[CellAnswer]:
    answers, cells = CellAnswers(plan), list[CellAnswer]()
    known: dict[tuple[str, ...], CellAnswer] = {}
    for number in range(plan.count):
        say(f"cell {number + 1} of {plan.count}")
        texts = plan.texts(number)
        if texts not in known:
            known[texts] = answers.answer(AskedCell("", texts))
        cells.append(known[texts])
    return cells
