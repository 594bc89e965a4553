"""The child process that makes the parts: a line of JSON a step; `make.py` is the other end.

It runs on its own because the CAD kernel can take a process with it, and has children of its own do the pieces of work
(`worker.py`), because an operation of the kernel can hang.
"""

from __future__ import annotations

import contextlib
import gc
import json
import os
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import ExitStack
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.base.child_process import follow_parent, line_writer
from tvimdesign.base.errors import CatalogError, GeometryError, TvimError
from tvimdesign.base.record import Record
from tvimdesign.base.units import from_si
from tvimdesign.base.user_cache import FOLDER_VARIABLE, cache_folder
from tvimdesign.cad import cad_report
from tvimdesign.cad.assembly.heater_leads import fuse_in_words
from tvimdesign.cad.make import HALF_MADE, WAITING, load_kernel
from tvimdesign.device import table_for
from tvimdesign.study import Design, catalog_of, read_design

if TYPE_CHECKING:
    from tvimdesign.cad.jobs.cache import Result

_NEEDED = "tvimdesign.cad.jobs.build_plan"  # Module that loads the CAD kernel, and all that draws with it

_LETTERS = "abcdefghijklmnopqrstuvwxyz 0123456789.,-() ABCDEFGHIJKLMNOPQRSTUVWXYZ"

_CACHE_NAME = "cad"  # Name of the user's folder of parts


def warm_up(mode: str = "") -> None:
    """Load what many pieces of work need before the first is started: each is a fork of the process that has it.

    Compile, read data files and the table of a mode that is known, find font and letters, load what renders.
    """
    from tvimdesign.cad.assembly import assembly_note
    from tvimdesign.cad.drawing import drawing_requirements
    from tvimdesign.cad.drawing.drawing_sheet import DrawingSheet
    from tvimdesign.cad.inspection import rays
    from tvimdesign.cad.jobs.cache import code_digest

    import_module(_NEEDED)
    if mode:
        table_for(mode)
    data = (drawing_requirements.requirements_data, drawing_requirements.standard_data, assembly_note.all_steps)
    for prepare in (*data, rays.compile_rays, code_digest):
        prepare()
    sheet = DrawingSheet(1.0)
    sheet.text(_LETTERS, (20.0, 20.0))
    sheet.pdf()
    import_module("tvimdesign.cad.render.pictures")


def run(design_path: Path, out: Path, send: Callable[..., None]) -> None:
    """Make what is not in the cache and put all files into `out`; `send` gets each step, then the results."""
    started = time.perf_counter()
    design = read_design(design_path)
    send(progress="loading the CAD kernel")
    load_kernel()
    from tvimdesign.cad.geometry.dimensions import dimensions
    from tvimdesign.cad.jobs.build_plan import PICTURES, build_plan
    from tvimdesign.cad.jobs.cache import Cache, TrackedDesign
    from tvimdesign.cad.jobs.worker import WorkerPool

    with ExitStack() as stack:
        prefix = HALF_MADE.format(os.getpid())
        own = cache_folder(_CACHE_NAME) or stack.enter_context(tempfile.TemporaryDirectory(dir=out, prefix=prefix))
        store = Cache(Path(own))
        pool = WorkerPool(
            TrackedDesign(design, _titles(design)), store, lambda step: send(progress=step),
            made=lambda result: _deliver(result, out),
        )  # fmt: skip
        done = pool.do(build_plan(dimensions(design)))
        files = sorted(name for result in done.results.values() for name in result.out)
    pictures = done.failed.pop(PICTURES, "")
    if done.failed:
        without = [f"without it there is no {', '.join(done.lost)}"] if done.lost else []
        written = f"the other {len(files)} files are written" if files else "no parts were made"
        raise GeometryError("; ".join([*done.failed.values(), *without, written]))
    checks = [check.fields() for result in done.results.values() for check in result.checks]
    notes = [f"no pictures: {pictures}"] if pictures else []
    notes += [f"{name} is made anew: its kept files are damaged, or others could change them" for name in store.damaged]
    notes += _cache_notes()
    send(checks=checks, files=files, notes=notes, reused=done.reused, seconds=time.perf_counter() - started)


def _cache_notes() -> list[str]:
    """Return a note if the user names a folder for kept results that cannot be one."""
    named = os.environ.get(FOLDER_VARIABLE)
    if not named or cache_folder(_CACHE_NAME) is not None:
        return []
    return [f"nothing is kept for the next run: {named} ({FOLDER_VARIABLE}) is no folder that only you can change"]


def _titles(design: Design) -> dict[str, str]:
    """Return what the records a design was made of are called, or ordered by where the catalogue says it.

    A record that is not here has its name only.
    """
    titles = {}
    for row in table_for(design.mode).choices:
        with contextlib.suppress(CatalogError):
            if row.category and row.name in design.choices:
                record = catalog_of(design).record(row.category, design.choices[row.name])
                titles[row.name] = _ordered_by(record, design, row.name)
                if row.name == "structure_material":
                    titles |= _printing_words(record)
    return titles


def _printing_words(record: Record) -> dict[str, str]:
    """Return a material's printing temperatures and the treatment of its specimens, if its record has them."""
    known = [name for name in cad_report.PRINT_TEMPERATURES if record.has(name)]
    words = {name: f"{from_si(record.value(name), 'degC'):.0f}" for name in known}
    return words | {name: word for name, word in record.words.items() if name == cad_report.TREATMENT}


def _ordered_by(record: Record, design: Design, row: str) -> str:
    """Return the designation of a standard part, its length filled in; else the record's title."""
    if record.category == "thermal_fuses":
        return fuse_in_words(record, design)
    length = design.values.get(f"{row}_length")
    if "designation" not in record.words or not isinstance(length, int | float):
        return record.title
    return record.words["designation"].format(length=f"{1e3 * length:.3g}")


def _deliver(result: Result, out: Path) -> None:
    """Copy a result into the user's folder, each file whole: the first are there long before the last."""
    for name in result.out:
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        atomic_write(out / name, (result.folder / "out" / name).read_bytes())


def main(arguments: list[str], job: Callable[[Path, Path, Callable[..., None]], None] = run) -> int:
    """Run a job, by default that of all parts; return the exit code. An error is a line of JSON too.

    With `--wait` it loads the CAD kernel, and reads a line of JSON with the other arguments from standard input.
    """
    follow_parent()
    gc.disable()  # a seventh of the time to load: this process keeps all that it makes; its children collect
    write = line_writer()  # the kernel prints to standard output from C++

    def send(**message: Any) -> None:
        write(message)

    try:
        if arguments[0] == WAITING:
            load_kernel()
            warm_up(arguments[1])
            line = sys.stdin.readline()
            if not line:
                return 0
            arguments = json.loads(line)
        job(Path(arguments[0]), Path(arguments[1]), send)
    except TvimError as error:
        send(error=str(error), code=error.exit_code)
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
