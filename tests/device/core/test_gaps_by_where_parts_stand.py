"""Gaps and fits as distances between discs and levels, placed from the inputs alone."""

from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
import pytest
from cad_designs import module_of_parts
from device_values import values_of
from hypothesis import given as drawn
from hypothesis import strategies
from support import cases_of

from tvimdesign.device import table_for
from tvimdesign.device.core.layout import EVENED, evened_least

MM = 1e-3
TABLE = table_for("shear")
SIZES: dict[str, dict[str, Any]] = {"as it is": {}, "other sizes": module_of_parts("OTHER_SIZES")}


class Disc(NamedTuple):
    """Plan view of a round part: where its centre is, and its radius [m]."""

    centre: complex
    radius: float


def around(radius: float, circle: float, count: int, start: float = 0.0) -> list[Disc]:
    """Equal discs on a circle about the axis."""
    return [Disc(circle * np.exp(1j * (start + 2.0 * np.pi * i / count)), radius) for i in range(count)]


def apart(*groups: list[Disc]) -> float:
    """Least distance between two discs of one group, or of two groups."""
    pairs = combinations(groups[0], 2) if len(groups) == 1 else ((a, b) for a in groups[0] for b in groups[1])
    return float(min(abs(a.centre - b.centre) - a.radius - b.radius for a, b in pairs))


def within(inner: list[Disc], radius: float) -> float:
    """Least distance of discs from a circle about the axis that holds them."""
    return float(min(radius - abs(circle.centre) - circle.radius for circle in inner))


@pytest.fixture(scope="module", params=SIZES)
def p(request: pytest.FixtureRequest, inputs: dict[str, Any]) -> dict[str, Any]:
    return {**inputs, **SIZES[request.param]}


def of(p: dict[str, Any], *names: str) -> list[float]:
    return [float(value) for value in TABLE.evaluate(p, names).values()]


def springs(p: dict[str, Any]) -> list[Disc]:
    # The tang runs on along the tangent for a bend of two wires about its middle, and is half a wire thick.
    reach = abs(complex(0.5 * p["coil_diameter"], 2.0 * p["wire_diameter"])) + 0.5 * p["wire_diameter"]
    return around(reach, p["placement_radius"], int(2 * p["spring_pairs"]))


def feet(p: dict[str, Any]) -> list[Disc]:
    count = int(2 * p["spring_pairs"])
    return around(p["mount_boss_radius"], p["placement_radius"], count, np.pi / count)


def test_springs_pins_and_feet_stand_where_they_are_drawn(p):
    clear, plate = p["radial_clearance"], [Disc(0j, p["pcl_outer_radius"] + p["rotor_rim"])]
    rotor, neighbour = of(p, "rotor_spring_gap", "spring_spring_gap")
    assert rotor == pytest.approx(apart(springs(p), plate) - clear, abs=1e-12)
    assert neighbour == pytest.approx(apart(springs(p)) - clear, abs=1e-12)
    pins = around(0.5 * p["pin_diameter"], p["pin_radius_ratio"] * p["placement_radius"], int(2 * p["spring_pairs"]))
    rim, leg, reach = of(p, "pin_rim_gap", "leg_rotor_gap", "leg_reach_gap")
    assert rim == pytest.approx(within(pins, p["pcl_outer_radius"] + p["rotor_rim"]) - p["radial_clearance"], abs=1e-12)
    # The tang's bend of two wires ends on the floor; from its top the coils rise by a pitch a turn.
    wire, pitch = p["wire_diameter"], p["wire_diameter"] + p["coil_gap"]
    start = 2.0 * wire * np.cos(np.arctan2(pitch, np.pi * p["coil_diameter"]))
    end = start + pitch * (p["coil_count"] + p["preload_angle"] / (2.0 * np.pi))
    plate = p["pcl_thickness"] + p["rotor_thickness"]
    assert leg == pytest.approx(end - 0.5 * wire - plate - p["axial_clearance"], abs=1e-12)
    # Seen along the leg's line, the coil's axis is beside it by half a coil, half a wire and half a pin.
    beside = 0.5 * (p["coil_diameter"] + wire + p["pin_diameter"])
    assert reach == pytest.approx(abs(pins[0].centre - p["placement_radius"]) - beside, abs=1e-12)
    wall, pad = of(p, "mount_wall_gap", "mount_pad_gap")
    skirt = max(abs(spring.centre) + spring.radius for spring in springs(p)) + p["radial_clearance"]
    assert wall == pytest.approx(within(feet(p), skirt) - p["minimum_running_clearance"], abs=1e-12)
    assert pad == pytest.approx(apart(feet(p), [Disc(0j, p["pcl_outer_radius"])]) - p["radial_clearance"], abs=1e-12)


