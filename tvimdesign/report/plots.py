"""Draws a run's plots from plain data, in a process of its own that loads matplotlib while the solver works.

Run as `python -m tvimdesign.report.plots`: reads one JSON object on standard input, `{"folder": ..., "plots": {...}}`,
and writes PNG files. `PlotProcess` is the other end.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from types import ModuleType, TracebackType
from typing import Any

from tvimdesign.errors import TvimError
from tvimdesign.study.design import write_whole

TIME_LIMIT = 120.0  # s
_FAST = {"compress_level": 1}  # a quarter of the time for a tenth more bytes


class PlotProcess:
    """A process that has matplotlib loaded by the time there is something to draw; stopped if there never is."""

    def __init__(self) -> None:
        """Start it."""
        self._child = subprocess.Popen(
            [sys.executable, "-m", "tvimdesign.report.plots"],
            stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
        )  # fmt: skip

    def __enter__(self) -> PlotProcess:
        """Return itself."""
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, at: TracebackType | None) -> None:
        """End the process if it has not ended."""
        if self._child.poll() is None:
            self._child.kill()
        self._child.communicate()

    def begin(self, folder: Path, plots: dict[str, Any]) -> None:
        """Ask for every plot, and come back at once."""
        message = json.dumps({"folder": str(folder.resolve()), "plots": plots}).encode()
        assert self._child.stdin is not None
        with contextlib.suppress(BrokenPipeError):  # a process that has died says why in `finish`
            self._child.stdin.write(message)
            self._child.stdin.close()
        self._child.stdin = None

    def finish(self) -> None:
        """Wait until every plot is in the folder. Raises TvimError where that fails."""
        try:
            _, complaint = self._child.communicate(timeout=TIME_LIMIT)
        except subprocess.TimeoutExpired as error:
            raise TvimError(f"the plots took longer than {TIME_LIMIT:g} s and were stopped") from error
        if self._child.returncode != 0:
            last = complaint.decode(errors="replace").strip().splitlines()[-1:]
            raise TvimError(f"the plots could not be drawn: {' '.join(last)}")


def main() -> None:
    """Load matplotlib, wait for the data, draw."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is the parent's to handle
    from tvimdesign.report import figures

    figures.warm_up()
    request = json.load(sys.stdin)
    folder = Path(request["folder"])
    folder.mkdir(parents=True, exist_ok=True)
    plots = list(request["plots"].items())
    if not hasattr(os, "fork"):
        _draw(figures, folder, plots)
        return
    # Matplotlib is slow and single-threaded: two processes with it loaded share the plots. Taking the interpreter down
    # in order would take as long as two plots, so they leave at once.
    other = os.fork()
    _draw(figures, folder, [plot for i, plot in enumerate(plots) if (i == len(plots) - 1) != bool(other)])
    if not other or os.waitpid(other, 0)[1] == 0:
        os._exit(0)
    raise SystemExit(1)


def _draw(figures: ModuleType, folder: Path, plots: list[tuple[str, Any]]) -> None:
    for name, data in plots:
        figure = getattr(figures, name)(data)
        stream = io.BytesIO()
        figure.savefig(stream, format="png", dpi=120, metadata={"Software": None}, pil_kwargs=_FAST)
        write_whole(folder / f"{name}.png", stream.getvalue())


if __name__ == "__main__":
    main()
