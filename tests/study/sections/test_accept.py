"""The section `accept`: ratings by name, everything else refused where it stands."""

import jsonschema
import pytest
import yaml

from tvimdesign.device import table_for
from tvimdesign.study import StudyError, read_study_text
from tvimdesign.study.schema import json_schema

SCHEMA = json_schema({mode: table_for(mode) for mode in ("shear", "compression")})


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


@pytest.mark.parametrize(
    "written",
    ["[module_mass]", "[stroke]", "[current_margin, current_margin]", "{current_margin: true}", "[[current_margin]]"],
)
def test_other_names_are_refused(written: str) -> None:
    text = f"mode: shear\naccept: {written}\n"
    with pytest.raises(StudyError):
        read_study_text(text)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(yaml.safe_load(text), SCHEMA)


def test_ratings_are_those_of_both_modes_and_no_rules() -> None:
    of = {mode: [row for row in table_for(mode).outputs if row.ratings] for mode in ("shear", "compression")}
    assert [row.name for row in of["shear"]] == [row.name for row in of["compression"]]
    assert not [row.name for row in of["shear"] if row.rules or row.advice]
