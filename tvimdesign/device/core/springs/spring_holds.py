"""What holds a spring gives with it: its leg bears on a pin of the rotor, its tang turns in the floor.

Both are as cold as the air here; the adhesive of a bonded tang counts as stiff as the structure. The coil bears the
torque of `held_spring_rate`, which every force and stress in the module comes from.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.springs.torsion_springs import quantities as shared
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.polymers import creep

quantities = QuantityGroup(shared.group)


@quantities.helper()
def pin_give(m: Module) -> Scalar:
    """Winding that a spring loses for each moment on its coil as its pin gives [rad/(N*m)]."""
    # As low as in `pin_safety`, for the same reason.
    height = np.fmax(m.coil_end_level + m.helix_slope * m.leg_arm - m.rotor_top_level, 0.5 * m.wire_diameter)
    return creep.peg_give(m.structure_youngs_modulus, m.structure_poissons_ratio, m.pin_diameter, height) / m.leg_arm**2


@quantities.helper()
def tang_give(m: Module) -> Scalar:
    """Winding that a spring loses for each moment on its coil as its tang turns in the floor [rad/(N*m)].

    The force on the pin acts at the leg's arm and the tang's lever, at most.
    """
    lever = 1.0 + m.tang_lever / m.leg_arm
    return creep.twisted_hole_give(m.structure_shear_modulus, m.wire_diameter, m.tang_length) * lever**2


@quantities.output("N*m/rad")
def held_spring_rate(m: Module) -> Scalar:
    """Torque of a spring per winding of spring, pin and floor in series; `leg_model: ignored` holds it rigidly."""
    if m.leg_model == "ignored":
        return m.spring_rate
    return m.spring_rate * creep.winding_left(m.spring_rate, (m.pin_give, 0.0), (m.tang_give, 0.0))


@quantities.output("rad")
def preload_give(m: Module) -> Scalar:
    """Winding that the coil loses at once at rest as pin and floor give; none of the margin, as its torque stays."""
    return m.preload_angle * (1.0 - m.held_spring_rate / m.spring_rate)
