"""Heat-set inserts: rings at the mouths of the screws' holes, and where they sit."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import TURNING
from tvimdesign.cad.geometry.solids import ring, turned
from tvimdesign.cad.parts.common_parts import between_springs, link_screws, spring_axes

JOINTS = ("link", "retainer", "adjuster", "cover")
"""Screwed joints that may have inserts, by the names of their rows."""


def insert_length(dims: Dimensions, joint: str) -> float:
    """Length of the inserts of a joint [mm]; zero where it has none."""
    return dims.of(joint, "insert_length") if joint in JOINTS else 0.0


def insert(joint: str, dims: Dimensions) -> cq.Shape:
    """One insert of a joint, upright on the module's axis: it fills its hole up to the screw's shank."""
    shank, hole = dims.of(joint, "screw_pilot"), dims.of(joint, "screw_hole")
    return ring(0.5 * shank, 0.5 * hole, 0, insert_length(dims, joint))


def places(dims: Dimensions, joint: str) -> list[tuple[float, float, float]]:
    """Middles of the lower ends of a joint's inserts, the rotor at rest."""
    length = insert_length(dims, joint)
    if joint == "link":
        return [(x, y, dims.link_bottom_level - length) for x, y in link_screws(dims)]
    if joint == "retainer":
        return [(0.0, 0.0, dims.core_bottom_level)]
    if joint == "adjuster":
        return [(x, y, -dims.adjuster_thickness) for x, y in spring_axes(dims)]
    return [(x, y, dims.rim_level - length) for x, y in between_springs(dims, dims.housing_inner_radius)]


def drawn(dims: Dimensions) -> dict[str, Callable[[Dimensions], cq.Shape]]:
    """How one of each kind is drawn, of what this module has."""
    return {f"{joint}_insert": partial(insert, joint) for joint in JOINTS if insert_length(dims, joint)}


def stand(dims: Dimensions, solids: Mapping[str, cq.Solid], rotor_angle: float) -> dict[str, cq.Shape]:
    """Place the inserts, the rotor at an angle [rad], by name."""
    placed: dict[str, cq.Shape] = {}
    for joint in JOINTS:
        kind = f"{joint}_insert"
        if kind in solids:
            angle = rotor_angle if kind in TURNING else 0.0
            for index, at in enumerate(places(dims, joint)):
                placed[f"{kind}_{index + 1}"] = turned(solids[kind].moved(cq.Location(cq.Vector(*at))), angle)
    return placed
