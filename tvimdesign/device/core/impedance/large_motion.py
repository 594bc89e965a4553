"""The molten joint over its whole stroke, not only in small motions: stiffness, damping, and the stress in the melt.

An oscillation to the full stroke at the hot point's temperature and frequency. The melt remembers a fraction of a
second, so it is strained less than the stroke says (Wagner's equation, `physics/polymers/melt.py`). Each mode
defines what its strains are: `stroke_strains`, (strain [1], share of the small-motion torque [1]) at
nodes, and `largest_melt_strain`.
The springs count by the first harmonic of their torque. Their slope falls nearly in proportion to the angle's square,
so that this is their slope at half the stroke: the mean of k0 - c (A cos x)^2, weighted by sin^2 x, is k0 - c (A/2)^2.
"""

from collections.abc import Sequence

import numpy as np

from tvimdesign.device.core.impedance.joint_impedance import CRYSTALLIZING
from tvimdesign.device.table import Module, QuantityGroup, Scalar
from tvimdesign.physics.layers import layer
from tvimdesign.physics.motions import contacts
from tvimdesign.physics.polymers import melt

quantities = QuantityGroup("Impedance")

Strains = Sequence[tuple[Scalar, Scalar]]


@quantities.helper()
def stroke_branch(m: Module) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness [N*m/rad] of the molten PCL and what is in series, at full stroke."""
    angular = 2.0 * np.pi * m.frequency_at_hot
    softened = [
        (share, melt.wagner_moduli(strain, angular, m.pcl_modes_at_hot, m.linear_strain_at_hot))
        for strain, share in m.stroke_strains
    ]
    storage, loss = (sum(share * moduli[part] for share, moduli in softened) for part in (0, 1))
    return layer.series_stiffness(storage, loss, *m.support_at_hot)


@quantities.output("N*m/rad")
def hot_stiffness_at_stroke(m: Module) -> Scalar:
    """Stiffness of the hot joint that swings over its whole stroke: springs as at half of it, and the strained PCL.

    `joint_stiffness@hot` is that of small motions about rest.
    """
    return m.spring_stiffness_half_stroke + m.stroke_branch[0]


@quantities.output("N*m*s/rad")
def hot_friction_damping(m: Module) -> Scalar:
    """Viscous damping that loses as much in a cycle of the whole stroke as all friction in the hot joint.

    Pins and wave spring rub with a constant torque T, 4 T/(pi omega theta); bearings or bore as a force at the link's
    end loads them.
    """
    angular = 2.0 * np.pi * m.frequency_at_hot
    constant = contacts.equivalent_damping(m.pin_friction_torque + m.preload_friction_torque, angular, m.stroke)
    stiffness, loss = hot_stiffness_at_stroke(m), m.stroke_branch[1]
    return constant + contacts.loaded_damping(m.bearing_friction_share, stiffness, loss, angular)


@quantities.output("N*m*s/rad")
def hot_damping_at_stroke(m: Module) -> Scalar:
    """Damping of the hot joint that swings over its whole stroke, friction counted.

    `joint_damping@hot` is that of small motions, without friction.
    """
    return m.stroke_branch[1] / (2.0 * np.pi * m.frequency_at_hot) + m.hot_friction_damping


@quantities.output("rad")
def cold_stroke(m: Module) -> Scalar:
    """Angle over which the cold joint swings: its stroke, or as far as the torque that it holds turns it."""
    return np.fmin(m.stroke, m.holding_torque / m.joint_stiffness_at_cold)


@quantities.output("N*m*s/rad")
def cold_friction_damping(m: Module) -> Scalar:
    """Viscous damping that loses as much in a cycle as friction of pins, bearings or bore in the cold joint.

    The wave spring does not rub while the PCL is frozen and the rotor off its stop.
    """
    angular = 2.0 * np.pi * m.frequency_at_cold
    return contacts.equivalent_damping(m.pin_friction_torque, angular, m.cold_stroke) + m.bearing_damping_at_cold


@quantities.output("N*m*s/rad")
def cold_damping_at_stroke(m: Module) -> Scalar:
    """Damping of the cold joint that swings over `cold_stroke`, friction counted; `joint_damping@cold` is without."""
    return m.joint_damping_at_cold + m.cold_friction_damping


@quantities.output("N*m*s/rad")
def hot_damping_at_stroke_least(m: Module) -> Scalar:
    """Damping of the hot joint over its whole stroke if the melt remembered all of it: the least, without friction.

    Chains longer than the grade's mean remember longer than the record's spectrum says.
    """
    angular = 2.0 * np.pi * m.frequency_at_hot
    softened = [
        (share, melt.unrelaxed_moduli(strain, angular, m.pcl_modes_at_hot, m.linear_strain_at_hot))
        for strain, share in m.stroke_strains
    ]
    storage, loss = (sum(share * moduli[part] for share, moduli in softened) for part in (0, 1))
    return layer.series_stiffness(storage, loss, *m.support_at_hot)[1] / angular


@quantities.output("kPa", headline=True)
def melt_stress(m: Module) -> Scalar:
    """Largest shear stress in the melt at full stroke and the hot point's frequency, softening by strain left out.

    So it is the most the melt can resist with.
    """
    return melt.shear_stress(m.largest_melt_strain, m.storage_modulus_at_hot, m.loss_modulus_at_hot)


quantities.margins("large_motion")


@quantities.output("mrad", requires=CRYSTALLIZING)
def edge_fracture_angle(m: Module) -> Scalar:
    """Deflection beyond which surface tension alone does not hold the melt's free edge at the hot point's frequency.

    In order of magnitude. A layer that goes on to the stroke needs walls or time to close again.
    """
    largest = melt.edge_strain(
        m.pcl_depth, m.pcl_melt_surface_tension, m.pcl_normal_stress_ratio, m.storage_modulus_at_hot
    )
    return m.stroke * largest / m.largest_melt_strain