def test_arcs_clear_the_hub_and_leave_webs_and_windows(p):
    hub, web, depth, width = of(p, "hub_arc_gap", "arc_gap", "window_depth", "window_width")
    bore = p["core_radius"] + p["running_clearance"] + p["hub_wall"]
    assert hub == pytest.approx(p["pcl_inner_radius"] - bore - p["radial_clearance"], abs=1e-12)
    # All arcs and all webs go once around.
    inner = p["pcl_inner_radius"]
    assert p["arc_count"] * (web + p["arc_span"] * inner) == pytest.approx(2.0 * np.pi * inner, rel=1e-12)
    assert depth + 2 * p["window_ledge"] == pytest.approx(p["pcl_outer_radius"] - inner, rel=1e-12)
    assert width + 2 * p["window_ledge"] == pytest.approx(p["arc_span"] * inner, rel=1e-12)


def test_posts_fill_nine_tenths_of_the_coil_at_its_tightest(p):
    # D n is kept: with the turns it gains, the coil gets narrower and longer (Shigley, section 10-12).
    turns = (p["preload_angle"] + p["stroke"] + p["stop_margin"]) / (2.0 * np.pi)
    wound = p["coil_diameter"] * p["coil_count"] / (p["coil_count"] + turns)
    names = "post_thickness", "post_margin", "spring_wound_diameter", "spring_body_length"
    post, margin, diameter, length = of({**p, "transmission": "unity"}, *names)
    assert diameter == pytest.approx(wound, rel=1e-12)
    assert post == pytest.approx(0.5 * 0.9 * (wound - p["wire_diameter"]), rel=1e-12)
    assert margin == pytest.approx(2.0 * post - p["minimum_feature"], abs=1e-12)
    # One more wire than turns, and the gaps between them.
    count = p["coil_count"] + turns
    assert length == pytest.approx(p["wire_diameter"] * (count + 1.0) + p["coil_gap"] * count, rel=1e-9)


def test_screws_in_the_core_keep_apart(p):
    heads = around(0.5 * p["link_screw_head"], p["link_bolt_ratio"] * p["core_radius"], 4)
    gap, web, top, deep, below = of(
        p, "link_screw_gap", "core_web", "link_bottom_level", "link_screw_depth", "retainer_screw_depth"
    )
    assert gap == pytest.approx(apart(heads), abs=1e-12)
    end = -(p["floor_thickness"] + p["running_clearance"])  # of the core, below the floor's upper face
    assert web == pytest.approx((top - deep) - (end + below), abs=1e-12)


@cases_of("gaps_by_where_parts_stand", "margins")
def test_a_margin_is_what_is_left_below_the_limit_and_negative_above_it(margin, limit, supplied, expected, inputs):
    known = {**inputs, limit: inputs.get(limit, 30.0)}
    for left in (expected, -expected):
        gap = TABLE.evaluate({**known, supplied: known[limit] - left}, [margin])[margin]
        assert gap == pytest.approx(left, rel=1e-9)
    row = TABLE.output(margin)
    (rule,) = (*row.ratings, *row.advice)
    assert (rule.sense, rule.value) == (">=", 0.0)


def test_energies_and_times_of_a_cycle_add_up(inputs):
    known = {**inputs, "response_time": 40.0, "return_time": 25.0, "switch_energy": 300.0, "stiffening_energy": 90.0,
             "stiffening_time": 20.0, "frozen_time": 25.0}  # fmt: skip
    names = ["cycle_time", "cycle_energy", "stiffening_over_freezing"]
    assert list(TABLE.evaluate(known, names).values()) == pytest.approx([65.0, 390.0, 0.8])


