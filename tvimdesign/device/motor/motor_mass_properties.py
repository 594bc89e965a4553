"""Volume, mass and inertia of the motor's parts, its hub and its housing; all zero without a motor."""

from __future__ import annotations

from tvimdesign.base.record import Record
from tvimdesign.device.core.mass_properties import quantities as shared
from tvimdesign.device.core.motor_choice import WITH_ENCODER, WITH_MOTOR, Encoder, Motor
from tvimdesign.device.fixtures.bearing import BEARINGS, bearing_inner_section, bearings_inertia
from tvimdesign.device.fixtures.bearing import bearing_density as density_as_a_ring
from tvimdesign.device.fixtures.fastening import template_screw_moments
from tvimdesign.device.fixtures.sensor_flange import Pattern, pattern_holes
from tvimdesign.device.motor.motor_layout import BASE_SCREWS
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import (
    NOTHING,
    Section,
    disc_at,
    inner_corner,
    notch,
    point_at,
    ring,
    spoke,
    stacked,
)

quantities = QuantityGroup(shared.group, WITH_MOTOR)


@quantities.helper(default=NOTHING)
def motor_hub_moments(
    motor_disc_radius: Scalar,
    motor_barrel_radius: Scalar,
    motor_collar_radius: Scalar,
    motor_corner_radius: Scalar,
    motor_journal_radius: Scalar,
    motor_plate_thickness: Scalar,
    motor_plate_level: Scalar,
    motor_rotor_bottom_level: Scalar,
    stator_top_level: Scalar,
    motor_journal_level: Scalar,
    motor_screw_pilot: Scalar,
    motor_screw_depth: Scalar,
    drill_point_ratio: Scalar,
    spring_count: Scalar,
    mount_boss_radius: Scalar,
    mount_screw_pilot: Scalar,
    placement_radius: Scalar,
) -> Section:
    """Volume and its polar moment about the axis, of the motor's hub; the spokes' corners count at the disc's rim."""
    spokes = spoke(mount_boss_radius, motor_disc_radius, placement_radius) - disc_at(
        0.5 * mount_screw_pilot, placement_radius
    )
    corners = 2.0 * inner_corner(motor_corner_radius, motor_disc_radius, mount_boss_radius)
    return stacked(
        (ring(0.0, motor_disc_radius), motor_plate_thickness),
        (spokes.times(spring_count), motor_plate_thickness),
        (Section(corners, corners * motor_disc_radius**2).times(spring_count), motor_plate_thickness),
        (ring(motor_barrel_radius, motor_disc_radius), motor_plate_level - motor_rotor_bottom_level),
        (ring(0.0, motor_collar_radius), motor_plate_level - stator_top_level),
        (ring(0.0, motor_journal_radius), stator_top_level - motor_journal_level),
        (ring(0.0, 0.5 * motor_screw_pilot), -motor_screw_depth),
        (point_at(0.5 * motor_screw_pilot, 0.0), -drill_point_ratio * motor_screw_pilot),
    )


@quantities.output("mm^3")
def motor_hub_volume(motor_hub_moments: Section) -> Scalar:
    """Volume of the motor's hub."""
    return motor_hub_moments.area


@quantities.output("mm^3")
def motor_housing_volume(
    drive_motor: Motor,
    angle_sensor: Encoder | None,
    motor_outer_radius: Scalar,
    stator_seat_radius: Scalar,
    motor_tube_radius: Scalar,
    motor_seat_radius: Scalar,
    motor_lip_radius: Scalar,
    motor_base_thickness: Scalar,
    stator_top_level: Scalar,
    motor_bottom_level: Scalar,
    motor_retainer_level: Scalar,
    motor_base_hole_depth: Scalar,
    mount_screw_pilot: Scalar,
    motor_wire_width: Scalar,
    motor_wire_depth: Scalar,
    encoder_recess_radius: Scalar,
    base_pattern: Pattern,
    flange_bore_radius: Scalar,
    flange_screw_depth: Scalar,
    drill_point_ratio: Scalar,
    sensor_recess_depth: Scalar,
) -> Scalar:
    """Volume of the motor's housing: base, wall and tube, less bore, seats, holes, recesses and wires' ways."""
    lower = motor_retainer_level + drive_motor.bearing_width - motor_bottom_level
    lip = stator_top_level - drive_motor.bearing_width - motor_bottom_level - lower
    solid = (
        ring(0.0, motor_outer_radius).area * motor_base_thickness
        + ring(stator_seat_radius, motor_outer_radius).area * drive_motor.stator_length
        + ring(0.0, motor_tube_radius).area * drive_motor.stator_length
    )
    bore = (
        ring(0.0, motor_seat_radius).area * (lower + drive_motor.bearing_width) + ring(0.0, motor_lip_radius).area * lip
    )
    point = 0.0 if base_pattern.screws else drill_point_ratio * mount_screw_pilot
    screws = BASE_SCREWS * ring(0.0, 0.5 * mount_screw_pilot).area * (motor_base_hole_depth + point / 3.0)
    wires = notch(0.5 * motor_wire_width, stator_seat_radius, motor_outer_radius).area * motor_wire_depth
    whole = solid - bore - screws - wires - pattern_holes(base_pattern, flange_screw_depth, drill_point_ratio)
    recesses: list[tuple[Scalar, Scalar]] = [(flange_bore_radius, sensor_recess_depth)] if base_pattern.screws else []
    if angle_sensor is not None:
        recesses.append((encoder_recess_radius, angle_sensor.board_height))
    for radius, height in recesses:
        groove = 0.0 if angle_sensor is None else notch(0.5 * motor_wire_width, radius, motor_outer_radius).area
        whole -= (ring(motor_seat_radius, radius).area + groove) * height
    return whole


