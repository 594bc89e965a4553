"""What a motor below the feet has to turn: the housing's moment of inertia, and that of all that goes with it.

It stands apart from the volumes because nothing else asks for it: without a motor the housing stands still. Holes of
tangs count at the springs' axes, the rounding of pockets and windows at their mean radius: right to a thousandth or
two (the checks on the solids hold it to 0.5 %).
"""

from __future__ import annotations

from tvimdesign.device.core.mass_properties import quantities as shared
from tvimdesign.device.core.motor_choice import WITH_MOTOR, Motor
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section

quantities = QuantityGroup(shared.group)


@quantities.output("kg*mm^2")
def housing_inertia(housing_moments: Section, structure_density: Scalar) -> Scalar:
    """Moment of inertia of the housing about the axis."""
    return housing_moments.polar * structure_density


@quantities.output("kg*mm^2", requires=WITH_MOTOR)
def driven_inertia(
    drive_inertia: Scalar,
    housing_inertia: Scalar,
    springs_mass: Scalar,
    adjusters_mass: Scalar,
    placement_radius: Scalar,
    coil_diameter: Scalar,
    pcl_mass: Scalar,
    peltier_mass: Scalar,
    spreader_mass: Scalar,
    thermistor_mass: Scalar,
    cutout_mass: Scalar,
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
    at_springs = placement_radius**2 + 0.25 * coil_diameter**2
    at_pcl = 0.5 * (pcl_inner_radius**2 + pcl_outer_radius**2)
    on_arcs = pcl_mass + peltier_mass + spreader_mass + thermistor_mass + cutout_mass
    carried = (springs_mass + adjusters_mass) * at_springs + on_arcs * at_pcl
    cover = cover_section.polar * cover_height * structure_density
    return drive_inertia + housing_inertia + cover + carried


@quantities.output("rad/s^2", requires=WITH_MOTOR)
def motor_acceleration(drive_motor: Motor, driven_inertia: Scalar) -> Scalar:
    """Acceleration of the housing by the motor's continuous torque while the link is free; zero without a motor."""
    return drive_motor.continuous_torque / driven_inertia
