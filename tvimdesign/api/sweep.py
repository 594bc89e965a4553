"""A study answered at every cell of an axis or a grid, in this process, each cell from its neighbour's optimum."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from tvimdesign.api import html
from tvimdesign.api.quantity import Quantity
from tvimdesign.api.result import Result
from tvimdesign.api.shown_progress import shown_progress
from tvimdesign.base.errors import InputError, TvimError
from tvimdesign.base.units import from_si, pretty
from tvimdesign.report.compare.answer_series import AnswerSeries
from tvimdesign.report.output.progress import Progress
from tvimdesign.study import Study as ResolvedStudy
from tvimdesign.study.tree import StudyTree

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

MOST_CELLS = 10_000
_ALWAYS = ("module_mass", "envelope_diameter", "response_time")
"""Outputs that every table has, whatever the study minimises and requires."""


class SweptStudy(Protocol):
    """What a sweep needs of a study: `tvimdesign.Study` has it."""

    _tree: StudyTree

    @property
    def resolved(self) -> ResolvedStudy:
        """The study as it was read, every number in SI."""

    @property
    def mode(self) -> str:
        """Shear or compression."""

    def set(self, values: Mapping[str, Any], /) -> SweptStudy:
        """A copy with inputs and choices of the module fixed."""


@dataclass(frozen=True)
class Cell:
    """One study of a sweep: where it stands on the axes, and its result, or why it has none."""

    at: Mapping[str, Any]
    study: SweptStudy
    result: Result | None
    status: str


@dataclass(frozen=True)
class Sweep:
    """Every cell, in the order of the axes, the last of which changes fastest."""

    axes: Mapping[str, Sequence[Any]]
    cells: tuple[Cell, ...]
    warm_solves: int
    """How many cells were optimised from their neighbour's optimum alone."""

    def table(self, *names: str) -> pd.DataFrame:
        """A row a cell: where it stands, its status, and the named outputs; else those the study asks about.

        Numbers are in the units of `tvimdesign rows`, which `table.attrs["units"]` has by column.
        """
        import pandas as pd

        columns = list(names) or self._asked
        frame = pd.DataFrame([self._row(cell, columns) for cell in self.cells])
        frame.attrs["units"] = {name: self._unit(name) for name in (*self.axes, *columns)}
        return frame

    def plot(self, name: str) -> Figure:
        """Draw an output over the first axis, a line for each value of the others; in a notebook it shows."""
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        from tvimdesign.api.figures import shown

        table, (first, *others) = self.table(name), list(self.axes)
        figure = Figure(figsize=(6.0, 3.8), layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots()
        for at, line in table.groupby(others, sort=False) if others else [((), table)]:
            label = ", ".join(f"{other} {value:.4g}" if isinstance(value, float) else f"{other} {value}"
                              for other, value in zip(others, at, strict=True))  # fmt: skip
            axes.plot(line[first], line[name], marker="o", label=label)
        axes.set(xlabel=self._label(first), ylabel=self._label(name))
        if others:
            axes.legend()
        return shown(figure)

    @property
    def _asked(self) -> list[str]:
        study = self.cells[0].study.resolved
        limits = [limit.output for limit in study.require]
        return list(dict.fromkeys([*study.minimize, *limits, *_ALWAYS, *study.vary]))

    def _row(self, cell: Cell, columns: Sequence[str]) -> dict[str, Any]:
        row = {name: self._plain(name, value, cell.study) for name, value in cell.at.items()}
        row["status"] = cell.status
        for name in columns:
            found = cell.result[name] if cell.result else math.nan
            row[name] = found.value if isinstance(found, Quantity) else found
        return row

    def _plain(self, name: str, value: Any, study: SweptStudy) -> Any:
        """A value of an axis as a number in the row's unit; as it was given where it is none."""
        set_to, unit = study.resolved.module.get(name), self._unit(name)
        return from_si(set_to, unit) if isinstance(set_to, float) else str(value)

    def _unit(self, name: str) -> str:
        row = self.cells[0].study.resolved.table.by_name.get(name.partition("@")[0])
        return getattr(row, "unit", "")  # a choice has none

    def _label(self, name: str) -> str:
        unit = pretty(self._unit(name) or "1")
        return f"{name.replace('_', ' ')} ({unit})" if unit else name.replace("_", " ")

    def __len__(self) -> int:
        """Count of cells."""
        return len(self.cells)

    def __getitem__(self, number: int) -> Cell:
        """A cell by its number, from 0."""
        return self.cells[number]

    def __iter__(self) -> Iterator[Cell]:
        """Every cell."""
        return iter(self.cells)

    def _repr_html_(self) -> str:
        table = self.table()
        heads = [f"{name} [{pretty(unit)}]" if (unit := table.attrs["units"].get(name)) and unit != "1" else name
                 for name in table.columns]  # fmt: skip
        rows = [[f"{value:.4g}" if isinstance(value, float) else str(value) for value in row]
                for row in table.itertuples(index=False)]  # fmt: skip
        return html.heading("Sweep", f"{len(self)} cells") + html.grid(heads, rows)


def swept(study: SweptStudy, axes: Mapping[str, Sequence[Any]], progress: bool) -> Sweep:
    """Answer a study at every cell of the grid, what is minimised over its value at the study's own start.

    Raises InputError for no grid, StudyError for what cannot be set.
    """
    cells = _cells(study, axes)
    whole = study.resolved
    series = AnswerSeries(whole)
    found = []
    with shown_progress(progress) as say:
        for number, (at, asked) in enumerate(cells, start=1):
            found.append(_answered(at, asked, series, _numbered(say, f"cell {number} of {len(cells)}")))
    return Sweep(dict(axes), tuple(found), series.warm_solves)


def _cells(study: SweptStudy, axes: Mapping[str, Sequence[Any]]) -> list[tuple[dict[str, Any], SweptStudy]]:
    """Every study of the grid, each read, so that a value that cannot be is told before anything is solved."""
    empty = [name for name, values in axes.items() if isinstance(values, str) or not len(values)]
    count = math.prod(len(values) for values in axes.values())
    if empty or not axes:
        named = f"the axis {empty[0]!r} is no list of values" if empty else "it has no axis"
        raise InputError(f'sweep: {named}; write pcl_thickness=linspace("0.6 mm", "2 mm", 20), for one')
    if count > MOST_CELLS:
        raise InputError(f"sweep: {count} cells; the limit is {MOST_CELLS}; take fewer values on an axis")
    plain = study.set({"front": None}) if study.resolved.front else study
    cells = []
    for values in itertools.product(*axes.values()):
        at = dict(zip(axes, values, strict=True))
        asked = plain.set(at)
        _ = asked.resolved
        cells.append((at, asked))
    return cells


def _numbered(say: Progress, cell: str) -> Progress:
    return lambda text: say(f"{cell}: {text}" if text else "")


def _answered(at: Mapping[str, Any], study: SweptStudy, series: AnswerSeries, say: Progress) -> Cell:
    try:
        say("begins")
        result = Result(series.answer(study._tree, say))
    except TvimError as error:
        return Cell(at, study, None, " ".join(str(error).split()))
    found = result._answered.result.found
    return Cell(at, study, result if found else None, result.status)
