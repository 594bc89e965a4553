"""A small campaign of inputs; and that it sees what it looks for."""

import json
import os
import random
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import fuzz
import pytest
from fuzzing import watched
from fuzzing.kind import Drawn, Kind
from fuzzing.mutations import ODD, mutated_data
from support import ROOT, run_process

USUAL = ["studies", "settings", "sweeps", "records", "designs", "data_files", "column_maps"]


@pytest.mark.parametrize(
    ("kind", "inputs"),
    [
        *((kind, 15) for kind in (*USUAL, "messages")),
        ("answers", 4),
        pytest.param("fits", 4, marks=pytest.mark.slow),
        *(pytest.param(kind, 500, marks=pytest.mark.slow) for kind in USUAL),
    ],
)
def test_mutated_inputs_are_read_or_refused_in_words(kind: str, inputs: int) -> None:
    found = fuzz.done(fuzz.Chunk(kind, 5, 0, inputs))
    assert found.failures == []
    assert found.inputs >= inputs


def test_what_failed_once_fails_no_more() -> None:
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


def test_an_input_is_copied_and_a_slow_one_is_a_fault(tmp_path: Path) -> None:
    before = repr(ODD)
    draw = random.Random(1)
    for _ in range(3000):
        mutated_data('{"a": {"b": [1, {"c": 2}]}}', [("a",), ("a", "b"), ("a", "b", 1), ("a", "b", 1, "c")], draw)
    assert repr(ODD) == before
    kind = Kind(lambda _: Drawn("input.txt", b""), spins_briefly, most_seconds=0.05)
    assert watched.ending(kind, tmp_path / "input.txt")[0].startswith("takes ")


def spins_briefly(_: Path) -> None:
    ends = time.process_time() + 0.1
    while time.process_time() < ends:
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
def test_the_campaign_sees_a_fault(
    use: Callable[[Path], None], fault: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(watched, "HANG", 0.05)
    kind = Kind(lambda _: Drawn("input.txt", b""), use)
    assert watched.ending(kind, Drawn("input.txt", b"x").written(tmp_path))[0].startswith(fault)


@pytest.mark.parametrize(("writes", "inside"), [(True, True), (False, False)])
def test_what_writes_may_write_beside_its_input_alone(writes: bool, inside: bool, tmp_path: Path) -> None:
    kind = Kind(lambda _: Drawn("input.txt", b""), leaves_a_file, writes=writes)
    assert (watched.ending(kind, tmp_path / "input.txt")[0] == "") == inside
    kind = Kind(lambda _: Drawn("input.txt", b""), lambda _: leaves_a_file(tmp_path / "x"), writes=True)
    (tmp_path / "own").mkdir()
    assert watched.ending(kind, tmp_path / "own/input.txt")[0] == f"touches open of {tmp_path / 'left'}"


@pytest.mark.slow
def test_a_campaign_goes_on_where_it_was_ended(tmp_path: Path) -> None:
    command = [sys.executable, str(ROOT / "campaigns/fuzz.py"), "--kinds", "column_maps", "--out", tmp_path / "found"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    for inputs, chunks in ((1000, 1), (2000, 2), (2000, 2)):
        run_process([*command, "--inputs", inputs], env=environment).check_returncode()
        found = [json.loads(line) for line in (tmp_path / "found").read_text().splitlines()]
        assert [(one["first"], one["end"], one["inputs"]) for one in found] == [
            (1000 * i, 1000 * (i + 1), 1000) for i in range(chunks)
        ]


def dies(path: Path) -> None:
    if path.read_bytes() == b"3":
        os._exit(7)


@pytest.mark.slow
def test_an_input_that_ends_the_process_is_at_fault_and_others_are_tried(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fuzz, "CORPUS", tmp_path)
    monkeypatch.setitem(fuzz.KINDS, "deadly", Kind(lambda _: Drawn("input.txt", b"0"), dies))
    monkeypatch.setattr(fuzz, "drawn", lambda *told: Drawn("input.txt", str(told[-1]).encode()))
    found = list(fuzz.in_processes([fuzz.Chunk("deadly", 1, 0, 6)], 1))
    assert [(chunk.first, chunk.end) for chunk in found] == [(0, 4), (4, 6)]
    assert found[0].failures[0].startswith("3: ends the process (7)")
    assert found[1].failures == []
