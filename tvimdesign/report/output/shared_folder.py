"""The folder of work that is done in cells: by processes here, by the jobs of an array that share it, or on a cluster.

Cells are kept in its shards as they are done. The job after which every cell is there gathers them.
"""

from __future__ import annotations

import glob
import json
import os
import platform
import shutil
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from rich.console import Console
from rich.markup import escape

from tvimdesign.base.errors import FolderInUseError, InputError
from tvimdesign.base.journal import recorded
from tvimdesign.report.output.claim import IN_PARTS, Claim
from tvimdesign.report.output.progress import Progress
from tvimdesign.report.output.replace_results import seed
from tvimdesign.report.output.results_folder import ResultsFolder, prepare, recovered, say
from tvimdesign.sweep.points import Texts
from tvimdesign.sweep.run_sweep import SweepDone, Where, run_cells
from tvimdesign.sweep.shards import SHARDS, Kept, Shards
from tvimdesign.sweep.work import Work

_STILL_WRITTEN = 5.0  # s


@dataclass(frozen=True)
class CellsAsked:
    """Cells of some work: their keys, and what each is set to."""

    work: Work
    keys: Sequence[str]
    texts: Callable[[int], Texts]
    called: str = "cell"
    """What one of them is called where they are counted."""
    folders: Sequence[str] = ()
    """Folders of files that belong to cells."""
    half_made: str = ""
    """What the names of folders begin with in which such files are made; a worker that is killed leaves its own."""

    def there(self, folder: Path) -> Iterator[Kept]:
        """What the cells came to, in their order. Raises KeyError where one is not done."""
        return Shards(folder, self.work.columns).kept(iter(self.keys))


def answered_cells(
    stack: ExitStack, out: Path, asked: CellsAsked, where: Where, progress: Progress, *, overwrite: bool, resume: bool
) -> tuple[ResultsFolder | None, SweepDone]:
    """Do the cells of this job; returns the folder to gather them in, none where that is another job's.

    The folder goes with the stack. Raises InputError, OutputError, and TvimError for a cluster that is gone.
    """
    if where.alone:
        folder = stack.enter_context(ResultsFolder(out, overwrite, resume, SHARDS, asked.folders))
        return folder, _done(asked, folder.path, where, progress)
    with joined(out, asked.folders, overwrite=overwrite) as shared:
        done = _done(asked, shared, where, progress)
    return (gatherer(stack, out, asked.folders) if done.whole else None), done


def own_half_made(half_made: str) -> str:
    """The beginning of the names that are this process's own: other jobs make files in the same folder."""
    return f"{half_made}{platform.node()}-{os.getpid()}-"


def _done(asked: CellsAsked, folder: Path, where: Where, progress: Progress) -> SweepDone:
    """Do the cells of this job, and take away what its killed workers have left."""
    try:
        return run_cells(asked.work, asked.keys, asked.texts, folder, where, progress, asked.called)
    finally:
        _remove(folder, asked.half_made and own_half_made(asked.half_made))


def _remove(folder: Path, half_made: str) -> None:
    """Remove folders whose names begin so; children of a worker that was killed may write for a moment longer."""
    end = time.monotonic() + _STILL_WRITTEN
    while half_made and (left := list(folder.glob(glob.escape(half_made) + "*"))) and time.monotonic() < end:
        for path in left:
            shutil.rmtree(path, ignore_errors=True)


@contextmanager
def joined(out: Path, folders: Sequence[str] = (), *, overwrite: bool = False) -> Iterator[Path]:
    """Write into a folder together with other jobs; yields where. Raises InputError where it is not theirs.

    Cells of earlier results are used again. `folders` hold the files of cells.
    """
    if overwrite:
        raise InputError("--overwrite and --shard: the parts share a folder; name another one with --out")
    try:
        prepare(out)
        with suppress(FolderInUseError):  # another job prepares it, or has
            _prepare_jobs(out, [SHARDS, *folders])
        claim = Claim(out, shared=True)
    except OSError as error:
        raise InputError(f"{out}: cannot be used as a results folder: {error.strerror or error}") from error
    try:
        yield claim.folder
    finally:
        claim.release(remove=False)


def _prepare_jobs(out: Path, folders: Sequence[str]) -> None:
    """Make the folder that jobs write into, with the cells of earlier results. Raises FolderInUseError, OSError."""
    claim = Claim(out)
    try:
        earlier = recovered(out, claim)
        if not recorded(claim.folder):
            own = {name: digest for name, digest in earlier.files.items() if PurePosixPath(name).parts[0] in folders}
            seed(out, claim.folder, own, say)
        claim.write(IN_PARTS, "")
    finally:
        claim.release(remove=False)


def gatherer(stack: ExitStack, out: Path, folders: Sequence[str] = ()) -> ResultsFolder | None:
    """Return the folder for the job that gathers; None where another one, which ended at the same time, does."""
    try:
        return stack.enter_context(ResultsFolder(out, resume=True, progress=SHARDS, kept=folders))
    except InputError:
        return None


def say_part(done: SweepDone, where: Where, out: Path, console: Console, *, as_json: bool) -> None:
    """Print what one job of an array has done."""
    told = {"cells": done.cells, "reused": done.reused, "computed": done.computed, "missing": done.missing}
    if as_json:
        print(json.dumps({**told, "shard": list(where.part), "process": os.getpid(), "folder": str(out)}, indent=2))
        return
    others = f"{done.missing} of {done.cells} cells are still with other parts"
    console.print(
        f"Part {where.part[0]} of {where.part[1]}: {done.reused} cells reused, {done.computed} computed; "
        f"{others if done.missing else 'all cells are there'}. The part that ends last gathers them in "
        f"[bold]{escape(str(out))}[/bold]",
        soft_wrap=True,
    )
