"""A run on a machine that lacks something; and that the campaign sees a wrong end."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import machine
import pytest


@pytest.mark.slow
@pytest.mark.parametrize("lack", machine.LACKS, ids=lambda lack: lack.name)
def test_a_run_is_done_or_ends_in_one_line(lack: machine.Lack, tmp_path: Path) -> None:
    if lack.mount and not machine.mounts():
        pytest.skip("`unshare -rm` fails here: a system may forbid it; only these two need a disk of their own")
    assert machine.faults_of(lack, tmp_path) == []


@pytest.mark.slow
def test_another_end_than_the_one_expected_is_a_fault(tmp_path: Path) -> None:
    lack = next(one for one in machine.LACKS if one.name == "files of 20 kB at most")
    found = machine.faults_of(dataclasses.replace(lack, code=0, says="no such words"), tmp_path)
    assert [fault.partition(":")[0] for fault in found] == ["exit code 4, not 0", "not one line about 'no such words'"]
