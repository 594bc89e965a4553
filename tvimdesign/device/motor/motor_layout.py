"""The motor that drives the module: where its parts are. A frameless motor stands under the floor, with an encoder.

The motor turns the module's housing, on the spring side; the link stays the output, so spring and PCL are in series
with the motor. Its hub is a disc with a spoke to each of the housing's feet; below the disc a barrel carries the rotor
and inside it a journal turns in two ball bearings. They stand in the tube of the motor's housing, a lip between them;
the housing's outer wall holds the stator, and its base is fixed from below. A retainer under the journal holds the
lower inner ring; its screw is sunk in it, and below the head sits the magnet of the encoder. The board lies in a recess
of the base. Rotor and stator are bonded, with the gap of parts that slip into another.

    floor, feet of the module's housing
    =====disc with spokes======
      | |  collar, journal | |      barrel, bonded to the rotor
    |S|R| [bearing] | lip    |R|S|  stator in the outer wall
    |S|R| [bearing] |        |R|S|
    base, retainer with magnet, board

With a flange for a torque sensor its pattern takes the place of the base's holes, and its spigot a recess below the
board, as deep as the spigot and a running clearance (`flange.py`).
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.layout import quantities as layout
from tvimdesign.device.core.motor_choice import WITH_ENCODER, WITH_MOTOR, Encoder, Motor
from tvimdesign.device.fixtures.drilled_holes import runout
from tvimdesign.device.fixtures.sensor_flange import Pattern
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup

BASE_SCREWS = 4
"""Screws that fix the motor's housing from below."""

quantities = QuantityGroup(layout.group, WITH_MOTOR)


# --- radii: all zero without a motor ---------------------------------------------------------------------------------


@quantities.output("mm")
def motor_disc_radius(drive_motor: Motor, slip_clearance: Scalar) -> Scalar:
    """Radius of the motor hub's disc and barrel, on which the rotor is bonded; zero without a motor."""
    return drive_motor.rotor_bore - slip_clearance


@quantities.output("mm")
def motor_corner_radius(corner_radius: Scalar, corner_depth_ratio: Scalar, motor_plate_thickness: Scalar) -> Scalar:
    """Radius of the corners between the hub's disc and its spokes, which are as deep as it; zero without a motor."""
    return np.fmax(corner_radius, motor_plate_thickness / corner_depth_ratio)


@quantities.output("mm")
def motor_barrel_radius(motor_disc_radius: Scalar, motor_hub_wall: Scalar) -> Scalar:
    """Inner radius of that barrel; zero without a motor."""
    return motor_disc_radius - motor_hub_wall


@quantities.output("mm")
def motor_journal_radius(drive_motor: Motor, seat_clearance: Scalar) -> Scalar:
    """Radius of the motor hub's journal in its bearings; zero without a motor."""
    return drive_motor.bearing_bore - seat_clearance


@quantities.output("mm")
def motor_collar_radius(drive_motor: Motor) -> Scalar:
    """Radius of what presses on the bearings' inner rings, collar above and retainer below; zero without a motor."""
    return drive_motor.inner_shoulder


@quantities.output("mm")
def motor_seat_radius(drive_motor: Motor, seat_clearance: Scalar) -> Scalar:
    """Radius of the seats of the motor's bearings; zero without a motor."""
    return drive_motor.bearing_radius + seat_clearance


@quantities.output("mm")
def motor_lip_radius(drive_motor: Motor) -> Scalar:
    """Inner radius of the lip between them; zero without a motor."""
    return drive_motor.outer_shoulder


@quantities.output("mm")
def motor_tube_radius(motor_seat_radius: Scalar, motor_wall: Scalar) -> Scalar:
    """Outer radius of the tube that holds the bearings; zero without a motor."""
    return motor_seat_radius + motor_wall


@quantities.output("mm")
def stator_seat_radius(drive_motor: Motor, slip_clearance: Scalar) -> Scalar:
    """Inner radius of the motor housing's wall, to which the stator is bonded; zero without a motor."""
    return drive_motor.stator_radius + slip_clearance


@quantities.output("mm")
def motor_outer_radius(stator_seat_radius: Scalar, motor_wall: Scalar) -> Scalar:
    """Outer radius of the motor's housing; zero without a motor."""
    return stator_seat_radius + motor_wall


@quantities.output("mm")
def motor_base_hole_radius(drive_motor: Motor) -> Scalar:
    """Radius of the circle of the base's screws, under the middle of the stator's ring; zero without a motor."""
    return 0.5 * (drive_motor.stator_bore + drive_motor.stator_radius)


@quantities.output("mm")
def motor_sink_radius(
    angle_sensor: Encoder | None,
    motor_screw_head: Scalar,
    motor_sink_clearance: Scalar,
    slip_clearance: Scalar,
) -> Scalar:
    """Radius of the retainer's counterbore for its screw's head, and for a magnet below it; zero without a motor."""
    head = 0.5 * motor_screw_head + motor_sink_clearance
    return head if angle_sensor is None else np.fmax(head, angle_sensor.magnet_radius + slip_clearance)


@quantities.output("mm", requires=WITH_ENCODER)
def encoder_recess_radius(angle_sensor: Encoder, slip_clearance: Scalar) -> Scalar:
    """Radius of the recess for the encoder's board; zero without an encoder."""
    return angle_sensor.board_radius + slip_clearance


