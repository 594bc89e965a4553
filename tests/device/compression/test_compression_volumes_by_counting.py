"""Volumes and inertia of vanes, blocks and slots against a count of points, level by level as they stand in space."""

from typing import Any

import numpy as np
import pytest
from counting import Array, count, in_stops, near, stack_up
from numpy.typing import NDArray

from tvimdesign.device import table_for

TABLE = table_for("compression")
SHAPES = {
    "as it is": {},
    "tall, near the axis": {
        "vane_count": 4, "block_height": 13e-3, "block_depth": 4e-3, "vane_thickness": 3e-3, "slot_share": 0.6,
        "core_radius": 8e-3, "pcl_inner_radius": 13e-3, "pcl_outer_radius": 24e-3, "rotor_rim": 8e-3,
        "coil_diameter": 12e-3, "coil_count": 7.5, "running_clearance": 0.6e-3, "floor_thickness": 5e-3,
        "spring_pairs": 3,
    },
}  # fmt: skip
WANTED = [
    "housing_volume", "housing_vanes_moments", "floor_moments", "skirt_moments", "rotor_volume", "rotor_inertia",
    "pcl_volume", "pcl_area", "pcl_mass", "peltier_volume", "peltier_mass", "module_mass", "housing_mass", "rotor_mass",
    "link_mass", "retainer_mass", "springs_mass", "rotor_bottom_level", "rotor_top_level", "pin_top_level",
    "link_bottom_level", "coil_end_level", "rotor_radius", "pin_radius", "hub_radius", "post_radius", "spring_count",
    "housing_inner_radius", "housing_outer_radius", "link_bolt_circle_radius", "link_screw_depth",
    "retainer_screw_depth", "screws_mass", "dowels_mass", "cutout_mass", "link_dowel_depth",
    "stop_width", "stop_post_length", "stop_outer_radius", "stop_inner_radius", "stop_post_span",
]  # fmt: skip


@pytest.fixture(scope="module", params=["as it is", pytest.param("tall, near the axis", marks=pytest.mark.slow)])
def part(request: pytest.FixtureRequest, squeezed: dict[str, Any]) -> dict[str, Any]:
    given = {**squeezed, "largest_foot_fillet": 1e-4, **SHAPES[request.param]}  # fillets have a test of their own
    return {**given, **TABLE.evaluate(given, WANTED)}


class Plan:
    """The chamber seen from above, at points; one pitch is drawn and repeated, a rotor vane at its middle."""

    def __init__(self, p: dict[str, Any], x: Array, y: Array) -> None:
        self.p, self.r = p, np.hypot(x, y)
        pitch = 2.0 * np.pi / p["vane_count"]
        turn = np.arctan2(y, x) % (2.0 * np.pi)
        self.off = np.abs((turn + 0.5 * pitch) % pitch - 0.5 * pitch)
        self.mean = 0.5 * (p["pcl_inner_radius"] + p["pcl_outer_radius"])
        self.rotor_face = 0.5 * p["vane_thickness"] / self.mean
        self.pad_face = self.rotor_face + p["block_depth"] / self.mean
        self.inside = (self.r > p["pcl_inner_radius"]) & (self.r < p["pcl_outer_radius"])

    def rotor_vane(self) -> NDArray[np.bool_]:
        return self.inside & (self.off < self.rotor_face)

    def block(self) -> NDArray[np.bool_]:
        return self.inside & (self.off > self.rotor_face) & (self.off < self.pad_face)

    def _behind(self) -> Array:
        """Distance behind the pads' hot plane, a plane through the axis."""
        return self.r * np.sin(self.off - self.pad_face)

    def housing_vane(self) -> NDArray[np.bool_]:
        return self.inside & (self.off > self.pad_face)

    def pad(self) -> NDArray[np.bool_]:
        return self.housing_vane() & (self._behind() < self.p["peltier_thickness"])

    def slot(self) -> NDArray[np.bool_]:
        half = 0.5 * self.p["slot_share"] * (self.p["pcl_outer_radius"] - self.p["pcl_inner_radius"])
        return self.housing_vane() & ~self.pad() & (np.abs(self.r - self.mean) < half)


def rims(p: dict[str, Any]) -> list[float]:
    mean, width = 0.5 * (p["pcl_inner_radius"] + p["pcl_outer_radius"]), p["pcl_outer_radius"] - p["pcl_inner_radius"]
    half = 0.5 * p["slot_share"] * width
    return [p["pcl_inner_radius"], mean - half, mean + half, p["pcl_outer_radius"], p["hub_radius"], p["core_radius"],
            p["core_radius"] + p["running_clearance"], p["housing_inner_radius"]]  # fmt: skip


def test_blocks_and_pads_fill_what_is_between_the_vanes(part: dict[str, Any]) -> None:
    p = part
    outer, rays = p["pcl_outer_radius"], 7919  # a prime, so that no ray runs along two faces
    blocks, _ = count(lambda x, y: Plan(p, x, y).block(), outer, [p["pcl_inner_radius"]], rays)
    pads, _ = count(lambda x, y: Plan(p, x, y).pad(), outer, [p["pcl_inner_radius"]], rays)
    assert p["pcl_volume"] == pytest.approx(blocks * p["block_height"], rel=3e-3)
    assert p["peltier_volume"] == pytest.approx(pads * p["block_height"], rel=3e-3)
    assert p["pcl_mass"] == pytest.approx(1145.0 * p["pcl_volume"], rel=1e-9)
    assert p["peltier_mass"] == pytest.approx(6e-3 * p["pcl_area"] / 1600e-6, rel=1e-9)


