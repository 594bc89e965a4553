"""Leads of the heaters under the arcs: how they bend, and the way they go down through the floor.

Both leads of a module leave one end of it side by side, at half its height. They bend down by `lead_bend_radius` and
back again, and run on along the ground below the floor. A slot beside that end of each module is as long as this bend
needs. The module's colder plate ends a porch before that end, on which the leads are soldered.

The leads of a pad lie on its outer face, in the middle of the window: one at either end of this, its bend towards that
end. They run on along the floor's lower face, above the thermal cut-out.
"""

import numpy as np

from tvimdesign.device.core.heater_form import CUT, LEADS, WITH_PADS, WITH_TILES
from tvimdesign.device.table import Module, QuantityGroup, Scalar
from tvimdesign.physics.solids.shapes import NOTHING, Section, disc_at, rectangle_at

_CUTTER = 2.2  # Least width of a slot over the radius of its corners
_LEAST = 0.05  # Share of a size below which roots are not taken: their slopes have no bound at zero

places = QuantityGroup("Layout")
slots = QuantityGroup("Layout", WITH_TILES)
slot_weights = QuantityGroup("Size and weight", WITH_TILES)
weights = QuantityGroup("Size and weight")
rules = QuantityGroup("Gaps")
slot_rules = QuantityGroup("Gaps", WITH_TILES)


@places.output("mm", hidden=True)
def lead_level(m: Module) -> Scalar:
    """Level at which the leads leave a heater: half a tile's height, or on the outer face of a pad."""
    if m.heater_form == CUT:
        return -m.pad_depth - 0.5 * m.lead_diameter
    return -m.spreader_depth - 0.5 * m.heater_thickness


def _to_floor(m: Module) -> Scalar:
    """Return the height from the level at which leads leave a heater to the one at which they touch the floor [m]."""
    return m.lead_level + m.floor_thickness + 0.5 * m.lead_diameter


@places.output("mm")
def lead_bend_radius(m: Module) -> Scalar:
    """Radius to which the leads of a heater are bent, along their middle: two quarter turns bring a pad's through."""
    least = (m.lead_bend_ratio + 0.5) * m.lead_diameter
    return np.fmax(least, 0.5 * (_to_floor(m) + m.lead_clearance)) if m.heater_form == CUT else least


@places.output("mm", hidden=True)
def lead_drop(m: Module) -> Scalar:
    """Height by which the leads go down: of a tile to the ground, but no further than their two bends reach."""
    if m.heater_form == CUT:
        return _to_floor(m) + m.lead_clearance
    to_ground = _to_floor(m) + m.foot_height - m.lead_diameter
    return np.fmin(np.fmax(to_ground, _LEAST * m.lead_bend_radius), 2.0 * m.lead_bend_radius)


@places.output("deg")
def lead_bend_angle(m: Module) -> Scalar:
    """Angle of each of a lead's two bends."""
    return np.arccos(1.0 - 0.5 * m.lead_drop / m.lead_bend_radius)


@places.output("mm", hidden=True)
def lead_way(m: Module) -> Scalar:
    """Length that a lead takes until it is below the floor."""
    run = 2.0 * m.lead_bend_radius * np.sin(m.lead_bend_angle)
    if m.heater_form == CUT:
        return run
    inside = m.lead_bend_radius - 0.5 * m.lead_diameter
    above = np.fmax(m.lead_level - m.lead_drop + m.lead_bend_radius + m.floor_thickness, 0.0)
    return run - np.sqrt(np.fmax(inside**2 - above**2, (_LEAST * inside) ** 2))


@places.output("mm", requires=WITH_PADS)
def lead_start(m: Module) -> Scalar:
    """Length of arc from the middle of a pad to where its leads leave it, towards its ends; zero with tiles."""
    return 0.5 * m.window_span * m.pcl_mean_radius - m.lead_way


@rules.gap("a pad's leads have no room in its window: less window_ledge, thinner leads", requires=WITH_PADS)
def lead_window_margin(m: Module) -> Scalar:
    """Room of a straight lead in the window of its pad, beside it or to the other one; zero with tiles."""
    beside = 0.5 * (m.window_depth - m.lead_diameter) - m.lead_way**2 / (8.0 * m.pcl_mean_radius)
    tilt = (m.lead_start + 0.5 * m.lead_way) / m.pcl_mean_radius
    return np.fmin(beside, m.lead_start - 0.5 * m.lead_diameter * tilt) - m.lead_clearance


@slots.output("mm")
def lead_slot_length(m: Module) -> Scalar:
    """Length of the slot that the leads go down through, from the end of their heater."""
    return np.fmax(m.lead_way + m.tile_clearance, _CUTTER * m.corner_radius)


@slots.output("mm")
def lead_slot_width(m: Module) -> Scalar:
    """Width of that slot: both leads go through it side by side."""
    return np.fmax(LEADS * m.lead_hole_diameter, _CUTTER * m.corner_radius)


def _slot_end(m: Module) -> Scalar:
    """Return how far from the middle of its module a slot ends, along the module [m]."""
    return 0.5 * m.heater_length + m.lead_slot_length


@slots.output("mm")
def lead_slot_radius(m: Module) -> Scalar:
    """Distance of that slot's middle from the axis, across its module: behind its middle, or as the arc allows."""
    least = 0.1 * m.pcl_outer_radius
    reach = np.sqrt(np.fmax(m.pcl_outer_radius**2 - _slot_end(m) ** 2, least**2))
    return np.fmin(m.tile_radius, reach - 0.5 * m.lead_slot_width)


@slot_weights.helper(default=NOTHING)
def lead_hole_section(m: Module) -> Section:
    """Plan view of the slots for leads, one beside each module, and of the thermistors' holes, one below each arc."""
    along = 0.5 * m.heater_length + 0.5 * m.lead_slot_length
    away = np.sqrt(m.lead_slot_radius**2 + along**2)
    slots = rectangle_at(m.lead_slot_width, m.lead_slot_length, away, m.corner_radius).times(m.heater_count)
    return slots.plus(disc_at(0.5 * m.lead_hole_diameter, m.tile_radius).times(m.arc_count))


@weights.output("mm^3")
def lead_volume(m: Module) -> Scalar:
    """Volume of all leads of heaters between these and the ground below the floor."""
    section = 0.25 * np.pi * m.lead_diameter**2
    return LEADS * m.heater_count * section * 2.0 * m.lead_bend_radius * m.lead_bend_angle


rules.margins("leads")


@slot_rules.gap("the slot for the leads reaches beyond the arc's end: a longer arc")
def lead_slot_end_margin(m: Module) -> Scalar:
    """Room between the far corner of the slot for the leads and the end of its arc."""
    half = 0.5 * (m.arc_span - (m.tiles_per_arc - 1.0) * m.tile_pitch)
    return (m.lead_slot_radius - 0.5 * m.lead_slot_width) * np.sin(half) - _slot_end(m) * np.cos(half)


@slot_rules.gap("the slot for the leads lies below the next heater: fewer, or a longer arc")
def lead_tile_margin(m: Module) -> Scalar:
    """Gap of that slot to the next heater of its arc beyond the least; zero for one module an arc."""
    inner, pitch = m.lead_slot_radius - 0.5 * m.lead_slot_width, m.tile_pitch
    beyond = inner * np.sin(pitch) - _slot_end(m) * np.cos(pitch) - 0.5 * m.heater_length
    return np.fmin(m.tiles_per_arc - 1.0, 1.0) * (beyond - m.tile_clearance)
