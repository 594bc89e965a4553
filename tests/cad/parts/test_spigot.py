"""Spigot of the link: what it bears by plane mechanics, its parts as drawn, and the choice beside dowel pins."""

from math import tan

import cadquery as cq
import numpy as np
import pytest
from cad_designs import broken_rules, design_of
from device_values import values_of
from placed_solids import build

from tvimdesign.base.errors import InputError
from tvimdesign.cad.assembly.assembly import drawn_part
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.inspection.inspect import part_checks
from tvimdesign.cad.inspection.size_checks import interference_checks, size_checks
from tvimdesign.physics.solids import fasteners, structure
from tvimdesign.solve.nlp.constraints import refuse_contradictory
from tvimdesign.study import given, read_study_text

MM = 1e-3
SPIGOT = {
    "process": "machine_6061", "link_fit": "spigot", "core_radius": 9.0 * MM, "spigot_ratio": 0.9,
    "spigot_height": 3.0 * MM, "link_screw_length": 12.0 * MM, "retainer_screw_length": 8.0 * MM, "retainer_screw": "iso_7380_m3",
}  # fmt: skip


def test_flanks_bear_what_their_pressure_adds_up_to():
    reach, height, width, radius = 8.0, 3.0, 9.0, 10.0
    places = np.linspace(0.0, reach, 20001)
    halves, torque = (height * np.trapezoid(places**power / reach, places) for power in (1, 2))
    assert fasteners.half_flank_torque(halves, reach) == pytest.approx(2.0 * torque)
    # Half of what is beyond the chord y = c of a circle, by strips, and a rectangle, as a gear's tooth.
    strips = np.linspace(0.5 * width, radius, 200001)
    half = np.sqrt(np.maximum(radius**2 - strips**2, 0.0))
    area = np.trapezoid(half, strips)
    middle = np.trapezoid(half * strips, strips) / area
    inertia = np.trapezoid(half * (strips - middle) ** 2, strips)
    root = structure.half_segment(2.0, radius, 0.5 * width)
    assert root == pytest.approx((2.0, area, inertia, middle - 0.5 * width), rel=1e-5)
    stub = structure.Root(2.0, 12.0, 16.0, 2.0)
    assert stub.stress == pytest.approx(structure.stub_stress(1.0, 2.0, 4.0, 3.0))


def test_one_screw_holds_without_play_by_the_least_of_three():
    names = "link_play link_screw_count fastener_count dowels_mass link_holding_torque spigot_flank_holding_torque "
    names += "spigot_root_holding_torque spigot_slot_holding_torque link_friction_torque core_stiffness"
    taper, pinned = (values_of(names, **{**SPIGOT, **more}) for more in ({}, {"link_fit": "dowels"}))
    assert (taper["link_play"], taper["link_friction_torque"], taper["dowels_mass"]) == (0.0, 0.0, 0.0)
    assert pinned["fastener_count"] - taper["fastener_count"] == 3.0 + 4.0
    least = min(taper[f"spigot_{part}_holding_torque"] for part in ("flank", "root", "slot"))
    assert taper["link_holding_torque"] == pytest.approx(least, rel=1e-12)
    higher = values_of(names, **{**SPIGOT, "spigot_height": 5.0 * MM})
    assert higher["spigot_flank_holding_torque"] > taper["spigot_flank_holding_torque"]
    assert higher["spigot_root_holding_torque"] < taper["spigot_root_holding_torque"]
    assert 0.3 * pinned["core_stiffness"] < taper["core_stiffness"] < pinned["core_stiffness"]


def test_link_and_core_touch_at_the_flanks_alone():
    design = design_of("spigot", SPIGOT)
    assert broken_rules(design) == []
    dims, parts = dimensions(design), build(design)
    turning = {name: parts[name] for name in ("rotor", "link", "link_screw")}
    assert [check.text for check in interference_checks(turning, "here") if not check.ok] == []
    for check in size_checks(design, parts):
        assert not check.name.startswith(("rotor", "link")) or abs(check.value) < 1e-6, check.text
    down = cq.Vector(0.0, 0.0, -0.01)
    overlap = parts["link"].translate(down).intersect(parts["rotor"])
    wedged = 2.0 * (dims.spigot_depth - dims.spigot_room) * 2.0 * dims.spigot_reach * 0.01 * tan(dims.spigot_angle)
    assert overlap.Volume() == pytest.approx(wedged, rel=0.02)
    for kind in ("rotor", "link"):
        checks = part_checks(design, dims, kind, drawn_part(dims, kind))
        assert [check.text for check in checks if check.level == "failure"] == []


def test_what_belongs_to_the_other_fit_is_refused_with_the_word_it_is_of():
    for other, row in (("spigot", "link_dowel_count: 2"), ("dowels", "spigot_height: 4 mm")):
        text = f"mode: shear\nmodule: {{link_fit: {other}, {row}}}\nrequire: {{holding_torque: '>= 1 N.m'}}\n"
        study = read_study_text(text, "a test")
        word = "dowels" if other == "spigot" else "spigot"
        with pytest.raises(InputError, match=f"no effect, as link_fit is {other}; add `link_fit: {word}`"):
            refuse_contradictory(study, given(study))
