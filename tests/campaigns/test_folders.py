"""Campaigns of folders, kills and mutated inputs."""

import dataclasses
import json
import os
import random
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import folders
import fuzz
import kills
import machine
import numpy as np
import pytest
import random_studies
from attack import Attack
from explorer_talk import Conversation, not_kept
from fuzzing import watched
from fuzzing.kind import Drawn, Kind
from kills import Try

from tvimdesign.base import atomic_files
from tvimdesign.explore.source import open_source
from tvimdesign.explore.state import open_history, write_history, written_digest
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
        yield from (f"{number}: {output} ({done})" for output in lost)


@pytest.mark.gate
def test_no_byte_of_the_user_s_is_changed_or_removed(tmp_path):
    assert list(losses(tmp_path, 20)) == []


@pytest.mark.gate
@pytest.mark.parametrize("broken", ["digest", "rename", pytest.param("links", marks=pytest.mark.slow)])
def test_the_campaign_sees_what_is_lost(tmp_path, monkeypatch, broken):
    if broken == "digest":  # as if a file's name were enough to make it ours
        monkeypatch.setattr(atomic_files, "is_as_written", lambda folder, name, _: (folder / name).is_file())
    elif broken == "rename":
        monkeypatch.setattr(Path, "rename", lambda self, _: self.unlink() if self.is_file() else None)
    else:
        monkeypatch.setattr(atomic_files, "link_on_the_way", lambda *_: None)
    assert next(losses(tmp_path, 200), "")


@pytest.mark.slow
@pytest.mark.parametrize("lack", machine.LACKS, ids=lambda lack: lack.name)
def test_a_run_is_done_or_ends_in_one_line(lack, tmp_path):
    if lack.mount and not machine.mounts():
        pytest.skip("`unshare -rm` fails here: a system may forbid it; only these two need a disk of their own")
    assert machine.faults_of(lack, tmp_path) == []


@pytest.mark.slow
def test_another_end_than_the_one_expected_is_a_fault(tmp_path):
    lack = next(known for known in machine.LACKS if known.name == "files of 20 kB at most")
    faults = machine.faults_of(dataclasses.replace(lack, code=0, says="no such words"), tmp_path)
    assert [fault.partition(":")[0] for fault in faults] == ["exit code 4, not 0", "not one line about 'no such words'"]


@pytest.mark.slow
@pytest.mark.parametrize("seed", [3, 6])
def test_a_random_study_is_answered_and_its_answer_stands(seed):
    verdict = random_studies.judged(seed)
    assert verdict["wrong"] == ""
    assert verdict["status"] == {3: "above_rating", 6: "infeasible"}[seed]


def test_the_attack_counts_only_designs_whose_switch_ends():
    study = random_studies.random_study(2)
    attack = Attack(study)
    optimum = random_studies.frozen(random.Random(2).choice(random_studies.BASES))
    assert attack.residual(attack.evaluated(attack.shares(optimum))) <= random_studies.CYCLE_TOLERANCE
    assert attack.worst(np.ones(len(attack.names))) > 100.0  # springs, layer and current at their largest together
    # Its peak of power is that of what it has come to: an attack that took it would better every optimum.
    text = "mode: shear\nvary: {current: [0.1 A, 3 A]}\nminimize: peak_power\nsolver: {cells: 6}\n"
    attack = Attack(read_study_text(text, "test"))
    assert attack.evaluated(attack.shares({"current": 1.0})) is None
    assert attack.evaluated(attack.shares({"current": 1.5})) is not None


@pytest.mark.slow
def test_what_is_no_optimum_is_bettered():
    study = random_studies.random_study(3)
    answered = answer(study)
    assert answered.solution is not None
    attack, values = Attack(study), dict(answered.design.values)
    assert attack.improved(values, answered.solution.reference) <= random_studies.BETTER
    values["wire_diameter"] *= 1.05  # it meets all limits, and is 1.3 % higher
    assert attack.improved(values, answered.solution.reference) > random_studies.BETTER


AFTER = {"run": 2.5, "run_with_parts": 12.0, "front": 4.0, "sweep": 5.0, "parts": 6.0, "explorer": 6.0, "tolerate": 6.0,
         "robot": 6.5, "prove": 6.0}  # fmt: skip
TRIES = [Try("run", signal.SIGKILL, 1.0), Try("simulate", signal.SIGTERM, 1.2), Try("explorer", signal.SIGINT, 2.5),
         *(Try(command, number, after) for command, after in AFTER.items() for number in kills.SIGNALS)]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("attempt", TRIES, ids=str)
def test_a_command_that_is_ended_leaves_nothing_behind(attempt, tmp_path):
    kills.prepare(attempt.command, tmp_path)
    own = tmp_path / "one"
    own.mkdir()
    assert kills.faults_after(attempt, own) == []


def test_the_campaign_refuses_a_command_that_fails_by_itself(tmp_path, monkeypatch):
    monkeypatch.setitem(kills.COMMANDS, "run", ["run", "there_is_none.yaml"])
    with pytest.raises(SystemExit, match="run ends with 2 where nobody ends it"):
        kills.run_through("run", tmp_path)


