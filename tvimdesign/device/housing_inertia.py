"""What a motor below the feet has to turn: the housing's moment of inertia, and that of all that goes with it.

It stands apart from the volumes because nothing else asks for it: without a motor the housing stands still. Holes of
tangs count at the springs' axes, the rounding of pockets and windows at their mean radius: right to a thousandth or so
(the checks on the solids hold it to half a hundredth).
"""

from __future__ import annotations

from tvimdesign.device.bodies import book as shared
from tvimdesign.device.book import Book
from tvimdesign.device.flange import Pattern
from tvimdesign.device.motor import Motor
from tvimdesign.device.rows import Scalar
from tvimdesign.physics.shapes import Section, disc_at, notch, ring

book = Book(shared.group)


@book.helper()
def skirt_polar(
    housing_inner_radius: Scalar,
    housing_outer_radius: Scalar,
    foot_height: Scalar,
    notch_width: Scalar,
    spring_count: Scalar,
    mount_boss_radius: Scalar,
    mount_hole: Scalar,
    placement_radius: Scalar,
) -> Scalar:
    """Polar moment [m^5] of the housing below its floor: skirt, notches and feet."""
    skirt = ring(housing_inner_radius, housing_outer_radius)
    notches = notch(0.5 * notch_width, housing_inner_radius, housing_outer_radius).times(spring_count)
    foot = disc_at(mount_boss_radius, placement_radius) - disc_at(0.5 * mount_hole, placement_radius)
    return (skirt.polar - notches.polar + spring_count * foot.polar) * foot_height


@book.helper()
def hub_polar(
    hub_radius: Scalar,
    hub_top_level: Scalar,
    hub_bottom_level: Scalar,
    seat_radius: Scalar,
    lip_radius: Scalar,
    bearing_width: Scalar,
) -> Scalar:
    """Polar moment [m^5] of the hub."""
    seats = 2.0 * bearing_width
    between = hub_top_level - hub_bottom_level - seats
    return ring(seat_radius, hub_radius).polar * seats + ring(lip_radius, hub_radius).polar * between


@book.helper()
def flange_polar(
    flange_volume: Scalar, sensor_pattern: Pattern, flange_bore_radius: Scalar, flange_outer_radius: Scalar
) -> Scalar:
    """Polar moment [m^5] of a torque sensor's flange, its volume spread over its ring; zero without one."""
    return flange_volume * 0.5 * (flange_bore_radius**2 + flange_outer_radius**2) if sensor_pattern.screws else 0.0


@book.helper()
def floor_polar(
    hub_radius: Scalar,
    housing_outer_radius: Scalar,
    floor_thickness: Scalar,
    spring_count: Scalar,
    spring_hole_area: Scalar,
    mount_hole: Scalar,
    placement_radius: Scalar,
    adjuster_radius: Scalar,
    floor_openings_polar: Scalar,
) -> Scalar:
    """Polar moment [m^5] of the floor around the hub, less its holes and what the mode opens in it."""
    disc = ring(hub_radius, housing_outer_radius).polar
    at_spring = placement_radius**2 + 0.5 * adjuster_radius**2
    hole = disc_at(0.5 * mount_hole, placement_radius).polar + spring_hole_area * at_spring
    return (disc - spring_count * hole) * floor_thickness - floor_openings_polar


@book.output("kg*mm^2")
def housing_inertia(
    skirt_polar: Scalar,
    hub_polar: Scalar,
    flange_polar: Scalar,
    floor_polar: Scalar,
    fixed_posts_volume: Scalar,
    post_radius: Scalar,
    placement_radius: Scalar,
    housing_inner_radius: Scalar,
    housing_outer_radius: Scalar,
    rim_level: Scalar,
    cover_bosses_volume: Scalar,
    housing_vanes_polar: Scalar,
    structure_density: Scalar,
) -> Scalar:
    """Moment of inertia of the housing about the axis."""
    wall = ring(housing_inner_radius, housing_outer_radius).polar * rim_level
    posts = fixed_posts_volume * (placement_radius**2 + 0.5 * post_radius**2)
    bosses = cover_bosses_volume * housing_inner_radius**2
    standing = hub_polar + wall + posts + bosses + housing_vanes_polar
    whole = skirt_polar + flange_polar + floor_polar + standing
    return whole * structure_density


@book.output("kg*mm^2")
def driven_inertia(
    drive: Motor | None,
    drive_inertia: Scalar,
    housing_inertia: Scalar,
    springs_mass: Scalar,
    adjusters_mass: Scalar,
    placement_radius: Scalar,
    coil_diameter: Scalar,
    pcl_mass: Scalar,
    peltier_mass: Scalar,
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    cover_section: Section,
    cover_height: Scalar,
    structure_density: Scalar,
) -> Scalar:
    """Moment of inertia of all the motor turns while the link stands; zero without a motor.

    Springs and adjusters as rings about the springs' axes, PCL and pads spread over their ring; a cover's screws not
    counted, nor the outer rings of the module's bearings, near the axis.
    """
    if drive is None:
        return 0.0
    at_springs = placement_radius**2 + 0.25 * coil_diameter**2
    at_pcl = 0.5 * (pcl_inner_radius**2 + pcl_outer_radius**2)
    carried = (springs_mass + adjusters_mass) * at_springs + (pcl_mass + peltier_mass) * at_pcl
    cover = cover_section.polar * cover_height * structure_density
    return drive_inertia + housing_inertia + cover + carried


@book.output("rad/s^2")
def motor_acceleration(drive: Motor | None, driven_inertia: Scalar) -> Scalar:
    """Acceleration of the housing by the motor's continuous torque while the link is free; zero without a motor."""
    return 0.0 if drive is None else drive.continuous_torque / driven_inertia