# --- levels: zero without a motor ------------------------------------------------------------------------------------


@quantities.output("mm")
def drive_height(
    drive_motor: Motor, motor_plate_thickness: Scalar, axial_clearance: Scalar, motor_base_thickness: Scalar
) -> Scalar:
    """Height the motor adds below the housing's feet: disc, gap, stator and base; zero without a motor."""
    return motor_plate_thickness + axial_clearance + drive_motor.stator_length + motor_base_thickness


@quantities.output("mm")
def motor_plate_level(floor_thickness: Scalar, foot_height: Scalar, motor_plate_thickness: Scalar) -> Scalar:
    """Lower face of the motor hub's disc and spokes, which the housing stands on; zero without a motor."""
    return -floor_thickness - foot_height - motor_plate_thickness


@quantities.output("mm")
def stator_top_level(motor_plate_level: Scalar, axial_clearance: Scalar) -> Scalar:
    """Upper end of stator, motor housing and upper bearing; zero without a motor."""
    return motor_plate_level - axial_clearance


@quantities.output("mm")
def stator_bottom_level(drive_motor: Motor, stator_top_level: Scalar) -> Scalar:
    """Lower end of the stator, on the base of the motor's housing; zero without a motor."""
    return stator_top_level - drive_motor.stator_length


@quantities.output("mm")
def motor_bottom_level(stator_bottom_level: Scalar, motor_base_thickness: Scalar) -> Scalar:
    """Lower face of the motor's housing; zero without a motor."""
    return stator_bottom_level - motor_base_thickness


@quantities.output("mm")
def encoder_board_level(motor_bottom_level: Scalar, sensor_recess_depth: Scalar) -> Scalar:
    """Lower face of the encoder's board, if any: the base's, or over a sensor's spigot; zero without a motor."""
    return motor_bottom_level + sensor_recess_depth


@quantities.output("mm")
def motor_rotor_bottom_level(drive_motor: Motor, stator_top_level: Scalar, stator_bottom_level: Scalar) -> Scalar:
    """Lower end of the motor's rotor and of the barrel: rotor and stator have one middle; zero without a motor."""
    return 0.5 * (stator_top_level + stator_bottom_level - drive_motor.rotor_length)


@quantities.output("mm", requires=WITH_ENCODER)
def magnet_room(angle_sensor: Encoder, encoder_magnet_spacing: Scalar) -> Scalar:
    """Height of magnet and gap below the head of the retainer's screw; zero without an encoder."""
    return angle_sensor.magnet_height + encoder_magnet_spacing


@quantities.output("mm")
def motor_retainer_thickness(
    motor_retainer_floor: Scalar, motor_screw_head_height: Scalar, magnet_room: Scalar
) -> Scalar:
    """Height of the motor's retainer, in which its screw's head and the magnet are sunk; zero without a motor."""
    return motor_retainer_floor + motor_screw_head_height + magnet_room


@quantities.output("mm")
def motor_retainer_level(
    angle_sensor: Encoder | None,
    encoder_board_level: Scalar,
    motor_retainer_thickness: Scalar,
    running_clearance: Scalar,
) -> Scalar:
    """Upper face of the motor's retainer, below the lower inner ring: the magnet keeps its gap to the chip."""
    below = running_clearance if angle_sensor is None else angle_sensor.air_gap + angle_sensor.board_height
    return encoder_board_level + below + motor_retainer_thickness


@quantities.output("mm")
def motor_journal_level(motor_retainer_level: Scalar, running_clearance: Scalar) -> Scalar:
    """Lower end of the motor hub's journal, short of the lower inner ring's; zero without a motor."""
    return motor_retainer_level + running_clearance


@quantities.output("mm")
def motor_screw_depth(
    motor_screw_length: Scalar,
    motor_retainer_floor: Scalar,
    running_clearance: Scalar,
    motor_screw_runout: Scalar,
) -> Scalar:
    """Depth of the retainer screw's hole in the journal, without a drill's point; zero without a motor."""
    return motor_screw_length - motor_retainer_floor - running_clearance + motor_screw_runout


@quantities.output("mm")
def motor_screw_runout(
    screw_tip_room: Scalar, tap_runout_ratio: Scalar, motor_screw_diameter: Scalar, motor_screw_pilot: Scalar
) -> Scalar:
    """Depth of that hole beyond the screw's end; zero without a motor."""
    return runout(screw_tip_room, tap_runout_ratio, motor_screw_diameter, motor_screw_pilot)


@quantities.output("mm")
def mount_screw_runout(
    screw_tip_room: Scalar, tap_runout_ratio: Scalar, mount_screw_diameter: Scalar, mount_screw_pilot: Scalar
) -> Scalar:
    """Depth of the base's holes beyond their thread; zero without a motor."""
    return runout(screw_tip_room, tap_runout_ratio, mount_screw_diameter, mount_screw_pilot)


@quantities.output("mm")
def motor_base_hole_depth(
    base_pattern: Pattern,
    motor_base_thickness: Scalar,
    drill_point_ratio: Scalar,
    mount_screw_pilot: Scalar,
    minimum_wall: Scalar,
) -> Scalar:
    """Depth of the base's holes: their points leave it the least wall; zero without a motor, or on a sensor."""
    if base_pattern.screws:
        return 0.0
    return motor_base_thickness - drill_point_ratio * mount_screw_pilot - minimum_wall
