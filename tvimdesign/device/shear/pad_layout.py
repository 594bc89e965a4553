"""Pads of the shear module in the floor: rigid modules as bought, pockets, and the thermistor beside them.

A flexible module is cut to the outline of the PCL. A rigid one, or a sheet heater that is not cut, is a rectangle:
`tiles_per_arc` of them lie side by side under each arc, their length along the arc, on a radius at which their inner
edge and their outer corners are as far from the pocket's walls. A spreader of the PCL's outline lies on them, flush
with the floor, and takes their heat to what they do not cover. The pocket has the outline of the arc as for a sheet;
a window below each tile leaves its colder plate a ledge on all four sides. At one end of an arc a hole goes through
the floor for a thermistor under the spreader; slots for leads are in `leads.py`.

A pocket has the outline of an arc, longer by a slip clearance at either end and wider by `heater_gap`, so that what
has that outline goes in.

Below a pad of an arc's outline there is no room, so a hole for the thermistor goes through the floor at the end of the
first arc, its middle on the end of the pad's pocket. Half of it lies beside the pocket: there the bead stands, touching
the pad's end, its top flush with the floor, below the end of the layer. Its wires go down through the hole. Tiles leave
room of their own: the bead stands below the spreader of each arc, over the hole that is there for its wires.
"""

import numpy as np

from tvimdesign.device.components.liner_and_adhesive import WITH_PADS
from tvimdesign.device.core.clearances import MM
from tvimdesign.device.core.heater_form import CUT, WITH_TILES
from tvimdesign.device.table import Module, QuantityGroup, Scalar, at_least
from tvimdesign.physics.solids.shapes import NOTHING, Section, disc_at, stacked

tile_places = QuantityGroup("Layout", WITH_TILES)
tile_weights = QuantityGroup("Size and weight", WITH_TILES)
tile_rules = QuantityGroup("Gaps", WITH_TILES)
kinds = QuantityGroup("Materials")

kinds.choices("pad_layout")


tile_places.same("pocket_count", "arc_count", "Pockets for heaters [1]: one under each arc", requires=())
tile_places.same("tiles_per_pocket", "tiles_per_arc", "Rectangular heaters in each pocket [1]", requires=())


@tile_places.helper()
def tile_reach(m: Module) -> Scalar:
    """Distance from the axis at which the outer corners of a tile would touch the pocket's outer wall [m]."""
    least = 0.1 * m.pcl_outer_radius
    return np.sqrt(np.fmax(m.pcl_outer_radius**2 - 0.25 * m.heater_length**2, least**2))


@tile_places.output("mm")
def tile_radius(m: Module) -> Scalar:
    """Distance of the tiles' middles from the axis: inner edge and outer corners have the same room."""
    return 0.5 * (m.pcl_inner_radius + m.tile_reach)


tile_places.formulas("pad_layout.tile_places")


@tile_places.output("deg")
def tile_pitch(m: Module) -> Scalar:
    """Angle from one tile of an arc to the next."""
    return (m.arc_span - 2.0 * m.lead_angle) / m.tiles_per_arc


@tile_weights.output("mm^3")
def spreader_volume(m: Module) -> Scalar:
    """Volume of all spreaders together; zero without."""
    return m.pad_section.area * m.spreader_depth


tile_rules.margins("pad_layout")


@tile_rules.gap("the heaters of an arc overlap: choose fewer, or a longer arc")
def tile_side_margin(m: Module) -> Scalar:
    """Gap between the inner corners of neighbouring tiles beyond the least; at an arc's end, between tile and hole."""
    inner = m.tile_radius - 0.5 * m.heater_width
    return 2.0 * inner * np.sin(0.5 * m.tile_pitch) - m.heater_length * np.cos(0.5 * m.tile_pitch) - m.tile_clearance


places = QuantityGroup("Layout")
rules = QuantityGroup("Gaps")
holds = QuantityGroup("Impedance")


places.formulas("pad_layout")


