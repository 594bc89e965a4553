"""Idealised designs, and ratings that a study accepts to exceed."""

import csv
import io
import json
import math
from functools import cache

import pytest
from answers import shipped_answer
from support import sample_text

from tvimdesign.device import table_for
from tvimdesign.report.output.tables import results, results_csv
from tvimdesign.report.run.blocks.more_facts import more_facts
from tvimdesign.report.run.blocks.verdict import verdict
from tvimdesign.report.run.front_report import ratings_note
from tvimdesign.report.run.reasons import above_rating
from tvimdesign.report.run.run_study import foreseen_ratings
from tvimdesign.solve.pareto.front import design_at
from tvimdesign.solve.pareto.tradeoff import Point
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import read_study_text

TABLE = table_for("shear")


@pytest.fixture(scope="module")
def published() -> StudyResult:
    return shipped_answer("paper_reconstructed")


@pytest.mark.gate
def test_the_papers_ratio_is_shown_with_the_stiffness_as_drawn(published):
    by = {idealization.text: idealization.as_drawn for idealization in published.idealizations}
    assert list(by) == ["leg_model: ignored", "transmission: unity"]
    # An independent reading of the drawn module found 4.53 N*m/rad at rest and 4.09 at full stroke, for 5.61.
    drawn = by["transmission: unity"]
    assert drawn["spring_stiffness"] == pytest.approx(4.53, abs=0.005)
    assert drawn["least_spring_stiffness"] == pytest.approx(4.09, abs=0.005)
    assert "envelope_diameter" not in drawn
    assert "layer_strain" not in drawn
    reported = results(published)
    rows = {row["name"]: row for row in csv.DictReader(io.StringIO(results_csv(reported["values"])))}
    assert rows["spring_stiffness"]["idealized"] == "leg_model: ignored, transmission: unity"
    assert rows["spring_rate"]["idealized"] == "leg_model: ignored"
    assert rows["envelope_diameter"]["idealized"] == ""


def test_a_study_as_drawn_has_none():
    result = answer(read_study_text("mode: shear\n"))
    assert result.idealizations == ()
    assert not any(row["idealized"] for row in results(result)["values"].values())


def test_every_idealization_is_no_default_and_names_its_omission():
    idealized = {row.name: row for mode in ("shear", "compression") for row in table_for(mode).choices if row.idealized}
    assert set(idealized) == {"leg_model", "transmission", "phase_model"}
    for row in idealized.values():
        assert row.default not in row.idealized
        assert all(word in row.options and about for word, about in row.idealized.items())


@pytest.mark.gate
def test_a_layer_that_freezes_where_it_melts_changes_times_alone():
    study = read_study_text("mode: shear\nmodule: {phase_model: equilibrium}\n")
    (idealization,) = answer(study).idealizations
    assert "stiffening_time" in idealization.as_drawn
    assert "spring_stiffness" not in idealization.as_drawn


SINK = "cold_side: sink, cooling_current: 0.8 A"
FOIL = "heater_module: silicone_9ar_08_24v, current: 0.53 A, target_temperature: 80 degC"


@cache
def module(changes: str) -> StudyResult:
    return answer(read_study_text(f"mode: shear\nmodule: {{{changes}}}\n", "a test"))


def stiff(of: StudyResult) -> str:
    return next(fact.text for fact in more_facts(of, {}, None) if fact.label == "Stiff")


@pytest.mark.gate
def test_the_pads_unpowered_are_a_module_with_no_cooling_current():
    cooled, air = module(SINK), module(SINK.replace("0.8 A", "0 A"))
    assert cooled.design.values["frozen_time"] < 0.8 * air.design.values["frozen_time"]
    for name, seconds in cooled.cooling.unpowered.items():
        assert seconds == pytest.approx(air.design.values[name], rel=2e-3)
    assert f"{air.design.values['frozen_time']:.3g} s if the heaters are switched off" in stiff(cooled)
    assert "by the air alone: no current cools" in stiff(air)
    reported = results(cooled)["cooling"]
    assert (reported["able"], reported["used"]) == (True, True)
    assert reported["unpowered"]["frozen_time"]["value"] == cooled.cooling.unpowered["frozen_time"]


@pytest.mark.gate
def test_a_foil_heater_heats_with_either_sign_of_its_current():
    alone, heated = module(FOIL), module(f"{FOIL}, heater_seebeck: 1e-9 V/K, cooling_current: 0.1 A")
    assert alone.design.values["cooling_current"] == 0.0
    assert (alone.cooling.able, alone.cooling.used, alone.cooling.unpowered) == (False, False, {})
    assert "by the air alone: this heater cannot cool" in stiff(alone)
    assert alone.design.values["frozen_time"] < 0.95 * heated.design.values["frozen_time"] < math.inf
    assert alone.design.values["stiffening_energy"] < 0.01 * alone.design.values["switch_energy"]