@quantities.helper(default=NOTHING)
def motor_retainer_moments(
    motor_collar_radius: Scalar,
    motor_screw_clearance: Scalar,
    motor_sink_radius: Scalar,
    motor_retainer_floor: Scalar,
    motor_retainer_thickness: Scalar,
) -> Section:
    """Volume and its polar moment about the axis, of the motor's retainer."""
    return stacked(
        (ring(0.5 * motor_screw_clearance, motor_collar_radius), motor_retainer_floor),
        (ring(motor_sink_radius, motor_collar_radius), motor_retainer_thickness - motor_retainer_floor),
    )


@quantities.output("mm^3")
def motor_retainer_volume(motor_retainer_moments: Section) -> Scalar:
    """Volume of the motor's retainer."""
    return motor_retainer_moments.area


@quantities.helper(default=NOTHING)
def motor_screw_moments(
    motor_screw_pilot: Scalar,
    motor_screw_length: Scalar,
    motor_screw_head: Scalar,
    motor_screw_head_height: Scalar,
) -> Section:
    """Volume and its polar moment about the axis, of the motor retainer's screw."""
    return template_screw_moments(
        1.0, 0.0, motor_screw_pilot, motor_screw_length, motor_screw_head, motor_screw_head_height
    )


@quantities.output("mm^3")
def motor_screw_volume(motor_screw_moments: Section) -> Scalar:
    """Volume of the motor retainer's screw."""
    return motor_screw_moments.area


@quantities.helper(default=NOTHING)
def mount_screw_moments(
    spring_count: Scalar,
    placement_radius: Scalar,
    mount_screw_pilot: Scalar,
    mount_screw_length: Scalar,
    mount_screw_head: Scalar,
    mount_screw_head_height: Scalar,
) -> Section:
    """Volume and its polar moment about the axis, of the screws between housing and motor hub."""
    return template_screw_moments(
        spring_count, placement_radius, mount_screw_pilot, mount_screw_length, mount_screw_head, mount_screw_head_height
    )


@quantities.output("mm^3")
def mount_screw_volume(mount_screw_moments: Section) -> Scalar:
    """Volume of the screws between housing and motor hub together; without a motor they are not the module's."""
    return mount_screw_moments.area


@quantities.output("mm^3")
def motor_rotor_volume(drive_motor: Motor) -> Scalar:
    """Volume of the motor's rotor as a ring."""
    return ring(drive_motor.rotor_bore, drive_motor.rotor_radius).area * drive_motor.rotor_length


@quantities.output("mm^3")
def motor_stator_volume(drive_motor: Motor) -> Scalar:
    """Volume of the motor's stator with its windings as a ring."""
    return ring(drive_motor.stator_bore, drive_motor.stator_radius).area * drive_motor.stator_length


@quantities.output("mm^3")
def motor_bearing_volume(drive_motor: Motor) -> Scalar:
    """Volume of the motor's two bearings as rings without gaps."""
    return BEARINGS * ring(drive_motor.bearing_bore, drive_motor.bearing_radius).area * drive_motor.bearing_width


@quantities.output("mm^3", requires=WITH_ENCODER)
def encoder_magnet_volume(angle_sensor: Encoder) -> Scalar:
    """Volume of the encoder's magnet."""
    return ring(0.0, angle_sensor.magnet_radius).area * angle_sensor.magnet_height


