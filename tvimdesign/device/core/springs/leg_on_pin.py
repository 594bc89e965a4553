"""Where a spring's leg lies on its pin, for the drawing: by the kinematics that the quantities of the springs have."""

from __future__ import annotations

from tvimdesign.physics.springs import transmission


def leg_azimuth(pin_radius: float, placement_radius: float, rotor_angle: float, offset: float) -> float:
    """Direction of a right-hand spring's leg in plan view [rad], from its coil to its pin, against the outward radius.

    Lengths in one unit, `rotor_angle` [rad]; `offset` is that of the line through the pin from the coil's axis.
    """
    return float(transmission.leg_direction(pin_radius, placement_radius, rotor_angle, offset))


def pin_distance(pin_radius: float, placement_radius: float, rotor_angle: float) -> float:
    """Distance of a coil's axis from its pin, which turns with the rotor, in the unit of the radii."""
    return float(transmission.pin_distance(pin_radius, placement_radius, rotor_angle))
