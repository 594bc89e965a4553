"""What must hold for the motor, its hub, housing, bearings and encoder; each quantity is zero without a motor."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.clearances import quantities as gaps
from tvimdesign.device.core.impedance.creep_under_hold import quantities as hold
from tvimdesign.device.core.motor_choice import WITH_ENCODER, WITH_MOTOR, Encoder, Motor
from tvimdesign.device.fixtures.bearing import BEARINGS, bearing_load_per_torque
from tvimdesign.device.fixtures.sensor_flange import Pattern
from tvimdesign.device.table.quantity import Rule, Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup

quantities, torques = QuantityGroup(gaps.group, WITH_MOTOR), QuantityGroup(hold.group, WITH_MOTOR)
groups = (quantities, torques)


@quantities.output("mm", at_least(0.0, "the module's retainer would rub on the motor's hub: more foot_height"))
def motor_retainer_gap(retainer_gap: Scalar, running_clearance: Scalar) -> Scalar:
    """Room between the module's retainer and the motor's hub beyond the running clearance; zero without a motor."""
    return retainer_gap - running_clearance


@quantities.output(
    "mm", at_least(0.0, "the motor's hub is wider than the circle of the housing's feet: a smaller motor")
)
def motor_foot_gap(placement_radius: Scalar, motor_disc_radius: Scalar, motor_corner_radius: Scalar) -> Scalar:
    """Length of the motor hub's spokes from their corners at its disc to the feet's middle; zero without a motor."""
    return placement_radius - motor_disc_radius - motor_corner_radius


@quantities.output("mm", at_least(0.0, "the spokes of the motor's hub would meet outside its disc: a larger motor"))
def motor_spoke_gap(
    motor_disc_radius: Scalar, motor_corner_radius: Scalar, spring_count: Scalar, mount_boss_radius: Scalar
) -> Scalar:
    """Half of the gap between the corners of neighbouring spokes of the motor hub's disc; zero without a motor."""
    centres = (motor_disc_radius + motor_corner_radius) * np.sin(np.pi / spring_count)
    return centres - mount_boss_radius - motor_corner_radius


@quantities.output("mm", at_least(0.0, "the motor hub's spokes would split around their screws"))
def motor_spoke_wall_margin(mount_boss_radius: Scalar, mount_screw_pilot: Scalar, minimum_wall: Scalar) -> Scalar:
    """Wall of the spokes around their screws beyond the process's least; zero without a motor."""
    return mount_boss_radius - 0.5 * mount_screw_pilot - minimum_wall


@quantities.output("mm", at_least(0.0, "the screws in the housing's feet are too short to hold in the motor's hub"))
def mount_thread_margin(
    mount_screw_length: Scalar,
    floor_thickness: Scalar,
    foot_height: Scalar,
    thread_engagement: Scalar,
    mount_screw_diameter: Scalar,
) -> Scalar:
    """Thread of those screws in the hub beyond what the process wants; zero without a motor."""
    return mount_screw_length - floor_thickness - foot_height - thread_engagement * mount_screw_diameter


@quantities.output("mm", at_least(0.0, "the screws in the housing's feet would reach through the motor hub's spokes"))
def mount_tip_margin(
    motor_plate_thickness: Scalar,
    mount_screw_length: Scalar,
    floor_thickness: Scalar,
    foot_height: Scalar,
) -> Scalar:
    """Spoke beyond the ends of those screws; zero without a motor."""
    return motor_plate_thickness + floor_thickness + foot_height - mount_screw_length


@quantities.output(
    "mm", at_least(0.0, "the motor's bearings do not fit inside its rotor: smaller ones, or thinner walls")
)
def motor_tube_gap(motor_barrel_radius: Scalar, motor_tube_radius: Scalar, running_clearance: Scalar) -> Scalar:
    """Room between the bearings' tube and the hub's barrel beyond the running clearance; zero without a motor."""
    return motor_barrel_radius - motor_tube_radius - running_clearance


