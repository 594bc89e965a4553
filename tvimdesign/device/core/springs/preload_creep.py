"""What the springs' preload loses as the plastic that holds it creeps, over months and hot hours.

What gives at once is in `held_spring_rate`. The pin is as warm as the plate beside the PCL, the floor as the air.
"""

from __future__ import annotations

from tvimdesign.device.core.impedance.warm_structure import PartTemperatures
from tvimdesign.device.core.springs.torsion_springs import quantities as shared
from tvimdesign.device.table.quantity import Rule, Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.polymers import creep

quantities = QuantityGroup(shared.group)


@quantities.helper()
def structure_creep(
    structure_creep_share: Scalar, structure_creep_exponent: Scalar, structure_creep_energy: Scalar
) -> creep.Creep:
    """How the structure creeps."""
    return creep.Creep(structure_creep_share, structure_creep_exponent, structure_creep_energy)


Holds = tuple[tuple[Scalar, Scalar], tuple[Scalar, Scalar]]
"""Elastic compliance [rad/(N*m)] of pin and tang, and the creep of each, of that [1]."""


@quantities.helper()
def spring_holds(
    pin_give: Scalar,
    tang_give: Scalar,
    structure_creep: creep.Creep,
    ambient_temperature: Scalar,
    part_temperatures_at_hot: PartTemperatures,
    rest_time: Scalar,
    hot_time: Scalar,
) -> Holds:
    """What holds a spring after `rest_time` in the air and `hot_time` at the hot point."""
    rested = creep.aged(rest_time, ambient_temperature, structure_creep)
    warm = (part_temperatures_at_hot.beside, part_temperatures_at_hot.floor)
    times = (rested + creep.aged(hot_time, temperature, structure_creep) for temperature in warm)
    on_pin, in_floor = (creep.growth(time, structure_creep) for time in times)
    return (pin_give, on_pin), (tang_give, in_floor)


@quantities.output("rad")
def preload_loss(preload_angle: Scalar, spring_rate: Scalar, spring_holds: Holds) -> Scalar:
    """Winding that a spring loses at rest by creep of pin and floor, after `rest_time` and `hot_time`."""
    at_once = creep.winding_left(spring_rate, *((compliance, 0.0) for compliance, _ in spring_holds))
    return preload_angle * (at_once - creep.winding_left(spring_rate, *spring_holds))


_CREPT = "a spring lifts off at full stroke once pins and floor have crept"


@quantities.output("rad", advice=(Rule(sense=">=", value=0.0, reason=_CREPT),))
def crept_preload_margin(preload_margin: Scalar, preload_loss: Scalar) -> Scalar:
    """Preload that is left at the end of the stroke, less what creep takes of it; adjusters can set it anew."""
    return preload_margin - preload_loss
