"""Volume, mass and inertia of the parts that all modes have, from the dimensions the solids are built from."""

import numpy as np

from tvimdesign.device.table import Module, QuantityGroup, Scalar
from tvimdesign.physics.solids import shapes
from tvimdesign.physics.solids.shapes import Section

quantities = QuantityGroup("Size and weight")


def template_volume(m: Module) -> Scalar:
    """Volume of {it}."""
    return m.template_moments.area


def template_mass(m: Module) -> Scalar:
    """Mass of {it}."""
    return m.template_volume * m.template_density


def template_made_mass(m: Module) -> Scalar:
    """Mass of {it}."""
    return m.template_volume * m.structure_density


def template_made_inertia(m: Module) -> Scalar:
    """Moment of inertia of {it}."""
    return m.template_moments.polar * m.structure_density


@quantities.output("mm", sprung=True)
def helix_length(m: Module) -> Scalar:
    """Length of the wire in the coils of one spring."""
    return m.coil_count * np.sqrt((np.pi * m.coil_diameter) ** 2 + m.coil_pitch**2)


@quantities.output("mm", sprung=True)
def wire_length(m: Module) -> Scalar:
    """Length of the wire of one spring: leg, coils, quarter bend and tang."""
    # The leg rises with the helix, so it is a little longer than its plan view; the bend turns from the helix to -z.
    leg = m.leg_length * np.sqrt(1.0 + m.helix_slope**2)
    bend = m.tang_bend_radius * (0.5 * np.pi - np.arctan(m.helix_slope))
    return leg + m.helix_length + bend + m.tang_length


@quantities.output("mm^3", sprung=True)
def spring_volume(m: Module) -> Scalar:
    """Volume of one spring."""
    return 0.25 * np.pi * m.wire_diameter**2 * m.wire_length


@quantities.helper()
def skirt_moments(m: Module) -> Section:
    """Volume and its polar moment about the axis, of what stands below the floor: skirt, notches and feet."""
    skirt = shapes.ring(m.housing_inner_radius, m.housing_outer_radius)
    notches = shapes.notch(0.5 * m.notch_width, m.housing_inner_radius, m.housing_outer_radius).times(m.foot_count)
    foot = shapes.disc_at(m.mount_boss_radius, m.placement_radius) - shapes.disc_at(
        0.5 * m.mount_hole, m.placement_radius
    )
    return (skirt - notches).plus(foot.times(m.foot_count)).times(m.foot_height)


@quantities.helper()
def hub_moments(m: Module) -> Section:
    """Volume and its polar moment about the axis, of the hub from its lower to its upper end."""
    seats = m.upper_seat_depth + m.lower_seat_depth
    between = m.hub_top_level - m.hub_bottom_level - seats
    return shapes.stacked(
        (shapes.ring(m.seat_radius, m.hub_radius), seats), (shapes.ring(m.lip_radius, m.hub_radius), between)
    )


@quantities.helper()
def floor_moments(m: Module) -> Section:
    """Volume and its polar moment about the axis, of the floor around the hub, less holes and the mode's openings."""
    holes = shapes.disc_at(0.5 * m.mount_hole, m.placement_radius).plus(m.spring_hole_section)
    solid = shapes.ring(m.hub_radius, m.housing_outer_radius) - holes.times(m.foot_count)
    return solid.times(m.floor_thickness) - m.floor_openings


@quantities.helper()
def bare_housing_moments(m: Module) -> Section:
    """Volume and its polar moment about the axis, of the housing without what the mode adds.

    That is skirt and floor, wall, hub, posts, bosses, stops.
    """
    wall = shapes.ring(m.housing_inner_radius, m.housing_outer_radius).times(m.rim_level)
    return wall.plus(
        m.skirt_moments if m.housing_base == "one_piece" else shapes.NOTHING,
        m.floor_moments,
        m.hub_moments,
        m.fixed_posts_moments,
        m.cover_bosses_moments,
        m.stop_posts_moments,
    )


@quantities.helper()
def bare_rotor_moments(m: Module) -> Section:
    """Volume and its polar moment about the axis, of plate, core and pins less screw and dowel holes."""
    screws = shapes.disc_at(0.5 * m.link_screw_hole, m.link_bolt_circle_radius)
    return shapes.stacked(
        (shapes.ring(m.core_radius, m.rotor_radius).plus(m.stop_teeth_section), m.rotor_thickness),
        (shapes.ring(0.0, m.core_radius), m.core_top_level - m.rotor_bottom_level),
        (shapes.ring(0.0, m.collar_radius), m.rotor_bottom_level - m.hub_top_level),
        (shapes.ring(0.0, m.journal_radius), m.hub_top_level - m.core_bottom_level),
        (m.pins_section, m.pin_foot_height),
        (m.leg_pin_section, -m.leg_pin_depth),
        (screws.times(m.link_screw_count), -m.link_screw_depth),
        (shapes.ring(0.0, 0.5 * m.retainer_screw_hole), -m.retainer_screw_depth),
        (m.link_dowel_section, -m.link_dowel_depth),
        (shapes.fillet_at_foot(m.core_radius, m.foot_fillet).plus(m.pin_fillets), 1.0),
        (_core_drill_points(m), -1.0),
        (m.spigot_slot_moments, -1.0),
    )


