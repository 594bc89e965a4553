"""A flange for a torque sensor: what the standard gives it, what it adds to the housing, and the rules that keep it."""

from __future__ import annotations

from typing import Any

import casadi as ca
import numpy as np
import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.catalog import Catalog
from tvimdesign.device import MODES, table_for
from tvimdesign.solve.nlp.constraints import limits_of, refuse_impossible
from tvimdesign.study import given, read_study_text

MM = 1e-3
RULES = {
    "flange_bore_gap", "flange_channel_gap", "flange_spring_gap", "flange_seat_reserve", "flange_thread_reserve",
    "flange_wall_reserve", "flange_bore_wall_reserve", "flange_pin_wall_reserve", "flange_spigot_reserve",
}  # fmt: skip
GOOD = {
    "sensor_flange": "iso_9409_40_4_m6", "core_radius": "9 mm", "foot_height": "12 mm", "flange_screw_reach": "10.5 mm",
}  # fmt: skip


def inputs_with(mode: str = "shear", **module: str) -> dict[str, Any]:
    lines = "\n".join(f"  {name}: {value}" for name, value in module.items())
    return given(read_study_text(f"mode: {mode}\nmodule:\n{lines}\n", "a test"), Catalog(), table_for(mode))


def values_of(rows: str, mode: str = "shear", **module: str) -> dict[str, float]:
    found: dict[str, float] = table_for(mode).evaluate(inputs_with(mode, **module), rows.split())
    return found


def test_the_flange_has_the_sizes_of_the_standard_and_the_fit_of_the_process() -> None:
    rows = "sensor_screw_count sensor_pitch_radius sensor_screw_pilot sensor_pin_diameter flange_bore_radius "
    found = values_of(rows + "flange_outer_radius flange_screw_depth", **GOOD)
    # ISO 9409-1-40-4-M6: four M6 on 40 mm, centring 25 mm, pin 6 mm; a printed seat has 0.05 mm to each side.
    assert list(found.values()) == pytest.approx([4, 20 * MM, 5 * MM, 6 * MM, 12.55 * MM, (20 + 3 + 2) * MM, 11 * MM])
    milled = values_of("flange_bore_radius", **GOOD | {"process": "machine_6061"})
    assert milled["flange_bore_radius"] == pytest.approx(12.5015 * MM)


@pytest.mark.parametrize("hub_depth", [0.0, 3.0])
def test_the_housing_grows_by_the_ring_less_its_holes_and_what_was_hub(hub_depth: float) -> None:
    more = {name: value for name, value in GOOD.items() if name != "sensor_flange"} | {
        "hub_depth": f"{hub_depth} mm", "hub_wall": "4.5 mm",
    }  # fmt: skip
    rows = "housing_volume hub_radius housing_mass module_mass"
    bare, with_flange = values_of(rows, **more), values_of(rows, **GOOD | more)
    hub = bare["hub_radius"] / MM
    assert hub == pytest.approx(9.0 + 0.4 + 4.5)  # wider than the bore of the flange, 12.55 mm
    step, inside = 0.05, lambda x, y, radius, at: (x - at[0]) ** 2 + (y - at[1]) ** 2 < radius**2
    x, y = np.meshgrid(*[np.arange(-25.0 + 0.5 * step, 25.0, step)] * 2)
    r = np.hypot(x, y)
    ring = (r > 12.55) & (r < 25.0)
    at = [(20.0 * np.cos(f), 20.0 * np.sin(f)) for f in np.radians([45.0, 135.0, 225.0, 315.0, 90.0])]
    screws = np.any([inside(x, y, 2.5, one) for one in at[:4]], axis=0)
    pin = inside(x, y, 3.0, at[4])
    # Of 12 mm below the floor the first `hub_depth` have the hub inside; holes go 11 and 6 mm up from the ground.
    added = ring.sum() * 12.0 - (ring & (r < hub)).sum() * hub_depth - screws.sum() * 11.0 - pin.sum() * 6.0
    grown = with_flange["housing_volume"] - bare["housing_volume"]
    assert grown == pytest.approx(added * step**2 * 1e-9, rel=2e-3)
    assert with_flange["module_mass"] - bare["module_mass"] == pytest.approx(1270.0 * grown)


@pytest.mark.parametrize("mode", MODES)
def test_the_floor_is_held_at_the_flange_and_no_more_at_the_feet(mode: str) -> None:
    rows = "structure_stiffness structure_shear_modulus pcl_mean_radius placement_radius flange_outer_radius floor_web"
    if mode == "compression":
        rows = rows.replace("floor_web", "floor_thickness vane_count slot_angle")
    plain, held = values_of(rows, mode), values_of(rows, mode, sensor_flange="iso_9409_31_5_4_m5")
    web = plain.get("floor_web")
    if web is None:
        web = plain["floor_thickness"] * (1.0 - plain["vane_count"] * plain["slot_angle"] / (2.0 * np.pi))

    def compliance(inner: float, outer: float) -> float:
        return (inner**-2 - outer**-2) / (4.0 * np.pi * plain["structure_shear_modulus"] * web)

    mean = plain["pcl_mean_radius"]
    expected = compliance(held["flange_outer_radius"], mean) - compliance(mean, plain["placement_radius"])
    change = 1.0 / held["structure_stiffness"] - 1.0 / plain["structure_stiffness"]
    assert change == pytest.approx(expected, rel=1e-9)


