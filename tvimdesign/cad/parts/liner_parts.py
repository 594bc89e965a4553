"""Liners between PCL and rotor: sheets in recesses of the rotor plate, or of the faces of the rotor's vanes."""

from __future__ import annotations

from collections.abc import Callable

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import block, rounded, sector, turned

SIDES = (1.0, -1.0)
"""Of a vane's faces."""


def drawn(dims: Dimensions) -> dict[str, Callable[[Dimensions], cq.Shape]]:
    """How a liner is drawn, where a module has one."""
    if not dims.liner_depth:
        return {}
    return {"liner": _on_arc if dims.mode == "shear" else _on_vane}


def _on_arc(dims: Dimensions) -> cq.Shape:
    """The liner above an arc that is centred on the x axis, flush with the rotor plate: it goes in between the lips."""
    slip = dims.slip_clearance
    radii = (dims.pcl_inner_radius + slip, dims.pcl_outer_radius - slip)
    return _over_arc(dims, radii, dims.liner_span, dims.liner_thickness)


def recesses_over_arc(dims: Dimensions) -> list[cq.Shape]:
    """What the rotor plate lacks above such an arc; nothing without a liner."""
    if not dims.liner_depth:
        return []
    return [_over_arc(dims, (dims.pcl_inner_radius, dims.pcl_outer_radius), dims.arc_span, dims.liner_depth)]


def _over_arc(dims: Dimensions, radii: tuple[float, float], span: float, depth: float) -> cq.Shape:
    """A sector between two radii with the corners of a pad, so deep into the rotor plate."""
    levels = (dims.rotor_bottom_level, dims.rotor_bottom_level + depth)
    return rounded(sector(*radii, span, *levels), dims.corner_radius)


def _on_vane(dims: Dimensions) -> cq.Shape:
    """One liner, upright along the x axis: the face of a block."""
    along = (dims.pcl_inner_radius, dims.pcl_outer_radius)
    return block(along, dims.liner_thickness, dims.running_clearance, dims.running_clearance + dims.block_height)


def recesses_in_vane(dims: Dimensions) -> list[cq.Shape]:
    """What both faces of a rotor vane on the x axis lack, open below and at both ends; nothing without liners."""
    if not dims.liner_depth:
        return []
    more, top = dims.liner_depth, dims.running_clearance + dims.block_height
    along = (dims.pcl_inner_radius - more, dims.pcl_outer_radius + more)
    plate = block(along, dims.liner_depth, 0.0, top)
    return [turned(plate, *_behind_face(dims, side, dims.liner_depth)) for side in SIDES]


def on_vane(dims: Dimensions, liner: cq.Solid, azimuth: float) -> list[cq.Shape]:
    """The two liners of a rotor vane at an azimuth [rad], flush with its faces."""
    places = [_behind_face(dims, side, dims.liner_thickness) for side in SIDES]
    return [turned(liner, azimuth + at, beside) for at, beside in places]


def _behind_face(dims: Dimensions, side: float, thickness: float) -> tuple[float, float]:
    """Azimuth of a face of a rotor vane, and how far beside it the middle of a sheet behind it lies."""
    return side * 0.5 * dims.rotor_vane_angle, -side * 0.5 * thickness
