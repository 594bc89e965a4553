"""What all tests share: the command line as a user calls it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from support import ROOT, Command

pytest_plugins = ["shear_designs"]

# What the benchmarks have written for numba is tested as plain Python: compiling it takes longer than all else.
os.environ["NUMBA_DISABLE_JIT"] = "1"

LONGEST = (
    "test_random_designs.py",
    "test_studies_as_parts.py",
    "test_cad_make.py",
    "test_studies.py",
    "test_discrete_choices.py",
    "test_compare.py",
    "test_worker_and_cache.py",
    "test_cad_mounts.py",
    "test_front.py",
    "test_stiffening.py",
    "test_docs_commands.py",
)
"""Files of a minute or more, the longest two first."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the longest files: they are dealt out whole, and none shall be alone at the end."""
    rank = {name: place for place, name in enumerate(LONGEST)}
    items.sort(key=lambda item: rank.get(item.path.name, len(LONGEST)))


@pytest.fixture(scope="session")
def tvimdesign() -> Command:
    """Run `python -m tvimdesign` with arguments; returns the finished process."""

    def call(
        *arguments: object, cwd: Path = ROOT, timeout: float = 300.0, spread: str = "off"
    ) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "tvimdesign", *map(str, arguments)],
            capture_output=True,
            text=True,
            cwd=cwd,
            timeout=timeout,
            check=False,
            # Parts are made anew: what an earlier run has kept must not hide what this one would make.
            env={
                **os.environ,
                "PYTHONPATH": str(ROOT),
                "COLUMNS": "120",
                "TVIMDESIGN_CACHE": "",
                "TVIMDESIGN_SPREAD": spread,
            },
        )

    return call
