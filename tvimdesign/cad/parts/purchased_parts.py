"""What is bought for all modes: screws, ball bearings and a wave spring, drawn as simply as the table counts them,
and placed."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import cylinder, join, polar, ring, turned
from tvimdesign.cad.parts.common_parts import LINK_SCREW_AZIMUTHS


def link_screw(dims: Dimensions) -> cq.Shape:
    """The first of the screws that hold the link: its shank as thick as its hole in the core, its head a cylinder."""
    at = polar(dims.link_bolt_circle_radius, LINK_SCREW_AZIMUTHS[0])
    top = dims.link_bottom_level + dims.link_thickness
    shank = cylinder(0.5 * dims.link_screw_pilot, top - dims.link_screw_length, top, at)
    return join(shank, [cylinder(0.5 * dims.link_screw_head, top, top + dims.link_screw_head_height, at)])


def retainer_screw(dims: Dimensions) -> cq.Shape:
    """The screw that holds the retainer, from below."""
    bottom = dims.retainer_top_level - dims.retainer_thickness
    shank = cylinder(0.5 * dims.retainer_screw_pilot, bottom, bottom + dims.retainer_screw_length)
    head = cylinder(0.5 * dims.retainer_screw_head, bottom - dims.retainer_screw_head_height, bottom)
    return join(shank, [head])


def bearing_inner(dims: Dimensions) -> cq.Shape:
    """What turns of the upper bearing."""
    top = dims.hub_top_level
    return ring(dims.bearing_bore_radius, _middle(dims), top - dims.bearing_width, top)


def bearing_outer(dims: Dimensions) -> cq.Shape:
    """What stands of the upper bearing."""
    top = dims.hub_top_level
    return ring(_middle(dims), dims.bearing_outer_radius, top - dims.bearing_width, top)


def preload_spring(dims: Dimensions) -> cq.Shape:
    """The wave spring at its working height, as a plain ring."""
    top = dims.preload_spring_level
    inner, outer = dims.preload_inner_radius, dims.preload_outer_radius
    return ring(inner, outer, top - dims.preload_height, top)


def drawn(dims: Dimensions) -> dict[str, Callable[[Dimensions], cq.Shape]]:
    """How one of each kind is drawn, of what this module has."""
    found: dict[str, Callable[[Dimensions], cq.Shape]] = {"link_screw": link_screw, "retainer_screw": retainer_screw}
    if dims.bearing_width:
        found |= {"bearing_inner": bearing_inner, "bearing_outer": bearing_outer}
    if dims.preload_height:
        found["preload_spring"] = preload_spring
    return found


def stand(dims: Dimensions, solids: Mapping[str, cq.Solid], rotor_angle: float) -> dict[str, cq.Shape]:
    """Place what is bought, the rotor at an angle [rad], by name."""
    first = LINK_SCREW_AZIMUTHS[0]
    placed: dict[str, cq.Shape] = {
        f"link_screw_{index + 1}": turned(solids["link_screw"], rotor_angle + azimuth - first)
        for index, azimuth in enumerate(LINK_SCREW_AZIMUTHS)
    }
    placed["retainer_screw"] = turned(solids["retainer_screw"], rotor_angle)
    if dims.preload_height:
        placed["preload_spring"] = turned(solids["preload_spring"], 0.0)
    if dims.bearing_width:
        down = cq.Location(cq.Vector(0, 0, dims.bearing_width - (dims.hub_top_level - dims.hub_bottom_level)))
        for kind, angle in (("bearing_inner", rotor_angle), ("bearing_outer", 0.0)):
            placed[f"{kind}_1"] = turned(solids[kind], angle)
            placed[f"{kind}_2"] = turned(solids[kind].moved(down), angle)
    return placed


def _middle(dims: Dimensions) -> float:
    """Radius at which a bearing is divided into what turns and what stands."""
    return 0.5 * (dims.bearing_bore_radius + dims.bearing_outer_radius)
