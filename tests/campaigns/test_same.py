"""The frozen oracle: that a comparison sees what changed, was lost or was added."""

import json
import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest
import same
from oracle import fits, frozen_files, messages, optima, study_outputs
from oracle.compare import Renames, Value, differences, relative_difference
from oracle.frozen_files import read_frozen, write_frozen
from support import cases_of, study_path

import tvimdesign

FROZEN: dict[str, Value] = {
    "mass": 0.1,
    "stiffness@hot": 5.0,
    "choice:motor": "none",
    "time": math.inf,
    "nan": math.nan,
}
OPTIMUM = {"status": "optimal", "objective": 1.0, "reference": {"mass": 0.2}}


def changes_of(now: Mapping[str, Value], **options: Any) -> list[tuple[str, str, str]]:
    return [(change.quantity, change.frozen, change.now) for change in differences("study", FROZEN, now, **options)]


def test_lost_added_and_different_values_are_distinguished():
    assert changes_of(dict(FROZEN)) == []
    assert changes_of({name: value for name, value in FROZEN.items() if name != "mass"}) == [("mass", "0.1", "lost")]
    assert changes_of({**FROZEN, "size": 3.0}) == [("size", "added", "3.0")]
    frozen, now = {"limit:mass <=": 1e-12, "mass": 1e-12}, {"limit:mass <=": 3e-12, "mass": 3e-12}
    assert [change.quantity for change in differences("study", frozen, now, tolerance=1e-9)] == ["mass"]
    assert relative_difference(2.0, 1.0) == 0.5
    assert relative_difference(-1.0, 1.0) == 2.0
    assert relative_difference(math.inf, math.inf) == relative_difference(math.nan, math.nan) == 0.0
    assert relative_difference(math.inf, 1.0) == relative_difference(1.0, math.nan) == math.inf


CHANGED = [("mass", math.nextafter(0.1, 1.0)), ("choice:motor", "small"), ("choice:motor", 1.0), ("time", 7.0),
           ("nan", 0.0), ("stiffness@hot", None)]  # fmt: skip


@pytest.mark.parametrize(("name", "value"), CHANGED)
def test_a_changed_value(name, value):
    assert changes_of({**FROZEN, name: value}) == [(name, str(FROZEN[name]), str(value))]


@pytest.mark.parametrize(("change", "count"), [(1e-10, 0), (1e-8, 1)])
def test_tolerance(change, count):
    assert len(changes_of({**FROZEN, "stiffness@hot": 5.0 * (1.0 + change)}, tolerance=1e-9)) == count


def test_renames():
    now = {**FROZEN, "rate@hot": 5.0, "size": 3.0}
    del now["stiffness@hot"], now["mass"]
    renames = Renames({"stiffness": "rate"}, frozenset({"mass"}), frozenset({"size"}))
    assert changes_of(now, renames=renames) == []
    assert changes_of({**now, "rate@hot": 5.1}, renames=renames) == [("rate@hot", "5.0", "5.1")]
    assert changes_of(now, renames=replace(renames, added=frozenset())) == [("size", "added", "3.0")]
    assert changes_of(now, renames=replace(renames, renamed={})) == [
        ("stiffness@hot", "5.0", "lost"), ("rate@hot", "added", "5.0"),
    ]  # fmt: skip


def test_a_renamed_input_is_set_by_its_name_of_today():
    study = tvimdesign.load(study_path("paper_shear"))
    design = {"chosen": {"wire_size": 0.0018}, "units": {"wire_size": "m"}, "current_profiles": {}}
    evaluated = study_outputs.evaluated_study(study, design, Renames({"wire_size": "wire_diameter"}))
    assert "wire_diameter: 0.0018 m" in evaluated.text
    assert "wire_size" not in evaluated.text


def test_a_file_of_renames(tmp_path):
    assert Renames.read(tmp_path / "none.json").expected(FROZEN).keys() == FROZEN.keys()
    path = tmp_path / "renames.json"
    path.write_text(json.dumps({"renamed": {"a": "b"}, "removed": ["c"]}))
    assert Renames.read(path).expected({"a@hot": 1.0, "c": 2.0}) == {"b@hot": 1.0}
    path.write_text(json.dumps({"rename": {"a": "b"}}))
    with pytest.raises(ValueError, match="unknown keys"):
        Renames.read(path)


def test_frozen_numbers_keep_every_bit(tmp_path):
    values = {"a": 0.1 + 0.2, "b": 5e-324, "c": math.inf, "d": -0.0, "e": 1.7976931348623157e308, "f": "\ud800"}
    write_frozen(tmp_path / "x.json", values)
    assert repr(read_frozen(tmp_path / "x.json")) == repr(dict(sorted(values.items())))
    with pytest.raises(FileNotFoundError, match="is not frozen"):
        read_frozen(tmp_path / "y.json")


@cases_of("same", "optimum")
def test_an_optimum(change, quantities):
    changes = optima.optimum_differences("study", OPTIMUM, OPTIMUM | change)
    assert [difference.quantity for difference in changes] == quantities


def test_objectives_places_and_fits_are_compared_without_wording():
    changes = [optima.objective_change(OPTIMUM, OPTIMUM | {"objective": value}) for value in (0.9, 1.0, 1.25, None)]
    assert changes == pytest.approx([-0.1, 0.0, 0.2, 0.0])
    assert messages.message_places("mode: shear\nmodul: {}\n") == {"2:1 modul": 1.0}
    assert messages.message_places("mode: shear\n") == {"accepted": 1.0}
    assert messages.message_places("a: b: c")["1:5 "] == 1.0
    case = next(case for case in fits.fit_cases() if case.kind == "torque_angle")
    once, again = fits.fit(case), fits.fit(case)
    assert once == again
    assert once["fit:kind"] == "torque_angle"
    assert once["read:0.torque[count]"] == 25.0
    assert "fit:parameters[stiffness].si.value" in once
    assert not any("meaning" in name for name in once)
    assert fits.fit(replace(case, data=b"nothing")) == {"read:refused": "InputError", "fit:refused": "InputError"}


def test_every_study_is_frozen():
    frozen = {path.stem: read_frozen(path) for path in (frozen_files.FOLDER / "studies").glob("*.json")}
    assert frozen.keys() == study_outputs.study_files().keys()
    for name, data in frozen.items():
        assert len(data["outputs"]) > 1000, name
        assert set(data["chosen"]) >= set(data["units"]), name
        assert ("objective" in data["optimum"]) == bool(data["optimum"]), name


@pytest.mark.gate
def test_a_frozen_design_has_the_frozen_names():
    frozen = read_frozen(study_outputs.frozen_file("paper_shear"))
    renames = Renames.read(same.RENAMES)
    now = study_outputs.outputs(study_outputs.evaluate_frozen("paper_shear", renames))
    changes = list(differences("paper_shear", frozen["outputs"], now, tolerance=1e-3, renames=renames))
    assert [str(difference) for difference in changes if difference.now == "lost" or difference.frozen == "added"] == []
    for name, value in frozen["chosen"].items():
        assert now[name] == value
