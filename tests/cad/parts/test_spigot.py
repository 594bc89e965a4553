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
from tvimdesign.physics.solids import fasteners, structure
from tvimdesign.solve.nlp.constraints import refuse_contradictory
from tvimdesign.study import given, read_study_text

SPIGOT = {
    "process": "machine_6061", "link_fit": "spigot", "core_radius": 9e-3, "spigot_ratio": 0.9, "spigot_height": 3e-3,
    "link_screw_length": 12e-3, "retainer_screw_length": 8e-3, "retainer_screw": "iso_7380_m3",
}  # fmt: skip


def test_flanks_and_roots_bear_what_their_stress_adds_up_to():
    places = np.linspace(0.0, 8.0, 20001)
    force, torque = (np.trapezoid(places**power / 8.0, places) for power in (1, 2))
    assert fasteners.half_flank_torque(force, 8.0) == pytest.approx(2.0 * torque)
    strips = np.linspace(4.5, 10.0, 200001)  # of half of what lies beyond the chord y = 4.5 of a circle
    half = np.sqrt(np.maximum(100.0 - strips**2, 0.0))
    area = np.trapezoid(half, strips)
    middle = np.trapezoid(half * strips, strips) / area
    root = structure.half_segment(2.0, 10.0, 4.5)
    assert root == pytest.approx(
        (2.0, area, np.trapezoid(half * (strips - middle) ** 2, strips), middle - 4.5), rel=1e-5
    )
    assert structure.Root(2.0, 12.0, 16.0, 2.0).stress == pytest.approx(structure.stub_stress(1.0, 2.0, 4.0, 3.0))


def test_one_screw_holds_without_play_by_the_least_of_three():
    parts = [f"spigot_{part}_holding_torque" for part in ("flank", "root", "slot")]
    names = [*parts, "link_play", "fastener_count", "dowels_mass", "link_holding_torque", "core_stiffness"]
    taper, pinned, high = (
        values_of(names, **SPIGOT | more) for more in ({}, {"link_fit": "dowels"}, {"spigot_height": 5e-3})
    )
    assert (taper["link_play"], taper["dowels_mass"], pinned[parts[0]]) == (0.0, 0.0, 0.0)
    assert pinned["fastener_count"] - taper["fastener_count"] == 3.0 + 4.0
    assert taper["link_holding_torque"] == pytest.approx(min(taper[part] for part in parts), rel=1e-12)
    assert [high[part] > taper[part] for part in parts] == [True, False, False]
    assert 0.3 * pinned["core_stiffness"] < taper["core_stiffness"] < pinned["core_stiffness"]


def test_link_and_core_touch_at_the_flanks_alone():
    design = design_of("spigot", SPIGOT)
    assert broken_rules(design) == []
    dims, parts = dimensions(design), build(design)
    turning = {name: parts[name] for name in ("rotor", "link", "link_screw")}
    assert all(check.ok for check in interference_checks(turning, "here"))
    checks = [check for check in size_checks(design, parts) if check.name.startswith(("rotor", "link"))]
    assert max(abs(check.value) for check in checks) < 1e-6
    overlap = parts["link"].translate(cq.Vector(0.0, 0.0, -0.01)).intersect(parts["rotor"]).Volume()
    wedged = 2.0 * (dims.spigot_depth - dims.spigot_room) * 2.0 * dims.spigot_reach * 0.01 * tan(dims.spigot_angle)
    assert overlap == pytest.approx(wedged, rel=0.02)
    for kind in ("rotor", "link"):
        assert all(check.level != "failure" for check in part_checks(design, dims, kind, parts[kind]))


def test_what_belongs_to_the_other_fit_is_refused_by_its_word():
    for fit, other, row in (("spigot", "dowels", "link_dowel_count: 2"), ("dowels", "spigot", "spigot_height: 4 mm")):
        study = read_study_text(f"mode: shear\nmodule: {{link_fit: {fit}, {row}}}\n", "a test")
        with pytest.raises(InputError, match=f"no effect, as link_fit is {fit}; add `link_fit: {other}`"):
            refuse_contradictory(study, given(study))
