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
"""

import numpy as np

from tvimdesign.device.components.bearing import BEARINGS, load_per_torque
from tvimdesign.device.components.process import runout
from tvimdesign.device.core.motor_choice import WITH_ENCODER, WITH_MOTOR
from tvimdesign.device.table import Module, QuantityGroup, Scalar, at_least

BASE_SCREWS = 4  # Screws that fix the motor's housing from below

quantities = QuantityGroup("Layout", WITH_MOTOR)


# --- radii: all zero without a motor ---------------------------------------------------------------------------------


quantities.formulas("motor_layout")


@quantities.output("mm")
def motor_sink_radius(m: Module) -> Scalar:
    """Radius of the retainer's counterbore for its screw's head, and for a magnet below it; zero without a motor."""
    head = 0.5 * m.motor_screw_head + m.motor_sink_clearance
    return head if m.angle_sensor is None else np.fmax(head, m.angle_sensor.magnet_radius + m.slip_clearance)


# --- levels: zero without a motor ------------------------------------------------------------------------------------


@quantities.output("mm")
def motor_retainer_level(m: Module) -> Scalar:
    """Upper face of the motor's retainer, below the lower inner ring: the magnet keeps its gap to the chip."""
    below = m.running_clearance if m.angle_sensor is None else m.angle_sensor.air_gap + m.angle_sensor.board_height
    return m.encoder_board_level + below + m.motor_retainer_thickness


@quantities.output("mm")
def motor_screw_runout(m: Module) -> Scalar:
    """Depth of that hole beyond the screw's end; zero without a motor."""
    return runout(m.screw_tip_room, m.tap_runout_ratio, m.motor_screw_diameter, m.motor_screw_pilot)


@quantities.output("mm")
def mount_screw_runout(m: Module) -> Scalar:
    """Depth of the base's holes beyond their thread; zero without a motor."""
    return runout(m.screw_tip_room, m.tap_runout_ratio, m.mount_screw_diameter, m.mount_screw_pilot)


clearances = QuantityGroup("Gaps", WITH_MOTOR)


clearances.margins("motor_layout")


@clearances.gap("the spokes of the motor's hub would meet outside its disc: a larger motor")
def motor_spoke_gap(m: Module) -> Scalar:
    """Half of the gap between the corners of neighbouring spokes of the motor hub's disc; zero without a motor."""
    centres = (m.motor_disc_radius + m.motor_corner_radius) * np.sin(np.pi / m.foot_count)
    return centres - m.mount_boss_radius - m.motor_corner_radius


@clearances.gap("the motor is too low for two bearings and a lip between them")
def motor_lip_margin(m: Module) -> Scalar:
    """Lip between the motor's bearings beyond the process's least wall; zero without a motor."""
    return m.stator_top_level - m.motor_retainer_level - BEARINGS * m.drive_motor.bearing_width - m.minimum_wall


@clearances.gap("the screw of the motor's retainer would come out of the hub's disc")
def motor_disc_margin(m: Module) -> Scalar:
    """Hub above the point of that screw's hole beyond the process's least wall; zero without a motor."""
    deep = m.motor_screw_depth + m.drill_point_ratio * m.motor_screw_pilot
    return m.motor_plate_level + m.motor_plate_thickness - m.motor_journal_level - deep - m.minimum_wall


@clearances.gap("the holes of the motor housing's base would meet its bore or the encoder's recess")
def motor_base_hole_gap(m: Module) -> Scalar:
    """Base between its holes and bore or recess beyond the least wall; zero without a motor."""
    inside = np.fmax(m.motor_seat_radius, m.encoder_recess_radius)
    return m.motor_base_hole_radius - 0.5 * m.mount_screw_pilot - inside - m.hole_wall


@clearances.gap(
    "the encoder's board has no ledge to lie on: a larger board, or smaller bearings", requires=WITH_ENCODER
)
def encoder_ledge_margin(m: Module) -> Scalar:
    """Ledge under the encoder's board beyond the process's least wall; zero without an encoder."""
    return m.angle_sensor.board_radius - m.motor_seat_radius - m.minimum_wall


@clearances.gap("the base above the encoder's board is thinner than the process can make it", requires=WITH_ENCODER)
def encoder_floor_margin(m: Module) -> Scalar:
    """Base above the encoder's board beyond the process's least wall; zero without an encoder."""
    return m.motor_base_thickness - m.angle_sensor.board_height - m.minimum_wall


@clearances.output("N")
def motor_bearing_load(m: Module) -> Scalar:
    """Force on the motor's upper bearing of a force at the link's end that the joint just holds; zero without one."""
    middle = m.link_bottom_level + 0.5 * m.link_thickness
    ends = (m.stator_top_level, m.motor_retainer_level)
    return m.holding_torque * load_per_torque(m.link_length, middle, *ends, m.drive_motor.bearing_width)


_DENTS = "a force at the link's end that the joint just holds would dent the races of the motor's bearings"


@clearances.output("N", advice=(at_least(0.0, _DENTS),))
def motor_bearing_margin(m: Module) -> Scalar:
    """Static rating of one of the motor's bearings less the force on it; zero without a motor."""
    return m.drive_motor.bearing_rating - m.motor_bearing_load
