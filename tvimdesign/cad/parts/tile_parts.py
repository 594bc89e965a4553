"""Rectangular Peltier modules under the arcs, the spreader on them, and what the floor opens for them."""

from __future__ import annotations

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import block, cylinder, polar, rounded, sector, turned


def tile(dims: Dimensions) -> cq.Shape:
    """One tile on the x axis, its length across that."""
    half = 0.5 * dims.peltier_width
    along_x = (dims.tile_radius - half, dims.tile_radius + half)
    return block(along_x, dims.peltier_length, -dims.pad_depth, -dims.spreader_depth)


def spreader(dims: Dimensions) -> cq.Shape:
    """One spreader on the tiles of an arc, centred on the x axis, flush with the floor."""
    sharp = sector(dims.pcl_inner_radius, dims.pcl_outer_radius, dims.arc_span, -dims.spreader_depth, 0)
    return rounded(sharp, dims.corner_radius)


def azimuths(dims: Dimensions) -> list[float]:
    """Azimuths [rad] of an arc's tiles from its middle."""
    count = dims.count("tiles_per_arc")
    return [dims.tile_pitch * (index - 0.5 * (count - 1)) for index in range(count)]


def openings(dims: Dimensions) -> list[cq.Shape]:
    """What goes through the floor below the pocket of one arc: a window below each tile, holes for leads."""
    top, bottom = -dims.pad_depth, -dims.floor_thickness
    half = 0.5 * dims.peltier_width - dims.window_ledge
    along_x = (dims.tile_radius - half, dims.tile_radius + half)
    window = rounded(block(along_x, dims.peltier_length - 2.0 * dims.window_ledge, bottom, top), dims.corner_radius)
    ends = 0.5 * (dims.arc_span - dims.lead_angle)
    holes = [cylinder(0.5 * dims.lead_hole_diameter, bottom, top, polar(dims.tile_radius, at)) for at in (-ends, ends)]
    return [*(turned(window, azimuth) for azimuth in azimuths(dims)), *holes]


DRAWN = {"spreader": spreader}
