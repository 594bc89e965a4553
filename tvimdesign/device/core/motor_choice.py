"""Frameless motor, bearings and encoder that drive the module, if any, and the sizes they are bought in."""

from typing import NamedTuple

from tvimdesign.device.table import Feature, Module, QuantityGroup

WITHOUT = "none"

WITH_MOTOR = (Feature("motor", WITHOUT),)
WITH_ENCODER = (*WITH_MOTOR, Feature("encoder", WITHOUT))
WITH_DRIVER = (*WITH_MOTOR, Feature("motor_driver", WITHOUT))

quantities = QuantityGroup("Layout", WITH_MOTOR)  # `layout.py` asks for the motor, so its name is not taken from there

quantities.choices("motor_choice")


class Motor(NamedTuple):
    """A motor by its record, and its bearings: radii, lengths [m], masses [kg]."""

    stator_radius: float
    stator_bore: float
    stator_length: float
    rotor_radius: float
    rotor_bore: float
    rotor_length: float
    stator_mass: float
    rotor_mass: float
    rotor_inertia: float
    torque_constant: float  # For an rms current [N*m/A]
    winding_resistance: float  # Between two terminals [ohm]
    continuous_torque: float
    peak_torque: float
    rated_speed: float
    bearing_bore: float
    bearing_radius: float
    bearing_width: float
    inner_shoulder: float
    outer_shoulder: float
    bearing_rating: float  # Static rating of one bearing [N]


class Encoder(NamedTuple):
    """An encoder by its record: radii, lengths [m], mass [kg]."""

    magnet_radius: float
    magnet_height: float
    magnet_density: float
    air_gap: float
    board_radius: float
    board_height: float
    board_mass: float
    resolution: float  # Steps a turn


@quantities.helper(default=None)
def drive_motor(m: Module) -> Motor:
    """The motor with its bearings, diameters as radii; None without one."""
    return Motor(
        stator_radius=0.5 * m.motor.value("stator_diameter"),
        stator_bore=0.5 * m.motor.value("stator_bore"),
        stator_length=m.motor.value("stator_length"),
        rotor_radius=0.5 * m.motor.value("rotor_diameter"),
        rotor_bore=0.5 * m.motor.value("rotor_bore"),
        rotor_length=m.motor.value("rotor_length"),
        stator_mass=m.motor.value("stator_mass"),
        rotor_mass=m.motor.value("rotor_mass"),
        rotor_inertia=m.motor.value("rotor_inertia"),
        torque_constant=m.motor.value("torque_constant"),
        winding_resistance=m.motor.value("winding_resistance"),
        continuous_torque=m.motor.value("continuous_torque"),
        peak_torque=m.motor.value("peak_torque"),
        rated_speed=m.motor.value("rated_speed"),
        bearing_bore=0.5 * m.motor_bearing.value("bore"),
        bearing_radius=0.5 * m.motor_bearing.value("outer_diameter"),
        bearing_width=m.motor_bearing.value("width"),
        inner_shoulder=0.5 * m.motor_bearing.value("inner_shoulder"),
        outer_shoulder=0.5 * m.motor_bearing.value("outer_shoulder"),
        bearing_rating=m.motor_bearing.value("static_load_rating"),
    )


@quantities.helper(requires=WITH_ENCODER, default=None)
def angle_sensor(m: Module) -> Encoder:
    """The encoder, diameters as radii; None without one, or without a motor."""
    return Encoder(
        magnet_radius=0.5 * m.encoder.value("magnet_diameter"),
        magnet_height=m.encoder.value("magnet_height"),
        magnet_density=m.encoder.value("magnet_density"),
        air_gap=m.encoder.value("air_gap"),
        board_radius=0.5 * m.encoder.value("board_diameter"),
        board_height=m.encoder.value("board_height"),
        board_mass=m.encoder.value("board_mass"),
        resolution=2.0 ** m.encoder.value("resolution_bits"),
    )


for _name, _field, _about in (
    ("stator_radius", "stator_radius", "Outer radius of the motor's stator"),
    ("stator_bore_radius", "stator_bore", "Inner radius of the motor's stator"),
    ("motor_rotor_radius", "rotor_radius", "Outer radius of the motor's rotor"),
    ("motor_rotor_bore_radius", "rotor_bore", "Inner radius of the motor's rotor"),
    ("motor_rotor_length", "rotor_length", "Length of the motor's rotor"),
    ("motor_bearing_bore_radius", "bearing_bore", "Inner radius of the motor's bearings"),
    ("motor_bearing_radius", "bearing_radius", "Outer radius of the motor's bearings"),
    ("motor_bearing_width", "bearing_width", "Width of one of the motor's bearings"),
):
    quantities.field(_name, "drive_motor", _field, f"{_about}; zero without one", "mm")


for _name, _field, _about in (
    ("encoder_magnet_radius", "magnet_radius", "Radius of the encoder's magnet"),
    ("encoder_magnet_height", "magnet_height", "Height of the encoder's magnet"),
    ("encoder_board_radius", "board_radius", "Radius of the encoder's board"),
    ("encoder_board_height", "board_height", "Height of the encoder's board with its chip"),
):
    quantities.field(_name, "angle_sensor", _field, f"{_about}; zero without one", "mm", requires=WITH_ENCODER)
