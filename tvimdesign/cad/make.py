"""Makes the parts of a design in a child process, which is ended if it exceeds its limit of processor time."""

import contextlib
import json
import queue
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from importlib import import_module
from pathlib import Path
from types import ModuleType, TracebackType
from typing import Any, Self

from tvimdesign.base.atomic_files import atomic_write, make_folder
from tvimdesign.base.child_process import read_lines, start_child
from tvimdesign.base.environment import require_extra
from tvimdesign.base.errors import GeometryError, InputError
from tvimdesign.base.processes import (
    Niceness,
    ProcessorLimit,
    ProcessorTimeError,
    end_process_tree,
    last_line,
    set_low_priority,
    wait_for,
)
from tvimdesign.cad.cad_report import CadReport, SolidCheck
from tvimdesign.study import Design, write_design

LIMIT = 3600.0  # Seconds of processor time, of all processes together, without a report of progress
HALF_MADE = ".parts.{}."  # Prefix of the folder in which a process makes parts, where none are kept between runs
JOB = "tvimdesign.cad.jobs.main"
_DESIGN_COPY = ".design.json.part"
"""The design as the parts are asked for, beside them: it is removed once they are made."""
WAITING = "--wait"
"""First argument of a child that reads from standard input what to make: a line of JSON with design and folder. The
second is the mode of the design that will come, or empty."""
_BRIDGED = "vtk"
KERNEL = "cadquery"


def load_kernel() -> None:
    """Import CadQuery without the whole of VTK, in a fifth of the time; who imports `vtk` afterwards gets it whole.

    OCP's bridge to VTK imports all 150 modules of it, where it finds one called `vtk`. Nothing here crosses that
    bridge: pictures are rendered from triangles, with the few modules of VTK that this takes.
    """
    if KERNEL in sys.modules or _BRIDGED in sys.modules:
        import_module(KERNEL)
        return
    sys.modules[_BRIDGED] = ModuleType(_BRIDGED)
    try:
        import_module(KERNEL)
    finally:
        del sys.modules[_BRIDGED]


def make_cad(
    design_path: Path, out: Path, progress: Callable[[str], None] = lambda _: None, *, job: str = JOB
) -> CadReport:
    """Build, check and write the parts of the design file into the folder `out`.

    `progress` gets each step. The files are written even where a check fails (`report.failed`), so that one can look
    at what collides. `job` is the module that is run as the child process: another one can change how parts are drawn
    (`MODULES` in `cad/assembly/assembly.py`) and call this one's `main`. Raises GeometryError where a part cannot
    be built or takes too long, naming the part, once the files of the others are written; also where the process
    crashes or takes more than `LIMIT` without a report of progress. Raises InputError where the design cannot be read,
    or the extra [cad] is not installed.
    """
    with PartsProcess(job) as process:
        process.begin(design_path, out)
        return process.finish(progress)


