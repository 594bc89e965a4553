"""Rules for the motor, its hub, housing, bearings and encoder; each quantity is zero without a motor."""

import numpy as np

from tvimdesign.device.components.bearing import BEARINGS, load_per_torque
from tvimdesign.device.core.motor_choice import WITH_ENCODER, WITH_MOTOR
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup

quantities = QuantityGroup("Gaps", WITH_MOTOR)


@quantities.output("mm", at_least(0.0, "the module's retainer would rub on the motor's hub: more foot_height"))
def motor_retainer_gap(m: Module) -> Scalar:
    """Room between the module's retainer and the motor's hub beyond the running clearance; zero without a motor."""
    return m.retainer_gap - m.running_clearance


@quantities.output(
    "mm", at_least(0.0, "the motor's hub is wider than the circle of the housing's feet: a smaller motor")
)
def motor_foot_gap(m: Module) -> Scalar:
    """Length of the motor hub's spokes from their corners at its disc to the feet's middle; zero without a motor."""
    return m.placement_radius - m.motor_disc_radius - m.motor_corner_radius


@quantities.output("mm", at_least(0.0, "the spokes of the motor's hub would meet outside its disc: a larger motor"))
def motor_spoke_gap(m: Module) -> Scalar:
    """Half of the gap between the corners of neighbouring spokes of the motor hub's disc; zero without a motor."""
    centres = (m.motor_disc_radius + m.motor_corner_radius) * np.sin(np.pi / m.foot_count)
    return centres - m.mount_boss_radius - m.motor_corner_radius


@quantities.output("mm", at_least(0.0, "the motor hub's spokes would split around their screws"))
def motor_spoke_wall_margin(m: Module) -> Scalar:
    """Wall of the spokes around their screws beyond the process's least; zero without a motor."""
    return m.mount_boss_radius - 0.5 * m.mount_screw_pilot - m.hole_wall


@quantities.output("mm", at_least(0.0, "the screws in the housing's feet are too short to hold in the motor's hub"))
def mount_thread_margin(m: Module) -> Scalar:
    """Thread of those screws in the hub beyond what the process wants; zero without a motor."""
    return m.mount_screw_length - m.floor_thickness - m.foot_height - m.thread_engagement * m.mount_screw_diameter


@quantities.output("mm", at_least(0.0, "the screws in the housing's feet would reach through the motor hub's spokes"))
def mount_tip_margin(m: Module) -> Scalar:
    """Spoke beyond the ends of those screws; zero without a motor."""
    return m.motor_plate_thickness + m.floor_thickness + m.foot_height - m.mount_screw_length


@quantities.output(
    "mm", at_least(0.0, "the motor's bearings do not fit inside its rotor: smaller ones, or thinner walls")
)
def motor_tube_gap(m: Module) -> Scalar:
    """Room between the bearings' tube and the hub's barrel beyond the running clearance; zero without a motor."""
    return m.motor_barrel_radius - m.motor_tube_radius - m.running_clearance


@quantities.output("mm", at_least(0.0, "the motor hub's barrel is thinner than the process can make it"))
def motor_hub_wall_margin(m: Module) -> Scalar:
    """Wall of that barrel beyond the process's least; zero without a motor."""
    return m.motor_hub_wall - m.minimum_wall


@quantities.output("mm", at_least(0.0, "the motor housing's walls are thinner than the process can make them"))
def motor_wall_margin(m: Module) -> Scalar:
    """Walls of the motor's housing beyond the process's least; zero without a motor."""
    return m.motor_wall - m.minimum_wall


@quantities.output("mm", at_least(0.0, "the motor's barrel would rub on the base: its rotor is longer than its stator"))
def motor_barrel_gap(m: Module) -> Scalar:
    """Room between the hub's barrel and the base beyond the running clearance; zero without a motor."""
    return m.motor_rotor_bottom_level - m.stator_bottom_level - m.running_clearance


@quantities.output("mm", at_least(0.0, "the motor is too low for two bearings and a lip between them"))
def motor_lip_margin(m: Module) -> Scalar:
    """Lip between the motor's bearings beyond the process's least wall; zero without a motor."""
    return m.stator_top_level - m.motor_retainer_level - BEARINGS * m.drive_motor.bearing_width - m.minimum_wall


