"""The section `accept`: ratings by name, everything else refused where it stands."""

import jsonschema
import pytest
import yaml

from tvimdesign.device import table_for
from tvimdesign.study import StudyError, read_study_text
from tvimdesign.study.schema import json_schema

SCHEMA = json_schema({mode: table_for(mode) for mode in ("shear", "compression")})


def problems(text: str) -> list[str]:
    with pytest.raises(StudyError) as refused:
        read_study_text(text)
    return [str(problem) for problem in refused.value.problems]


@pytest.mark.parametrize(
    ("written", "read"),
    [
        ("[structure_temperature_margin, current_margin]", ("structure_temperature_margin", "current_margin")),
        ("pcl_temperature_margin", ("pcl_temperature_margin",)),
        ("[]", ()),
        ("", ()),
    ],
)
def test_ratings_are_read_by_name(written: str, read: tuple[str, ...]) -> None:
    text = f"mode: shear\naccept: {written}\n"
    assert read_study_text(text).accept == read
    jsonschema.validate(yaml.safe_load(text), SCHEMA)


def test_a_misspelt_rating_is_refused_with_the_nearest() -> None:
    (problem,) = problems("mode: shear\naccept: [structure_temperature]\n")
    assert "accept[0]" in problem
    assert "structure_temperature_margin" in problem


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("[module_mass]", "is no rating"),
        ("[stroke]", "is no rating"),
        ("[current_margin, current_margin]", "twice"),
        ("{current_margin: true}", "list of ratings"),
        ("[[current_margin]]", "accept"),
    ],
)
def test_what_is_no_rating_is_refused(written: str, said: str) -> None:
    text = f"mode: shear\naccept: {written}\n"
    assert said in problems(text)[0]
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(yaml.safe_load(text), SCHEMA)


def test_every_rating_is_of_both_modes_and_is_neither_a_rule_nor_advice() -> None:
    of = {mode: [row for row in table_for(mode).outputs if row.ratings] for mode in ("shear", "compression")}
    assert [row.name for row in of["shear"]] == [row.name for row in of["compression"]]
    assert not [row.name for row in of["shear"] if row.rules or row.advice]
