"""Idealizations beside the module as drawn, and cooling beside the same with its pads unpowered."""

import csv
import io
import math
from functools import cache

import pytest
from answers import shipped_answer

from tvimdesign.device import table_for
from tvimdesign.report.output.tables import results, results_csv
from tvimdesign.report.run.blocks.facts import more_facts
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import read_study_text

TABLE = table_for("shear")


@pytest.fixture(scope="module")
def published() -> StudyResult:
    return shipped_answer("paper_reconstructed")


@pytest.mark.gate
def test_the_papers_ratio_is_told_with_the_stiffness_as_drawn(published: StudyResult) -> None:
    by = {one.text: one.as_drawn for one in published.idealizations}
    assert list(by) == ["leg_model: ignored", "transmission: unity"]
    # An independent reading of the drawn module found 4.53 N*m/rad at rest and 4.09 at full stroke, for 5.61.
    drawn = by["transmission: unity"]
    assert drawn["spring_stiffness"] == pytest.approx(4.53, abs=0.005)
    assert drawn["least_spring_stiffness"] == pytest.approx(4.09, abs=0.005)
    assert "envelope_diameter" not in drawn
    assert "layer_strain" not in drawn
    reported = results(published, TABLE)
    rows = {row["name"]: row for row in csv.DictReader(io.StringIO(results_csv(reported["values"])))}
    assert rows["spring_stiffness"]["idealized"] == "leg_model: ignored, transmission: unity"
    assert rows["spring_rate"]["idealized"] == "leg_model: ignored"
    assert rows["envelope_diameter"]["idealized"] == ""


def test_a_study_as_drawn_has_none() -> None:
    found = answer(read_study_text("mode: shear\n"))
    assert found.idealizations == ()
    assert not any(row["idealized"] for row in results(found, TABLE)["values"].values())


def test_every_idealization_is_no_default_and_names_its_omission() -> None:
    idealized = {row.name: row for mode in ("shear", "compression") for row in table_for(mode).choices if row.idealized}
    assert set(idealized) == {"leg_model", "transmission", "phase_model"}
    for row in idealized.values():
        assert row.default not in row.idealized
        assert all(word in row.options and about for word, about in row.idealized.items())


def test_a_layer_that_freezes_where_it_melts_changes_times_alone() -> None:
    study = read_study_text("mode: shear\nmodule: {phase_model: equilibrium}\n")
    (one,) = answer(study).idealizations
    assert "stiffening_time" in one.as_drawn
    assert "spring_stiffness" not in one.as_drawn


SINK = "cold_side: sink, cooling_current: 0.8 A"
FOIL = "peltier_module: silicone_9ar_08_24v, current: 0.53 A, target_temperature: 80 degC"


@cache
def module(changes: str) -> StudyResult:
    return answer(read_study_text(f"mode: shear\nmodule: {{{changes}}}\n", "a test"))


def stiff(of: StudyResult) -> str:
    return next(fact.text for fact in more_facts(of, {}, None) if fact.label == "Stiff")


def test_the_pads_unpowered_are_a_module_with_no_cooling_current() -> None:
    cooled, air = module(SINK), module(SINK.replace("0.8 A", "0 A"))
    assert cooled.design.values["frozen_time"] < 0.8 * air.design.values["frozen_time"]
    for name, seconds in cooled.cooling.unpowered.items():
        assert seconds == pytest.approx(air.design.values[name], rel=2e-3)
    assert f"{air.design.values['frozen_time']:.3g} s if the heaters are switched off" in stiff(cooled)
    assert "by the air alone: no current cools" in stiff(air)
    reported = results(cooled, TABLE)["cooling"]
    assert (reported["able"], reported["used"]) == (True, True)
    assert reported["unpowered"]["frozen_time"]["value"] == cooled.cooling.unpowered["frozen_time"]


def test_a_foil_heater_heats_with_either_sign_of_its_current() -> None:
    alone, heated = module(FOIL), module(f"{FOIL}, peltier_seebeck: 1e-9 V/K, cooling_current: 0.1 A")
    assert alone.design.values["cooling_current"] == 0.0
    assert (alone.cooling.able, alone.cooling.used, alone.cooling.unpowered) == (False, False, {})
    assert "by the air alone: this heater cannot cool" in stiff(alone)
    assert alone.design.values["frozen_time"] < 0.95 * heated.design.values["frozen_time"] < math.inf
    assert alone.design.values["stiffening_energy"] < 0.01 * alone.design.values["switch_energy"]