@quantities.helper(sprung=True, default=shapes.NOTHING)
def pins_section(m: Module) -> Section:
    """Plan view of the pins on the rotor plate, or of the bosses about dowel pins."""
    return shapes.disc_at(0.5 * m.pin_foot_diameter, m.pin_radius).times(m.spring_count)


@quantities.helper(sprung=True, default=shapes.NOTHING)
def pin_fillets(m: Module) -> Section:
    """Volume and its polar moment about the axis, of the fillets at the feet of the pins."""
    of_pin = shapes.fillet_at_foot(0.5 * m.pin_foot_diameter, m.foot_fillet)
    return Section(of_pin.area, of_pin.polar + of_pin.area * m.pin_radius**2).times(m.spring_count)


def _core_drill_points(m: Module) -> Section:
    """Return the volume and its polar moment about the axis, of the points of the rotor's blind holes; nothing where
    printed."""
    drilled = (
        (m.link_screw_hole, m.link_bolt_circle_radius, m.link_screw_count),
        (m.retainer_screw_hole, 0.0, 1.0),
        (m.link_dowel_diameter, m.link_dowel_circle_radius, m.dowels_fitted),
        (m.pin_diameter, m.pin_radius, m.leg_pins_fitted),
    )
    points = ((shapes.point_at(0.5 * wide, away).times(count), wide) for wide, away, count in drilled)
    return shapes.stacked(*((point, m.drill_point_ratio * wide) for point, wide in points))


@quantities.helper()
def link_section(m: Module) -> Section:
    """Plan view of the output link: an obround from the core to the housing's edge, less its holes."""
    screws = shapes.disc_at(0.5 * m.link_screw_clearance, m.link_bolt_circle_radius).times(m.link_screw_count)
    tool = shapes.disc_at(0.5 * m.link_tool_hole, m.link_length)
    return shapes.slot(m.link_half_width, m.link_length) - screws - tool - m.link_dowel_section


@quantities.helper()
def retainer_section(m: Module) -> Section:
    """Plan view of the retainer."""
    return shapes.ring(0.5 * m.retainer_screw_clearance, m.retainer_radius)


quantities.from_template("thermistor", "all thermistor beads together; zero without", template_mass, "g")
quantities.from_template(
    "housing",
    "the housing: skirt and floor, wall, hub and spring posts, and what its mode adds",
    template_volume,
    "mm^3",
)
quantities.from_template("rotor", "the rotor with its core and pins", template_volume, "mm^3")


quantities.formulas("mass_properties")


quantities.from_template("housing", "the housing", template_made_mass, "g", name="housing_mass")
quantities.from_template("rotor", "the rotor", template_made_mass, "g", name="rotor_mass")
quantities.from_template("link", "the output link", template_made_mass, "g", name="link_mass")
quantities.from_template("retainer", "the retainer", template_made_mass, "g", name="retainer_mass")


quantities.from_template("pcl", "all PCL together", template_mass, "g")


quantities.from_template("heater", "all heaters together", template_mass, "g")


@quantities.output("g", headline=True)
def module_mass(m: Module) -> Scalar:
    """Mass of the module with its motor, without wires beyond its floor and the screws that fix it."""
    made = m.housing_mass + m.rotor_mass + m.link_mass + m.retainer_mass + m.cover_mass + m.pcl_mass + m.base_mass
    fasteners = m.screws_mass + m.inserts_mass + m.dowels_mass
    heater = m.heater_mass + m.spreader_mass + m.lead_mass + m.thermistor_mass + m.cutout_mass
    bought = m.springs_mass + heater + m.liner_mass + fasteners + m.bearings_mass + m.preload_spring_mass
    return made + bought + m.adjusters_mass + m.drive_mass


quantities.from_template("rotor", "the rotor about the axis", template_made_inertia, "kg*mm^2", name="rotor_inertia")


@quantities.output("kg*mm^2", headline=True)
def parts_inertia(m: Module) -> Scalar:
    """Moment of inertia of all that turns in the module: rotor, liners, link, retainer, fasteners and inner rings."""
    retainer = m.retainer_section.polar * m.retainer_thickness * m.structure_density
    fasteners = m.screws_inertia + m.inserts_inertia + m.dowels_inertia
    return m.rotor_inertia + m.liner_inertia + m.link_inertia + retainer + fasteners + m.bearings_inertia
