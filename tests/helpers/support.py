"""Names that tests share: where the project is, its studies, and the type of the command fixture."""

import gc
import io
import os
import subprocess
import sys
import time
import warnings
from collections.abc import Callable, Sequence
from contextlib import chdir, redirect_stderr, redirect_stdout
from functools import cache
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any
from unittest import mock

import psutil
import pytest
import yaml
from cvodes_cycle import CvodesSimulator

from tvimdesign.base import user_cache
from tvimdesign.base.processes import LIMIT, communicate, end_process_tree
from tvimdesign.cli.main import main
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions

ROOT = Path(__file__).resolve().parents[2]
STUDIES = sorted((ROOT / "studies").glob("*.yaml"))
"""The studies that ship."""
TASKS = sorted((ROOT / "studies/tasks").glob("*.yaml"))
"""Studies of a task, which ship beside them."""
Command = Callable[..., CompletedProcess[str]]
TRANSFORMED = {"hold_angle", "set_angle", "backlash", "relaxation_loss"}
"""Rows read off a Laplace transform, whose weights cancel: other rounding shows in the tenth digit."""


PAST = "validation/fe_structure/studies"


def study_path(name: str) -> Path:
    """Return the path of a study by name: shipped, or kept for tests or for its parts by FE."""
    places = (ROOT / folder / f"{name}.yaml" for folder in ("studies", "studies/tasks", "tests/studies", PAST))
    return next((path for path in places if path.exists()), ROOT / f"tests/studies/{name}.yaml")


def sample_text(name: str) -> str:
    """Return the text of a study, or of a record, that tests read whole or with changes."""
    return (ROOT / f"tests/studies/texts/{name}.yaml").read_text(encoding="utf-8")


def refused(what: str) -> list[Any]:
    """Return cases of input that is refused, with the words of each refusal."""
    cases: list[Any] = yaml.safe_load((ROOT / f"tests/refused/{what}.yaml").read_text(encoding="utf-8"))
    return cases


@cache
def _tables(file: str) -> dict[str, list[list[Any]]]:
    tables: dict[str, list[list[Any]]] = yaml.safe_load((ROOT / f"tests/cases/{file}.yaml").read_text(encoding="utf-8"))
    return tables


def cases_of(file: str, table: str) -> pytest.MarkDecorator:
    """Return the mark that runs a test with each row of a table of tests/cases; its first row names the arguments."""
    names, *rows = _tables(file)[table]
    return pytest.mark.parametrize(names, rows)


def is_at_work(process: int) -> bool:
    """Return whether a process runs; one that has ended and waits to be reaped does not."""
    try:
        return psutil.Process(process).status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


def wait_until(condition: Callable[[], bool], within: float = 600.0) -> bool:
    """Wait until a condition holds, generously: other processes may use all processors. Return whether it does."""
    end = time.monotonic() + within
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


def are_gone(processes: Sequence[int]) -> bool:
    """Wait until processes have ended, at most a minute; tests start longer ones. Return whether they have."""
    return wait_until(lambda: not any(map(is_at_work, processes)), 60.0)


def run_process(command: Sequence[object], limit: float = LIMIT, **options: Any) -> CompletedProcess[Any]:
    """Run a command with a limit on its processor time; return its output; `options` are Popen's."""
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
    words = [str(word) for word in command]
    with subprocess.Popen(words, **options) as process:
        try:
            out, err = communicate(process, limit)
        except BaseException:
            end_process_tree(process.pid)
            raise
    return CompletedProcess(words, process.returncode, out, err)


def digits(name: str, usual: float) -> float:
    """Relative tolerance between two ways to compute a row, by full name, from the one that is usual."""
    return 1e-9 if name.partition("@")[0] in TRANSFORMED else usual


def fine(model: DeviceFunctions) -> CvodesSimulator:
    """Another simulator, by CVODES at 1e-9, that judges the product's."""
    return CvodesSimulator(model, tolerance=1e-9, steps=200)


def tight(model: DeviceFunctions) -> Simulator:
    """Return the product's simulator at a tenth of its error: values are within 1e-5 of what they converge to."""
    return Simulator(model, tolerance=1e-5)


def store_equations(home: Path = ROOT / "build/cache") -> None:
    """Store recorded equations below `home`, for all workers and later runs.

    Parts are made anew, as a file has the name of their folder: stored ones must not hide what a test would make.
    """
    (home / "tvimdesign").mkdir(parents=True, exist_ok=True)
    (home / "tvimdesign/cad").touch()
    os.environ.pop(user_cache.FOLDER_VARIABLE, None)
    os.environ["XDG_CACHE_HOME"] = str(home)
    user_cache._MOST = 2000  # a study has ten tapes, and these are of hundreds


def environment(spread: str = "off") -> dict[str, str]:
    """Return the command line's environment in a test."""
    return {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "120", "TVIMDESIGN_SPREAD": spread}


def called(*arguments: object, cwd: Path = ROOT, spread: str = "off", **more: str) -> CompletedProcess[str]:
    """Call the command line in this process, where the libraries are loaded already; `more` is environment."""
    words, out, err = ["tvimdesign", *map(str, arguments)], io.StringIO(), io.StringIO()
    code: object = 0
    threshold = gc.get_threshold()
    with (
        chdir(cwd),
        redirect_stdout(out),
        redirect_stderr(err),
        mock.patch.dict(os.environ, {**environment(spread), **more}),
        mock.patch.object(sys, "argv", words),
        mock.patch.object(gc, "freeze"),  # this process goes on, and what is garbage now shall not stay
        warnings.catch_warnings(),
    ):
        warnings.simplefilter("default")  # as in a process of its own, where pytest's filters are unknown
        try:
            main()
        except SystemExit as ended:
            code = ended.code
        finally:
            gc.set_threshold(*threshold)
    assert code is None or isinstance(code, int), code
    return CompletedProcess(words, code or 0, out.getvalue(), err.getvalue())
