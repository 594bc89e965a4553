"""Small campaigns: random folders, random studies, and a machine that lacks something."""

import dataclasses
import random
from collections.abc import Iterator
from pathlib import Path

import folders
import machine
import numpy as np
import pytest
import random_studies
from attack import Attack

from tvimdesign.base import atomic_files, manifest
from tvimdesign.solve.result import answer
from tvimdesign.study import read_study_text

WRITTEN = {
    "fit": {"fit.json": b"{}", "fit.png": b"png", "residuals.csv": b"a"},
    "run_with_parts": {
        name: name.encode() for name in ("results.csv", "report.html", "plots/a.png", "cad/a.step", "cad/b.step")
    },
    "front": {"front.csv": b"a", "front/01.design.json": b"{}", "results.csv": b"b"},
    "sweep": {"shards/00001.jsonl": b"{}", "cells.csv": b"a", "sweep.json": b"{}"},
    "cells": {"cell-1/cad/a.step": b"a", "parts.csv": b"b"},
    "explorer": {"explore.json": b"{}"},
}


def losses(tmp_path: Path, count: int) -> Iterator[str]:
    """Try so many folders; yield what is lost."""
    for number in range(count):
        place = tmp_path / str(number)
        place.mkdir()
        lost, done = folders.one_folder(number, 7, WRITTEN, place, real=False)
        yield from (f"{number}: {one} ({done})" for one in lost)


@pytest.mark.gate
def test_no_byte_of_the_user_s_is_changed_or_removed(tmp_path: Path) -> None:
    assert list(losses(tmp_path, 20)) == []


@pytest.mark.gate
@pytest.mark.parametrize("broken", ["digest", "rename", "links"])
def test_the_campaign_sees_what_is_lost(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, broken: str) -> None:
    if broken == "digest":  # as if a file's name were enough to make it ours
        monkeypatch.setattr(manifest, "is_as_written", lambda folder, name, _: (folder / name).is_file())
    elif broken == "rename":
        monkeypatch.setattr(Path, "rename", lambda self, _: self.unlink() if self.is_file() else None)
    else:
        for module in (atomic_files, manifest):
            monkeypatch.setattr(module, "link_on_the_way", lambda *_: None)
    assert next(losses(tmp_path, 200), "")


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


@pytest.mark.slow
@pytest.mark.parametrize("seed", [3, 5])
def test_a_random_study_is_answered_and_its_answer_stands(seed: int) -> None:
    found = random_studies.judged(seed)
    assert found["wrong"] == ""
    assert found["status"] == {3: "above_rating", 5: "infeasible"}[seed]


def test_the_attack_counts_only_designs_whose_switch_ends() -> None:
    study = random_studies.random_study(2)
    attack = Attack(study)
    optimum = random_studies.frozen(random.Random(2).choice(random_studies.BASES))
    assert attack.residual(attack.evaluated(attack.shares(optimum))) <= random_studies.CYCLE_TOLERANCE
    assert attack.worst(np.ones(len(attack.names))) > 100.0  # springs, layer and current at their largest together
    # Its peak of power is that of what it has come to: an attack that took it would better every optimum.
    asked = "mode: shear\nvary: {current: [0.1 A, 3 A]}\nminimize: peak_power\nsolver: {cells: 6}\n"
    attack = Attack(read_study_text(asked, "test"))
    assert attack.evaluated(attack.shares({"current": 1.0})) is None
    assert attack.evaluated(attack.shares({"current": 1.5})) is not None


@pytest.mark.slow
def test_what_is_no_optimum_is_bettered() -> None:
    study = random_studies.random_study(3)
    answered = answer(study)
    assert answered.solution is not None
    attack, values = Attack(study), dict(answered.design.values)
    assert attack.improved(values, answered.solution.reference) <= random_studies.BETTER
    values["wire_diameter"] *= 1.05  # it keeps all limits, and is 1.3 % higher
    assert attack.improved(values, answered.solution.reference) > random_studies.BETTER
