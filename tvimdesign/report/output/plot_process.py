"""Draws a run's plots from plain data, in a process of its own that loads matplotlib while the solver works.

Run as `python -m tvimdesign.report.output.plot_process`: reads JSON objects on standard input, a line each,
`{"folder": ..., "study": ..., "endings": ["png", ...], "drawings": [{"file": ..., "figure": ..., "data": ...}]}`, and
writes a file of each ending for each drawing. `PlotProcess` is the other end.
"""

import gc
import json
import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.base.child_process import follow_parent, start_child
from tvimdesign.base.errors import TvimError
from tvimdesign.base.processes import FedProcess, Niceness, ProcessorTimeError, communicate

ENDINGS = ("png", "pdf", "svg")
PROCESSOR_LIMIT = 600.0  # Seconds of processor time for all plots of a command; they take about five


class Drawing(NamedTuple):
    """One plot: its file's name without ending, the function that draws it (`file.function`), and from what."""

    file: str
    figure: str
    data: dict[str, Any]


def drawn(drawing: Drawing, study: str) -> Any:
    """Return the figure of a drawing, signed with the study's name."""
    from tvimdesign.report.figures.theme import sign

    file, _, function = drawing.figure.partition(".")
    figure = getattr(import_module(f"tvimdesign.report.figures.{file}"), function)(drawing.data)
    sign(figure, study)
    return figure


class PlotProcess(FedProcess):
    """A process that has matplotlib loaded by the time there is something to draw; stopped if there never is."""

    def __init__(self, *, gives_way: bool = False) -> None:
        """Start it, at low priority if the first screen and parts need the processors first."""
        child = start_child(
            "tvimdesign.report.output.plot_process", stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, text=True, encoding="utf-8", errors="replace",
        )  # fmt: skip
        super().__init__(child, Niceness.FAR if gives_way else None)

    def draw(self, folder: Path, drawings: Sequence[Drawing], study: str, endings: Sequence[str] = ENDINGS) -> None:
        """Ask for a file of each ending for each plot, signed with the study's name, and come back at once."""
        request = {
            "folder": str(folder.resolve()), "study": study, "endings": endings,
            "drawings": [drawing._asdict() for drawing in drawings],
        }  # fmt: skip
        self.send(json.dumps(request))

    def finish(self, again: str = "repeat the command with --overwrite") -> None:
        """Wait until every plot is in the folder. Raises TvimError if that fails; `again` says how to get the plots.

        Write all numbers before.
        """
        self.send_no_more()
        try:
            _, complaint = communicate(self.child, PROCESSOR_LIMIT)
        except ProcessorTimeError as error:
            reason = str(error)
        else:
            if self.child.returncode == 0:
                return
            lines = complaint.strip().splitlines()
            reason = lines[-1] if lines else f"the process ended with code {self.child.returncode}"
        raise TvimError(f"the plots could not be drawn: {reason}. All numbers are written; for the plots, {again}")


def main() -> None:
    """Load matplotlib, wait for the data, draw."""
    follow_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is the parent's to handle
    gc.disable()  # a tenth of the time; all there ever is to collect is a few figures
    _warm_up()
    request = json.loads(sys.stdin.readline())
    if sys.platform != "linux":  # a fork is not safe elsewhere
        _draw(request)
        _draw_added()
        return
    # Matplotlib is slow and single-threaded: two processes with it loaded share the plots. Taking the interpreter down
    # in order would take as long as two plots, so they leave at once.
    first, other = os.getpid(), os.fork()
    if not other:
        follow_parent(first)
    _draw(request, slice(int(bool(other)), None, 2))
    if other:
        _draw_added()
    if not other or os.waitpid(other, 0)[1] == 0:
        os._exit(0)
    raise SystemExit(1)


def _draw_added() -> None:
    """Draw what `PlotProcess.draw` asks for later, until there is no more."""
    for line in sys.stdin:
        _draw(json.loads(line))


def _warm_up() -> None:
    """Load the figures of every run and draw on every kind of axes, so that fonts and caches are ready."""
    from tvimdesign.report.figures.theme import log_ticks, new_figure, place, png

    import_module("tvimdesign.report.figures.design_figures")
    figure = new_figure(3.0)
    linear, logarithmic = place(figure, 0.5, 0.5, 2.0, 2.0), place(figure, 4.0, 0.5, 2.0, 2.0)
    linear.plot([0.0, 1.0], label="°")
    linear.barh([0.0], [1.0], hatch="//")
    linear.legend(title="text")
    logarithmic.semilogy([1.0, 1e3])
    log_ticks(logarithmic.yaxis)
    png(figure)
    import_module("fontTools.subset")  # what cuts a PDF's fonts


def _draw(request: dict[str, Any], part: slice = slice(None)) -> None:
    """Write every plot, or a part of them, in the first ending, which people look at, before any in another."""
    from tvimdesign.report.figures.theme import as_file

    folder = Path(request["folder"])
    folder.mkdir(parents=True, exist_ok=True)
    figures = {}
    first, *others = request["endings"]
    for drawing in (Drawing(**drawing) for drawing in request["drawings"][part]):
        figure = figures[drawing.file] = drawn(drawing, request["study"])
        atomic_write(folder / f"{drawing.file}.{first}", as_file(figure, first))
    for name, figure in figures.items():
        for ending in others:
            atomic_write(folder / f"{name}.{ending}", as_file(figure, ending))


if __name__ == "__main__":
    main()
