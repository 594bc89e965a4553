"""Rectangular Peltier modules in the housing's vanes, the spreader before them, and the slots behind them."""

from __future__ import annotations

import cadquery as cq

from tvimdesign.cad.geometry.dimensions import Dimensions
from tvimdesign.cad.geometry.solids import block, rounded, wedge


def tile(dims: Dimensions) -> cq.Shape:
    """One tile, upright, its middle on the axis and its length along x."""
    half, bottom = 0.5 * dims.peltier_length, dims.running_clearance
    return block((-half, half), dims.peltier_thickness, bottom, bottom + dims.peltier_width)


def spreader(dims: Dimensions) -> cq.Shape:
    """One spreader, upright along the x axis: the face of a block."""
    along = (dims.pcl_inner_radius, dims.pcl_outer_radius)
    return block(along, dims.spreader_depth, dims.running_clearance, dims.vane_height)


def row(dims: Dimensions) -> list[float]:
    """Distances of a row's tiles from the axis, along the face of their vane."""
    count = dims.count("tiles_per_block")
    return [dims.pcl_inner_radius + dims.tile_spacing * (index + 0.5) for index in range(count)]


def slots(dims: Dimensions) -> list[cq.Shape]:
    """The slots of a vane on the x axis, one behind each tile: wider below the tiles, by their rounded corners."""
    bottom, seat, top = -dims.floor_thickness, dims.running_clearance, dims.slot_top_level
    feet = [rounded(foot, dims.corner_radius) for foot in _wedges(dims, dims.pad_seat, bottom, seat)]
    return [foot.fuse(upper) for foot, upper in zip(feet, _wedges(dims, dims.pad_depth, seat, top), strict=True)]


def _wedges(dims: Dimensions, inset: float, bottom: float, top: float) -> list[cq.Solid]:
    """What a vane has not got behind its tiles between two levels, so far behind its faces."""
    count, half = dims.count("tiles_per_block"), 0.5 * dims.slot_width
    middles = [dims.tile_slot_radius + dims.tile_slot_pitch * (index - 0.5 * (count - 1)) for index in range(count)]
    return [wedge((at - half, at + half), dims.housing_vane_angle, inset, bottom, top) for at in middles]


DRAWN = {"spreader": spreader}
