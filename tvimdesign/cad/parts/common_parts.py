"""The drawn parts that all modes share: rotor axis z, the floor's upper face z = 0. A mode adds its own; no springs."""

from collections.abc import Iterable
from math import atan2, hypot, pi, sqrt

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.kinds import pin_foot_level
from tvimdesign.cad.geometry.solids import (
    blind_hole,
    block,
    bossed_ring,
    cylinder,
    foot,
    join,
    polar,
    ring,
    sector,
    slot,
    spoked_disc,
    tapered_bar,
    toothed_disc,
    turned,
)
from tvimdesign.cad.geometry.spring_solids import installed_coil
from tvimdesign.device.components.hard_stops import STOPS

_DOWEL_AZIMUTHS = (0.0, pi, 0.5 * pi, 1.5 * pi)
"""In the order in which pins are added: on the link's long axis, then across it, all between the link screws."""
_LINK_SCREW_AZIMUTHS = tuple(0.25 * pi + 0.5 * pi * index for index in range(4))


def hand_of(index: int) -> str:
    """Return the hand of a spring by its place around the module: right, left, right ..."""
    return "right" if index % 2 == 0 else "left"


def tang_positions(dims: Dimensions) -> list[tuple[float, float]]:
    """Return where the springs' tangs enter the floor, in the order of the springs."""
    x, y = installed_coil(dims).tang_position
    radius = hypot(dims.placement_radius + x, y)
    beside = atan2(y, dims.placement_radius + x)
    return [
        polar(radius, azimuth + (beside if hand_of(index) == "right" else -beside))
        for index, azimuth in enumerate(dims.azimuths("spring_count"))
    ]


def bare_housing(dims: Dimensions, added: Iterable[cq.Shape], openings: Iterable[cq.Shape]) -> cq.Shape:
    """Draw floor, hub, wall, spring posts, stops, cover bosses, what the mode adds, and skirt and feet without a base.

    Less bore, the mode's openings, tang and screw holes, and notches.
    """
    floor_bottom = -dims.floor_thickness
    floor = cylinder(dims.housing_outer_radius, floor_bottom, 0)
    below = floor_bottom - (0.0 if dims.base_height else dims.foot_height)
    hub = cylinder(dims.hub_radius, dims.hub_bottom_level, dims.hub_top_level)
    posts, holes = spring_places(dims)
    walls, cover_holes = walls_and_cover_holes(dims, below)
    feet = [] if dims.base_height else mounts(dims)
    feet = [cylinder(dims.mount_boss_radius, below, floor_bottom, at) for at in feet]
    mount_holes = [cylinder(0.5 * dims.mount_hole, below, 0, at) for at in mounts(dims)]
    mount_holes += [] if dims.base_height else notches(dims)
    body = join(floor, [*walls, hub, *posts, *stops(dims), *feet, *added])
    return body.cut(*bores(dims), *openings, *holes, *cover_holes, *mount_holes)


def base(dims: Dimensions) -> cq.Shape:
    """Draw the base: skirt, feet and the webs between them, with holes for the screws and notches above its sill."""
    levels = (-dims.floor_thickness - dims.base_height, -dims.floor_thickness)
    sizes = dims.housing_inner_radius, dims.mount_boss_radius, dims.placement_radius, dims.base_corner_radius
    body = spoked_disc(*sizes, foot_azimuths(dims), levels, dims.housing_outer_radius)
    return body.cut(*(cylinder(0.5 * dims.mount_hole, *levels, at) for at in mounts(dims)), *notches(dims))


def stop_azimuths(dims: Dimensions) -> list[float]:
    """Return azimuths of the rotor's teeth at rest [rad]: two opposite each other, at the azimuths of feet."""
    first = pi / dims.count("foot_count")
    return [first + 2.0 * pi * index / STOPS for index in range(STOPS)]


def stops(dims: Dimensions) -> list[cq.Shape]:
    """Draw the posts that the rotor's teeth meet at the end of their way, two for each tooth."""
    post = sector(dims.stop_inner_radius, dims.stop_outer_radius, dims.stop_post_span, 0.0, dims.rotor_top_level)
    beside = dims.stop_angle + 0.5 * (dims.stop_tooth_span + dims.stop_post_span)
    return [turned(post, azimuth + side * beside) for azimuth in stop_azimuths(dims) for side in (1.0, -1.0)]


