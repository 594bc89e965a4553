"""Some random studies are answered and their answers stand; and the attack finds what there is."""

from __future__ import annotations

import json
import random
from pathlib import Path

import numpy as np
import pytest
import random_studies
from attack import Attack

from tvimdesign.solve.result import answer
from tvimdesign.study import read_study_text


@pytest.mark.slow
@pytest.mark.parametrize("seed", [3, 5])
def test_a_random_study_is_answered_and_its_answer_stands(seed: int) -> None:
    found = random_studies.judged(seed)
    assert found["wrong"] == ""
    assert found["status"] == {3: "above_rating", 5: "infeasible"}[seed]


def test_the_attack_finds_a_design_where_there_is_one_and_none_where_there_is_none() -> None:
    study = random_studies.random_study(2)
    attack = Attack(study)
    optimum = random_studies.released(random.Random(2).choice(random_studies.BASES))
    assert attack.residual(attack.evaluated(attack.shares(optimum))) <= random_studies.CYCLE_TOLERANCE
    assert attack.worst(np.ones(len(attack.names))) > 100.0  # springs, layer and current at their largest together


def test_a_module_whose_switch_never_ends_is_no_design() -> None:
    """Its peak of power is that of what it has come to: an attack that took it would better every optimum."""
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


def test_a_campaign_goes_on_where_it_was_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []

    def judged(seed: int) -> dict[str, object]:
        asked.append(seed)
        return {"seed": seed, "status": "optimal", "wrong": ""}

    monkeypatch.setattr(random_studies, "in_a_process", judged)
    out = tmp_path / "answers"
    assert len(random_studies.campaign(range(1, 4), 1, out)) == 3
    assert len(random_studies.campaign(range(1, 6), 1, out)) == 5
    assert asked == [1, 2, 3, 4, 5]
    assert [json.loads(line)["seed"] for line in out.read_text().splitlines()] == asked
