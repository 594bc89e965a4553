"""The folder of a sweep that the jobs of an array share: the job after which every cell is there gathers them."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path, PurePosixPath

from rich.console import Console
from rich.markup import escape

from tvimdesign.base.atomic_files import recorded
from tvimdesign.base.errors import FolderInUseError, InputError
from tvimdesign.report.output.claim import IN_PARTS, Claim
from tvimdesign.report.output.replace_results import seed
from tvimdesign.report.output.results_folder import prepare, recovered, say
from tvimdesign.sweep.run_sweep import Executor, SweepDone
from tvimdesign.sweep.shards import SHARDS


@contextmanager
def joined(out: Path, *, overwrite: bool = False) -> Iterator[Path]:
    """Write into a folder together with other jobs; yields where. Raises InputError where it is not theirs.

    Cells of earlier results are used again.
    """
    if overwrite:
        raise InputError("--overwrite and --shard: the parts share a folder; name another one with --out")
    try:
        prepare(out)
        with suppress(FolderInUseError):  # another job prepares it, or has
            _prepare_jobs(out)
        claim = Claim(out, shared=True)
    except OSError as error:
        raise InputError(f"{out}: cannot be used as a results folder: {error.strerror or error}") from error
    try:
        yield claim.folder
    finally:
        claim.release(remove=False)


def _prepare_jobs(out: Path) -> None:
    """Make the folder that jobs write into, with the cells of earlier results. Raises FolderInUseError, OSError."""
    claim = Claim(out)
    try:
        earlier = recovered(out, claim)
        if not recorded(claim.folder):
            own = {name: digest for name, digest in earlier.files.items() if PurePosixPath(name).parts[0] == SHARDS}
            seed(out, claim.folder, own, say)
        claim.write(IN_PARTS, "")
    finally:
        claim.release(remove=False)


def say_part(done: SweepDone, executor: Executor, out: Path, console: Console, *, as_json: bool) -> None:
    """Print what one job of an array has done."""
    counts = {"cells": done.cells, "reused": done.reused, "computed": done.computed, "missing": done.missing}
    if as_json:
        print(
            json.dumps({**counts, "shard": list(executor.part), "process": os.getpid(), "folder": str(out)}, indent=2)
        )
        return
    others = f"{done.missing} of {done.cells} cells are still with other parts"
    console.print(
        f"Part {executor.part[0]} of {executor.part[1]}: {done.reused} cells reused, {done.computed} computed; "
        f"{others if done.missing else 'all cells are there'}. The part that ends last gathers them in "
        f"[bold]{escape(str(out))}[/bold]",
        soft_wrap=True,
    )
