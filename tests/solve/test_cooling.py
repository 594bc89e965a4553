"""Benefit of cooling by current: the same module with its pads unpowered, and heaters that cannot cool."""

from __future__ import annotations

import math
from functools import cache

import pytest

from tvimdesign.report.output.tables import results
from tvimdesign.report.run.blocks.facts import more_facts
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import read_study_text

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
    assert f"{air.design.values['frozen_time']:.3g} s if the Peltiers are switched off" in stiff(cooled)
    assert "by the air alone: no current cools" in stiff(air)


def test_a_foil_heater_heats_with_either_sign_of_its_current() -> None:
    alone, heated = module(FOIL), module(f"{FOIL}, peltier_seebeck: 1e-9 V/K, cooling_current: 0.1 A")
    assert alone.design.values["cooling_current"] == 0.0
    assert (alone.cooling.able, alone.cooling.used, alone.cooling.unpowered) == (False, False, {})
    assert "by the air alone: this heater cannot cool" in stiff(alone)
    assert alone.design.values["frozen_time"] < 0.95 * heated.design.values["frozen_time"] < math.inf
    assert alone.design.values["stiffening_energy"] < 0.01 * alone.design.values["switch_energy"]


def test_the_results_have_it_in_json() -> None:
    table = read_study_text("mode: shear\n", "a test").table
    cooled = results(module(SINK), table)["cooling"]
    assert (cooled["able"], cooled["used"]) == (True, True)
    assert cooled["unpowered"]["frozen_time"]["value"] == module(SINK).cooling.unpowered["frozen_time"]
    assert results(module(FOIL), table)["cooling"] == {"able": False, "used": False, "unpowered": {}}
