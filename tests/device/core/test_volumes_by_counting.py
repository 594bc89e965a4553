"""Volumes and inertias against a count of points inside the parts, described level by level as they stand in space."""

from typing import Any

import numpy as np
import pytest
from counting import Array, count, in_stops, near, stack_up
from numpy.typing import NDArray

from tvimdesign.device import table_for

SHAPES = {
    "as it is": {},
    "three arcs, other sizes": {
        "arc_count": 3, "arc_span": 1.3, "spring_pairs": 3, "wire_diameter": 1.8e-3, "coil_diameter": 17e-3,
        "key_count": 5, "key_diameter": 4e-3,
        "pcl_inner_radius": 24e-3, "pcl_outer_radius": 41e-3, "floor_thickness": 5e-3, "core_radius": 8e-3,
        "link_thickness": 6e-3, "preload_angle": 0.4, "pcl_thickness": 1.6e-3,
    },
}  # fmt: skip


@pytest.fixture(scope="module", params=SHAPES)
def part(request: pytest.FixtureRequest, inputs: dict[str, Any]) -> dict[str, Any]:
    """Every input, and every output that has a number without a simulation."""
    table = table_for("shear")
    given = {**inputs, "largest_foot_fillet": 1e-4, **SHAPES[request.param]}  # fillets have a test of their own
    wanted = [
        *(f"{name}_mass" for name in ("housing", "rotor", "link", "retainer", "springs", "pcl", "peltier", "screws")),
        *(f"{name}_volume" for name in ("housing", "rotor", "link", "retainer", "spring", "pcl", "peltier")),
        *(f"{name}_inertia" for name in ("housing", "rotor", "link", "parts")),
        *(f"{name}_length" for name in ("leg", "tang", "link")),
        *(f"{name}_level" for name in ("coil_end", "pin_top", "rotor_top", "link_bottom")),
        *(f"{name}_radius" for name in ("housing_outer", "housing_inner", "hub", "post", "rotor", "pin")),
        "module_mass", "cutout_mass", "dowels_mass", "dowels_inertia", "link_dowel_depth", "link_screw_depth",
        "retainer_screw_depth", "screws_inertia", "pcl_area", "spring_count",
        "link_bolt_circle_radius", "link_half_width", "stop_width", "stop_post_length", "stop_outer_radius",
    ]  # fmt: skip
    return {**given, **table.evaluate(given, wanted)}


def in_arcs(x: Array, y: Array, p: dict[str, Any], margin: float) -> NDArray[np.bool_]:
    """Inside the outline of the pads, drawn in by a margin, its angle at the inner radius."""
    r, f = np.hypot(x, y), np.arctan2(y, x) % (2.0 * np.pi)
    half = 0.5 * p["arc_span"] - margin / p["pcl_inner_radius"]
    pitch = 2.0 * np.pi / p["arc_count"]
    off = np.abs((f + 0.5 * pitch) % pitch - 0.5 * pitch)
    return (off < half) & (r > p["pcl_inner_radius"] + margin) & (r < p["pcl_outer_radius"] - margin)


def in_keys(x: Array, y: Array, p: dict[str, Any]) -> NDArray[np.bool_]:
    """Inside a key: each arc is divided evenly, and its keys stand in the middles on its mean radius."""
    hit = np.zeros(x.shape, dtype=bool)
    share, middle = p["arc_span"] / p["key_count"], 0.5 * (p["pcl_inner_radius"] + p["pcl_outer_radius"])
    for i in range(int(p["key_count"])):
        turn = share * (i + 0.5) - 0.5 * p["arc_span"]
        hit |= near(x, y, 0.5 * p["key_diameter"], middle, int(p["arc_count"]), turn)
    return hit


def test_pads_cover_their_arcs(part: dict[str, Any]) -> None:
    area, _ = count(lambda x, y: in_arcs(x, y, part, 0.0), part["pcl_outer_radius"], [part["pcl_inner_radius"]])
    assert part["pcl_area"] == pytest.approx(area, rel=3e-3)
    keys, _ = count(lambda x, y: in_keys(x, y, part), part["pcl_outer_radius"], [part["pcl_inner_radius"]])
    deep = part["rotor_thickness"] - 1.2e-3  # a printed wall is left above them
    assert part["pcl_volume"] == pytest.approx(area * part["pcl_thickness"] + keys * deep, rel=3e-3)
    assert part["peltier_volume"] == pytest.approx(area * part["peltier_thickness"], rel=3e-3)