@rules.gap("the floor between two pads' pockets is thinner than can be made: shorter arcs")
def pocket_web_margin(m: Module) -> Scalar:
    """Floor between neighbouring pockets at their inner radius, beyond the process's least wall."""
    return (2.0 * np.pi / m.arc_count - m.pocket_span) * m.pocket_inner_radius - m.minimum_wall


@rules.output("mm", at_least(0.2 * MM, "a pad that lies against one wall of its pocket falls off the opposite ledge"))
def pad_ledge(m: Module) -> Scalar:
    """Width of what a pad, or a tile, lies on beside its window when it is pushed away from there."""
    return m.window_ledge - (m.slip_clearance if m.heater_form == CUT else m.tile_clearance)


@holds.output("MPa", requires=WITH_PADS)
def ledge_tension(m: Module) -> Scalar:
    """Tension that holds pads cut to the arcs on their ledges while the layer freezes: the adhesive there bears it.

    The layer pulls with `freezing_traction`, its highest, over all of it, and with no more than its bond bears.
    """
    glued = m.pad_section.area - m.window_section.area
    return np.fmin(m.freezing_traction, m.pcl_bond_strength) * m.pcl_area / glued


levels = QuantityGroup("Layout")


@levels.output("mm", hidden=True)
def rotor_bottom_level(m: Module) -> Scalar:
    """Lower face of the rotor plate, which lies on the layer."""
    return m.pcl_thickness


levels.same("pcl_depth", "pcl_thickness", "Way of heat and load through the PCL [m]")


ROOM = 2.3
"""Diameter of the seat over that of the bead: twice the bead, which stands in half of it, and what it is glued in."""

weights = QuantityGroup("Size and weight")


@places.output("1")
def thermistor_count(m: Module) -> Scalar:
    """Thermistors by the layer: one at the end of the first arc, or below the spreader of each."""
    return 1.0 if m.heater_form == CUT else m.arc_count


@places.output("mm")
def thermistor_seat_diameter(m: Module) -> Scalar:
    """Diameter of the hole for the thermistor at the end of an arc; zero without, and where tiles leave it room."""
    return ROOM * m.thermistor_diameter if m.heater_form == CUT else 0.0


@weights.helper(default=NOTHING)
def thermistor_seat_moments(m: Module) -> Section:
    """Volume of the thermistor's seat in the floor, half of it beside the pocket, and its polar moment.

    The end of a pocket points to the axis, so either half of the hole has half of its polar moment.
    """
    whole = disc_at(0.5 * m.thermistor_seat_diameter, m.thermistor_seat_radius)
    return stacked((whole.times(0.5), m.pad_depth), (whole, m.floor_web))


@weights.output("mm^3")
def thermistor_volume(m: Module) -> Scalar:
    """Volume of all thermistor beads together; zero without."""
    return m.thermistor_count * 0.25 * np.pi * m.thermistor_diameter**2 * m.thermistor_length


@rules.gap("the thermistor's seat leaves too thin a web to the window: a smaller bead, or a wider window_ledge")
def thermistor_window_gap(m: Module) -> Scalar:
    """Web between the thermistor's seat and the window below the pad, beyond the least wall where there is a seat."""
    ledge = m.thermistor_seat_radius * np.sin((m.window_ledge + m.slip_clearance) / m.pcl_inner_radius)
    wall = np.fmin(m.hole_wall, m.thermistor_seat_diameter)
    return np.fmax(ledge, wall) - wall - 0.5 * m.thermistor_seat_diameter


@rules.gap("the thermistor's seat leaves too thin a web to the next arc: a smaller bead, or shorter arcs")
def thermistor_arc_gap(m: Module) -> Scalar:
    """Web between the thermistor's seat and the next arc's pocket, beyond the least wall where there is a seat."""
    to_next = m.thermistor_seat_radius * np.sin(np.fmin(2.0 * np.pi / m.arc_count - m.pocket_span, 0.5 * np.pi))
    wall = np.fmin(m.hole_wall, m.thermistor_seat_diameter)
    return np.fmax(to_next, wall) - wall - 0.5 * m.thermistor_seat_diameter