@pytest.mark.gate
def test_a_command_that_goes_on_as_if_nothing_had_come_is_seen(tmp_path, monkeypatch):
    goes_on = (
        "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN)\nwhile time.process_time() < 3.0: pass"
    )

    def start(_: list[str], own: Path) -> subprocess.Popen[bytes]:
        (own / "said.txt").write_text("")
        return subprocess.Popen([sys.executable, "-S", "-c", goes_on], cwd=own, env=kills.environment(own))

    monkeypatch.setattr(kills, "start", start)
    (fault,) = kills.faults_after(Try("run", signal.SIGTERM, 0.2), tmp_path)
    assert fault.startswith("went on for 2.")


def test_signals_that_a_shell_has_ignored_are_followed():
    asks = "import signal, shell_signals; shell_signals.follow_signals(); print(signal.getsignal(signal.SIGINT))"
    command = ["sh", "-c", f"trap '' INT; exec {sys.executable} -c '{asks}'"]
    environment = {**os.environ, "PYTHONPATH": str(Path(kills.__file__).parent)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert "default_int_handler" in done.stdout


def test_the_campaign_sees_broken_files(tmp_path):
    (tmp_path / "manifest.json").write_text(json.dumps({"status": "running"}))
    (tmp_path / "results.json").write_text('{"a": ')
    (tmp_path / "cycle.png").write_bytes(b"\x89PNG")
    (tmp_path / ".why.csv.x.part").write_text("a")
    faults = kills.broken_files(tmp_path, Try("run", signal.SIGTERM, 1.0), through=False)
    assert faults == [
        ".why.csv.x.part is left half written", "cycle.png is broken", "results.json is broken",
        "the folder says running, not interrupted",
    ]  # fmt: skip
    (tmp_path / "manifest.json").write_text('{"status": ')
    assert "manifest.json is broken" in kills.broken_files(tmp_path, Try("run", signal.SIGTERM, 1.0), through=False)
    (tmp_path / "joint.fmu").write_bytes(b"PK")
    assert "joint.fmu is broken" in kills.broken_files(tmp_path, Try("robot", signal.SIGKILL, 1.0), through=False)


def test_the_campaign_sees_what_an_explorer_has_lost(tmp_path):
    source, talk = open_source(kills.SMALL), Conversation(1)
    history = open_history(tmp_path, source.text, source.first)
    history.state = history.state.model_copy(update={"at": {**source.first.at, "current": "1.1 A"}})
    write_history(tmp_path, history, written_digest(tmp_path))
    talk.history = talk.requested = {"current": "1.2 A"}
    assert not_kept(talk, kills.SMALL, tmp_path)[0].startswith("kept {")
    talk.requested = {"current": "1.1 A"}  # it was under way when the explorer was ended
    assert not_kept(talk, kills.SMALL, tmp_path) == []
    (tmp_path / "explore.json").write_text("{")
    assert not_kept(talk, kills.SMALL, tmp_path)[0].startswith("cannot be opened again: ")


USUAL = ["studies", "settings", "sweeps", "records", "designs", "data_files", "column_maps"]


@pytest.mark.gate
@pytest.mark.parametrize(
    ("kind", "inputs"),
    [
        *((kind, 15) for kind in (*USUAL, "messages")),
        ("answers", 4),
        pytest.param("fits", 4, marks=pytest.mark.slow),
        *(pytest.param(kind, 500, marks=pytest.mark.slow) for kind in USUAL),
    ],
)
def test_mutated_inputs_are_read_or_refused_in_words(kind, inputs):
    chunk = fuzz.done(fuzz.Chunk(kind, 5, 0, inputs))
    assert chunk.failures == []
    assert chunk.inputs >= inputs


def test_what_failed_once_fails_no_more():
    assert fuzz.known_failures() == []


def raises(path: Path) -> None:
    raise KeyError(path.name)


def leaves_a_file(path: Path) -> None:
    path.with_name("left").write_text("")


def removes_a_file(path: Path) -> None:
    path.unlink()


def starts_a_process(_: Path) -> None:
    subprocess.run([sys.executable, "-V"], capture_output=True, check=True)


def spins(_: Path) -> None:
    while True:
        pass


def panics(_: Path) -> None:
    raise BaseException("as a library of another language does")


@pytest.mark.parametrize(
    ("use", "fault"),
    [
        (raises, "KeyError in "), (leaves_a_file, "touches open of "), (removes_a_file, "touches os.remove of "),
        (starts_a_process, "touches subprocess.Popen"), (spins, "Hang in "), (panics, "BaseException in "),
    ],
)  # fmt: skip
def test_the_campaign_sees_a_fault(use, fault, tmp_path, monkeypatch):
    monkeypatch.setattr(watched, "HANG", 0.05)
    kind = Kind(lambda _: Drawn("input.txt", b""), use)
    assert watched.ending(kind, Drawn("input.txt", b"x").written(tmp_path))[0].startswith(fault)


@pytest.mark.parametrize(("writes", "inside"), [(True, True), (False, False)])
def test_what_writes_may_write_beside_its_input_alone(writes, inside, tmp_path):
    kind = Kind(lambda _: Drawn("input.txt", b""), leaves_a_file, writes=writes)
    assert (watched.ending(kind, tmp_path / "input.txt")[0] == "") == inside
    kind = Kind(lambda _: Drawn("input.txt", b""), lambda _: leaves_a_file(tmp_path / "x"), writes=True)
    (tmp_path / "own").mkdir()
    assert watched.ending(kind, tmp_path / "own/input.txt")[0] == f"touches open of {tmp_path / 'left'}"
