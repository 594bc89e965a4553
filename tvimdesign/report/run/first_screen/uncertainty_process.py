"""How sure a run's design is, computed in a process that loads the compiler and scipy while the solver works.

Run as `python -m tvimdesign.report.run.first_screen.uncertainty_process`: reads two lines of JSON on
standard input, a study, for which it compiles, and its design, and prints what `Uncertainty` says of that.
`UncertaintyProcess` is the other end.
"""

from __future__ import annotations

import contextlib
import gc
import json
import signal
import subprocess
import sys
from importlib import import_module
from types import TracebackType
from typing import Any

from tvimdesign.base.child_process import follow_parent, start_child
from tvimdesign.base.process_tree import Behind, give_way
from tvimdesign.study import Study
from tvimdesign.study.design import Design

TIME_LIMIT = 120.0  # s, many times what it takes where processors are shared


class UncertaintyProcess:
    """A process that has the compiler and scipy loaded by the time there is a design; stopped if there never is."""

    def __init__(self, study: Study) -> None:
        """Start it, and let it compile the study's module."""
        self._child = start_child(
            "tvimdesign.report.run.first_screen.uncertainty_process",
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, encoding="utf-8",
        )  # fmt: skip
        give_way(self._child.pid, Behind.A_LITTLE)  # to the solver
        self._write(study.model_dump_json() + "\n")

    def __enter__(self) -> UncertaintyProcess:
        """Return itself."""
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, at: TracebackType | None) -> None:
        """End the process if it has not ended."""
        if self._child.poll() is None:
            self._child.kill()
        self._child.communicate()

    def begin(self, design: Design) -> None:
        """Ask for a design's, and come back at once."""
        self._write(design.model_dump_json() + "\n")

    def _write(self, line: str) -> None:
        assert self._child.stdin is not None
        with contextlib.suppress(BrokenPipeError):  # a process that has died has nothing to say
            self._child.stdin.write(line)
            self._child.stdin.flush()

    def finish(self) -> dict[str, Any]:
        """What `Uncertainty` says of the design; empty where the process failed or took too long."""
        try:
            said, _ = self._child.communicate(timeout=TIME_LIMIT)
        except subprocess.TimeoutExpired:
            return {}
        found: dict[str, Any] = json.loads(said) if self._child.returncode == 0 else {}
        return found


def main() -> None:
    """Compile for the study, wait for its design, print what there is to say of that."""
    follow_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is the parent's to handle
    gc.disable()  # a third of the time; the process is short
    import_module("scipy.special")  # loaded while the solver works, used when modules are drawn
    from tvimdesign.base.machine_code import compile_quickly
    from tvimdesign.report.run.first_screen.uncertainty_data import Uncertainty

    compile_quickly()  # some thousand modules are drawn: the compiler would take longer than they do
    uncertainty = Uncertainty(Study.model_validate_json(sys.stdin.readline()))
    uncertainty.draw_ahead()
    line = sys.stdin.readline()
    if line:
        print(json.dumps(uncertainty.data(Design.model_validate_json(line)), allow_nan=False))


if __name__ == "__main__":
    main()
