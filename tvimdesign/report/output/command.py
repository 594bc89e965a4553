"""The shell of all commands that write a folder: its claim, progress, plots, failures and last words."""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from rich.console import Console
from rich.markup import escape

from tvimdesign.base.errors import InputError, TvimError
from tvimdesign.base.results_folder import PROGRESS, ResultsFolder
from tvimdesign.report.output.page_sections import made_by_words, study_section, there, versions_section, write_page
from tvimdesign.report.output.plot_process import ENDINGS, Drawing, PlotProcess
from tvimdesign.report.output.terminal import Progress, print_section, progress_output, wide_console
from tvimdesign.report.page.blocks import Block, Page, Section, Tone
from tvimdesign.study import Study

PARTLY_DONE = "partly done"  # Status in a manifest


class Command:
    """A command at work on its results folder.

    Use it as a context manager. The block ends with `finish`; `report` follows the block, since plots may have failed.
    """

    def __init__(
        self, out: Path, *, overwrite: bool = False, as_json: bool = False, plots: bool = False, resume: bool = False,
        keep: str = PROGRESS, progress: Progress | None = None,
    ) -> None:  # fmt: skip
        """Note what was asked.

        `keep` names the folder that a resumed command continues from; `progress` replaces lines on standard error.
        """
        self.out, self.as_json, self.resume = out, as_json, resume
        self.failures: list[TvimError] = []
        self.missing: list[str] = []  # Libraries that are not installed, which is no failure
        self._claim, self._plots, self._progress = (overwrite, resume, keep), plots, progress
        self._plotter: PlotProcess | None = None
        self._drawn = False
        self.headline, self.shown = "", list[Section]()  # Lines printed at the end; `page` sets both
        self._stack = ExitStack()

    def __enter__(self) -> Self:
        """Claim the folder and start what draws. Raises InputError."""
        with ExitStack() as stack:
            self.folder = stack.enter_context(ResultsFolder(self.out, *self._claim))
            self.progress = self._progress or stack.enter_context(progress_output())
            self._stack = stack.pop_all()
        if self._plots:
            self.start_plotter()
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, at: TracebackType | None) -> None:
        self._stack.__exit__(kind, value, at)

    def start_plotter(self, *, gives_way: bool = False) -> None:
        """Start the process that draws, so that it is ready when there is something to draw."""
        self._plotter = self._plotter or self._stack.enter_context(PlotProcess(gives_way=gives_way))

    def begin_plots(self, drawings: Sequence[Drawing], study: str, *, vector: bool = True, folder: str = "") -> None:
        """Start to draw plots, signed with the study's name, if a plotter was started."""
        self._drawn = bool(drawings)
        if self._plotter and drawings:
            self._plotter.draw(self.folder.path / folder, drawings, study, ENDINGS if vector else ENDINGS[:1])

    def add_plot(self, make: Callable[[], Drawing], study: str, ending: str) -> None:
        """Start to draw one more plot if there are plots, from what was not known before."""
        if self._plotter and self._drawn:
            self._plotter.draw(self.folder.path, [make()], study, [ending])

    def finish_plots(
        self, what: str = "drawing the figure", again: str = "repeat the command with --overwrite"
    ) -> None:
        """Wait for the plots. A failure is noted; its message says how to draw them `again`."""
        if self._plotter and self._drawn:
            self.progress(what)
            with noting(self.failures):
                self._plotter.finish(again)

    def page(
        self, title: str, kind: str, status: str, first: Sequence[Block], sections: Sequence[Section], *,
        tone: Tone = "", files: Mapping[str, str] | None = None, study: str = "",
    ) -> Page:  # fmt: skip
        """Return the page, which ends with the study's file, if given, and versions; it links those `files` that exist.

        Its text and tables that are not folded are what `report` prints.
        """
        self.headline, self.shown = f"{title}: {status}", [Section("first", "", first), *sections]
        last = [*([study_section(study)] if study else []), versions_section(self.folder)]
        made_by, existing = made_by_words(self.folder), there(self.folder, files or {})
        return Page(title, kind, status, tone, first, None, [*sections, *last], made_by, existing)

    def finish(
        self, status: str, inputs: dict[str, Path], study: dict[str, Any], timing: dict[str, float] | None = None,
        page: Page | None = None,
    ) -> None:  # fmt: skip
        """Write the page and the manifest, and put the results in place."""
        self.progress("")
        if page:
            write_page(self.folder, page)
        self.folder.finish(PARTLY_DONE if self.failures else status, inputs, study, timing)

    def report(
        self, data: Mapping[str, Any] | None, where: str, show: Callable[[Console], None] | None = None,
        error: Callable[[list[TvimError]], TvimError] | None = None,
    ) -> None:  # fmt: skip
        """Print the results as JSON, if there are any, or for people; `where` says what is in the folder.

        People see what the page has, or what `show` prints.

        Raises noted failures as one `error`, with exit code 4 unless another is given.
        """
        if self.as_json and data is not None:
            print(json.dumps({**data, **self.account()}, indent=2, allow_nan=False))
        elif not self.as_json:
            console = wide_console()
            if show:
                show(console)
            if self.headline:
                console.print(f"[bold]{escape(self.headline)}[/bold]", soft_wrap=True)
            for section in self.shown:
                print_section(section, console, folded=False)
            if where:
                console.print(f"\n{where} in [bold]{escape(str(self.out))}[/bold]", soft_wrap=True)
        if self.failures:
            raise (error or done_in_part)(self.failures)

    def account(self) -> dict[str, Any]:
        """Return the fields that the output of `--json` ends with: the folder, and what was not done."""
        return {"folder": str(self.out), "not_done": [*self.missing, *map(str, self.failures)]}


@contextmanager
def noting(failures: list[TvimError]) -> Iterator[None]:
    """Add a failure to a list, so that the command continues; wrong input stays an error of its own."""
    try:
        yield
    except InputError:
        raise
    except TvimError as error:
        failures.append(error)


def done_in_part(failures: list[TvimError]) -> TvimError:
    """Return the error, with exit code 4, by which a command ends that has noted failures."""
    error = TvimError("done in part: " + "; ".join(str(failure) for failure in failures))
    error.exit_code = 4
    return error


def record_files(study: Study, choices: Mapping[str, str]) -> dict[str, Path]:
    """Return the files of the catalogue's records that a module with these choices is made of."""
    return {
        f"{row.category}/{choices[row.name]}": study.catalog.path(row.category, choices[row.name])
        for row in study.table.choices
        if row.category and choices[row.name] not in ("", *row.options)
    }


def design_file(path: Path) -> Path:
    """Return the design.json of the folder of a run, or the file itself."""
    return path / "design.json" if path.is_dir() else path
