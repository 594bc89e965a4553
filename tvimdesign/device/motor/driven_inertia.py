"""What a motor below the feet has to turn: the housing's moment of inertia, and that of all that goes with it.

It stands apart from the volumes because nothing else asks for it: without a motor the housing stands still. Holes of
tangs count at the springs' axes, the rounding of pockets and windows at their mean radius: right to a thousandth or
two (the checks on the solids hold it to 0.5 %).
"""

from __future__ import annotations

from tvimdesign.device.core.mass_properties import quantities as shared
from tvimdesign.device.core.motor_choice import WITH_MOTOR
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup

quantities = QuantityGroup(shared.group)


@quantities.output("kg*mm^2")
def housing_inertia(m: Module) -> Scalar:
    """Moment of inertia of the housing about the axis."""
    return m.housing_moments.polar * m.structure_density


@quantities.output("kg*mm^2", requires=WITH_MOTOR)
def driven_inertia(m: Module) -> Scalar:
    """Moment of inertia of all the motor turns while the link stands; zero without a motor.

    Springs and adjusters as rings about the springs' axes, PCL and pads spread over their ring; a cover's screws not
    counted, nor the outer rings of the module's bearings, near the axis.
    """
    at_springs = m.placement_radius**2 + 0.25 * m.coil_diameter**2
    at_pcl = 0.5 * (m.pcl_inner_radius**2 + m.pcl_outer_radius**2)
    on_arcs = m.pcl_mass + m.peltier_mass + m.spreader_mass + m.thermistor_mass + m.cutout_mass
    carried = (m.springs_mass + m.adjusters_mass) * at_springs + on_arcs * at_pcl
    cover = m.cover_section.polar * m.cover_height * m.structure_density
    return m.drive_inertia + m.housing_inertia + cover + carried


@quantities.output("rad/s^2", requires=WITH_MOTOR)
def motor_acceleration(m: Module) -> Scalar:
    """Acceleration of the housing by the motor's continuous torque while the link is free; zero without a motor."""
    return m.drive_motor.continuous_torque / m.driven_inertia