def test_housing_has_the_volume_and_inertia_of_its_levels(part: dict[str, Any]) -> None:
    p = part
    bore, outer = p["core_radius"] + p["running_clearance"], p["housing_outer_radius"]
    tang = 0.5 * p["wire_diameter"] + p["tang_clearance"]

    def ring(x: Array, y: Array, inner: float, rim: float) -> NDArray[np.bool_]:
        return (np.hypot(x, y) > inner) & (np.hypot(x, y) < rim)

    def wall(x: Array, y: Array) -> NDArray[np.bool_]:
        return ring(x, y, p["housing_inner_radius"], outer)

    def posts(x: Array, y: Array) -> NDArray[np.bool_]:
        return around(x, y, p["post_radius"])

    springs, half_pitch = int(p["spring_count"]), np.pi / p["spring_count"]

    def around(x: Array, y: Array, radius: float, turn: float = 0.0) -> NDArray[np.bool_]:
        return near(x, y, radius, p["placement_radius"], springs, turn)

    def skirt(x: Array, y: Array) -> NDArray[np.bool_]:
        open_to_air = np.zeros(x.shape, dtype=bool)
        for i in range(springs):
            c, s = np.cos(2.0 * np.pi * i / springs), np.sin(2.0 * np.pi * i / springs)
            open_to_air |= (np.abs(c * y - s * x) < 0.5 * p["notch_width"]) & (c * x + s * y > 0.0)
        feet = around(x, y, p["mount_boss_radius"], half_pitch)
        return (wall(x, y) & ~open_to_air | feet) & ~around(x, y, 0.5 * p["mount_hole"], half_pitch)

    def floor(x: Array, y: Array) -> NDArray[np.bool_]:
        # A tang's hole is beside its post: on the coil's circle, anywhere in the floor does for the volume.
        holes = around(x, y, tang, 0.2) | around(x, y, 0.5 * p["mount_hole"], half_pitch)
        return ring(x, y, bore, outer) & ~holes

    pocket, web = p["peltier_thickness"], p["floor_thickness"] - p["peltier_thickness"]
    post_top = p["coil_end_level"] + 0.5 * p["wire_diameter"]
    volume, polar = stack_up(
        [
            (p["foot_height"], skirt),
            (web, lambda x, y: floor(x, y) & ~in_arcs(x, y, p, p["window_ledge"])),
            (pocket, lambda x, y: floor(x, y) & ~in_arcs(x, y, p, -p["slip_clearance"])),
            (p["pcl_thickness"], lambda x, y: wall(x, y) | posts(x, y) | ring(x, y, bore, p["hub_radius"])),
            (post_top - p["pcl_thickness"], lambda x, y: wall(x, y) | posts(x, y)),
            (p["pin_top_level"] - post_top, wall),
            (p["rotor_top_level"], lambda x, y: in_stops(x, y, p)[0]),
        ],
        outer,
        [bore, p["hub_radius"], p["housing_inner_radius"], p["stop_outer_radius"]],
    )
    assert part["housing_volume"] == pytest.approx(volume, rel=3e-3)
    assert part["housing_inertia"] == pytest.approx(1270.0 * polar, rel=3e-3)


def test_rotor_has_the_volume_and_inertia_of_its_levels(part: dict[str, Any]) -> None:
    p = part

    def core(x: Array, y: Array) -> NDArray[np.bool_]:
        return np.hypot(x, y) < p["core_radius"]

    def pins(x: Array, y: Array) -> NDArray[np.bool_]:
        return near(x, y, 0.5 * p["pin_diameter"], p["pin_radius"], int(p["spring_count"]))

    def screws(x: Array, y: Array) -> NDArray[np.bool_]:
        return near(x, y, 0.5 * p["link_screw_pilot"], p["link_bolt_circle_radius"], 4)

    def retainer_screw(x: Array, y: Array) -> NDArray[np.bool_]:
        return np.hypot(x, y) < 0.5 * p["retainer_screw_pilot"]

    def dowels(x: Array, y: Array) -> NDArray[np.bool_]:
        return near(x, y, 0.5 * p["link_dowel_diameter"], 0.7 * p["core_radius"], 4, 0.25 * np.pi)

    low = p["floor_thickness"] + p["running_clearance"]  # the core's end below the floor's upper face
    slabs = [
        (low + p["pcl_thickness"], core),
        (p["rotor_thickness"] - 1.2e-3, lambda x, y: (np.hypot(x, y) < p["rotor_radius"]) & ~in_keys(x, y, p)),
        (1.2e-3, lambda x, y: np.hypot(x, y) < p["rotor_radius"]),
        (p["rotor_thickness"], lambda x, y: in_stops(x, y, p)[1]),
        (p["pin_top_level"] - p["rotor_top_level"], lambda x, y: core(x, y) | pins(x, y)),
        (p["link_bottom_level"] - p["pin_top_level"], core),
        (-p["link_screw_depth"], screws),
        (-p["retainer_screw_depth"], retainer_screw),
        (-p["link_dowel_depth"], dowels),
    ]
    volume, polar = stack_up(
        slabs, p["stop_outer_radius"], [0.5 * p["retainer_screw_pilot"], p["core_radius"], p["rotor_radius"]]
    )
    assert part["rotor_volume"] == pytest.approx(volume, rel=3e-3)
    assert part["rotor_inertia"] == pytest.approx(polar * p["structure_density"], rel=3e-3)


