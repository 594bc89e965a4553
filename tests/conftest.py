"""Shared by all tests: the command line as a user calls it."""

import gc
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from browsers import no_browser_message
from hypothesis import settings
from shell_signals import follow_signals
from support import ROOT, Command, called, environment, run_process, store_equations

from tvimdesign.base.processes import LIMIT

pytest_plugins = ["shear_designs"]

# As the command line does: tests make many objects and keep most, and looking for garbage among them takes its time.
gc.set_threshold(200_000, 20, 20)

follow_signals()  # tests send some
store_equations()

# A test that is right is right on a machine that is busy, too.
settings.register_profile("any machine", deadline=None)
settings.load_profile("any machine")

LONGEST = (
    "tests/device/",
    "tests/test_studies.py",
    "tests/cad/test_cad_make.py",
    "tests/report/compare/test_compare.py",
    "tests/paper/",
    "tests/api/",
    "tests/report/run/",
    "tests/report/page/",
    "tests/simulation/working_cycle/",
    "tests/solve/pareto/test_front.py",
    "tests/test_docs_commands.py",
)
"""Files and rooms that take longest, of the fast or of all tests. A room is dealt out whole, as a file is: its files
share what takes long to make."""


def place(file: str) -> int:
    """Return a file's place among the longest; behind them if it is none."""
    return next((rank for rank, begin in enumerate(LONGEST) if file.startswith(begin)), len(LONGEST))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with what takes longest: it is dealt out whole, and none shall be alone at the end."""
    items.sort(key=lambda item: place(item.nodeid))


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config: pytest.Config) -> None:
    """Say in the last line that there was no browser, where there was none."""
    reporter = config.pluginmanager.get_plugin("terminalreporter")
    words = no_browser_message(reporter.stats.get("skipped", [])) if reporter else ""
    if words:
        reporter.write_line(words)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Deal out files, and whole rooms where LONGEST has a room."""
    from xdist.scheduler import LoadScopeScheduling

    class ByRoom(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            file = nodeid.partition("::")[0]
            rank = place(file)
            return LONGEST[rank] if rank < len(LONGEST) else file

    return ByRoom(config, log) if config.getoption("dist") == "loadfile" else None


@pytest.fixture(scope="session")
def tvimdesign() -> Command:
    """Call the command line with arguments, in this process; returns what a finished process would."""
    return called


@pytest.fixture(scope="session")
def process() -> Command:
    """Run `python -m tvimdesign` with arguments as a user's shell does; returns the finished process."""

    def call(
        *arguments: object, cwd: Path = ROOT, limit: float = LIMIT, spread: str = "off"
    ) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "tvimdesign", *arguments]
        return run_process(command, limit, text=True, cwd=cwd, env=environment(spread))

    return call
