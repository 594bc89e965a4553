"""Bearings, the wave spring, the rotary adjusters of the springs, cover and base: drawn and placed."""

from collections.abc import Callable, Mapping
from math import atan2, pi

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import blind_hole, block, cylinder, join, polar, ring, turned
from tvimdesign.cad.geometry.spring_solids import installed_coil
from tvimdesign.cad.parts.common_parts import base, hand_of, scale_dot, spring_axes
from tvimdesign.device.components.preload_adjuster import FIRST_DOT, LAST_DOT


def bearing_inner(dims: Dimensions) -> cq.Shape:
    """Draw what turns of the upper bearing."""
    top = dims.hub_top_level
    return ring(dims.bearing_bore_radius, _middle(dims), top - dims.bearing_width, top)


def bearing_outer(dims: Dimensions) -> cq.Shape:
    """Draw what stands of the upper bearing."""
    top = dims.hub_top_level
    return ring(_middle(dims), dims.bearing_outer_radius, top - dims.bearing_width, top)


def preload_spring(dims: Dimensions) -> cq.Shape:
    """Draw the wave spring at its working height, as a plain ring."""
    top = dims.preload_spring_level
    inner, outer = dims.preload_inner_radius, dims.preload_outer_radius
    return ring(inner, outer, top - dims.preload_height, top)


def _middle(dims: Dimensions) -> float:
    """Return the radius at which a bearing is divided into what turns and what stands."""
    return 0.5 * (dims.bearing_bore_radius + dims.bearing_outer_radius)


def adjuster(dims: Dimensions) -> cq.Shape:
    """Draw adjuster of a right-hand spring about its axis: flange, post, the tang's hole, the screw's and the slot."""
    bottom, top = -dims.adjuster_thickness, dims.post_height
    body = join(cylinder(dims.adjuster_radius, bottom, 0), [cylinder(dims.post_radius, bottom, top)])
    tang = cylinder(0.5 * dims.wire_diameter + dims.tang_clearance, bottom, 0, installed_coil(dims).tang_position)
    pilot = blind_hole(dims.adjuster_screw_hole, bottom, bottom + dims.adjuster_screw_depth, dims.drill_point_ratio)
    across = (-dims.adjuster_radius, dims.adjuster_radius)
    slot = block(across, dims.driver_slot_width, top - dims.driver_slot_depth, top)
    return body.cut(tang, *pilot, slot, *scale(dims))


def scale(dims: Dimensions) -> list[cq.Shape]:
    """Draw the dots of a flange, from its tang on around the axis."""
    tang = atan2(*reversed(installed_coil(dims).tang_position))
    places = [
        polar(dims.scale_circle_radius, tang + index * dims.scale_division) for index in range(FIRST_DOT, LAST_DOT + 1)
    ]
    return [dot for at in places for dot in scale_dot(dims, at)]


def cover(dims: Dimensions) -> cq.Shape:
    """Draw the ring around the core with every hole that the device's `cover_hole_circles` lists."""
    bottom, top = dims.rim_level, dims.rim_level + dims.cover_height
    holes = [cylinder(radius, bottom, top, at) for radius, places in dims.holes("cover_hole_circles") for at in places]
    return ring(dims.cover_hole_radius, dims.housing_outer_radius, bottom, top).cut(*holes)


def drawn(dims: Dimensions) -> dict[str, Callable[[Dimensions], cq.Shape]]:
    """Return how one of each kind is drawn, of what this module has."""
    return {
        **({"bearing_inner": bearing_inner, "bearing_outer": bearing_outer} if dims.bearing_width else {}),
        **({"preload_spring": preload_spring} if dims.preload_height else {}),
        **({"adjuster": adjuster} if dims.adjuster_radius else {}),
        **({"cover": cover} if dims.cover_height else {}),
        **({"base": base} if dims.base_height else {}),
    }


def stand(dims: Dimensions, solids: Mapping[str, cq.Solid], rotor_angle: float) -> dict[str, cq.Shape]:
    """Place what is there of them, the rotor at an angle [rad], by name."""
    placed: dict[str, cq.Shape] = {
        kind: turned(solids[kind], 0.0) for kind in ("preload_spring", "cover", "base") if kind in solids
    }
    if "bearing_inner" in solids:
        down = cq.Location(cq.Vector(0, 0, dims.bearing_width - (dims.hub_top_level - dims.hub_bottom_level)))
        for kind, angle in (("bearing_inner", rotor_angle), ("bearing_outer", 0.0)):
            placed[f"{kind}_1"] = turned(solids[kind], angle)
            placed[f"{kind}_2"] = turned(solids[kind].moved(down), angle)
    return placed | (_adjusters(dims, solids["adjuster"]) if "adjuster" in solids else {})


def _adjusters(dims: Dimensions, solid: cq.Solid) -> dict[str, cq.Shape]:
    """Place the adjusters, by name: those of the left-hand springs are turned to meet their tangs."""
    x, y = installed_coil(dims).tang_position
    to_left = -2.0 * atan2(y, x)
    placed: dict[str, cq.Shape] = {}
    for index, (at, azimuth) in enumerate(zip(spring_axes(dims), dims.azimuths("spring_count"), strict=True)):
        angle = azimuth + (0.0 if hand_of(index) == "right" else to_left)
        turn = cq.Location(cq.Vector(*at, 0), cq.Vector(0, 0, 1), angle * 180.0 / pi)
        placed[f"adjuster_{index + 1}"] = solid.moved(turn)
    return placed
