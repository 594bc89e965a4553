"""Rigid Peltier modules under the arcs, as they are bought: rectangular tiles in a row below a spreader.

A flexible module is cut to the outline of the PCL. A rigid one, or a sheet heater that is not cut, is a rectangle:
`tiles_per_arc` of them lie side by side under each arc, their length along the arc, on a radius at which their inner
edge and their outer corners are as far from the pocket's walls. A spreader of the PCL's outline lies on them, flush
with the floor, and takes their heat to what they do not cover. The pocket has the outline of the arc as for a sheet;
a window below each tile leaves its colder plate a ledge on all four sides. At one end of an arc a hole goes through
the floor for a thermistor under the spreader; slots for leads are in `leads.py`.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.heat.heater_form import WITH_TILES
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.solids.shapes import NOTHING, Section, rectangle_at

places, weights, rules = (
    QuantityGroup("Layout", WITH_TILES),
    QuantityGroup("Size and weight", WITH_TILES),
    QuantityGroup("Gaps", WITH_TILES),
)
kinds = QuantityGroup("Materials")

kinds.option(
    "heater_wiring",
    ("series", "arcs_parallel", "all_parallel"),
    "How the Peltier modules are wired: all in series, the arcs in parallel each in series, or all in parallel",
)


@places.helper(requires=())
def pocket_count(m: Module) -> Scalar:
    """Pockets for Peltier modules [1]: one under each arc."""
    return m.arc_count


@places.helper(requires=())
def tiles_per_pocket(m: Module) -> Scalar:
    """Rectangular Peltier modules in each pocket [1]."""
    return m.tiles_per_arc


@places.helper()
def tile_reach(m: Module) -> Scalar:
    """Distance from the axis at which the outer corners of a tile would touch the pocket's outer wall [m]."""
    least = 0.1 * m.pcl_outer_radius
    return np.sqrt(np.fmax(m.pcl_outer_radius**2 - 0.25 * m.peltier_length**2, least**2))


@places.output("mm")
def tile_radius(m: Module) -> Scalar:
    """Distance of the tiles' middles from the axis: inner edge and outer corners have the same room."""
    return 0.5 * (m.pcl_inner_radius + m.tile_reach)


@places.output("deg")
def lead_angle(m: Module) -> Scalar:
    """Angle at each end of an arc that is left to a thermistor's hole."""
    return (m.lead_hole_diameter + 2.0 * m.tile_clearance) / m.pcl_inner_radius


@places.output("deg")
def tile_pitch(m: Module) -> Scalar:
    """Angle from one tile of an arc to the next."""
    return (m.arc_span - 2.0 * m.lead_angle) / m.tiles_per_arc


@weights.helper(default=NOTHING)
def tile_section(m: Module) -> Section:
    """Plan view of all tiles, of their longer plate."""
    return rectangle_at(m.peltier_width, m.peltier_length, m.tile_radius).times(m.heater_count)


@places.output("mm")
def cold_plate_length(m: Module) -> Scalar:
    """Length of a tile's colder plate, which lies on the ledges of its window: a porch shorter than the other one."""
    return m.peltier_length - m.peltier_porch


@weights.output("mm^3")
def spreader_volume(m: Module) -> Scalar:
    """Volume of all spreaders together; zero without."""
    return m.pad_section.area * m.spreader_depth


@rules.output("mm", at_least(0.0, "a Peltier module is too wide for its arc: choose a smaller one, or a wider arc"))
def tile_radial_margin(m: Module) -> Scalar:
    """Gap of a tile's inner edge and outer corners to the walls of its pocket, beyond the least."""
    return 0.5 * (m.tile_reach - m.pcl_inner_radius - m.peltier_width) - m.tile_clearance


@rules.output("mm", at_least(0.0, "the Peltier modules of an arc overlap: choose fewer, or a longer arc"))
def tile_side_margin(m: Module) -> Scalar:
    """Gap between the inner corners of neighbouring tiles beyond the least; at an arc's end, between tile and hole."""
    inner = m.tile_radius - 0.5 * m.peltier_width
    return 2.0 * inner * np.sin(0.5 * m.tile_pitch) - m.peltier_length * np.cos(0.5 * m.tile_pitch) - m.tile_clearance
