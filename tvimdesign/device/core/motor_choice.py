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
    motor, bearing = m.motor.value, m.motor_bearing.value
    same = ("stator_length", "rotor_length", "stator_mass", "rotor_mass", "rotor_inertia", "torque_constant",
            "winding_resistance", "continuous_torque", "peak_torque", "rated_speed")  # fmt: skip
    halved = ("stator_bore", "rotor_bore")
    return Motor(
        stator_radius=0.5 * motor("stator_diameter"), rotor_radius=0.5 * motor("rotor_diameter"),
        bearing_bore=0.5 * bearing("bore"), bearing_radius=0.5 * bearing("outer_diameter"),
        bearing_width=bearing("width"), inner_shoulder=0.5 * bearing("inner_shoulder"),
        outer_shoulder=0.5 * bearing("outer_shoulder"), bearing_rating=bearing("static_load_rating"),
        **{name: motor(name) for name in same}, **{name: 0.5 * motor(name) for name in halved},
    )  # fmt: skip


@quantities.helper(requires=WITH_ENCODER, default=None)
def angle_sensor(m: Module) -> Encoder:
    """The encoder, diameters as radii; None without one, or without a motor."""
    encoder = m.encoder.value
    same = ("magnet_height", "magnet_density", "air_gap", "board_height", "board_mass")
    return Encoder(
        magnet_radius=0.5 * encoder("magnet_diameter"), board_radius=0.5 * encoder("board_diameter"),
        resolution=2.0 ** encoder("resolution_bits"), **{name: encoder(name) for name in same},
    )  # fmt: skip


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
