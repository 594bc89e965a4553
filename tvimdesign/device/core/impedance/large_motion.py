"""The molten joint over its whole stroke, not only in small motions: stiffness, damping, and the stress in the melt.

An oscillation to the full stroke at the hot point's temperature and frequency. The melt remembers a fraction of a
second, so it is strained less than the stroke says (Wagner's equation, `physics/polymers/large_strain.py`). Each mode
says in its own room what its strains are: `stroke_strains`, (strain [1], share of the small-motion torque [1]) at
nodes, and `largest_melt_strain`.
The springs count as at rest; their change over the stroke is `stiffness_over_stroke`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tvimdesign.device.core.impedance.joint_impedance import quantities as shared
from tvimdesign.device.core.materials import CRYSTALLIZING
from tvimdesign.device.table.quantity import Rule, Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.layers import layer
from tvimdesign.physics.motions import friction
from tvimdesign.physics.motions.motion import Modes
from tvimdesign.physics.polymers import large_strain

quantities = QuantityGroup(shared.group)

Strains = Sequence[tuple[Scalar, Scalar]]


@quantities.helper()
def stroke_branch(
    stroke_strains: Strains,
    frequency_at_hot: Scalar,
    pcl_modes_at_hot: Modes,
    linear_strain_at_hot: Scalar,
    support_at_hot: tuple[Scalar, Scalar],
) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness [N*m/rad] of the molten PCL and what is in series, at full stroke."""
    angular = 2.0 * np.pi * frequency_at_hot
    softened = [
        (share, large_strain.wagner_moduli(strain, angular, pcl_modes_at_hot, linear_strain_at_hot))
        for strain, share in stroke_strains
    ]
    storage, loss = (sum(share * moduli[part] for share, moduli in softened) for part in (0, 1))
    return layer.series_stiffness(storage, loss, *support_at_hot)


@quantities.output("N*m/rad")
def hot_stiffness_at_stroke(spring_stiffness: Scalar, stroke_branch: tuple[Scalar, Scalar]) -> Scalar:
    """Stiffness of the hot joint that swings over its whole stroke; `joint_stiffness@hot` is that of small motions."""
    return spring_stiffness + stroke_branch[0]


@quantities.output("N*m*s/rad")
def hot_friction_damping(
    pin_friction_torque: Scalar,
    preload_friction_torque: Scalar,
    bearing_friction_share: Scalar,
    spring_stiffness: Scalar,
    stroke_branch: tuple[Scalar, Scalar],
    frequency_at_hot: Scalar,
    stroke: Scalar,
) -> Scalar:
    """Viscous damping that loses as much in a cycle of the whole stroke as all friction in the hot joint.

    Pins and wave spring rub with a constant torque T, 4 T/(pi omega theta); bearings or bore as a force at the link's
    end loads them.
    """
    angular = 2.0 * np.pi * frequency_at_hot
    constant = friction.equivalent_damping(pin_friction_torque + preload_friction_torque, angular, stroke)
    stiffness = spring_stiffness + stroke_branch[0]
    loaded = friction.loaded_damping(bearing_friction_share, stiffness, stroke_branch[1], angular)
    return constant + loaded


@quantities.output("N*m*s/rad")
def hot_damping_at_stroke(
    stroke_branch: tuple[Scalar, Scalar], hot_friction_damping: Scalar, frequency_at_hot: Scalar
) -> Scalar:
    """Damping of the hot joint that swings over its whole stroke, friction counted.

    `joint_damping@hot` is that of small motions, without friction.
    """
    return stroke_branch[1] / (2.0 * np.pi * frequency_at_hot) + hot_friction_damping


@quantities.output("rad")
def cold_stroke(stroke: Scalar, holding_torque: Scalar, joint_stiffness_at_cold: Scalar) -> Scalar:
    """Angle over which the cold joint swings: its stroke, or as far as the torque that it holds turns it."""
    return np.fmin(stroke, holding_torque / joint_stiffness_at_cold)


@quantities.output("N*m*s/rad")
def cold_friction_damping(
    pin_friction_torque: Scalar, bearing_damping_at_cold: Scalar, frequency_at_cold: Scalar, cold_stroke: Scalar
) -> Scalar:
    """Viscous damping that loses as much in a cycle as friction of pins, bearings or bore in the cold joint.

    The wave spring does not rub while the PCL is frozen and the rotor off its stop.
    """
    angular = 2.0 * np.pi * frequency_at_cold
    return friction.equivalent_damping(pin_friction_torque, angular, cold_stroke) + bearing_damping_at_cold


@quantities.output("N*m*s/rad")
def cold_damping_at_stroke(joint_damping_at_cold: Scalar, cold_friction_damping: Scalar) -> Scalar:
    """Damping of the cold joint that swings over `cold_stroke`, friction counted; `joint_damping@cold` is without."""
    return joint_damping_at_cold + cold_friction_damping


@quantities.output("N*m*s/rad")
def hot_damping_at_stroke_least(
    stroke_strains: Strains,
    frequency_at_hot: Scalar,
    pcl_modes_at_hot: Modes,
    linear_strain_at_hot: Scalar,
    support_at_hot: tuple[Scalar, Scalar],
) -> Scalar:
    """Damping of the hot joint over its whole stroke if the melt remembered all of it: the least, without friction.

    Chains longer than the grade's mean remember longer than the record's spectrum says.
    """
    angular = 2.0 * np.pi * frequency_at_hot
    softened = [
        (share, large_strain.unrelaxed_moduli(strain, angular, pcl_modes_at_hot, linear_strain_at_hot))
        for strain, share in stroke_strains
    ]
    storage, loss = (sum(share * moduli[part] for share, moduli in softened) for part in (0, 1))
    return layer.series_stiffness(storage, loss, *support_at_hot)[1] / angular


@quantities.output("kPa", headline=True)
def melt_stress(largest_melt_strain: Scalar, storage_modulus_at_hot: Scalar, loss_modulus_at_hot: Scalar) -> Scalar:
    """Largest shear stress in the melt at full stroke and the hot point's frequency, softening by strain left out.

    So it is the most the melt can resist with.
    """
    return large_strain.shear_stress(largest_melt_strain, storage_modulus_at_hot, loss_modulus_at_hot)


@quantities.output(
    "1",
    Rule(sense=">=", value=1.0, reason="the melt breaks, or slips on its faces, at the hot point's frequency"),
    requires=CRYSTALLIZING,
)
def melt_stress_safety(pcl_melt_fracture_stress: Scalar, melt_stress: Scalar) -> Scalar:
    """Shear stress at which the flowing melt breaks over the largest it sees."""
    return pcl_melt_fracture_stress / melt_stress


@quantities.output("mrad", requires=CRYSTALLIZING)
def edge_fracture_angle(
    stroke: Scalar,
    largest_melt_strain: Scalar,
    pcl_depth: Scalar,
    pcl_melt_surface_tension: Scalar,
    pcl_normal_stress_ratio: Scalar,
    storage_modulus_at_hot: Scalar,
) -> Scalar:
    """Deflection beyond which surface tension alone does not hold the melt's free edge at the hot point's frequency.

    In order of magnitude. A layer that goes on to the stroke needs walls or time to close again.
    """
    largest = large_strain.edge_strain(
        pcl_depth, pcl_melt_surface_tension, pcl_normal_stress_ratio, storage_modulus_at_hot
    )
    return stroke * largest / largest_melt_strain