@pytest.mark.parametrize(("soft", "stiff"), [(10.0, 60.0), (30.0, 20.0)])
def test_thresholds_stand_apart_by_the_logarithm_of_their_ratio(soft, stiff, inputs):
    known = {
        **inputs, "impedance_targets": "stated", "soft_impedance": soft, "stiff_impedance": stiff,
        "softening_band": 1.2, "stiffening_band": 1.5, "joint_impedance@hot": 8.0, "joint_impedance@cold": 90.0,
    }  # fmt: skip
    names = ["soft_threshold", "stiff_threshold", "thresholds_apart", "soft_reach", "stiff_reach"]
    low, high, apart_by, soft_reach, stiff_reach = TABLE.evaluate(known, names).values()
    # Soft is up to a fifth above its target, stiff down to two thirds of its own.
    assert (low, high) == pytest.approx((1.2 * soft, stiff / 1.5))
    assert np.exp([apart_by, soft_reach, stiff_reach]) == pytest.approx([high / low, low / 8.0, 90.0 / high])


def test_a_fillet_stays_below_legs_rim_and_the_other_fillet():
    rows = ["foot_fillet", "coil_end_level", "rotor_top_level", "rotor_radius", "pin_radius"]
    filleted = values_of(rows, largest_foot_fillet=9.0 * MM)
    wire, pin, play = 2.413 * MM, 4.0 * MM, 0.4 * MM
    rooms = [filleted["coil_end_level"] - 0.5 * wire - filleted["rotor_top_level"] - play,
             filleted["rotor_radius"] - filleted["pin_radius"] - 0.5 * pin - 0.1 * MM]  # fmt: skip
    assert 0.0 < filleted["foot_fillet"] <= min(rooms) + 1e-12
    assert values_of(rows, largest_foot_fillet=0.3 * MM)["foot_fillet"] == pytest.approx(0.3 * MM)
    # At the rim two circles that touch left a mesh that does not close; `paper_shear` has its pins that near.
    rows = ["foot_fillet", "rotor_radius", "pin_radius"]
    near = values_of(rows, largest_foot_fillet=9.0 * MM, rotor_rim=1.0 * MM)
    rim = near["rotor_radius"] - near["pin_radius"] - 2.0 * MM
    assert near["foot_fillet"] <= max(rim - 0.1 * MM, 0.1 * MM) + 1e-12


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_the_strength_of_core_and_pins_counts_it(mode):
    rows = ["core_holding_torque", "pin_foot_safety", "foot_fillet"]
    small, large = (values_of(rows, mode, largest_foot_fillet=at * MM, radial_clearance=2.5 * MM) for at in (0.5, 2.0))
    assert large["foot_fillet"] == pytest.approx(2.0 * MM)
    assert large["pin_foot_safety"] / small["pin_foot_safety"] == pytest.approx(4.0**0.33243)
    rise = large["core_holding_torque"] / small["core_holding_torque"]
    assert 1.01 < rise < 1.0 / 0.86  # 0.83 to 0.90 by validation/fe_structure/fillets.csv


@drawn(strategies.floats(-5e-3, 5e-3), strategies.floats(-5e-3, 5e-3))
def test_the_evened_least_is_smooth_and_least_away_from_ties(first, other):
    smooth, least = evened_least(first, other), min(first, other)
    assert least - EVENED / 6.0 - 1e-12 <= smooth <= least
    assert smooth == evened_least(other, first)
    if abs(first - other) >= EVENED:
        assert smooth == least
    step = 1e-3 * EVENED
    at = np.arange(-1.5 * EVENED, 1.5 * EVENED, step)
    slope = np.diff(evened_least(at, 0.0)) / step
    curvature = np.diff(slope) / step
    assert np.max(np.abs(np.diff(slope))) < 2e-3  # of one in all
    assert np.max(np.abs(np.diff(curvature))) < 2e-3 / EVENED
