"""What the terminal and summary.txt say of a run: the first screen, every table if asked, and where to look first."""

from __future__ import annotations

import io
import os
import time
from collections.abc import Mapping
from types import TracebackType
from typing import Any

from rich.console import Console
from rich.text import Text

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.page.page_file import FILE as PAGE
from tvimdesign.report.output.console import OwnMarkupConsole
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.run.answered_study import AnsweredStudy
from tvimdesign.report.run.first_screen.layout import LABEL, joined
from tvimdesign.report.run.first_screen.screen import Told, first_screen
from tvimdesign.report.run.first_screen.uncertainty_process import UncertaintyProcess
from tvimdesign.report.run.full_summary import print_full_summary
from tvimdesign.study import Study
from tvimdesign.study.design import Design

FILE = "summary.txt"
SPREAD = "TVIMDESIGN_SPREAD"
"""Variable of the environment: `off` leaves yield and assumptions out, where many runs share few processors."""
_FILE_WIDTH = 120
COLOURS = {
    "bold": r"^\S.*? · (?=shear|compression)", "green": r"OPTIMAL|ALL LIMITS KEPT",
    "red": r"BROKEN|NO DESIGN FOUND|NEVER SOFT|ABOVE RATING(, NOT ACCEPTED)?", "yellow": r"\bBINDS\b|\bOPEN\b|^Warning",
}  # fmt: skip


class RunScreen:
    """A run's screen: started with the run, so that its clock runs and the uncertainty is known in time."""

    def __init__(self, study: Study) -> None:
        """Start the clock, and the process that says how sure the study's design is."""
        self._began = time.perf_counter()
        self._process = UncertaintyProcess(study) if os.environ.get(SPREAD) != "off" else None
        self._asked = False
        self._uncertainty: dict[str, Any] | None = None

    def __enter__(self) -> RunScreen:
        """Return itself."""
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, at: TracebackType | None) -> None:
        """End the process if it has not ended."""
        if self._process:
            self._process.__exit__(kind, value, at)

    def ask(self, design: Design) -> None:
        """Ask how sure a design is, and come back at once."""
        if self._process:
            self._process.begin(design)
            self._asked = True

    def uncertainty(self, deadline: Deadline = NEVER) -> dict[str, Any]:
        """Return how sure the design is; empty if nobody asked. Raises TvimError once if it cannot be computed.

        Raises TimeOverError once if that takes longer than the deadline allows.
        """
        if self._uncertainty is None:
            self._uncertainty = {}
            if self._process and self._asked:
                self._uncertainty = self._process.finish(deadline)
        return self._uncertainty

    def told(self, answered: AnsweredStudy, *, timed: bool) -> Told:
        """What is to be told beside the answer; a file is not told the seconds, so that it is the same every time."""
        seconds = time.perf_counter() - self._began if timed else None
        return Told(seconds, self.uncertainty(), answered.warnings, answered.front.front, answered.left_out)

    def tell(self, answered: AnsweredStudy, folder: ResultsFolder, console: Console | None, *, full: bool) -> None:
        """Write summary.txt, and print the first screen, or everything."""
        told = self.told(answered, timed=True)
        write_summary(answered, folder, told.uncertainty)
        if console is not None and full:
            _print_all(answered, told, console)
        elif console is not None:
            show(first_screen(answered.result, answered.study.table, told, console.width), console)


def write_summary(answered: AnsweredStudy, folder: ResultsFolder, uncertainty: Mapping[str, Any]) -> None:
    """Write summary.txt: the first screen and every table; without seconds, so that it is the same every time."""
    stream = io.StringIO()
    file = OwnMarkupConsole(file=stream, width=_FILE_WIDTH, color_system=None, highlight=False)
    _print_all(answered, Told(None, uncertainty, answered.warnings, answered.front.front, answered.left_out), file)
    folder.write(FILE, "\n".join(line.rstrip() for line in stream.getvalue().splitlines()) + "\n")


def print_screen(answered: AnsweredStudy, console: Console) -> None:
    """Print the first screen of an answer of which nobody asked how sure it is."""
    told = Told(warnings=answered.warnings, front=answered.front.front, left_out=answered.left_out)
    show(first_screen(answered.result, answered.study.table, told, console.width), console)


def _print_all(answered: AnsweredStudy, told: Told, console: Console) -> None:
    """The first screen, and every table."""
    show(first_screen(answered.result, answered.study.table, told, console.width), console)
    console.print()
    print_tables(answered, told.uncertainty, console)


def print_tables(answered: AnsweredStudy, uncertainty: Mapping[str, Any], console: Console) -> None:
    """Every table of an answer, for people."""
    print_full_summary(answered.result, answered.study.table, console, uncertainty, answered.warnings)
    names = answered.reported.get("sensitivities_left_out")
    if names:
        console.print(f"Not in sensitivities.csv, as they never happen or follow a profile: {', '.join(names)}.")
    answered.front.show(console)


def show(lines: list[str], console: Console) -> None:
    """Print lines as they are: none is wrapped again."""
    for line in lines:
        text = Text(line)
        for style, pattern in COLOURS.items():
            text.highlight_regex(pattern, style)
        console.print(text, soft_wrap=True)


def look_first(shown: str, width: int) -> list[str]:
    """Where to look first: the page of the folder, and the tables."""
    files = [f"{shown}/{PAGE}", f"all tables: {shown}/{FILE}, --full"]
    return joined("Look first", files, max(width, LABEL + 1))
