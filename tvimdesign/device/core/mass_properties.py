"""Volume, mass and inertia of the parts that all modes have, from the dimensions the solids are built from."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section, disc_at, fillet_at_foot, notch, point_at, ring, slot, stacked

quantities = QuantityGroup("Size and weight")
LINK_SCREWS = 4


@quantities.output("mm")
def helix_length(coil_count: Scalar, coil_diameter: Scalar, coil_pitch: Scalar) -> Scalar:
    """Length of the wire in the coils of one spring."""
    return coil_count * np.sqrt((np.pi * coil_diameter) ** 2 + coil_pitch**2)


@quantities.output("mm")
def wire_length(
    helix_length: Scalar, leg_length: Scalar, tang_bend_radius: Scalar, helix_slope: Scalar, tang_length: Scalar
) -> Scalar:
    """Length of the wire of one spring: leg, coils, quarter bend and tang."""
    # The leg rises with the helix, so it is a little longer than its plan view; the bend turns from the helix to -z.
    leg = leg_length * np.sqrt(1.0 + helix_slope**2)
    bend = tang_bend_radius * (0.5 * np.pi - np.arctan(helix_slope))
    return leg + helix_length + bend + tang_length


@quantities.output("mm^3")
def spring_volume(wire_length: Scalar, wire_diameter: Scalar) -> Scalar:
    """Volume of one spring."""
    return 0.25 * np.pi * wire_diameter**2 * wire_length


@quantities.helper()
def skirt_moments(
    housing_inner_radius: Scalar,
    housing_outer_radius: Scalar,
    foot_height: Scalar,
    notch_width: Scalar,
    spring_count: Scalar,
    mount_boss_radius: Scalar,
    mount_hole: Scalar,
    placement_radius: Scalar,
) -> Section:
    """Volume and its polar moment about the axis, of the housing below its floor: skirt, notches and feet."""
    skirt = ring(housing_inner_radius, housing_outer_radius)
    notches = notch(0.5 * notch_width, housing_inner_radius, housing_outer_radius).times(spring_count)
    foot = disc_at(mount_boss_radius, placement_radius) - disc_at(0.5 * mount_hole, placement_radius)
    return (skirt - notches).plus(foot.times(spring_count)).times(foot_height)


@quantities.output("mm^3")
def skirt_volume(skirt_moments: Section) -> Scalar:
    """Volume of the housing below its floor: the skirt with its notches, and the mounting feet."""
    return skirt_moments.area


@quantities.helper()
def hub_moments(
    hub_radius: Scalar,
    hub_top_level: Scalar,
    hub_bottom_level: Scalar,
    seat_radius: Scalar,
    lip_radius: Scalar,
    upper_seat_depth: Scalar,
    lower_seat_depth: Scalar,
) -> Section:
    """Volume and its polar moment about the axis, of the hub from its lower to its upper end."""
    seats = upper_seat_depth + lower_seat_depth
    between = hub_top_level - hub_bottom_level - seats
    return stacked((ring(seat_radius, hub_radius), seats), (ring(lip_radius, hub_radius), between))


@quantities.output("mm^3")
def hub_volume(hub_moments: Section) -> Scalar:
    """Volume of the hub from its lower to its upper end, the floor around it not counted."""
    return hub_moments.area


@quantities.helper()
def floor_moments(
    hub_radius: Scalar,
    housing_outer_radius: Scalar,
    floor_thickness: Scalar,
    spring_count: Scalar,
    spring_hole_section: Section,
    mount_hole: Scalar,
    placement_radius: Scalar,
    floor_openings: Section,
) -> Section:
    """Volume and its polar moment about the axis, of the floor around the hub, less holes and the mode's openings."""
    holes = disc_at(0.5 * mount_hole, placement_radius).plus(spring_hole_section)
    solid = ring(hub_radius, housing_outer_radius) - holes.times(spring_count)
    return solid.times(floor_thickness) - floor_openings


@quantities.helper()
def bare_housing_moments(
    skirt_moments: Section,
    floor_moments: Section,
    housing_inner_radius: Scalar,
    housing_outer_radius: Scalar,
    hub_moments: Section,
    rim_level: Scalar,
    fixed_posts_moments: Section,
    cover_bosses_moments: Section,
    flange_moments: Section,
) -> Section:
    """Volume and its polar moment about the axis, of the housing without what the mode adds.

    That is skirt and floor, wall, hub, posts, bosses, flange.
    """
    wall = ring(housing_inner_radius, housing_outer_radius).times(rim_level)
    return wall.plus(
        skirt_moments, floor_moments, hub_moments, fixed_posts_moments, cover_bosses_moments, flange_moments
    )