@quantities.output("mm^3", requires=WITH_ENCODER)
def encoder_board_volume(angle_sensor: Encoder) -> Scalar:
    """Volume of the encoder's board as a disc as high as board and chip."""
    return ring(0.0, angle_sensor.board_radius).area * angle_sensor.board_height


@quantities.output("kg/m^3")
def motor_rotor_density(drive_motor: Motor, motor_rotor_volume: Scalar) -> Scalar:
    """Mass of the motor's rotor over that volume; zero without a motor."""
    return drive_motor.rotor_mass / motor_rotor_volume


@quantities.output("kg/m^3")
def motor_stator_density(drive_motor: Motor, motor_stator_volume: Scalar) -> Scalar:
    """Mass of the motor's stator over that volume; zero without a motor."""
    return drive_motor.stator_mass / motor_stator_volume


@quantities.output("kg/m^3")
def motor_bearing_density(motor_bearing: Record) -> Scalar:
    """Mass of one of the motor's bearings over its volume; zero without a motor."""
    return density_as_a_ring(motor_bearing)


@quantities.output("kg/m^3", requires=WITH_ENCODER)
def encoder_magnet_density(angle_sensor: Encoder) -> Scalar:
    """Density of the encoder's magnet; zero without an encoder."""
    return angle_sensor.magnet_density


@quantities.output("kg/m^3", requires=WITH_ENCODER)
def encoder_board_density(angle_sensor: Encoder, encoder_board_volume: Scalar) -> Scalar:
    """Mass of the encoder's board over its volume; zero without an encoder."""
    return angle_sensor.board_mass / encoder_board_volume


@quantities.output("g")
def drive_mass(
    drive_motor: Motor,
    structure_density: Scalar,
    motor_hub_volume: Scalar,
    motor_housing_volume: Scalar,
    motor_retainer_volume: Scalar,
    motor_screw_volume: Scalar,
    motor_screw_density: Scalar,
    mount_screw_volume: Scalar,
    mount_screw_density: Scalar,
    motor_bearing_volume: Scalar,
    motor_bearing_density: Scalar,
    encoder_magnet_volume: Scalar,
    encoder_magnet_density: Scalar,
    encoder_board_volume: Scalar,
    encoder_board_density: Scalar,
) -> Scalar:
    """Mass of motor, its hub, housing, retainer, bearings and screws, and encoder; zero without a motor."""
    made = (motor_hub_volume + motor_housing_volume + motor_retainer_volume) * structure_density
    screws = motor_screw_volume * motor_screw_density + mount_screw_volume * mount_screw_density
    bought = drive_motor.stator_mass + drive_motor.rotor_mass + motor_bearing_volume * motor_bearing_density
    encoder = encoder_magnet_volume * encoder_magnet_density + encoder_board_volume * encoder_board_density
    return made + screws + bought + encoder


@quantities.output("kg*mm^2")
def motor_hub_inertia(motor_hub_moments: Section, structure_density: Scalar) -> Scalar:
    """Moment of inertia of the motor's hub about the axis; zero without a motor."""
    return motor_hub_moments.polar * structure_density


@quantities.output("kg*mm^2")
def drive_inertia(
    drive_motor: Motor,
    motor_hub_inertia: Scalar,
    motor_retainer_moments: Section,
    structure_density: Scalar,
    motor_screw_moments: Section,
    motor_screw_density: Scalar,
    mount_screw_moments: Section,
    mount_screw_density: Scalar,
    motor_bearing_density: Scalar,
    encoder_magnet_radius: Scalar,
    encoder_magnet_height: Scalar,
    encoder_magnet_density: Scalar,
) -> Scalar:
    """Moment of inertia of what the motor turns below the housing: rotor, hub, retainer, screws, inner rings, magnet.

    It is on the motor's side of springs and PCL, and no part of `parts_inertia`. The rotor's is its record's.
    """
    retainer = motor_retainer_moments.polar * structure_density
    screws = motor_screw_moments.polar * motor_screw_density + mount_screw_moments.polar * mount_screw_density
    inner = bearing_inner_section(drive_motor.bearing_bore, drive_motor.bearing_radius)
    rings = bearings_inertia(inner, drive_motor.bearing_width, motor_bearing_density)
    magnet = ring(0.0, encoder_magnet_radius).polar * encoder_magnet_height * encoder_magnet_density
    return drive_motor.rotor_inertia + motor_hub_inertia + retainer + screws + rings + magnet
