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

from tvimdesign.base.errors import InputError
from tvimdesign.base.record import Record
from tvimdesign.device.core.clearances import quantities as gaps
from tvimdesign.device.core.layout import quantities as layout
from tvimdesign.device.core.mass_properties import quantities as bodies
from tvimdesign.device.core.materials import quantities as materials
from tvimdesign.device.table.quantity import Feature, Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import NOTHING, Section, disc_at, rectangle_at

CUT = "flexible"
WITH_TILES = (Feature("heater_form", CUT),)

kinds = QuantityGroup(materials.group)
places, weights, rules = (
    QuantityGroup(layout.group, WITH_TILES),
    QuantityGroup(bodies.group, WITH_TILES),
    QuantityGroup(gaps.group, WITH_TILES),
)
groups = (kinds, places, weights, rules)

kinds.option(
    "heater_form",
    (CUT, "rigid"),
    "How the Peltier modules lie under the arcs: cut to their outline, or as rectangles below a spreader",
    record=("peltier_module", "form"),
)
kinds.option(
    "heater_wiring",
    ("series", "arcs_parallel", "all_parallel"),
    "How the Peltier modules are wired: all in series, the arcs in parallel each in series, or all in parallel",
)
kinds.record(
    "spreader_material", "spreaders", "aluminum_6061", "Sheet between rigid Peltier modules and the PCL",
    requires=WITH_TILES,
)  # fmt: skip
for name, unit, field, description in (
    ("peltier_length", "mm", "length", "Length of one rectangular Peltier module, along the arc"),
    ("peltier_width", "mm", "width", "Width of one rectangular Peltier module, across the arc"),
):
    kinds.property(name, unit, ("peltier_module", field), description, mode="shear", default=0.0)
for name, unit, field, description in (
    ("spreader_density", "kg/m^3", "density", "Density of the spreader"),
    ("spreader_conductivity", "W/m/K", "thermal_conductivity", "Thermal conductivity of the spreader"),
    ("spreader_specific_heat", "J/kg/K", "specific_heat", "Specific heat of the spreader"),
    ("spreader_shear_modulus", "GPa", "shear_modulus", "Shear modulus of the spreader"),
    ("spreader_youngs_modulus", "GPa", "youngs_modulus", "Young's modulus of the spreader"),
):
    kinds.property(name, unit, ("spreader_material", field), description, mode="shear")


@places.output("1", default=1.0, requires=())
def heater_count(heater_form: str, peltier_module: Record, arc_count: Scalar, tiles_per_arc: Scalar) -> Scalar:
    """Peltier modules of the module: one pad under each arc, or all its tiles."""
    if heater_form != CUT:
        return arc_count * tiles_per_arc
    if peltier_module.word("form") != CUT:
        raise InputError(f"heater_form: {CUT} needs a module that can be cut; {peltier_module.name} is rigid")
    return arc_count


@places.output("mm")
def spreader_depth(spreader_thickness: Scalar) -> Scalar:
    """Depth the spreader takes of the pocket below the PCL; zero without one."""
    return spreader_thickness


@places.output("mm", requires=())
def pad_depth(peltier_thickness: Scalar, spreader_depth: Scalar) -> Scalar:
    """Depth of the pockets for the Peltier modules and the spreader on them."""
    return peltier_thickness + spreader_depth


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


@weights.output("g")
def spreader_mass(spreader_volume: Scalar, spreader_density: Scalar) -> Scalar:
    """Mass of all spreaders together; zero without."""
    return spreader_volume * spreader_density


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
