"""Compliance and creep of what holds a spring: its leg bears on a pin of the rotor, its tang turns in the floor.

Both are as cold as the air here; the adhesive of a bonded tang counts as stiff as the structure. The coil bears the
torque of `held_spring_rate`, which every force and stress in the module comes from.

The preload falls as the plastic that holds it creeps, over months and hot hours. The pin is as warm as the plate beside
the PCL, the floor as the air."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Rule, Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.polymers import plastics

quantities = QuantityGroup("Springs")


@quantities.helper()
def pin_give(m: Module) -> Scalar:
    """Winding that a spring loses for each moment on its coil as its pin gives [rad/(N*m)]."""
    # As low as in `pin_safety`, for the same reason.
    height = np.fmax(m.coil_end_level + m.helix_slope * m.leg_arm - m.rotor_top_level, 0.5 * m.wire_diameter)
    return (
        plastics.peg_give(m.structure_youngs_modulus, m.structure_poissons_ratio, m.pin_diameter, height) / m.leg_arm**2
    )


@quantities.helper()
def tang_give(m: Module) -> Scalar:
    """Winding that a spring loses for each moment on its coil as its tang turns in the floor [rad/(N*m)].

    The force on the pin acts at the leg's arm and the tang's lever, at most.
    """
    lever = 1.0 + m.tang_lever / m.leg_arm
    return plastics.twisted_hole_give(m.structure_shear_modulus, m.wire_diameter, m.tang_length) * lever**2


@quantities.output("N*m/rad")
def held_spring_rate(m: Module) -> Scalar:
    """Torque of a spring per winding of spring, pin and floor in series; `leg_model: ignored` holds it rigidly."""
    if m.leg_model == "ignored":
        return m.spring_rate
    return m.spring_rate * plastics.winding_left(m.spring_rate, (m.pin_give, 0.0), (m.tang_give, 0.0))


@quantities.output("rad")
def preload_give(m: Module) -> Scalar:
    """Winding that the coil loses at once at rest as pin and floor give; none of the margin, as its torque stays."""
    return m.preload_angle * (1.0 - m.held_spring_rate / m.spring_rate)


def _structure_creep(m: Module) -> plastics.Creep:
    """Return the creep of the structure."""
    return plastics.Creep(m.structure_creep_share, m.structure_creep_exponent, m.structure_creep_energy)


Holds = tuple[tuple[Scalar, Scalar], tuple[Scalar, Scalar]]
"""Elastic compliance [rad/(N*m)] of pin and tang, and the creep of each, of that [1]."""


def _spring_holds(m: Module) -> Holds:
    """Return the supports of a spring after `rest_time` in the air and `hot_time` at the hot point."""
    rested = plastics.aged(m.rest_time, m.ambient_temperature, _structure_creep(m))
    warm = (m.part_temperatures_at_hot.beside, m.part_temperatures_at_hot.floor)
    times = (rested + plastics.aged(m.hot_time, temperature, _structure_creep(m)) for temperature in warm)
    on_pin, in_floor = (plastics.growth(time, _structure_creep(m)) for time in times)
    return (m.pin_give, on_pin), (m.tang_give, in_floor)


@quantities.output("rad")
def preload_loss(m: Module) -> Scalar:
    """Winding that a spring loses at rest by creep of pin and floor, after `rest_time` and `hot_time`."""
    at_once = plastics.winding_left(m.spring_rate, *((compliance, 0.0) for compliance, _ in _spring_holds(m)))
    return m.preload_angle * (at_once - plastics.winding_left(m.spring_rate, *_spring_holds(m)))


_CREPT = "a spring lifts off at full stroke once pins and floor have crept"


@quantities.output("rad", advice=(Rule(sense=">=", value=0.0, reason=_CREPT),))
def crept_preload_margin(m: Module) -> Scalar:
    """Preload that is left at the end of the stroke, less what creep takes of it; adjusters can set it anew."""
    return m.preload_margin - m.preload_loss