@quantities.helper()
def bare_rotor_moments(
    rotor_radius: Scalar,
    rotor_thickness: Scalar,
    core_radius: Scalar,
    link_bottom_level: Scalar,
    rotor_bottom_level: Scalar,
    collar_radius: Scalar,
    hub_top_level: Scalar,
    journal_radius: Scalar,
    core_bottom_level: Scalar,
    spring_count: Scalar,
    pin_diameter: Scalar,
    pin_radius: Scalar,
    pin_top_level: Scalar,
    rotor_top_level: Scalar,
    link_screw_hole: Scalar,
    link_screw_depth: Scalar,
    link_bolt_circle_radius: Scalar,
    retainer_screw_hole: Scalar,
    retainer_screw_depth: Scalar,
    link_dowel_section: Section,
    link_dowel_depth: Scalar,
    core_drill_points: Section,
    foot_fillets: Section,
) -> Section:
    """Volume and its polar moment about the axis, of plate, core and pins less screw and dowel holes."""
    return stacked(
        (ring(core_radius, rotor_radius), rotor_thickness),
        (ring(0.0, core_radius), link_bottom_level - rotor_bottom_level),
        (ring(0.0, collar_radius), rotor_bottom_level - hub_top_level),
        (ring(0.0, journal_radius), hub_top_level - core_bottom_level),
        (disc_at(0.5 * pin_diameter, pin_radius).times(spring_count), pin_top_level - rotor_top_level),
        (disc_at(0.5 * link_screw_hole, link_bolt_circle_radius).times(LINK_SCREWS), -link_screw_depth),
        (ring(0.0, 0.5 * retainer_screw_hole), -retainer_screw_depth),
        (link_dowel_section, -link_dowel_depth),
        (foot_fillets, 1.0),
        (core_drill_points, -1.0),
    )


@quantities.helper()
def foot_fillets(
    foot_fillet: Scalar, core_radius: Scalar, pin_diameter: Scalar, pin_radius: Scalar, spring_count: Scalar
) -> Section:
    """Volume and its polar moment about the axis, of the fillets at the feet of core and pins."""
    of_pin = fillet_at_foot(0.5 * pin_diameter, foot_fillet)
    beside = Section(of_pin.area, of_pin.polar + of_pin.area * pin_radius**2)
    return fillet_at_foot(core_radius, foot_fillet).plus(beside.times(spring_count))


@quantities.helper()
def core_drill_points(
    drill_point_ratio: Scalar,
    link_screw_hole: Scalar,
    link_bolt_circle_radius: Scalar,
    retainer_screw_hole: Scalar,
    dowels_fitted: Scalar,
    link_dowel_diameter: Scalar,
    link_dowel_circle_radius: Scalar,
) -> Section:
    """Volume and its polar moment about the axis, of the points of the core's blind holes; nothing where printed."""
    return stacked(
        (
            point_at(0.5 * link_screw_hole, link_bolt_circle_radius).times(LINK_SCREWS),
            drill_point_ratio * link_screw_hole,
        ),
        (point_at(0.5 * retainer_screw_hole, 0.0), drill_point_ratio * retainer_screw_hole),
        (
            point_at(0.5 * link_dowel_diameter, link_dowel_circle_radius).times(dowels_fitted),
            drill_point_ratio * link_dowel_diameter,
        ),
    )


@quantities.helper()
def link_section(
    link_half_width: Scalar,
    link_length: Scalar,
    link_screw_clearance: Scalar,
    link_bolt_circle_radius: Scalar,
    link_tool_hole: Scalar,
    link_dowel_section: Section,
) -> Section:
    """Plan view of the output link: an obround from the core to the housing's edge, less its holes."""
    screws = disc_at(0.5 * link_screw_clearance, link_bolt_circle_radius).times(LINK_SCREWS)
    tool = disc_at(0.5 * link_tool_hole, link_length)
    return slot(link_half_width, link_length) - screws - tool - link_dowel_section


@quantities.helper()
def retainer_section(retainer_radius: Scalar, retainer_screw_clearance: Scalar) -> Section:
    """Plan view of the retainer."""
    return ring(0.5 * retainer_screw_clearance, retainer_radius)


@quantities.output("mm^3")
def rotor_volume(rotor_moments: Section) -> Scalar:
    """Volume of the rotor with its core and pins."""
    return rotor_moments.area