def test_link_and_retainer_have_the_volume_and_inertia_of_their_outlines(part: dict[str, Any]) -> None:
    p = part

    def link(x: Array, y: Array) -> NDArray[np.bool_]:
        along = np.clip(x, 0.0, p["link_length"])
        bar = np.hypot(x - along, y) < p["link_half_width"]
        screws = near(x, y, 0.5 * p["link_screw_clearance"], p["link_bolt_circle_radius"], 4)
        tool = np.hypot(x - p["link_length"], y) < 0.5 * p["link_tool_hole"]
        return (
            bar & ~screws & ~tool & ~near(x, y, 0.5 * p["link_dowel_diameter"], 0.7 * p["core_radius"], 4, 0.25 * np.pi)
        )

    def retainer(x: Array, y: Array) -> NDArray[np.bool_]:
        r = np.hypot(x, y)
        return (r < p["core_radius"] + p["retainer_lip"]) & (r > 0.5 * p["retainer_screw_clearance"])

    area, polar = count(link, p["housing_outer_radius"], [p["core_radius"]])
    assert part["link_volume"] == pytest.approx(area * p["link_thickness"], rel=3e-3)
    assert part["link_inertia"] == pytest.approx(polar * p["link_thickness"] * p["structure_density"], rel=3e-3)
    area, disc = count(retainer, 0.03, [0.5 * p["retainer_screw_clearance"], p["core_radius"] + p["retainer_lip"]])
    assert part["retainer_volume"] == pytest.approx(area * p["retainer_thickness"], rel=3e-3)
    rest = (polar * p["link_thickness"] + disc * p["retainer_thickness"]) * p["structure_density"]
    bought = part["screws_inertia"] + part["dowels_inertia"]
    assert part["parts_inertia"] - part["rotor_inertia"] - bought == pytest.approx(rest, rel=3e-3)


def test_spring_has_the_volume_of_its_wire_laid_out_in_space(part: dict[str, Any]) -> None:
    p = part
    wire, radius = p["wire_diameter"], 0.5 * p["coil_diameter"]
    pitch = wire + p["coil_gap"]
    turns = np.linspace(0.0, p["coil_count"], 20001)
    helix = np.column_stack([radius * np.cos(2 * np.pi * turns), radius * np.sin(2 * np.pi * turns), pitch * turns])
    slope = np.arctan2(pitch, 2.0 * np.pi * radius)
    # The leg goes on as the helix ends; at the other end the wire bends from the helix's slope to straight down.
    leg = np.array([[0.0, 0.0, 0.0], [p["leg_length"], 0.0, p["leg_length"] * np.tan(slope)]])
    turn = np.linspace(slope, 0.5 * np.pi, 2001)
    bend = 2.0 * wire * np.column_stack([np.sin(turn), 0.0 * turn, np.cos(turn)])
    length = sum(float(np.sum(np.linalg.norm(np.diff(line, axis=0), axis=1))) for line in (helix, leg, bend))
    volume = 0.25 * np.pi * wire**2 * (length + p["tang_length"])
    assert p["spring_volume"] == pytest.approx(volume, rel=1e-6)
    assert p["springs_mass"] == pytest.approx(p["spring_count"] * 7850.0 * volume, rel=1e-6)


def test_masses_are_volumes_times_densities_and_add_up(part: dict[str, Any]) -> None:
    p = part
    for name in ("housing", "rotor", "link", "retainer"):
        assert p[f"{name}_mass"] == pytest.approx(1270.0 * p[f"{name}_volume"], rel=1e-9), name  # PETG
    assert p["pcl_mass"] == pytest.approx(1145.0 * p["pcl_volume"], rel=1e-9)
    # The pads are cut from modules of 1600 mm^2 and 6 g; their corners of 0.2 mm take a ten-thousandth.
    assert p["peltier_mass"] == pytest.approx(6e-3 * p["pcl_area"] / 1600e-6, rel=1.5e-4)
    parts = ("housing", "rotor", "link", "retainer", "springs", "pcl", "peltier", "screws", "dowels", "cutout")
    assert p["module_mass"] == pytest.approx(sum(p[f"{name}_mass"] for name in parts), rel=1e-12)