@quantities.output(
    "mm", at_least(0.0, "the motor's journal would split around its screw: a larger bearing, a smaller screw")
)
def motor_journal_wall_margin(m: Module) -> Scalar:
    """Wall of that journal around its screw beyond the process's least; zero without a motor."""
    return m.motor_journal_radius - 0.5 * m.motor_screw_pilot - m.hole_wall


@quantities.output("mm", at_least(0.0, "the screw of the motor's retainer is too short to hold in the journal"))
def motor_thread_margin(m: Module) -> Scalar:
    """Thread of that screw beyond what the process wants; zero without a motor."""
    return m.motor_screw_depth - m.motor_screw_runout - m.thread_engagement * m.motor_screw_diameter


@quantities.output("mm", at_least(0.0, "the screw of the motor's retainer would come out of the hub's disc"))
def motor_disc_margin(m: Module) -> Scalar:
    """Hub above the point of that screw's hole beyond the process's least wall; zero without a motor."""
    deep = m.motor_screw_depth + m.drill_point_ratio * m.motor_screw_pilot
    return m.motor_plate_level + m.motor_plate_thickness - m.motor_journal_level - deep - m.minimum_wall


@quantities.output("mm", at_least(0.0, "the motor's retainer would split around its screw's head, or the magnet"))
def motor_retainer_wall_margin(m: Module) -> Scalar:
    """Wall of that retainer around its counterbore beyond the process's least; zero without a motor."""
    return m.motor_collar_radius - m.motor_sink_radius - m.minimum_wall


@quantities.output("mm", at_least(0.0, "the motor housing's base is too thin for the screws that fix it"))
def motor_base_thread_margin(m: Module) -> Scalar:
    """Thread in the base beyond what the process wants; zero without a motor."""
    return m.motor_base_hole_depth - m.mount_screw_runout - m.thread_engagement * m.mount_screw_diameter


@quantities.output(
    "mm", at_least(0.0, "the holes of the motor housing's base would meet its bore or the encoder's recess")
)
def motor_base_hole_gap(m: Module) -> Scalar:
    """Base between its holes and bore or recess beyond the least wall; zero without a motor."""
    inside = np.fmax(m.motor_seat_radius, m.encoder_recess_radius)
    return m.motor_base_hole_radius - 0.5 * m.mount_screw_pilot - inside - m.hole_wall


@quantities.output(
    "mm",
    at_least(0.0, "the encoder's board has no ledge to lie on: a larger board, or smaller bearings"),
    requires=WITH_ENCODER,
)
def encoder_ledge_margin(m: Module) -> Scalar:
    """Ledge under the encoder's board beyond the process's least wall; zero without an encoder."""
    return m.angle_sensor.board_radius - m.motor_seat_radius - m.minimum_wall


@quantities.output(
    "mm",
    at_least(0.0, "the base above the encoder's board is thinner than the process can make it"),
    requires=WITH_ENCODER,
)
def encoder_floor_margin(m: Module) -> Scalar:
    """Base above the encoder's board beyond the process's least wall; zero without an encoder."""
    return m.motor_base_thickness - m.angle_sensor.board_height - m.minimum_wall


@quantities.output("N")
def motor_bearing_load(m: Module) -> Scalar:
    """Force on the motor's upper bearing of a force at the link's end that the joint just holds; zero without one."""
    middle = m.link_bottom_level + 0.5 * m.link_thickness
    ends = (m.stator_top_level, m.motor_retainer_level)
    return m.holding_torque * load_per_torque(m.link_length, middle, *ends, m.drive_motor.bearing_width)


_DENTS = "a force at the link's end that the joint just holds would dent the races of the motor's bearings"


@quantities.output("N", advice=(at_least(0.0, _DENTS),))
def motor_bearing_margin(m: Module) -> Scalar:
    """Static rating of one of the motor's bearings less the force on it; zero without a motor."""
    return m.drive_motor.bearing_rating - m.motor_bearing_load