@quantities.output("mm", at_least(0.0, "the motor hub's barrel is thinner than the process can make it"))
def motor_hub_wall_margin(motor_hub_wall: Scalar, minimum_wall: Scalar) -> Scalar:
    """Wall of that barrel beyond the process's least; zero without a motor."""
    return motor_hub_wall - minimum_wall


@quantities.output("mm", at_least(0.0, "the motor housing's walls are thinner than the process can make them"))
def motor_wall_margin(motor_wall: Scalar, minimum_wall: Scalar) -> Scalar:
    """Walls of the motor's housing beyond the process's least; zero without a motor."""
    return motor_wall - minimum_wall


@quantities.output("mm", at_least(0.0, "the motor's barrel would rub on the base: its rotor is longer than its stator"))
def motor_barrel_gap(
    motor_rotor_bottom_level: Scalar, stator_bottom_level: Scalar, running_clearance: Scalar
) -> Scalar:
    """Room between the hub's barrel and the base beyond the running clearance; zero without a motor."""
    return motor_rotor_bottom_level - stator_bottom_level - running_clearance


@quantities.output("mm", at_least(0.0, "the motor is too low for two bearings and a lip between them"))
def motor_lip_margin(
    drive_motor: Motor, stator_top_level: Scalar, motor_retainer_level: Scalar, minimum_wall: Scalar
) -> Scalar:
    """Lip between the motor's bearings beyond the process's least wall; zero without a motor."""
    return stator_top_level - motor_retainer_level - BEARINGS * drive_motor.bearing_width - minimum_wall


@quantities.output(
    "mm", at_least(0.0, "the motor's journal would split around its screw: a larger bearing, a smaller screw")
)
def motor_journal_wall_margin(motor_journal_radius: Scalar, motor_screw_pilot: Scalar, minimum_wall: Scalar) -> Scalar:
    """Wall of that journal around its screw beyond the process's least; zero without a motor."""
    return motor_journal_radius - 0.5 * motor_screw_pilot - minimum_wall


@quantities.output("mm", at_least(0.0, "the screw of the motor's retainer is too short to hold in the journal"))
def motor_thread_margin(
    motor_screw_depth: Scalar,
    motor_screw_runout: Scalar,
    thread_engagement: Scalar,
    motor_screw_diameter: Scalar,
) -> Scalar:
    """Thread of that screw beyond what the process wants; zero without a motor."""
    return motor_screw_depth - motor_screw_runout - thread_engagement * motor_screw_diameter


@quantities.output("mm", at_least(0.0, "the screw of the motor's retainer would come out of the hub's disc"))
def motor_disc_margin(
    motor_plate_level: Scalar,
    motor_plate_thickness: Scalar,
    motor_journal_level: Scalar,
    motor_screw_depth: Scalar,
    drill_point_ratio: Scalar,
    motor_screw_pilot: Scalar,
    minimum_wall: Scalar,
) -> Scalar:
    """Hub above the point of that screw's hole beyond the process's least wall; zero without a motor."""
    deep = motor_screw_depth + drill_point_ratio * motor_screw_pilot
    return motor_plate_level + motor_plate_thickness - motor_journal_level - deep - minimum_wall


@quantities.output("mm", at_least(0.0, "the motor's retainer would split around its screw's head, or the magnet"))
def motor_retainer_wall_margin(motor_collar_radius: Scalar, motor_sink_radius: Scalar, minimum_wall: Scalar) -> Scalar:
    """Wall of that retainer around its counterbore beyond the process's least; zero without a motor."""
    return motor_collar_radius - motor_sink_radius - minimum_wall


@quantities.output("mm", at_least(0.0, "the motor housing's base is too thin for the screws that fix it"))
def motor_base_thread_margin(
    base_pattern: Pattern,
    motor_base_hole_depth: Scalar,
    mount_screw_runout: Scalar,
    thread_engagement: Scalar,
    mount_screw_diameter: Scalar,
) -> Scalar:
    """Thread in the base beyond what the process wants; zero without a motor, or where a sensor bears it."""
    if base_pattern.screws:
        return 0.0
    return motor_base_hole_depth - mount_screw_runout - thread_engagement * mount_screw_diameter


