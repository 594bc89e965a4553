"""A real cluster of three worker processes gives the table of one process, whatever of it ends meanwhile."""

import resource
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from local_cluster import LocalCluster
from small_sweeps import SMALL, plan, swept, tables
from support import ROOT, environment

from tvimdesign.report.sweep.sweep_study import sweep_folder
from tvimdesign.sweep.run_sweep import Executor
from tvimdesign.sweep.shards import Shards

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


def test_a_scheduler_that_is_started_again_costs_no_cell(
    wide_file: Path, expected: dict[str, bytes], tmp_path: Path
) -> None:
    with LocalCluster(tmp_path) as cluster:

        def restart() -> None:
            cluster.kill_scheduler()
            for number in range(3):
                cluster.kill_worker(number)
            cluster.start_scheduler()
            for _ in range(3):
                cluster.start_worker()

        run = on_cluster(wide_file, tmp_path / "out", cluster.address, {10: restart})
    assert run["computed"] == 36
    assert tables(tmp_path / "out") == expected


def test_a_disk_that_is_full_is_said_in_a_line_and_costs_no_cell(
    wide_file: Path, expected: dict[str, bytes], tmp_path: Path
) -> None:
    """The answers of all workers come to one shard here; there is room for some of them, then for all."""
    out, room = tmp_path / "out", 5000
    with LocalCluster(tmp_path) as cluster:
        words = ["sweep", str(wide_file), "--out", str(out), "--no-plots", "--scheduler", cluster.address]
        command = [sys.executable, "-m", "tvimdesign", *words]
        full = subprocess.run(
            command, env=environment(), cwd=ROOT, capture_output=True, text=True, check=False,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (room, room)),
        )  # fmt: skip
        assert full.returncode == 4, full.stderr
        last = full.stderr.strip().splitlines()[-1]
        assert "00001.jsonl: cannot be written: File too large; the cells before are kept: make room" in full.stderr
        assert "--resume goes on" in last
        assert "Traceback" not in full.stderr
        kept = len(Shards(out, plan(wide_file).columns))
        assert 0 < kept < 36
        again = subprocess.run(
            [*command, "--resume"], env=environment(), cwd=ROOT, capture_output=True, text=True, check=False
        )
        assert again.returncode == 0, again.stderr
    assert f"{kept} reused, {36 - kept} computed" in again.stdout
    assert tables(out) == expected
