"""Spigot of the link: what it bears by plane mechanics, its parts as drawn, and the choice beside dowel pins."""

from math import tan

import cadquery as cq
import numpy as np
import pytest
from cad_designs import broken_rules, design_of
from device_values import values_of
from placed_solids import build

from tvimdesign.base.errors import InputError
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.inspection.inspect import part_checks
from tvimdesign.cad.inspection.size_checks import interference_checks, size_checks
from tvimdesign.physics.solids import structure
from tvimdesign.solve.nlp.constraints import refuse_contradictory
from tvimdesign.study import given, read_study_text

SPIGOT = {
    "process": "machine_6061", "link_fit": "spigot", "core_radius": 9e-3, "spigot_ratio": 0.9, "spigot_height": 3e-3,
    "link_screw_length": 12e-3, "retainer_screw_length": 8e-3, "retainer_screw": "iso_7380_m3",
}  # fmt: skip


def test_flanks_bear_what_their_pressure_adds_up_to():
    names = "spigot_reach spigot_flank_holding_torque cold_strength spigot_engagement holding_safety"
    value = values_of(names, **SPIGOT)
    places = np.linspace(0.0, value["spigot_reach"], 20001)
    torque = 2.0 * value["cold_strength"] * value["spigot_engagement"] * np.trapezoid(places**2, places) / places[-1]
    assert value["spigot_flank_holding_torque"] * value["holding_safety"] == pytest.approx(torque)
    beam = structure.stub_compliance(2.0, 0.8, 30.0, 2.0, 3.0)
    assert beam == pytest.approx(30.0**3 / (3.0 * 2.0 * 2.0), rel=0.01)


def test_one_screw_holds_without_play_by_the_least_of_three():
    parts = [f"spigot_{part}_holding_torque" for part in ("flank", "root", "slot")]
    names = [*parts, "link_play", "fastener_count", "link_holding_torque", "core_stiffness"]
    taper, pinned, high = (
        values_of(names, **SPIGOT | more) for more in ({}, {"link_fit": "dowels"}, {"spigot_height": 5e-3})
    )
    assert (taper["link_play"], pinned["fastener_count"] - taper["fastener_count"]) == (0.0, 3.0 + 4.0)
    assert taper["link_holding_torque"] == pytest.approx(min(taper[part] for part in parts), rel=1e-12)
    assert [high[part] > taper[part] for part in parts] == [True, False, False]
    assert 0.3 * pinned["core_stiffness"] < taper["core_stiffness"] < pinned["core_stiffness"]


def test_link_and_core_touch_at_the_flanks_alone():
    design = design_of("spigot", SPIGOT)
    assert broken_rules(design) == []
    dims, parts = dimensions(design), build(design)
    assert all(check.ok for check in interference_checks(parts, "here"))
    checks = [check for check in size_checks(design, parts) if check.name.startswith(("rotor", "link"))]
    assert max(abs(check.value) for check in checks) < 1e-6
    overlap = parts["link"].translate(cq.Vector(0.0, 0.0, -0.01)).intersect(parts["rotor"]).Volume()
    wedged = 2.0 * (dims.spigot_depth - dims.spigot_room) * 2.0 * dims.spigot_reach * 0.01 * tan(dims.spigot_angle)
    assert overlap == pytest.approx(wedged, rel=0.02)
    checks = [check for kind in ("rotor", "link") for check in part_checks(design, dims, kind, parts[kind])]
    assert all(check.level != "failure" for check in checks)


def test_what_belongs_to_the_other_fit_is_refused_by_its_word():
    study = read_study_text("mode: shear\nmodule: {spigot_height: 4 mm}\n", "a test")
    with pytest.raises(InputError, match="no effect, as link_fit is dowels; add `link_fit: spigot`"):
        refuse_contradictory(study, given(study))
