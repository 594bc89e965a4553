"""The thermistor by the layer: its bead at the end of a pad or below a spreader, and its hole in the floor."""

from __future__ import annotations

from collections.abc import Callable

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import cylinder, polar


def bead(dims: Dimensions) -> cq.Shape:
    """One bead of an arc that is centred on the x axis: beside the end of its pad, or below its spreader."""
    radius, top = 0.5 * dims.thermistor_diameter, -dims.spreader_depth
    ends = (top - dims.thermistor_length, top)
    if dims.spreader_depth:
        return cylinder(radius, *ends, polar(dims.tile_radius, 0.5 * (dims.arc_span - dims.lead_angle)))
    along, across = polar(1.0, 0.5 * dims.arc_span)
    x, y = polar(dims.thermistor_seat_radius, 0.5 * dims.arc_span)
    return cylinder(radius, *ends, (x - radius * across, y + radius * along))


def seats(dims: Dimensions) -> list[cq.Shape]:
    """The hole through the floor at the end of such an arc; none without a thermistor, and none below tiles."""
    if not dims.thermistor_seat_diameter:
        return []
    at = polar(dims.thermistor_seat_radius, 0.5 * dims.pocket_span)
    return [cylinder(0.5 * dims.thermistor_seat_diameter, -dims.floor_thickness, 0, at)]


def drawn(dims: Dimensions) -> dict[str, Callable[[Dimensions], cq.Shape]]:
    """How a bead is drawn, where a module has one: the shear module alone has the sizes."""
    return {"thermistor": bead if dims.mode == "shear" else standing} if dims.thermistor_diameter else {}


def standing(dims: Dimensions) -> cq.Shape:
    """The bead at the outer end of what stands behind a vane's face that is the x axis, the vane below that."""
    bottom = dims.running_clearance
    return cylinder(0.5 * dims.thermistor_diameter, bottom, bottom + dims.thermistor_length, _at_end(dims))


def hole_at_end(dims: Dimensions) -> list[cq.Shape]:
    """The hole below such a bead, through the floor and the sill of the vane; none without."""
    if not dims.thermistor_diameter:
        return []
    ends = (-dims.floor_thickness, dims.running_clearance)
    return [cylinder(0.5 * dims.thermistor_seat_diameter, *ends, _at_end(dims))]


def _at_end(dims: Dimensions) -> tuple[float, float]:
    half = 0.5 * dims.thermistor_diameter
    return dims.pcl_outer_radius + half, -half