def test_a_good_flange_keeps_its_rules_and_each_is_broken_by_what_its_name_says() -> None:
    assert min(values_of(" ".join(RULES), **GOOD).values()) > -1e-12
    for rule, module in {
        "flange_bore_gap": {"core_radius": "10 mm"},
        "flange_channel_gap": {"pcl_inner_radius": "22.5 mm"},
        "flange_spring_gap": {"placement_radius": "38 mm"},
        "flange_seat_reserve": {"flange_screw_reach": "12.9 mm"},
        "flange_thread_reserve": {"flange_screw_reach": "10.4 mm"},
        "flange_wall_reserve": {"flange_wall": "1.1 mm"},
        "flange_bore_wall_reserve": {"minimum_wall": "4.5 mm"},
        "flange_pin_wall_reserve": {"minimum_wall": "9.9 mm"},
        "flange_spigot_reserve": {"foot_height": "11 mm"},
    }.items():
        assert values_of(rule, **GOOD | module)[rule] < 0.0, rule


def test_no_hole_opens_into_a_seat_a_channel_or_an_adjuster_s_pocket() -> None:
    rows = "flange_seat_reserve flange_channel_gap flange_spring_gap placement_radius adjuster_radius floor_web"
    turning = values_of(rows, **GOOD | {"preload_adjuster": "rotary", "radial_clearance": "1.7 mm"})
    # 12 mm of foot, the floor below the pads and a wall of 1.2 mm; the deepest hole has 11 mm.
    assert turning["flange_seat_reserve"] == pytest.approx(turning["floor_web"] + (12.0 - 11.0 - 1.2) * MM)
    assert turning["flange_channel_gap"] == pytest.approx((26.0 + 2.0 - 25.0) * MM)
    pocket = turning["placement_radius"] - turning["adjuster_radius"] - 0.2 * MM
    assert turning["flange_spring_gap"] == pytest.approx(pocket - 25.0 * MM)
    among_vanes = values_of("flange_channel_gap slot_inner_radius flange_outer_radius", "compression", **GOOD)
    room = among_vanes["slot_inner_radius"] - among_vanes["flange_outer_radius"]
    assert among_vanes["flange_channel_gap"] == pytest.approx(room)


@pytest.mark.parametrize("mode", MODES)
def test_there_is_no_flange_and_no_rule_of_one_unless_it_is_chosen(mode: str) -> None:
    table = table_for(mode)
    off = table.evaluate(inputs_with(mode, stroke="0.1 rad"), sorted(RULES | {"flange_volume", "sensor_screw_count"}))
    assert set(off.values()) == {0.0}
    told = {limit.output for limit in limits_of(read_study_text(f"mode: {mode}\n", "a test"), table)}
    assert not told & RULES
    text = f"mode: {mode}\nmodule: {{sensor_flange: iso_9409_50_4_m6}}\n"
    assert {limit.output for limit in limits_of(read_study_text(text, "a test"), table)} >= RULES
    text = f"mode: {mode}\nvary: {{sensor_flange: {{choose: [none, iso_9409_40_4_m6]}}}}\nminimize: module_mass\n"
    assert {limit.output for limit in limits_of(read_study_text(text, "a test"), table)} >= RULES
    idle = read_study_text(f"mode: {mode}\nmodule: {{flange_wall: 3 mm}}\n", "a test")
    with pytest.raises(InputError, match="flange_wall: no effect, as sensor_flange is none"):
        refuse_impossible(idle, Catalog(), table)


def test_numbers_and_symbols_give_the_same_flange() -> None:
    table, known = table_for("shear"), inputs_with(**GOOD)
    free = ("flange_wall", "flange_screw_reach", "foot_height", "core_radius", "hub_depth")
    symbols = ca.SX.sym("x", len(free))
    rows = [*sorted(RULES), "flange_volume", "structure_stiffness"]
    traced = table.evaluate(known | dict(zip(free, ca.vertsplit(symbols), strict=True)), rows)
    function = ca.Function("f", [symbols], [ca.vertcat(*(traced[name] for name in rows))])
    expected = table.evaluate(known, rows)
    found = np.array(function([known[name] for name in free])).ravel()
    assert found == pytest.approx([expected[name] for name in rows], rel=1e-12)
