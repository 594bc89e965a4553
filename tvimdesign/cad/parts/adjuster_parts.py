"""The rotary adjusters of the springs: a post with a flange, the screw that clamps it, and where they stand."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan2, pi

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import blind_hole, block, cylinder, join, polar
from tvimdesign.cad.geometry.spring_solids import installed_coil
from tvimdesign.cad.parts.common_parts import hand_of, scale_dot
from tvimdesign.device.components.preload_adjuster import FIRST_DOT, LAST_DOT


def adjuster(dims: Dimensions) -> cq.Shape:
    """The adjuster of a right-hand spring about its axis: flange, post, the tang's hole, the screw's and the slot."""
    bottom, top = -dims.adjuster_thickness, dims.post_height
    body = join(cylinder(dims.adjuster_radius, bottom, 0), [cylinder(dims.post_radius, bottom, top)])
    tang = cylinder(0.5 * dims.wire_diameter + dims.tang_clearance, bottom, 0, installed_coil(dims).tang_position)
    pilot = blind_hole(dims.adjuster_screw_hole, bottom, bottom + dims.adjuster_screw_depth, dims.drill_point_ratio)
    across = (-dims.adjuster_radius, dims.adjuster_radius)
    slot = block(across, dims.driver_slot_width, top - dims.driver_slot_depth, top)
    return body.cut(tang, *pilot, slot, *_scale(dims))


def _scale(dims: Dimensions) -> list[cq.Shape]:
    """The dots of a flange, from its tang on around the axis."""
    tang = atan2(*reversed(installed_coil(dims).tang_position))
    places = [
        polar(dims.scale_circle_radius, tang + index * dims.scale_division) for index in range(FIRST_DOT, LAST_DOT + 1)
    ]
    return [dot for at in places for dot in scale_dot(dims, at)]


def adjuster_screw(dims: Dimensions) -> cq.Shape:
    """The screw that clamps an adjuster from below, about the spring's axis."""
    bottom = -dims.floor_thickness
    shank = cylinder(0.5 * dims.adjuster_screw_pilot, bottom, bottom + dims.adjuster_screw_length)
    return join(shank, [cylinder(0.5 * dims.adjuster_screw_head, bottom - dims.adjuster_screw_head_height, bottom)])


def stand(dims: Dimensions, solids: Mapping[str, cq.Solid]) -> dict[str, cq.Shape]:
    """Place adjusters and their screws, by name: those of the left-hand springs are turned to meet their tangs."""
    x, y = installed_coil(dims).tang_position
    to_left = -2.0 * atan2(y, x)
    placed: dict[str, cq.Shape] = {}
    for index, azimuth in enumerate(dims.azimuths("spring_count")):
        at = cq.Vector(*polar(dims.placement_radius, azimuth), 0)
        angle = azimuth + (0.0 if hand_of(index) == "right" else to_left)
        turned = cq.Location(at, cq.Vector(0, 0, 1), angle * 180.0 / pi)
        placed[f"adjuster_{index + 1}"] = solids["adjuster"].moved(turned)
        placed[f"adjuster_screw_{index + 1}"] = solids["adjuster_screw"].moved(cq.Location(at))
    return placed
