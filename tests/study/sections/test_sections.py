"""The sections `vary`, `require`, `minimize`, `profile` and `accept`: good and bad entries."""

from collections.abc import Callable
from typing import Any

import jsonschema
import pytest
import yaml
from support import cases_of

from tvimdesign.device import table_for
from tvimdesign.study import Options, Range, Study, StudyError, read_study_text
from tvimdesign.study.written_studies import json_schema

Read = Callable[..., Study]


def _study(name: str, form: str, module: str = "") -> str:
    return f"mode: shear\nminimize: module_mass\nmodule: {{{module}}}\nvary:\n  {name}: {form}\n"


def _flat(vary: Options | Range) -> list[Any]:
    return [*vary.values, vary.source] if isinstance(vary, Options) else [vary.lower, vary.upper, vary.start]


@cases_of("sections", "forms")
def test_forms(read, name, form, expected):
    result = read(_study(name, form)).vary[name]
    for found_value, value in zip(_flat(result), _flat(type(result)(**expected)), strict=True):
        assert found_value == (value if isinstance(value, str | None) else pytest.approx(value))


@cases_of("sections", "within_options")
def test_the_modules_value_may_lie_within_the_options(read, name, form, value):
    assert read(_study(name, form, f"{name}: {value}")).module[name] is not None


VALIDATOR = jsonschema.Draft7Validator(json_schema({mode: table_for(mode) for mode in ("shear", "compression")}))


@cases_of("sections", "ratings")
def test_ratings_are_read_by_name(written, read):
    text = f"mode: shear\naccept: {written}\n"
    assert read_study_text(text).accept == tuple(read)
    VALIDATOR.validate(yaml.safe_load(text))


@pytest.mark.parametrize(
    "written",
    ["[module_mass]", "[stroke]", "[current_margin, current_margin]", "{current_margin: true}", "[[current_margin]]"],
)
def test_other_names_are_refused(written):
    text = f"mode: shear\naccept: {written}\n"
    with pytest.raises(StudyError):
        read_study_text(text)
    with pytest.raises(jsonschema.ValidationError):
        VALIDATOR.validate(yaml.safe_load(text))


def test_ratings_are_those_of_both_modes_and_no_rules():
    """In shear alone the joint's torque goes through the adhesive of the heaters, which has a rating."""
    of = {mode: [row for row in table_for(mode).outputs if row.ratings] for mode in ("shear", "compression")}
    shear, compression = ([row.name for row in rows] for rows in of.values())
    shear.remove("heater_adhesive_margin")
    assert shear == compression
    assert not [row.name for row in of["shear"] if row.rules or row.advice]


@cases_of("sections", "limits")
def test_limits(read, written, sense, limit):
    (requirement,) = read(f"mode: shear\nrequire: {{module_mass: {written}}}").require
    assert (requirement.output, requirement.sense) == ("module_mass", sense)
    assert requirement.limit == pytest.approx(limit)
    assert requirement.text == written.strip("' ")


def test_goals_and_fronts_are_read(read):
    study = read("mode: shear\nvary: {coil_count: [2, 3]}\nminimize: joint_stiffness@hot")
    assert study.minimize == {"joint_stiffness@hot": 1.0}
    study = read(
        "mode: shear\nvary: {coil_count: [2, 3]}\nminimize: {response_time: 1}\nrequire: {switch_energy: '<= 400 J'}"
    )
    assert study.minimize == {"response_time": 1.0}
    assert study.require[0].limit == 400.0
    front = read(FREE + "front: {of: [response_time, joint_stiffness@hot, module_mass], points: 30}\n").front
    assert front.of == ("response_time", "joint_stiffness@hot", "module_mass")
    assert front.points == 30
    assert read(FREE + "front: {of: [response_time, module_mass]}\n").front is not None
    assert read(FREE).front is None
    assert len(read("mode: shear\nrequire: {module_mass: ['>= 5 g', '<= 0.005 kg']}").require) == 2


FREE = "mode: shear\nvary: {current: [1 A, 2 A]}\nminimize: module_mass\n"


VARY = "mode: shear\nvary: {current: [0.5 A, 3 A], coil_count: [2, 3]}\nminimize: response_time\n"


def test_pieces_by_stage(read):
    study = read(VARY + "profile: {softening: 8}")
    assert study.profile.pieces() == {"softening": 8}
    both = VARY.replace("coil_count: [2, 3]", "cooling_current: [0 A, 2 A]")
    assert read(both + "profile: {softening: 8, stiffening: 4}").profile.pieces() == {"softening": 8, "stiffening": 4}
    text = "mode: shear\nvary: {current: {from: 1 A, to: 2 A}}\nminimize: response_time\nprofile: {softening: 4}"
    assert read(text).profile.pieces() == {"softening": 4}


@pytest.mark.parametrize(
    "section", ["", "profile:", "profile: {}", "profile: {softening: 0}", "profile: {stiffening: 0}"]
)
def test_zero_pieces_are_a_constant_current(read, section):
    assert read(VARY + section).profile.pieces() == {}
    assert read("mode: shear\n" + section).profile.pieces() == {}


STUDY = "tvimdesign: 1\nname: x\nmode: shear\nvary: {{{}}}\nminimize: module_mass\n"


@cases_of("sections", "sold_lengths")
def test_the_lengths_a_screw_or_pin_is_sold_in_are_those_that_are_tried(row, record, lengths):
    study = read_study_text(STUDY.format(f"{row}: {record}"), "x.yaml")
    result = study.vary[row]
    assert isinstance(result, Options)
    assert result.values == pytest.approx([1e-3 * length for length in lengths])
