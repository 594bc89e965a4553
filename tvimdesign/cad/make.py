"""Makes the parts of a design in a child process that is ended when it takes too long."""

from __future__ import annotations

import json
import queue
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import IO, Any

from tvimdesign.base.child_process import hear, start_child
from tvimdesign.base.errors import GeometryError, InputError
from tvimdesign.base.extras import require_extra
from tvimdesign.base.process_tree import end_process_tree
from tvimdesign.base.whole_files import make_folder
from tvimdesign.cad.cad_report import CadReport, SolidCheck

TIMEOUT = 300.0
"""Seconds without a word; a module takes about ten, many times that where the machine has other work."""
PART_TIMEOUT = 90.0
"""Seconds for one part with its files, or one set of checks; the longest takes two."""
HALF_MADE = ".parts.*"
"""Folder in which parts are made where none are kept from one run to the next: a pattern."""
JOB = "tvimdesign.cad.build.main"


def make_cad(
    design_path: Path,
    out: Path,
    timeout_s: float = TIMEOUT,
    progress: Callable[[str], None] | None = None,
    *,
    part_timeout_s: float = PART_TIMEOUT,
    job: str = JOB,
) -> CadReport:
    """Build, check and write the parts of the design file into the folder `out`.

    `progress` is told each step. The files are written even where a check fails (`report.failed`), so that one can look
    at what collides. `job` is the module that is run as the child process: another one can change how parts are drawn
    (`MODULES` in `cad/assembly/module_parts.py`) and call this one's `main`. Raises GeometryError where a part cannot
    be built or takes more than `part_timeout_s` [s], naming the part, once the files of the others are written; also
    where the process crashes or says nothing for `timeout_s` [s]. Raises InputError where the
    design cannot be read, or the extra [cad] is not installed.
    """
    require_extra("cad", "parts")
    make_folder(out)
    state: dict[str, Any] = {"progress": "starting"}
    with tempfile.TemporaryFile() as progress_output:
        process = start_child(
            job, [str(design_path.resolve()), str(out.resolve()), str(part_timeout_s)],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=progress_output, text=True, encoding="utf-8",
            start_new_session=True,
        )  # fmt: skip
        try:
            for message in _messages(process, timeout_s):
                state |= message
                if progress and "progress" in message:
                    progress(message["progress"])
            code = process.wait(timeout=10.0)
        except (TimeoutError, subprocess.TimeoutExpired):
            code = None
        finally:
            _end(process)
            for half_made in out.glob(HALF_MADE):
                shutil.rmtree(half_made, ignore_errors=True)
        return _report(out, state, code, timeout_s, _tail(progress_output))


def _end(process: subprocess.Popen[str]) -> None:
    """End the process with its children."""
    if process.poll() is None:
        end_process_tree(process.pid)
    process.wait()


def _messages(process: subprocess.Popen[str], silence_s: float) -> Iterator[dict[str, Any]]:
    """What the child says, until it ends; raises TimeoutError once it has said nothing for so long [s]."""
    said: queue.Queue[str | None] = queue.Queue()
    hear(process, said.put)
    while True:
        try:
            line = said.get(timeout=silence_s)
        except queue.Empty:
            raise TimeoutError from None
        if line is None:
            return
        message = json.loads(line)
        yield message


def _report(out: Path, state: dict[str, Any], code: int | None, timeout_s: float, tail: str) -> CadReport:
    """Turn what the child said, and how it ended, into a report or an error."""
    why = f"no answer in {timeout_s:g} s" if code is None else f"the CAD process ended with code {code}"
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


def _tail(progress_output: IO[bytes]) -> str:
    """Last line of what the child wrote to standard error."""
    progress_output.seek(0)
    written = progress_output.read().decode(errors="replace").strip().splitlines()
    return written[-1] if written else ""