def test_housing_s_vanes_have_the_volume_of_their_levels(part: dict[str, Any]) -> None:
    p = part
    low, high = p["running_clearance"], p["running_clearance"] + p["block_height"]
    roof = high - p["window_ledge"]
    volume, _ = stack_up(
        [
            (low, lambda x, y: Plan(p, x, y).housing_vane() & ~Plan(p, x, y).slot()),
            (roof - low, lambda x, y: Plan(p, x, y).housing_vane() & ~Plan(p, x, y).slot() & ~Plan(p, x, y).pad()),
            (high - roof, lambda x, y: Plan(p, x, y).housing_vane() & ~Plan(p, x, y).pad()),
        ],
        p["rotor_radius"], rims(p),
    )  # fmt: skip
    assert p["housing_vanes_moments"].area == pytest.approx(volume, rel=3e-3)


def test_floor_has_the_volume_that_hub_slots_and_holes_leave(part: dict[str, Any]) -> None:
    p = part
    hub, outer = p["hub_radius"], p["housing_outer_radius"]
    springs, tang = int(p["spring_count"]), 0.5 * p["wire_diameter"] + p["tang_clearance"]

    def floor(x: Array, y: Array) -> NDArray[np.bool_]:
        r = np.hypot(x, y)
        holes = near(x, y, tang, p["placement_radius"], springs, 0.2)
        holes |= near(x, y, 0.5 * p["mount_hole"], p["placement_radius"], springs, np.pi / springs)
        return (r > hub) & (r < outer) & ~holes & ~Plan(p, x, y).slot()

    volume, _ = stack_up([(p["floor_thickness"], floor)], outer, rims(p))
    assert p["floor_moments"].area == pytest.approx(volume, rel=3e-3)


def test_housing_is_its_parts_and_masses_add_up(part: dict[str, Any]) -> None:
    p = part
    wall = np.pi * (p["housing_outer_radius"] ** 2 - p["housing_inner_radius"] ** 2) * p["pin_top_level"]
    bore = p["core_radius"] + p["running_clearance"]
    height = p["floor_thickness"] + p["block_height"] + 2.0 * p["running_clearance"]
    hub = np.pi * (p["hub_radius"] ** 2 - bore**2) * height
    posts = p["spring_count"] * np.pi * p["post_radius"] ** 2 * (p["coil_end_level"] + 0.5 * p["wire_diameter"])
    stops = 2.0 * p["stop_post_span"] * (p["stop_outer_radius"] ** 2 - p["stop_inner_radius"] ** 2)
    posts += stops * p["rotor_top_level"]
    whole = p["skirt_moments"].area + p["floor_moments"].area + p["housing_vanes_moments"].area + wall + hub + posts
    assert p["housing_volume"] == pytest.approx(whole, rel=1e-12)
    names = ("housing", "rotor", "link", "retainer", "springs", "pcl", "peltier", "screws", "dowels", "cutout")
    assert part["module_mass"] == pytest.approx(sum(part[f"{name}_mass"] for name in names), rel=1e-12)


def test_rotor_has_the_volume_and_inertia_of_its_levels(part: dict[str, Any]) -> None:
    p = part

    def core(x: Array, y: Array) -> NDArray[np.bool_]:
        return np.hypot(x, y) < p["core_radius"]

    def pins(x: Array, y: Array) -> NDArray[np.bool_]:
        return near(x, y, 0.5 * p["pin_diameter"], p["pin_radius"], int(p["spring_count"]))

    clear = p["running_clearance"]
    slabs = [
        (p["floor_thickness"] + 2.0 * clear, core),
        (p["block_height"] + clear, lambda x, y: core(x, y) | Plan(p, x, y).rotor_vane()),
        (p["rotor_thickness"], lambda x, y: (np.hypot(x, y) < p["rotor_radius"]) | in_stops(x, y, p)[1]),
        (p["pin_top_level"] - p["rotor_top_level"], lambda x, y: core(x, y) | pins(x, y)),
        (p["link_bottom_level"] - p["pin_top_level"], core),
        (-p["link_screw_depth"], lambda x, y: near(x, y, 0.5 * p["link_screw_pilot"], p["link_bolt_circle_radius"], 4)),
        (-p["retainer_screw_depth"], lambda x, y: np.hypot(x, y) < 0.5 * p["retainer_screw_pilot"]),
        (
            -p["link_dowel_depth"],
            lambda x, y: near(x, y, 0.5 * p["link_dowel_diameter"], 0.7 * p["core_radius"], 4, 0.25 * np.pi),
        ),
    ]
    volume, polar = stack_up(
        slabs, p["stop_outer_radius"], [0.5 * p["retainer_screw_pilot"], p["rotor_radius"], *rims(p)]
    )
    assert p["rotor_volume"] == pytest.approx(volume, rel=3e-3)
    assert p["rotor_inertia"] == pytest.approx(polar * p["structure_density"], rel=3e-3)
    # What turns and what stands are apart by a running clearance, above and below.
    assert p["rotor_bottom_level"] == pytest.approx(p["block_height"] + 2.0 * clear, rel=1e-12)