# PETG, rated for 60 degC, holds pads that take the far face of the layer to 100 degC.
SEARCHED = sample_text("above_a_rating")
BOTH = ("structure_temperature_margin", "stiffening_structure_margin")
PADS = "heater_temperature_margin"  # of the default module, 7 K above their 120 degC
ACCEPTED = f"accept: [{', '.join((*BOTH, PADS))}]\n"


@cache
def answered(accept: str = "", *, searched: bool = True) -> StudyResult:
    text = SEARCHED + accept if searched else f"mode: shear\n{accept}"
    return answer(read_study_text(text))


def _facts(result: StudyResult) -> dict[str, str]:
    return {fact.label: fact.text for fact in more_facts(result, {}, None)}


def test_an_optimum_beyond_ratings_is_not_called_optimal():
    result = answered()
    assert result.design.status == "above_rating"
    assert set(result.design.above_rating) == {*BOTH, PADS}
    assert result.design.accepting == ()
    assert result.has_design  # it is a design all the same: every limit is met
    assert verdict(result, {}, []).text.startswith("Above a rating: ")
    text = above_rating(result)
    assert f"structure_temperature_margin >= 0 K, by {-result.design.value(BOTH[0]):.3g} K" in text
    assert f"accept: [{', '.join(result.design.above_rating)}]" in text


def test_an_optimum_within_accepted_ratings_says_what_it_accepts():
    result = answered(ACCEPTED)
    assert (result.design.status, result.design.above_rating) == ("optimal", ())
    assert set(result.design.accepting) == {*BOTH, PADS}
    assert verdict(result, {}, []).kind != "rating"
    assert f"as the study accepts: {', '.join(result.design.accepting)}" in _facts(result)["Accepts"]
    assert above_rating(result) == ""
    assert not {check.output for check in result.warnings} & {*BOTH, PADS}
    assert result.accepted_in_vain == ()
    result = answered(f"accept: [{', '.join(BOTH)}]\n")
    assert result.design.status == "above_rating"
    assert (result.design.above_rating, set(result.design.accepting)) == ((PADS,), set(BOTH))
    result = answered(ACCEPTED.replace("[", "[pcl_temperature_margin, "))
    assert result.design.status == "optimal"
    assert result.accepted_in_vain == ("pcl_temperature_margin",)
    assert "pcl_temperature_margin: not needed" in _facts(result)["Accepts"]


def test_an_evaluation_claims_nothing_and_says_it_too():
    result = answered(searched=False)
    assert result.design.status == "evaluated"
    assert set(result.design.above_rating) == {*BOTH, PADS}
    assert verdict(result, {}, []).kind == "rating"
    assert verdict(answered(ACCEPTED, searched=False), {}, []).kind != "rating"


def test_check_says_it_beforehand_of_the_module_a_search_starts_from():
    messages = foreseen_ratings(read_study_text(SEARCHED))
    assert [line.split(" is ")[1].split(": ")[1] for line in messages if "starts from" in line] == [PADS, *BOTH]
    assert all("accept: [" in line and "An optimum may be, too." in line for line in messages)
    required = SEARCHED.replace("require: {", f'require: {{{PADS}: ">= 0 K", ')
    assert [PADS in line for line in foreseen_ratings(read_study_text(required))] == [False, False]
    assert foreseen_ratings(read_study_text(SEARCHED + ACCEPTED)) == []


def test_a_point_of_a_front_has_its_own():
    design = answered().design.model_copy(update={"study": {"accept": list(BOTH)}})
    point = design_at(design, Point("between", design.values, {}), 2)
    assert point.status == "above_rating"
    assert (point.above_rating, set(point.accepting)) == ((PADS,), set(BOTH))
    cooler = Point("between", design.values | {PADS: 1.0}, {})
    assert design_at(design, cooler, 2).status == "optimal"
    assert ratings_note([(PADS,), ()]).startswith("points 1 of the front")


@pytest.mark.slow
def test_the_command_ends_with_3_and_a_whole_folder(tvimdesign, tmp_path):
    for accept, code, word in (("", 3, "above_rating"), (ACCEPTED, 0, "optimal")):
        study, out = tmp_path / f"{word}.yaml", tmp_path / word
        study.write_text(SEARCHED + accept)
        done = tvimdesign("run", study, "--no-cad", "--no-plots", "--out", out)
        assert done.returncode == code, done.stderr
        results = json.loads((out / "results.json").read_text())
        assert results["status"] == json.loads((out / "design.json").read_text())["status"] == word
        assert {row["output"] for row in results["above_rating" if code else "accepting"]} == {*BOTH, PADS}
        assert json.loads((out / "manifest.json").read_text())["status"] == word
        assert ("accept: [" in done.stderr) == bool(code)
        tested = tvimdesign("simulate", out, "--test", "release", "--out", tmp_path / f"{word}_released")
        assert tested.returncode == 0, tested.stderr
        assert "beyond its rating" in tested.stdout
