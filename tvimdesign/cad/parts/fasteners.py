"""Screws, heat-set inserts and dowel pins, drawn upright on the axis as the table counts them, and placed."""

from collections.abc import Callable, Mapping
from functools import partial

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import TURNING
from tvimdesign.cad.geometry.solids import cylinder, join, ring, turned
from tvimdesign.cad.parts.common_parts import by_feet, leg_pins, link_dowels, link_screws, mounts, spring_axes

Point = tuple[float, float]
INSERTED = ("link", "retainer", "adjuster", "cover")
"""Screwed joints that may have inserts, by the names of their quantities."""
_ON_AXIS = ((0.0, 0.0),)
_PRESENT = {"adjuster": "adjuster_radius", "cover": "cover_height", "motor": "drive_height", "mount": "drive_height"}
"""The dimension that is zero where a module has no such joint."""
_SEATS: Mapping[str, Callable[[Dimensions], tuple[float, int]]] = {
    "link": lambda dims: (dims.link_bottom_level + dims.link_thickness, -1),
    "retainer": lambda dims: (dims.retainer_top_level - dims.retainer_thickness, 1),
    "adjuster": lambda dims: (-dims.floor_thickness, 1),
    "cover": lambda dims: (dims.rim_level + dims.cover_height, -1),
    "motor": lambda dims: (dims.motor_retainer_level - dims.motor_retainer_floor, 1),
    "mount": lambda _: (0.0, -1),
}
"""Level that the heads of a joint's screws lie on, and the way in: 1 upwards, -1 downwards."""
_MOUTHS: Mapping[str, Callable[[Dimensions], float]] = {
    "link": lambda dims: dims.link_screw_mouth_level - insert_length(dims, "link"),
    "retainer": lambda dims: dims.core_bottom_level,
    "adjuster": lambda dims: -dims.adjuster_thickness,
    "cover": lambda dims: dims.rim_level - insert_length(dims, "cover"),
}
"""Lower ends of a joint's inserts."""


def screw(joint: str, dims: Dimensions) -> cq.Shape:
    """Draw a screw of a joint: its shank as thick as its hole in what it is screwed into, its head a cylinder."""
    seat, inwards = _SEATS[joint](dims)
    end, top = seat + inwards * dims.of(joint, "screw_length"), seat - inwards * dims.of(joint, "screw_head_height")
    shank = cylinder(0.5 * dims.of(joint, "screw_pilot"), min(seat, end), max(seat, end))
    return join(shank, [cylinder(0.5 * dims.of(joint, "screw_head"), min(seat, top), max(seat, top))])


def insert(joint: str, dims: Dimensions) -> cq.Shape:
    """Draw an insert of a joint, which fills its hole up to the screw's shank."""
    shank, hole = dims.of(joint, "screw_pilot"), dims.of(joint, "screw_hole")
    return ring(0.5 * shank, 0.5 * hole, 0, insert_length(dims, joint))


def insert_length(dims: Dimensions, joint: str) -> float:
    """Return the length of the inserts of a joint [mm]; zero where it has none."""
    return dims.of(joint, "insert_length") if joint in INSERTED else 0.0


def link_dowel(dims: Dimensions) -> cq.Shape:
    """Draw a dowel pin, flush with the link."""
    top = dims.link_bottom_level + dims.link_thickness
    return cylinder(0.5 * dims.link_dowel_diameter, top - dims.link_dowel_length, top)


def leg_pin(dims: Dimensions) -> cq.Shape:
    """Draw a dowel pin that a leg bears on."""
    return cylinder(0.5 * dims.pin_diameter, dims.pin_top_level - dims.leg_pin_length, dims.pin_top_level)


_DOWELS: Mapping[str, tuple[Callable[[Dimensions], cq.Shape], Callable[[Dimensions], list[Point]]]] = {
    "link_dowel": (link_dowel, link_dowels),
    "leg_pin": (leg_pin, leg_pins),
}
"""How a dowel pin of each kind is drawn, and where they stand, the rotor at rest."""


def axes(dims: Dimensions, joint: str) -> list[Point]:
    """Return the axes of a joint's screws, the rotor at rest."""
    match joint:
        case "link":
            return link_screws(dims)
        case "adjuster":
            return spring_axes(dims)
        case "cover":
            return by_feet(dims, dims.housing_inner_radius)
        case "mount":
            return mounts(dims)
    return list(_ON_AXIS)


def insert_places(dims: Dimensions, joint: str) -> list[tuple[float, float, float]]:
    """Return the middles of the lower ends of a joint's inserts, the rotor at rest."""
    return [(*at, _MOUTHS[joint](dims)) for at in axes(dims, joint)]


def drawn(dims: Dimensions) -> dict[str, Callable[[Dimensions], cq.Shape]]:
    """Return how one of each kind is drawn, of what this module has."""
    screws = {f"{joint}_screw": partial(screw, joint) for joint in _SEATS if _has(dims, joint)}
    inserts = {f"{joint}_insert": partial(insert, joint) for joint in INSERTED if insert_length(dims, joint)}
    dowels = {kind: draw for kind, (draw, places) in _DOWELS.items() if places(dims)}
    return {**screws, **inserts, **dowels}


def stand(dims: Dimensions, solids: Mapping[str, cq.Solid], rotor_angle: float) -> dict[str, cq.Shape]:
    """Place what is there of them, the rotor at an angle [rad], by name."""
    placed: dict[str, cq.Shape] = {}
    for kind in (*(f"{joint}_screw" for joint in _SEATS), *(f"{joint}_insert" for joint in INSERTED), *_DOWELS):
        if kind not in solids:
            continue
        angle = rotor_angle if kind in TURNING else 0.0
        places = _places(dims, kind)
        for index, at in enumerate(places):
            name = f"{kind}_{index + 1}" if len(places) > 1 or kind.endswith("_insert") else kind
            placed[name] = turned(solids[kind].moved(cq.Location(cq.Vector(*at))), angle)
    return placed


def _has(dims: Dimensions, joint: str) -> bool:
    return joint not in _PRESENT or bool(getattr(dims, _PRESENT[joint]))


def _places(dims: Dimensions, kind: str) -> list[tuple[float, float, float]]:
    joint, thing = kind.rsplit("_", 1)
    if thing == "insert":
        return insert_places(dims, joint)
    return [(x, y, 0.0) for x, y in (axes(dims, joint) if thing == "screw" else _DOWELS[kind][1](dims))]