def spring_places(dims: Dimensions) -> tuple[list[cq.Shape], list[cq.Shape]]:
    """Draw what stands on the floor for the springs, and what is cut from it: posts and tang holes, or pockets."""
    floor_bottom = -dims.floor_thickness
    axes = spring_axes(dims)
    if not axes:
        return [], []
    if not dims.adjuster_radius:
        hole_radius = 0.5 * dims.wire_diameter + dims.tang_clearance
        holes = [cylinder(hole_radius, floor_bottom, 0, at) for at in tang_positions(dims)]
        return [cylinder(dims.post_radius, 0, dims.post_height, at) for at in axes], holes
    radius = dims.adjuster_radius + dims.slip_clearance
    pockets = [cylinder(radius, -dims.adjuster_thickness, 0, at) for at in axes]
    screws = [cylinder(0.5 * dims.adjuster_screw_clearance, floor_bottom, 0, at) for at in axes]
    marks = []
    for (x, y), azimuth in zip(axes, dims.azimuths("spring_count"), strict=True):
        beside = polar(dims.scale_mark_radius, azimuth + _MARK)
        marks += scale_dot(dims, (x + beside[0], y + beside[1]))
    return [], [*pockets, *screws, *marks]


_MARK = pi / 3.0  # Azimuth about an adjuster's axis [rad], from outwards, at which the floor has the mark of its scale


def scale_dot(dims: Dimensions, at: tuple[float, float]) -> list[cq.Shape]:
    """Draw a dot of an adjuster's scale, or its mark, in faces that are level with the floor's upper one."""
    return [*blind_hole(dims.scale_dot_diameter, 0.0, -dims.scale_dot_depth, dims.drill_point_ratio, at)]


def bores(dims: Dimensions) -> list[cq.Shape]:
    """Draw what is cut from the hub: a plain bore, or a lip's bore with a seat for a bearing at either end.

    A hub that ends below the floor's upper face, to make room for a wave spring, leaves a recess there.
    """
    bottom, top = dims.hub_bottom_level, dims.hub_top_level
    between = cylinder(dims.lip_radius, bottom, max(top, 0.0))
    recess = [cylinder(dims.hub_radius, top, 0.0)] if top < 0.0 else []
    if not dims.bearing_width:
        return [between, *recess]
    lower = cylinder(dims.seat_radius, bottom, bottom + dims.lower_seat_depth)
    return [between, *recess, lower, cylinder(dims.seat_radius, top - dims.upper_seat_depth, top)]


def spring_axes(dims: Dimensions) -> list[tuple[float, float]]:
    """Return the axes of the springs, in their order."""
    return [polar(dims.placement_radius, azimuth) for azimuth in dims.azimuths("spring_count")]


def mounts(dims: Dimensions) -> list[tuple[float, float]]:
    """Return the axes of the screws that fix the housing: midway between the springs."""
    return by_feet(dims, dims.placement_radius)


def foot_azimuths(dims: Dimensions) -> list[float]:
    """Return the azimuths of the feet [rad], which are midway between the springs."""
    half_pitch = pi / dims.count("foot_count")
    return [azimuth + half_pitch for azimuth in dims.azimuths("foot_count")]


def by_feet(dims: Dimensions, radius: float) -> list[tuple[float, float]]:
    """Return places at the azimuths of the feet at a radius."""
    return [polar(radius, azimuth) for azimuth in foot_azimuths(dims)]


def walls_and_cover_holes(dims: Dimensions, bottom: float) -> tuple[list[cq.Shape], list[cq.Shape]]:
    """Draw skirt and wall from a level, with bosses where there is a cover, and the holes for its screws."""
    inner, outer, rim = dims.housing_inner_radius, dims.housing_outer_radius, dims.rim_level
    if not dims.cover_height:
        return [ring(inner, outer, bottom, rim)], []
    axes = by_feet(dims, inner)
    wall = bossed_ring((inner, outer), dims.cover_boss_radius, dims.cover_corner_radius, foot_azimuths(dims), (0, rim))
    point, end = dims.drill_point_ratio, rim - dims.cover_screw_depth
    holes = [hole for at in axes for hole in blind_hole(dims.cover_screw_hole, rim, end, point, at)]
    return [ring(inner, outer, bottom, 0), wall], holes


def notches(dims: Dimensions) -> list[cq.Shape]:
    """Draw what is cut from the skirt midway between feet: air for the pads' cold sides, and a way for their wires."""
    width, top = dims.notch_width, -dims.floor_thickness
    inside = sqrt(dims.housing_inner_radius**2 - (0.5 * width) ** 2)
    bottom = top - dims.foot_height + dims.base_sill
    opening = block((inside, dims.housing_outer_radius + 1.0), width, bottom, top)
    return [turned(opening, azimuth) for azimuth in dims.azimuths("foot_count")]


