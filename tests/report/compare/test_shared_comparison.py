"""Studies of a comparison answered by the jobs of an array or on a cluster: the same files as in one process."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from comparable import SHEAR, written
from local_cluster import LocalCluster, answered_on
from support import Command

from tvimdesign.report.compare.shared_answers import ComparisonWork, found_of, studies_asked
from tvimdesign.study.tree import tree_of_file
from tvimdesign.sweep.shards import ShardWriter
from tvimdesign.sweep.work import CellAnswer


def _drawn(text: str) -> str:
    """The study without what varies, on half the cells."""
    return text[: text.index("vary:")] + text[text.index("operating_points:") :].replace("1}", "1, cells: 6}")


SMALL = _drawn(SHEAR)
WIDER = SMALL.replace("  current: 1.5 A", "  current: 1.5 A\n  pcl_thickness: 1.1 mm")
FILES = ("compare.csv", "summary.txt", "small/drawn.json", "wider/drawn.json", "small/study.yaml")


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    return list(written(tmp_path_factory.mktemp("pair"), small=SMALL, wider=WIDER))


@pytest.fixture(scope="module")
def expected(tvimdesign: Command, pair: list[Path]) -> dict[str, bytes]:
    out = pair[0].parent / "expected"
    done = tvimdesign("compare", *pair, "--no-plots", "--out", out)
    assert done.returncode == 0, done.stderr
    return _files(out)


def _files(out: Path) -> dict[str, bytes]:
    found = {name: (out / name).read_bytes() for name in FILES}
    told = json.loads((out / "compare.json").read_text())
    told.pop("seconds")
    for study in told["studies"].values():
        study.pop("seconds")
    return {**found, "compare.json": json.dumps(told).encode()}


@pytest.mark.gate
def test_each_job_answers_its_studies_and_the_last_compares(
    tvimdesign: Command, pair: list[Path], expected: dict[str, bytes], tmp_path: Path
) -> None:
    for part in (2, 1):
        done = tvimdesign("compare", *pair, "--no-plots", "--workers", 1, "--shard", f"{part}/2", "--out", tmp_path)
        assert done.returncode == 0, done.stderr
        assert ("1 of 2 cells are still with other parts" in done.stdout) == (part == 2)
        assert (tmp_path / "compare.csv").exists() == (part == 1)
    assert _files(tmp_path) == expected
    again = tvimdesign("compare", *pair, "--no-plots", "--resume", "--out", tmp_path)
    assert again.returncode == 0, again.stderr
    assert "study 1 of" not in again.stderr
    assert _files(tmp_path) == expected


def test_a_study_whose_workers_die_is_told_and_the_other_kept(pair: list[Path], tmp_path: Path) -> None:
    asked = studies_asked([tree_of_file(path) for path in pair], 0)
    crashed = CellAnswer("crashed", "its process ended with code -9", None, None, (None,))
    there = CellAnswer("answered", "", None, None, (json.dumps({"troubles": [], "seconds": {}}),))
    with ShardWriter(tmp_path, asked.work.columns) as shard:
        shard.append([(asked.keys[0], crashed, 0.0), (asked.keys[1], there, 1.0)])
    found = found_of(asked, ["a", "b"], tmp_path)
    assert found["a"]["troubles"][0]["error"] == "its process ended with code -9"
    assert found["b"]["troubles"] == []


def test_a_key_changes_with_every_study_and_with_the_points(pair: list[Path]) -> None:
    trees = [tree_of_file(path) for path in pair]
    base = studies_asked(trees, 0)
    assert len(set(base.keys)) == 2
    assert isinstance(base.work, ComparisonWork)
    assert not set(base.keys) & set(studies_asked(trees, 1).keys)
    assert not set(base.keys) & set(studies_asked([trees[0], trees[0]], 0).keys)
    assert list(base.keys) == list(studies_asked(trees, 0).keys)


@pytest.mark.slow
def test_a_cluster_that_loses_a_worker_compares_the_same(
    tvimdesign: Command, pair: list[Path], expected: dict[str, bytes], tmp_path: Path
) -> None:
    out = tmp_path / "out"
    with LocalCluster(tmp_path) as cluster:
        asked = studies_asked([tree_of_file(path) for path in pair], 6)
        done = answered_on(cluster, asked, out, {0: lambda: cluster.kill_worker(1)})
    assert (done.whole, done.computed) == (True, 2)
    gathered = tvimdesign("compare", *pair, "--no-plots", "--resume", "--out", out)
    assert gathered.returncode == 0, gathered.stderr
    assert "study 1 of" not in gathered.stderr
    assert _files(out) == expected
