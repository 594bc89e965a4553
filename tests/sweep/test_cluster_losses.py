"""What a cluster does not say in time is asked again: no cell is lost with the answer."""

from pathlib import Path
from typing import Any

import pytest
from small_sweeps import plan

from tvimdesign.sweep.chunks import CellQueue
from tvimdesign.sweep.cluster import Cluster
from tvimdesign.sweep.plan import Cell, SweptStudy
from tvimdesign.sweep.run_sweep import Usage
from tvimdesign.sweep.shards import ShardWriter


class _Lost:
    """A chunk that failed on its worker, and whose reason does not come."""

    status = "error"

    def exception(self, timeout: float) -> None:
        raise TimeoutError(f"nothing in {timeout:g} s")


class _Scheduler:
    """A client of a scheduler with too much to do: it neither says why a chunk failed nor farewell."""

    status = "running"

    def nthreads(self) -> dict[str, int]:
        return {"worker": 1}

    def submit(self, *_: Any, **__: Any) -> _Lost:
        return _Lost()

    def close(self) -> None:
        raise TimeoutError


@pytest.fixture
def job(study_file: Path) -> SweptStudy:
    return SweptStudy.of(plan(study_file))


def test_cells_whose_reason_does_not_come_are_left(job: SweptStudy, tmp_path: Path) -> None:
    cells = [Cell(f"key {number}", ("0.6 mm", "20 mm")) for number in range(4)]
    left, cluster = CellQueue(cells, job, 1), Cluster("tcp://127.0.0.1:9", job, tmp_path)
    client: Any = _Scheduler()
    with ShardWriter(tmp_path, job.columns) as shard, cluster._closing(client):
        cluster._work(client, left, Usage(), shard, lambda _spent: None)
    assert len(left) == len(cells)
