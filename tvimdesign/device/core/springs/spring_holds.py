"""What holds a spring gives with it: its leg bears on a pin of the rotor, its tang turns in the floor.

Both are as cold as the air here; the adhesive of a bonded tang counts as stiff as the structure. The coil bears the
torque of `held_spring_rate`, which every force and stress in the module comes from.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.springs.torsion_springs import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.polymers import creep

quantities = QuantityGroup(shared.group)


@quantities.helper()
def pin_give(
    structure_youngs_modulus: Scalar,
    structure_poissons_ratio: Scalar,
    pin_diameter: Scalar,
    coil_end_level: Scalar,
    helix_slope: Scalar,
    leg_arm: Scalar,
    rotor_top_level: Scalar,
    wire_diameter: Scalar,
) -> Scalar:
    """Winding that a spring loses for each moment on its coil as its pin gives [rad/(N*m)]."""
    # As low as in `pin_safety`, for the same reason.
    height = np.fmax(coil_end_level + helix_slope * leg_arm - rotor_top_level, 0.5 * wire_diameter)
    return creep.peg_give(structure_youngs_modulus, structure_poissons_ratio, pin_diameter, height) / leg_arm**2


@quantities.helper()
def tang_give(
    structure_shear_modulus: Scalar, wire_diameter: Scalar, tang_length: Scalar, tang_lever: Scalar, leg_arm: Scalar
) -> Scalar:
    """Winding that a spring loses for each moment on its coil as its tang turns in the floor [rad/(N*m)].

    The force on the pin acts at the leg's arm and the tang's lever, at most.
    """
    lever = 1.0 + tang_lever / leg_arm
    return creep.twisted_hole_give(structure_shear_modulus, wire_diameter, tang_length) * lever**2


@quantities.output("N*m/rad")
def held_spring_rate(spring_rate: Scalar, pin_give: Scalar, tang_give: Scalar, leg_model: str) -> Scalar:
    """Torque of a spring per winding of spring, pin and floor in series; `leg_model: ignored` holds it rigidly."""
    if leg_model == "ignored":
        return spring_rate
    return spring_rate * creep.winding_left(spring_rate, (pin_give, 0.0), (tang_give, 0.0))


@quantities.output("rad")
def preload_give(preload_angle: Scalar, spring_rate: Scalar, held_spring_rate: Scalar) -> Scalar:
    """Winding that the coil loses at once at rest as pin and floor give; none of the margin, as its torque stays."""
    return preload_angle * (1.0 - held_spring_rate / spring_rate)