@quantities.output("mm^3")
def link_volume(link_section: Section, link_thickness: Scalar) -> Scalar:
    """Volume of the output link."""
    return link_section.area * link_thickness


@quantities.output("mm^3")
def retainer_volume(retainer_section: Section, retainer_thickness: Scalar) -> Scalar:
    """Volume of the retainer."""
    return retainer_section.area * retainer_thickness


@quantities.output("g")
def housing_mass(housing_volume: Scalar, structure_density: Scalar) -> Scalar:
    """Mass of the housing."""
    return housing_volume * structure_density


@quantities.output("g")
def rotor_mass(rotor_volume: Scalar, structure_density: Scalar) -> Scalar:
    """Mass of the rotor."""
    return rotor_volume * structure_density


@quantities.output("g")
def link_mass(link_volume: Scalar, structure_density: Scalar) -> Scalar:
    """Mass of the output link."""
    return link_volume * structure_density


@quantities.output("g")
def retainer_mass(retainer_volume: Scalar, structure_density: Scalar) -> Scalar:
    """Mass of the retainer."""
    return retainer_volume * structure_density


@quantities.output("g")
def springs_mass(spring_count: Scalar, spring_volume: Scalar, spring_density: Scalar) -> Scalar:
    """Mass of all springs together."""
    return spring_count * spring_volume * spring_density


@quantities.output("g")
def pcl_mass(pcl_volume: Scalar, pcl_density: Scalar) -> Scalar:
    """Mass of all PCL together."""
    return pcl_volume * pcl_density


@quantities.output("kg/m^3")
def peltier_density(peltier_unit_mass: Scalar, peltier_area: Scalar, peltier_thickness: Scalar) -> Scalar:
    """Mass of the Peltier module over its volume."""
    return peltier_unit_mass / (peltier_area * peltier_thickness)


@quantities.output("g")
def peltier_mass(peltier_volume: Scalar, peltier_density: Scalar) -> Scalar:
    """Mass of all Peltier pads together."""
    return peltier_volume * peltier_density


@quantities.output("g", headline=True)
def module_mass(
    housing_mass: Scalar,
    rotor_mass: Scalar,
    link_mass: Scalar,
    retainer_mass: Scalar,
    springs_mass: Scalar,
    pcl_mass: Scalar,
    peltier_mass: Scalar,
    spreader_mass: Scalar,
    thermistor_mass: Scalar,
    liner_mass: Scalar,
    cutout_mass: Scalar,
    screws_mass: Scalar,
    bearings_mass: Scalar,
    adjusters_mass: Scalar,
    cover_mass: Scalar,
    inserts_mass: Scalar,
    preload_spring_mass: Scalar,
    dowels_mass: Scalar,
    drive_mass: Scalar,
) -> Scalar:
    """Mass of the module with its motor, without wires and the screws that fix it."""
    made = housing_mass + rotor_mass + link_mass + retainer_mass + cover_mass + pcl_mass
    fasteners = screws_mass + inserts_mass + dowels_mass
    heater = peltier_mass + spreader_mass + thermistor_mass + cutout_mass
    bought = springs_mass + heater + liner_mass + fasteners + bearings_mass + preload_spring_mass
    return made + bought + adjusters_mass + drive_mass


@quantities.output("kg*mm^2")
def rotor_inertia(rotor_moments: Section, structure_density: Scalar) -> Scalar:
    """Moment of inertia of the rotor about the axis."""
    return rotor_moments.polar * structure_density


@quantities.output("kg*mm^2")
def link_inertia(link_section: Section, link_thickness: Scalar, structure_density: Scalar) -> Scalar:
    """Moment of inertia of the output link about the axis."""
    return link_section.polar * link_thickness * structure_density


@quantities.output("kg*mm^2", headline=True)
def parts_inertia(
    rotor_inertia: Scalar,
    link_inertia: Scalar,
    retainer_section: Section,
    retainer_thickness: Scalar,
    structure_density: Scalar,
    screws_inertia: Scalar,
    inserts_inertia: Scalar,
    bearings_inertia: Scalar,
    dowels_inertia: Scalar,
    liner_inertia: Scalar,
) -> Scalar:
    """Moment of inertia of all that turns in the module: rotor, liners, link, retainer, fasteners and inner rings."""
    retainer = retainer_section.polar * retainer_thickness * structure_density
    fasteners = screws_inertia + inserts_inertia + dowels_inertia
    return rotor_inertia + liner_inertia + link_inertia + retainer + fasteners + bearings_inertia
