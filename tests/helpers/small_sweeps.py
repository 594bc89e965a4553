"""A sweep of six cells that are evaluated in a second or two, and how tests have it done."""

from pathlib import Path
from typing import Any

from support import sample_text

from tvimdesign.report.output.command import Command
from tvimdesign.report.sweep.sweep_study import sweep_folder
from tvimdesign.study.tree import tree_of_file
from tvimdesign.sweep.plan import SweepPlan, plan_of
from tvimdesign.sweep.run_sweep import Executor
from tvimdesign.sweep.shards import SHARDS

SMALL = sample_text("small_sweep")
"""Half of the cells are no module: the layer would end before it begins."""


def plan(path: Path, *settings: str) -> SweepPlan:
    return plan_of(tree_of_file(path, settings))


def swept(path: Path, out: Path, *, resume: bool = False, **where: Any) -> dict[str, Any]:
    """Sweep a study into a folder, as the command does; return its report of the run."""
    command = Command(out, resume=resume, keep=SHARDS, progress=lambda _: None)
    done = sweep_folder(plan(path), Executor(**where), command, plots=False)
    run: dict[str, Any] = done["run"]
    return run


def tables(out: Path) -> dict[str, bytes]:
    """Return the tables of a folder, to be compared byte for byte."""
    return {name: (out / name).read_bytes() for name in ("cells.csv", "cells.sqlite", "sweep.json")}