def bare_rotor(dims: Dimensions, added: Iterable[cq.Shape] = (), openings: Iterable[cq.Shape] = ()) -> cq.Shape:
    """Draw plate with its teeth, core that turns in the hub and carries the link, springs' pins or the bosses of bought
    ones, what the mode adds.

    Less the holes for screws and dowel pins and the mode's openings.
    """
    core_bottom = dims.core_bottom_level
    radii, levels = (dims.rotor_radius, dims.stop_outer_radius), (dims.rotor_bottom_level, dims.rotor_top_level)
    plate = toothed_disc(radii, dims.corner_radius, dims.stop_tooth_span, stop_azimuths(dims), levels)
    core = [
        cylinder(dims.journal_radius, core_bottom, dims.rotor_top_level),
        cylinder(dims.core_radius, dims.rotor_bottom_level, dims.core_top_level),
    ]
    if dims.rotor_bottom_level > dims.hub_top_level:
        core.append(cylinder(dims.collar_radius, dims.hub_top_level, dims.rotor_top_level))
    top, places = dims.rotor_top_level, pin_places(dims)
    radius = 0.5 * dims.pin_foot_diameter if places else 0.0
    pins = [cylinder(radius, top, pin_foot_level(dims), at) for at in places]
    feet = [(dims.core_radius, (0.0, 0.0)), *((radius, at) for at in places)]
    pins += [foot(radius, dims.foot_fillet, top, at) for radius, at in feet]
    holes = [*_screw_holes(dims), *_dowel_holes_in_rotor(dims)]
    return join(plate, [*core, *pins, *added]).cut(*holes, *openings)


def _screw_holes(dims: Dimensions) -> list[cq.Shape]:
    """Draw the core's holes for the screws of retainer and link, and the slot for the link's spigot."""
    top, bottom, point = dims.link_screw_mouth_level, dims.core_bottom_level, dims.drill_point_ratio
    holes = blind_hole(dims.retainer_screw_hole, bottom, bottom + dims.retainer_screw_depth, point)
    for at in link_screws(dims):
        holes += blind_hole(dims.link_screw_hole, top, top - dims.link_screw_depth, point, at)
    if not dims.spigot_depth:
        return holes
    width = dims.spigot_width - dims.slip_clearance
    return [*holes, tapered_bar(dims.core_radius + 1.0, width, dims.spigot_angle, top, dims.core_top_level)]


def link(dims: Dimensions) -> cq.Shape:
    """Draw output link: an obround from the core to the housing's edge, with its spigot, and its holes for screws,
    dowel pins and a tool."""
    bottom, top = dims.link_bottom_level, dims.link_bottom_level + dims.link_thickness
    lowest = bottom - dims.spigot_depth
    holes = [cylinder(0.5 * dims.link_screw_clearance, lowest, top, at) for at in link_screws(dims)]
    holes += [cylinder(0.5 * dims.link_dowel_diameter, bottom, top, at) for at in link_dowels(dims)]
    tool_hole = cylinder(0.5 * dims.link_tool_hole, bottom, top, (dims.link_length, 0.0))
    plate = slot(dims.link_half_width, dims.link_length, bottom, top)
    if dims.spigot_depth:
        plate = join(plate, [tapered_bar(dims.spigot_reach, dims.spigot_width, dims.spigot_angle, lowest, bottom)])
    return plate.cut(tool_hole, *holes)


def retainer(dims: Dimensions) -> cq.Shape:
    """Draw the disc below the floor, screwed to the core, that keeps the rotor in the housing."""
    top = dims.retainer_top_level
    return ring(0.5 * dims.retainer_screw_clearance, dims.retainer_radius, top - dims.retainer_thickness, top)


def link_screws(dims: Dimensions) -> list[tuple[float, float]]:
    """Return the axes of the screws that hold the link on the core: four, or one on the axis."""
    circle = dims.link_bolt_circle_radius
    return [polar(circle, azimuth) for azimuth in _LINK_SCREW_AZIMUTHS] if circle else [(0.0, 0.0)]


def link_dowels(dims: Dimensions) -> list[tuple[float, float]]:
    """Return the axes of the dowel pins between link and core; none where screws alone hold the link."""
    count = dims.count("dowels_fitted") if dims.dowels_fitted else 0
    return [polar(dims.link_dowel_circle_radius, azimuth) for azimuth in _DOWEL_AZIMUTHS[:count]]


def pin_places(dims: Dimensions) -> list[tuple[float, float]]:
    """Return the axes of the pins that the springs' legs bear on."""
    return [polar(dims.pin_radius, azimuth) for azimuth in dims.azimuths("spring_count")]


def leg_pins(dims: Dimensions) -> list[tuple[float, float]]:
    """Return the axes of the legs' dowel pins; none where the rotor's own pins stand there."""
    return pin_places(dims) if dims.leg_pins_fitted else []


def reamed_places(dims: Dimensions) -> list[tuple[float, float]]:
    """Return the axes of all holes that dowel pins are pressed into: print files have them as they are drawn."""
    return [*link_dowels(dims), *leg_pins(dims)]


def _dowel_holes_in_rotor(dims: Dimensions) -> list[cq.Shape]:
    """Draw what is cut from core and bosses for dowel pins."""
    core = dims.link_bottom_level
    holes = [(dims.link_dowel_diameter, core, dims.link_dowel_depth, at) for at in link_dowels(dims)]
    holes += [(dims.pin_diameter, pin_foot_level(dims), dims.leg_pin_depth, at) for at in leg_pins(dims)]
    return [
        hole
        for diameter, top, deep, at in holes
        for hole in blind_hole(diameter, top, top - deep, dims.drill_point_ratio, at)
    ]
