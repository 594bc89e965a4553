"""A real cluster of three worker processes gives the table of one process, whatever of it ends meanwhile."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from local_cluster import LocalCluster
from small_sweeps import SMALL, plan, swept, tables

from tvimdesign.report.sweep.sweep_study import sweep_folder
from tvimdesign.sweep.run_sweep import Executor

pytestmark = pytest.mark.slow
WIDE = SMALL.replace("count: 3", "count: 12").replace("[20 mm, 70 mm]", "{from: 20 mm, to: 23 mm, count: 3}")
"""36 cells, some ten seconds of work."""


@pytest.fixture(scope="module")
def wide_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("wide") / "wide.yaml"
    path.write_text(WIDE)
    return path


@pytest.fixture(scope="module")
def expected(wide_file: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    out = tmp_path_factory.mktemp("expected") / "out"
    swept(wide_file, out, workers=1)
    return tables(out)


def on_cluster(path: Path, out: Path, address: str, at: dict[int, Callable[[], Any]]) -> dict[str, Any]:
    """Sweep on a cluster; `at` says what is done to it once so many cells are done."""
    left = dict(at)

    def heard(text: str) -> None:
        number = int(text.split()[1]) - 1 if text.startswith("cell ") else 0
        for count in [count for count in left if number >= count]:
            left.pop(count)()

    where = Executor(scheduler=address)
    told = sweep_folder(plan(path), out, where, heard, overwrite=False, resume=False, plots=False)
    assert not left
    run: dict[str, Any] = told["run"]
    return run


@pytest.mark.parametrize("killed", [None, 1])
def test_a_cluster_gives_the_same_bytes_and_a_killed_worker_costs_none(
    wide_file: Path, expected: dict[str, bytes], tmp_path: Path, killed: int | None
) -> None:
    with LocalCluster(tmp_path) as cluster:
        at: dict[int, Callable[[], Any]] = {} if killed is None else {8: lambda: cluster.kill_worker(killed)}
        run = on_cluster(wide_file, tmp_path / "out", cluster.address, at)
    assert run["computed"] == 36
    assert tables(tmp_path / "out") == expected
