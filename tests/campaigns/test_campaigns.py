"""Small versions of the campaigns of faults; and that each campaign sees what it looks for."""

import json
import random
import signal
from collections.abc import Callable
from pathlib import Path

import fuzz
import kills
import pytest
import random_studies
from kills import Try

from tvimdesign.solve.result import answer


@pytest.mark.parametrize("kind", fuzz.KINDS)
def test_mutated_inputs_are_read_or_refused_in_words(kind: str) -> None:
    assert fuzz.campaign(kind, 60, seed=5)["failures"] == 0


def test_what_failed_once_fails_no_more() -> None:
    assert fuzz.known_failures() == []


def raises(folder: Path) -> None:
    raise KeyError(folder.name)


def leaves_a_file(folder: Path) -> None:
    (folder / "left").write_text("")


@pytest.mark.parametrize(("use", "fault"), [(raises, "KeyError in "), (leaves_a_file, "leaves left")])
def test_the_campaign_of_inputs_sees_a_fault(use: Callable[[Path], None], fault: str, tmp_path: Path) -> None:
    assert fault in fuzz.fault_of(use, tmp_path)


def test_mutations_change_a_text_and_data() -> None:
    draw = random.Random(1)
    assert len({fuzz.mutated_text("mode: shear\n", draw) for _ in range(50)}) > 25
    plain = {"a": [1, {"b": 2}]}
    assert list(fuzz.paths(plain)) == [("a",), ("a", 0), ("a", 1), ("a", 1, "b")]
    assert any(fuzz.mutated_data(plain, list(fuzz.paths(plain)), draw) != plain for _ in range(5))
    assert plain == {"a": [1, {"b": 2}]}


@pytest.mark.parametrize(
    ("command", "number", "after"),
    [
        ("run", signal.SIGKILL, 1.5),
        *(
            pytest.param("run", number, after, marks=pytest.mark.slow)
            for number in kills.SIGNALS
            for after in (2.5, 4.0)
        ),
        *(pytest.param("sweep", number, 5.0, marks=pytest.mark.slow) for number in kills.SIGNALS),
        *(pytest.param("parts", number, 6.0, marks=pytest.mark.slow) for number in kills.SIGNALS),
    ],
)
def test_a_command_that_is_ended_leaves_nothing_behind(
    command: str, number: signal.Signals, after: float, tmp_path: Path
) -> None:
    assert kills.faults_after(Try(command, number, after), tmp_path) == []


def test_the_campaign_of_kills_sees_broken_files(tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_text(json.dumps({"status": "running"}))
    (tmp_path / "results.json").write_text('{"a": ')
    (tmp_path / "cycle.png").write_bytes(b"\x89PNG")
    (tmp_path / ".why.csv.x.part").write_text("a")
    found = kills.broken_files(tmp_path, Try("run", signal.SIGTERM, 1.0), ended=False)
    assert found == [
        ".why.csv.x.part is left half written", "cycle.png is broken", "results.json is broken",
        "the manifest says running, not interrupted",
    ]  # fmt: skip


def test_a_random_study_is_answered_and_its_answer_stands() -> None:
    found = random_studies.judged(2)
    assert found["wrong"] == ""
    assert found["status"] in {"optimal", "above_rating"}


def test_the_attack_finds_a_design_where_there_is_one() -> None:
    study = random_studies.random_study(2)
    answered = answer(study)
    attack = random_studies.Attack(study)
    shares = [(answered.design.values[name] - low) / (high - low)
              for name, (low, high) in zip(attack.names, attack.ends, strict=True)]  # fmt: skip
    assert attack.worst(shares) <= random_studies.CYCLE_TOLERANCE