@quantities.output(
    "mm", at_least(0.0, "the holes of the motor housing's base would meet its bore or the encoder's recess")
)
def motor_base_hole_gap(
    base_pattern: Pattern,
    motor_base_hole_radius: Scalar,
    mount_screw_pilot: Scalar,
    motor_seat_radius: Scalar,
    encoder_recess_radius: Scalar,
    minimum_wall: Scalar,
) -> Scalar:
    """Base between its holes and bore or recess beyond the least wall; zero without a motor, or with a sensor's."""
    if base_pattern.screws:
        return 0.0
    inside = np.fmax(motor_seat_radius, encoder_recess_radius)
    return motor_base_hole_radius - 0.5 * mount_screw_pilot - inside - minimum_wall


@quantities.output(
    "mm",
    at_least(0.0, "the encoder's board has no ledge to lie on: a larger board, or smaller bearings"),
    requires=WITH_ENCODER,
)
def encoder_ledge_margin(angle_sensor: Encoder, motor_seat_radius: Scalar, minimum_wall: Scalar) -> Scalar:
    """Ledge under the encoder's board beyond the process's least wall; zero without an encoder."""
    return angle_sensor.board_radius - motor_seat_radius - minimum_wall


@quantities.output(
    "mm",
    at_least(0.0, "the base above the encoder's board is thinner than the process can make it"),
    requires=WITH_ENCODER,
)
def encoder_floor_margin(
    angle_sensor: Encoder, motor_base_thickness: Scalar, sensor_recess_depth: Scalar, minimum_wall: Scalar
) -> Scalar:
    """Base above the encoder's board beyond the process's least wall; zero without an encoder."""
    return motor_base_thickness - sensor_recess_depth - angle_sensor.board_height - minimum_wall


@quantities.output("N")
def motor_bearing_load(
    drive_motor: Motor,
    holding_torque: Scalar,
    link_length: Scalar,
    link_bottom_level: Scalar,
    link_thickness: Scalar,
    stator_top_level: Scalar,
    motor_retainer_level: Scalar,
) -> Scalar:
    """Force on the motor's upper bearing of a force at the link's end that the joint just holds; zero without one."""
    return holding_torque * bearing_load_per_torque(
        link_length, link_bottom_level, link_thickness, stator_top_level, motor_retainer_level,
        drive_motor.bearing_width,
    )  # fmt: skip


_DENTS = "a force at the link's end that the joint just holds would dent the races of the motor's bearings"


@quantities.output("N", advice=(Rule(sense=">=", value=0.0, reason=_DENTS),))
def motor_bearing_margin(drive_motor: Motor, motor_bearing_load: Scalar) -> Scalar:
    """Static rating of one of the motor's bearings less the force on it; zero without a motor."""
    return drive_motor.bearing_rating - motor_bearing_load


# --- what the motor must bear ----------------------------------------------------------------------------------------

_TOO_WEAK = "the motor cannot for long turn the springs alone by the stroke"


@torques.output("N*m", advice=(Rule(sense=">=", value=0.0, reason=_TOO_WEAK),))
def motor_torque_margin(drive_motor: Motor, spring_stiffness: Scalar, stroke: Scalar) -> Scalar:
    """Continuous torque of the motor less what turns the springs alone by the stroke; zero without a motor."""
    return drive_motor.continuous_torque - spring_stiffness * stroke


@torques.output("A")
def motor_hold_current(drive_motor: Motor, hold_torque: Scalar) -> Scalar:
    """Current with which the motor bears the load of the hold; zero without a motor."""
    return hold_torque / drive_motor.torque_constant


@torques.output("N*m", requires=WITH_ENCODER)
def encoder_torque_step(angle_sensor: Encoder, spring_stiffness: Scalar) -> Scalar:
    """Torque of the molten joint that one step of the encoder stands for; zero without an encoder."""
    return 2.0 * np.pi / angle_sensor.resolution * spring_stiffness
