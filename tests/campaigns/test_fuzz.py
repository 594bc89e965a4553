"""A small campaign of inputs; and that it sees what it looks for."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import fuzz
import pytest
from fuzzing import watched
from fuzzing.kind import Drawn, Kind

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