class PartsProcess:
    """The child process that makes parts: it loads the CAD kernel at once, and may wait long for its design."""

    def __init__(self, job: str = JOB, mode: str = "") -> None:
        """Start it, to read the table of a mode ahead. Raises InputError where the extra [cad] is not installed."""
        require_extra("cad", "parts")
        with ExitStack() as stack:
            self._tail = stack.enter_context(tempfile.TemporaryFile())
            self._process = start_child(
                job, [WAITING, mode], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._tail, text=True,
                encoding="utf-8", process_group=0,  # no session: Linux shares processors out by session first
            )  # fmt: skip
            self._stack = stack.pop_all()
        self._lines: queue.Queue[str | None] = queue.Queue()
        read_lines(self._process, self._lines.put)
        self._out: Path | None = None

    @property
    def process(self) -> int:
        """Its number."""
        return int(self._process.pid)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, at: TracebackType | None) -> None:
        """End the process with its children if it has not ended, and take away what they have left half made."""
        if self._process.poll() is None:
            end_process_tree(self._process.pid)
        self._process.wait()
        if self._process.stdin:
            with contextlib.suppress(OSError):
                self._process.stdin.close()
        self._stack.close()
        if self._out:
            (self._out / _DESIGN_COPY).unlink(missing_ok=True)
            for half_made in self._out.glob(f"{HALF_MADE.format(self._process.pid)}*"):
                shutil.rmtree(half_made, ignore_errors=True)

    def begin(self, design_path: Path, out: Path) -> None:
        """Let it make the parts of a design file, which it reads at once, into the folder `out`; comes back at once."""
        make_folder(out)
        self._out = out
        assert self._process.stdin is not None
        with contextlib.suppress(BrokenPipeError):  # that it has died shows at the end
            self._process.stdin.write(json.dumps([str(design_path.resolve()), str(out.resolve())]) + "\n")
            self._process.stdin.flush()

    def finish(self, progress: Callable[[str], None] = lambda _: None) -> CadReport:
        """Wait for what came of it; `progress` gets each step. Raises as `make_cad` does."""
        assert self._out is not None
        state: dict[str, Any] = {"progress": "starting"}
        watch = ProcessorLimit(self._process.pid, LIMIT)
        try:
            for message in _messages(self._lines, watch):
                state |= message
                if "progress" in message:
                    progress(message["progress"])
            code = wait_for(watch, lambda seconds: self._process.wait(timeout=seconds))
            why = f"the CAD process ended with code {code}"
        except ProcessorTimeError as error:
            why = f"the CAD process failed: {error}"
        return _report(self._out, state, why, last_line(self._tail))


class BackgroundPartsJob(PartsProcess):
    """Parts made while a run goes on: the CAD kernel is loaded as the solver works, and begins with the answer."""

    def __init__(self, mode: str = "", *, gives_way: bool = True) -> None:
        """Start the process that loads the kernel, and reads the table of the mode that is known to come.

        By default its priority is lower than the solver's; its parts but the first have a still lower one.
        """
        super().__init__(mode=mode)
        if gives_way:
            set_low_priority(self.process, Niceness.LOW)

    def stop(self) -> None:
        """End the process if it has not ended: nothing more is written into the folder."""
        self.__exit__(None, None, None)

    def begin_with(self, design: Design, out: Path) -> None:
        """Let the parts of a design be made into a folder; comes back at once."""
        make_folder(out)
        self.begin(write_design(design, out / _DESIGN_COPY), out)

    def finish(self, progress: Callable[[str], None] = lambda _: None) -> CadReport:
        """Wait for the parts, and write their checks.json. Raises GeometryError where they cannot be made."""
        progress("parts: starting the CAD kernel")
        try:
            report = super().finish(lambda text: progress(f"parts, {text}"))
        finally:
            self.stop()
        atomic_write(report.folder / "checks.json", (json.dumps(report.plain(), indent=2) + "\n").encode())
        progress("")
        return report


def make_parts_of(design: Path, out: Path, progress: Callable[[str], None]) -> CadReport:
    """Make the parts of a design.json beside their checks.json. Raises GeometryError where they cannot be made."""
    with BackgroundPartsJob() as parts:
        parts.begin(design, out)
        return parts.finish(progress)


def _messages(lines: queue.Queue[str | None], watch: ProcessorLimit) -> Iterator[dict[str, Any]]:
    """Yield what a child reports, until it ends. Raises ProcessorTimeError between two reports."""
    while (line := wait_for(watch, lambda seconds: lines.get(timeout=seconds))) is not None:
        watch.restart()
        message: dict[str, Any] = json.loads(line)
        yield message


def _report(out: Path, state: dict[str, Any], why: str, tail: str) -> CadReport:
    """Turn the last state that the child reported, and how it ended, into a report or an error."""
    if "error" in state:
        raise (GeometryError if state["code"] == GeometryError.exit_code else InputError)(state["error"])
    if "checks" not in state:
        raise GeometryError(f"{state['progress']}: {why}{f' ({tail})' if tail else ''}; no parts were made")
    return CadReport(
        folder=out,
        files=tuple(state["files"]),
        checks=tuple(SolidCheck(**check) for check in state["checks"]),
        seconds=state["seconds"],
        notes=tuple(state["notes"]),
        reused=tuple(state["reused"]),
    )
