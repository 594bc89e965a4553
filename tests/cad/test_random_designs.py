"""Random designs within a study's bounds: refused by a named rule, or sound."""

from __future__ import annotations

import pytest
import random_choices
import random_designs
from support import ROOT

from tvimdesign.device import table_for
from tvimdesign.study import read_study

STUDIES = {"shear": "wrist_joint", "compression": "wrist_compression"}


def tally(mode: str, count: int) -> random_designs.Tally:
    return random_designs.run(read_study(ROOT / f"studies/{STUDIES[mode]}.yaml"), count, seed=20)


@pytest.mark.slow
@pytest.mark.parametrize(("mode", "count"), [("shear", 12), ("compression", 8)])
def test_designs_of_either_mode_that_keep_the_rules_are_sound(mode: str, count: int) -> None:
    found = tally(mode, count)
    assert found.failed == []
    assert found.built == count
    assert found.refused["rotor_spring_gap"] > 0


@pytest.mark.slow
def test_a_random_design_is_sound_or_refused_by_a_named_rule() -> None:
    found = tally("shear", 1)
    assert (found.failed, found.built) == ([], 1)
    assert found.refused["rotor_spring_gap"] > 0


@pytest.mark.slow
def test_a_design_that_is_not_sound_is_told() -> None:
    draws = random_designs.Draws(read_study(ROOT / "studies/wrist_joint.yaml"), seed=20)
    good = next(draws.keeping_rules(1, random_designs.Tally()))
    bad = good.model_copy(update={"values": good.values | {"housing_volume": 1.01 * good.value("housing_volume")}})
    wrong, _ = random_designs.faults(bad, inspect=False)
    assert [text.split(":")[0] for text in wrong] == ["housing_volume"]


def test_random_choices_are_refused_by_name_or_have_a_design_that_keeps_the_rules() -> None:
    outcome = random_choices.Outcome()
    kept = sum(1 for _ in random_choices.designs(12, 3, outcome))
    assert kept + sum(outcome.read.values()) + sum(outcome.ruled.values()) == 12
    assert {*outcome.read, *outcome.ruled} <= {row.name for mode in STUDIES for row in table_for(mode).quantities}


@pytest.mark.slow
def test_modules_of_random_choices_are_sound() -> None:
    outcome = random_choices.run(12, 3, inspect=True, hands=1)
    assert outcome.tally.failed == []
    assert outcome.tally.built > 0
