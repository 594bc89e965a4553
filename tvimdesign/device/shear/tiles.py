"""Rigid Peltier modules under the arcs, as they are bought: rectangular tiles in a row below a spreader.

A flexible module is cut to the outline of the PCL. A rigid one, or a sheet heater that is not cut, is a rectangle:
`tiles_per_arc` of them lie side by side under each arc, their length along the arc, on a radius at which their inner
edge and their outer corners are as far from the pocket's walls. A spreader of the PCL's outline lies on them, flush
with the floor, and takes their heat to what they do not cover. The pocket has the outline of the arc as for a sheet;
a window below each tile leaves it a ledge on all four sides. At each end of an arc a hole goes through the floor: one
for the tiles' leads, one for a thermistor under the spreader.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.clearances import quantities as gaps
from tvimdesign.device.core.heat.heater_form import WITH_TILES
from tvimdesign.device.core.layout import quantities as layout
from tvimdesign.device.core.mass_properties import quantities as bodies
from tvimdesign.device.core.materials import quantities as materials
from tvimdesign.device.table.quantity import Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import NOTHING, Section, disc_at, rectangle_at

places, weights, rules = (
    QuantityGroup(layout.group, WITH_TILES),
    QuantityGroup(bodies.group, WITH_TILES),
    QuantityGroup(gaps.group, WITH_TILES),
)
kinds = QuantityGroup(materials.group)
groups = (kinds, places, weights, rules)

kinds.option(
    "heater_wiring",
    ("series", "arcs_parallel", "all_parallel"),
    "How the Peltier modules are wired: all in series, the arcs in parallel each in series, or all in parallel",
)


@places.helper(requires=())
def pocket_count(arc_count: Scalar) -> Scalar:
    """Pockets for Peltier modules [1]: one under each arc."""
    return arc_count


@places.helper(requires=())
def tiles_per_pocket(tiles_per_arc: Scalar) -> Scalar:
    """Rectangular Peltier modules in each pocket [1]."""
    return tiles_per_arc


@places.helper()
def tile_reach(pcl_outer_radius: Scalar, peltier_length: Scalar) -> Scalar:
    """Distance from the axis at which the outer corners of a tile would touch the pocket's outer wall [m]."""
    least = 0.1 * pcl_outer_radius
    return np.sqrt(np.fmax(pcl_outer_radius**2 - 0.25 * peltier_length**2, least**2))


@places.output("mm")
def tile_radius(pcl_inner_radius: Scalar, tile_reach: Scalar) -> Scalar:
    """Distance of the tiles' middles from the axis: inner edge and outer corners have the same room."""
    return 0.5 * (pcl_inner_radius + tile_reach)


@places.output("deg")
def lead_angle(lead_hole_diameter: Scalar, tile_clearance: Scalar, pcl_inner_radius: Scalar) -> Scalar:
    """Angle at each end of an arc that is left to a hole for leads or the thermistor's."""
    return (lead_hole_diameter + 2.0 * tile_clearance) / pcl_inner_radius


@places.output("deg")
def tile_pitch(arc_span: Scalar, lead_angle: Scalar, tiles_per_arc: Scalar) -> Scalar:
    """Angle from one tile of an arc to the next."""
    return (arc_span - 2.0 * lead_angle) / tiles_per_arc


@weights.helper(default=NOTHING)
def tile_section(heater_count: Scalar, peltier_length: Scalar, peltier_width: Scalar, tile_radius: Scalar) -> Section:
    """Plan view of all tiles."""
    return rectangle_at(peltier_width, peltier_length, tile_radius).times(heater_count)


@weights.helper(default=NOTHING)
def lead_hole_section(arc_count: Scalar, lead_hole_diameter: Scalar, tile_radius: Scalar) -> Section:
    """Plan view of the holes for leads and thermistors: two below each arc."""
    return disc_at(0.5 * lead_hole_diameter, tile_radius).times(2.0 * arc_count)


@weights.output("mm^3")
def spreader_volume(pad_section: Section, spreader_depth: Scalar) -> Scalar:
    """Volume of all spreaders together; zero without."""
    return pad_section.area * spreader_depth


@rules.output("mm", at_least(0.0, "a Peltier module is too wide for its arc: choose a smaller one, or a wider arc"))
def tile_radial_margin(
    tile_reach: Scalar, pcl_inner_radius: Scalar, peltier_width: Scalar, tile_clearance: Scalar
) -> Scalar:
    """Gap of a tile's inner edge and outer corners to the walls of its pocket, beyond the least."""
    return 0.5 * (tile_reach - pcl_inner_radius - peltier_width) - tile_clearance


@rules.output("mm", at_least(0.0, "the Peltier modules of an arc overlap: choose fewer, or a longer arc"))
def tile_side_margin(
    tile_radius: Scalar, tile_pitch: Scalar, peltier_length: Scalar, peltier_width: Scalar, tile_clearance: Scalar
) -> Scalar:
    """Gap between the inner corners of neighbouring tiles beyond the least; at an arc's end, between tile and hole."""
    inner = tile_radius - 0.5 * peltier_width
    return 2.0 * inner * np.sin(0.5 * tile_pitch) - peltier_length * np.cos(0.5 * tile_pitch) - tile_clearance
