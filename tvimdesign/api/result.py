"""A study's answer as Python users hold it: quantities, tables, figures, reasons, parts and files."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from tvimdesign.api import notebook
from tvimdesign.api.notebook import shown_progress
from tvimdesign.api.tables import cycle_table, interval_table, quantity, value_table
from tvimdesign.base.errors import InfeasibleError, InputError, TvimError
from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.base.units import format_quantity, parse_quantity
from tvimdesign.report.output.tables import check_row, margin_text, value_text
from tvimdesign.report.run.answered_study import AnsweredStudy, drawings
from tvimdesign.report.run.reasons import complaint, sentences, why_rows
from tvimdesign.study import Design, write_design
from tvimdesign.study.text.mistakes import did_you_mean

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure
    from pint import Quantity


StudyT = TypeVar("StudyT")  # The study of Python users, which makes results


class NoDesignError(InfeasibleError):
    """No design is feasible; `result` is where the search ended, the closest design."""

    def __init__(self, message: str, result: Result[Any]) -> None:
        super().__init__(message)
        self.result = result


@dataclass(frozen=True)
class Reasons:
    """Reasons for a design: what the active limits cost, in sentences and as a table of every limit."""

    sentences: tuple[str, ...]
    rows: tuple[dict[str, Any], ...]

    def table(self) -> pd.DataFrame:
        """Return a table of every limit: its state, its margin, and its cost in each output, in percent a step."""
        import pandas as pd

        return pd.DataFrame([{**row, **row["sensitivity"]} for row in self.rows]).drop(
            columns="sensitivity", errors="ignore"
        )

    def __str__(self) -> str:
        return (
            "\n".join(self.sentences) or "No limit is active: the study was evaluated, or every limit has some margin."
        )

    def _repr_html_(self) -> str:
        return "".join(f"<p>{line}</p>" for line in str(self).splitlines())


@dataclass(frozen=True)
class Parts:
    """Exported parts of a design: the folder, its files, and the checks on the solids."""

    folder: Path
    files: tuple[Path, ...]
    checks: tuple[dict[str, Any], ...]

    def table(self) -> pd.DataFrame:
        """Return every check on the solids: level, what was measured, limit."""
        import pandas as pd

        return pd.DataFrame(list(self.checks))

    def _repr_png_(self) -> bytes | None:
        preview = self.folder / "preview.png"
        return preview.read_bytes() if preview.exists() else None


class Result(Generic[StudyT]):
    """Result of a study. `result["module_mass"]` is a quantity of pint, `result["motor"]` the word of a choice."""

    def __init__(self, answered: AnsweredStudy, study: StudyT) -> None:
        """Hold an answer and its study; `study.run()` makes results."""
        self._answered = answered
        self._study = study

    @classmethod
    def of(cls, answered: AnsweredStudy, study: StudyT) -> Result[StudyT]:
        """Return the result of a study's answer. Raises NoDesignError where there is no design."""
        result = cls(answered, study)
        if not answered.result.has_design:
            raise NoDesignError(complaint(answered.result), result)
        return result

    @property
    def study(self) -> StudyT:
        """The study that it answers, to be changed and run again."""
        return self._study

    @property
    def verdict(self) -> str:
        """The first line of the screen, such as `Build it`; yield and intervals are computed for it."""
        from tvimdesign.report.run.first_screen import verdict_of

        if self._answered.result.has_design:
            self.uncertainty()
        return verdict_of(self._answered).text

    @property
    def name(self) -> str:
        """The study's name."""
        return self.design.name

    @property
    def status(self) -> str:
        """`evaluated`, `optimal`, `above_rating` (the optimum, beyond ratings that are not accepted), `below_yield` (a
        design that fewer modules keep than asked), or why not.
        """
        return self.design.status

    @property
    def above_rating(self) -> tuple[str, ...]:
        """The quantities beyond what a material or a bought part is rated for that the study does not accept."""
        return self.design.above_rating

    @property
    def accepting(self) -> tuple[str, ...]:
        """The quantities beyond their rating that the study accepts."""
        return self.design.accepting

    @property
    def feasible(self) -> bool:
        """Return whether every requirement and every rule of the machine is satisfied."""
        return self._answered.result.feasible

    @property
    def design(self) -> Design:
        """The design as plain data in SI: what `tvimdesign cad` and `read_design` take and give."""
        return self._answered.result.design

    @property
    def data(self) -> dict[str, Any]:
        """Everything there is to know, as `results.json` has it."""
        return self._answered.reported

    @property
    def warnings(self) -> list[str]:
        """Advice that the design does not follow, what was not done, and records in doubt."""
        table = self._answered.study.table
        advice = [
            f"{check.text}, by {margin_text(check, table).lstrip('-')}: {check.origin}"
            for check in self._answered.result.warnings
        ]
        return [*advice, *map(str, self._answered.failures), *self.data.get("doubts", [])]

    def __getitem__(self, name: str) -> Quantity[float] | Any:
        """Return a value by full name, `row` or `row@point`, as pint's quantity; a choice's word. Raises InputError."""
        design, table = self.design, self._answered.study.table
        if name in design.choices:
            return design.choices[name]
        if name not in design.values:
            known = [*design.values, *design.choices]
            raise InputError(f"the result has no value {name!r}; {did_you_mean(name, known) or '`table()` lists all'}")
        return quantity(design.values[name], table.unit(name))

    def table(self, match: str = "") -> pd.DataFrame:
        """Return every value by name: value, unit, meaning, status, low and high where history leaves it open, group.

        Only those with `match` in their name or meaning, where it is given.
        """
        return value_table(self._answered, match)

    def requirements(self) -> pd.DataFrame:
        """Return a table of every requirement and rule of the machine: limit, value, margin and state."""
        import pandas as pd

        return pd.DataFrame([check_row(check, self._answered.study.table) for check in self._answered.result.checks])

    @property
    def cycle(self) -> pd.DataFrame:
        """The phases of the working cycle, a row a moment: phase, time since it began, temperatures, current, power,
        stiffness and damping. `cycle.attrs["units"]` has the unit of each column.
        """
        return cycle_table(self._answered.result.histories)

    def uncertainty(self) -> dict[str, Any]:
        """Return the yield, and intervals over the unmeasured inputs, as `results.json` has them.

        Computed when first asked for, in some seconds.
        """
        if "uncertainty" not in self.data:
            from tvimdesign.report.run.answered_study import note_uncertainty
            from tvimdesign.report.run.uncertainty_data import uncertainty_data

            note_uncertainty(self._answered, uncertainty_data(self._answered.study, self.design))
        entry: dict[str, Any] = self.data["uncertainty"]
        return entry

    def intervals(self) -> pd.DataFrame:
        """Return the intervals of headlines and requirements from unmeasured inputs, and what to measure first.

        Columns: value; low and high with all unmeasured inputs anywhere in their ranges (95 %); the same with one at a
        time; unit; the input that carries most of it and its share; which to measure for half the width.
        """
        return interval_table(self.uncertainty()["intervals"])

    def why(self) -> Reasons:
        """Return what holds the design back, and what easing it would buy."""
        return Reasons(tuple(sentences(self._answered.result)), tuple(why_rows(self._answered.result)))

    @property
    def plots(self) -> list[str]:
        """Names of the figures there are."""
        return [drawing.file for drawing in drawings(self._answered)]

    def plot(self, name: str = "cycle") -> Figure:
        """Draw a figure by name; in a notebook it shows. Raises InputError for a name there is not."""
        by_file = {drawing.file: drawing for drawing in drawings(self._answered)}
        if name not in by_file:
            raise InputError(f"the result has no figure {name!r}; there are: {', '.join(by_file) or 'none'}")
        return notebook.drawn(by_file[name], self.name)

    def show(self) -> None:
        """Print the first screen of `tvimdesign run`, without what it says of spread."""
        from tvimdesign.report.output.terminal import wide_console
        from tvimdesign.report.run.first_screen import print_first_screen

        print_first_screen(self._answered, wide_console())

    def save(self, folder: str | os.PathLike[str], *, overwrite: bool = False, plots: bool = True) -> Path:
        """Write what `tvimdesign run --no-cad` writes; returns the folder. Raises InputError where it is in use.

        Plots that cannot be drawn are a warning.
        """
        from tvimdesign.report.output.command import noting
        from tvimdesign.report.output.plot_process import PlotProcess
        from tvimdesign.report.run.first_screen import write_summary
        from tvimdesign.report.run.run_page import finish, summary_sheet, write_answer

        failures: list[TvimError] = []
        with ResultsFolder(Path(folder), overwrite) as written:
            write_answer(written, self._answered)
            write_summary(self._answered, written)
            figures = drawings(self._answered) if plots else []
            if figures:
                with PlotProcess() as drawing, noting(failures):
                    drawing.draw(written.path / "plots", figures, self.name)
                    drawing.draw(written.path, [summary_sheet(written, self._answered)], self.name, ["pdf"])
                    drawing.finish("save again with overwrite=True")
            finish(written, self._answered)
        for failure in failures:
            warnings.warn(str(failure), stacklevel=2)
        return Path(folder)

    def parts(self, folder: str | os.PathLike[str], *, overwrite: bool = False, progress: bool = True) -> Parts:
        """Make the parts into a folder: STEP, print files, drawings, checks. Raises GeometryError where a check fails.

        This takes a minute or so, in processes of its own.
        """
        from tvimdesign.cad.make import make_parts_of

        with ResultsFolder(Path(folder), overwrite) as written, shown_progress(progress) as say:
            report = make_parts_of(write_design(self.design, written.path / "design.json"), written.path, say)
            report.refuse_failed()
            written.finish(self.status, {}, self.design.study)
        files = tuple(sorted(written.path / name for name in report.files))
        return Parts(written.path, files, tuple(report.plain()["checks"]))

    def robot(
        self, folder: str | os.PathLike[str], *, timestep: str | None = None, overwrite: bool = False,
        progress: bool = True,
    ) -> Path:  # fmt: skip
        """Write the joint for simulators: MJCF and URDF of each operating point, FMU, meshes, tables; returns the
        folder.

        `timestep`, such as "0.5 ms", is that of the simulation; without it one that suits the bench's load. Raises
        GeometryError where the solids are not the design's, InputError for a time step that is none.
        """
        from tvimdesign.report.robot_files import write_models

        step = parse_quantity(timestep, "s") if timestep else None
        with ResultsFolder(Path(folder), overwrite) as written, shown_progress(progress) as say:
            write_models(self.design, written, step, say)
            written.finish("written", {}, self.design.study)
        return Path(folder)

    def __repr__(self) -> str:
        return f"<Result {self.name!r}: {self.design.mode} mode, {self.status}>"

    def _repr_html_(self) -> str:
        result, table = self._answered.result, self._answered.study.table
        rows = [
            (check.text, value_text(result, check.output), "met" if check.met else "violated", margin)
            for check in result.checks if check.origin == "require" for margin in (margin_text(check, table),)
        ]  # fmt: skip
        names = [*self.design.study["vary"], *self.design.study["minimize"]]
        values = [(n, format_quantity(self.design.values[n], table.unit(n))) for n in names if n in self.design.values]
        values += [(n, self.design.choices[n]) for n in names if n in self.design.choices]
        tables = notebook.grid(("asked", "got", "", "margin"), rows) + notebook.grid(("", "value"), values)
        return notebook.heading(self.name, f"{self.design.mode} mode, {self.status}") + tables
