"""Random designs within a study's bounds: refused by a named rule, or sound."""

import json
from pathlib import Path

import pytest
import random_choices
import random_designs
from support import study_path

from tvimdesign.device import table_for
from tvimdesign.study import read_study

STUDIES = {"shear": "wrist_joint", "compression": "wrist_compression"}


def tally(mode: str, count: int) -> random_designs.Tally:
    return random_designs.run(read_study(study_path(STUDIES[mode])), count, seed=20)


@pytest.mark.slow
@pytest.mark.parametrize(("mode", "count"), [("shear", 12), ("compression", 8)])
def test_designs_of_either_mode_that_keep_the_rules_are_sound(mode: str, count: int) -> None:
    found = tally(mode, count)
    assert found.failed == []
    assert found.built == count
    assert found.refused["rotor_spring_gap"] > 0


@pytest.mark.slow
def test_a_design_that_is_not_sound_is_told() -> None:
    draws = random_designs.Draws(read_study(study_path("wrist_joint")), seed=20)
    good = next(draws.keeping_rules(1, random_designs.Tally()))
    bad = good.model_copy(update={"values": good.values | {"housing_volume": 1.01 * good.value("housing_volume")}})
    wrong, _ = random_designs.faults(bad, inspect=False)
    assert [text.split(":")[0] for text in wrong] == ["housing_volume"]


@pytest.mark.slow
def test_slivers_are_told_where_a_process_makes_but_thick_walls() -> None:
    draws = random_designs.Draws(read_study(study_path("wrist_compression")), seed=20)
    good = next(draws.keeping_rules(1, random_designs.Tally()))
    assert random_designs.slivers(good) == []
    thick = good.model_copy(update={"values": good.values | {"minimum_wall": 1.5 * good.value("minimum_wall")}})
    assert any("the thinnest wall" in text for text in random_designs.slivers(thick))


def test_random_choices_are_refused_by_name_or_satisfy_the_rules() -> None:
    drawn = [random_choices.drawn(index, 3, inspect=True) for index in range(12)]
    ended = [one for one in drawn if isinstance(one, random_choices.Ended)]
    assert len(ended) < len(drawn)
    assert {one.by for one in ended} <= {row.name for mode in STUDIES for row in table_for(mode).quantities}


@pytest.mark.slow
def test_modules_of_random_choices_are_sound() -> None:
    built = [one for one in random_choices.run(range(12), 3, inspect=True, hands=1) if one.how == "built"]
    assert built
    assert [fault for one in built for fault in one.faults] == []


def test_a_draw_that_is_in_the_file_is_not_drawn_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "draws.jsonl"
    ended = [random_choices.Ended(index, 1, False, "built", faults=["a gap"] * index) for index in range(2)]
    file.write_text("".join(json.dumps(one._asdict()) + "\n" for one in ended))
    assert random_choices.main(["--draws", "2", "--out", str(file)]) == 1
    assert "2 draws: 0 refused by the reader, 0 without" in (printed := capsys.readouterr().out)
    assert "draw 1 of seed 1: a gap" in printed
