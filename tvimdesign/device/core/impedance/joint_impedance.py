"""Stiffness and damping of the joint at its operating points: PCL, structure and springs together.

Each mode defines what its PCL and its structure are: `pcl_stiffness` and `pcl_damping`, and for spectra
`pcl_moment` over `pcl_depth` times the shear modulus, in series with `support`. `warm_structure.py` has the structure.

Creep of the PCL in a hold under load, and its cost in impedance.

The joint is at rest and its PCL free of stress; a load comes on at once, stays for `hold_time`, and goes. Meanwhile the
PCL relaxes, so that it would be free of stress somewhere else: `set_angle`. Each mode defines how much of
it can part from what presses on it, `parting_share`. A block that only pushes leaves a gap as wide as its set; a
layer bonded to both faces cannot part and acts in both senses from where it is, so that a hold takes nothing of its
impedance, however much of its stress has relaxed. The springs turn such a joint back all the same, more slowly.
"""

import numpy as np

from tvimdesign.base.record import Record
from tvimdesign.device.table import Feature, Module, QuantityGroup, Scalar, at_least
from tvimdesign.physics.layers import block, lasting_load, layer
from tvimdesign.physics.motions import motion, one_sided
from tvimdesign.physics.polymers import plastics, polymer, transitions, viscoelasticity
from tvimdesign.physics.solids import structure

CRYSTALLIZING = (Feature("pcl_freezing", "equilibrium"),)
GLASS = (Feature("pcl_softening", "melting"),)
quantities = QuantityGroup("Impedance")

quantities.inputs()


@quantities.helper()
def pcl_melting(m: Module) -> polymer.Melting:
    """Melting curve of the PCL."""
    return polymer.Melting(
        m.pcl_specific_heat_solid, m.pcl_specific_heat_melt, m.pcl_latent_heat, m.pcl_melting_start, m.pcl_melting_end,
        m.enthalpy_smoothing,
    )  # fmt: skip


@quantities.helper(requires=CRYSTALLIZING, default=None)
def pcl_kinetics(m: Module) -> transitions.Kinetics:
    """Freezing and melting of the PCL in time; none where it freezes as it melts."""
    return transitions.Kinetics(
        m.pcl_avrami_exponent, m.pcl_crystallization_half_time, m.pcl_crystallization_reference,
        m.pcl_nucleation_constant, m.pcl_equilibrium_melting_temperature, m.pcl_glass_transition,
        m.pcl_transport_energy, m.melting_time,
    )  # fmt: skip


@quantities.helper()
def pcl_solid_modulus(m: Module) -> polymer.SolidModulus:
    """Modulus of the frozen PCL."""
    return polymer.SolidModulus(
        m.pcl_flexural_modulus, m.pcl_reference_temperature, m.pcl_softening_slope, m.pcl_softening_onset,
        m.pcl_softening_width, m.pcl_poissons_ratio,
    )  # fmt: skip


def melt_modes(pcl_grade: Record, viscosity: Scalar = None, plateau: Scalar = None) -> polymer.Modes:
    """Return the relaxation spectrum of a melt from viscosity and plateau modulus, the grade's unless others are given.

    A spectrum of the grade's own is scaled to them.
    """
    viscosity = pcl_grade.value("zero_shear_viscosity") if viscosity is None else viscosity
    plateau = pcl_grade.value("plateau_modulus") if plateau is None else plateau
    if "melt_spectrum" not in pcl_grade.tables:
        return polymer.melt_spectrum(viscosity, plateau, len(pcl_grade.table("solid_spectrum")))
    stiffer = plateau / pcl_grade.value("plateau_modulus")
    later = viscosity / pcl_grade.value("zero_shear_viscosity") / stiffer
    return [(later * row["relaxation_time"], stiffer * row["modulus"]) for row in pcl_grade.table("melt_spectrum")]


def solid_modes(pcl_grade: Record) -> polymer.Modes:
    """Return the relaxation spectrum of a solid, its moduli relative to one another."""
    return [(row["relaxation_time"], row["relative_modulus"]) for row in pcl_grade.table("solid_spectrum")]


@quantities.helper(requires=GLASS, default=None)
def pcl_glass(m: Module) -> transitions.Glass:
    """Relaxation spectrum of a layer that softens through a glass transition, at any temperature."""
    at_reference = structure.shear_modulus(m.pcl_solid_modulus.reference_modulus, m.pcl_solid_modulus.poissons_ratio)
    transition = transitions.GlassTransition(
        m.pcl_glass_transition, m.pcl_wlf_c1, m.pcl_wlf_c2, m.pcl_glass_activation_energy
    )
    return transitions.Glass(
        at_reference, m.pcl_solid_modulus.reference_temperature, transition, solid_modes(m.pcl_grade)
    )


@quantities.helper(requires=CRYSTALLIZING, default=None)
def pcl_memory(m: Module) -> polymer.MeltMemory:
    """Memory of its crystals in the molten PCL; none where it freezes as it melts."""
    return polymer.MeltMemory(m.melt_memory, m.memory_temperature, m.memory_width, m.time_in_melt)


@quantities.output("1", per_point=True)
def memory_factor(m: Module) -> Scalar:
    """Viscosity of the melt over that without memory of its crystals, at an operating point."""
    return 1.0 if m.pcl_memory is None else np.exp(polymer.memory_shift(m.temperature, m.pcl_memory))


@quantities.helper()
def pcl_rheology(m: Module) -> polymer.AnyRheology:
    """Relaxation spectrum of the PCL at any temperature and solid fraction.

    Chains of another length relax sooner or later; the melt's plateau modulus is the same (Ferry, ch. 13).
    """
    if m.pcl_glass is not None:
        return m.pcl_glass
    solid = solid_modes(m.pcl_grade)
    modes = melt_modes(m.pcl_grade, m.pcl_zero_shear_viscosity, m.pcl_plateau_modulus)
    melt = [(m.melt_viscosity_factor * time, modulus) for time, modulus in modes]
    flow = m.pcl_flow_activation_energy, m.pcl_melt_reference
    return polymer.Rheology(m.pcl_solid_modulus, solid, melt, *flow, m.pcl_memory)


@quantities.helper()
def pcl_linear_range(m: Module) -> polymer.LinearRange:
    """Strains up to which the PCL's moduli do not depend on strain."""
    return polymer.LinearRange(m.pcl_linear_strain_solid, m.pcl_linear_strain_melt)


@quantities.output("1", per_point=True)
def solid_fraction(m: Module) -> Scalar:
    """Share of the PCL that is frozen, on the equilibrium melting curve."""
    return polymer.solid_fraction(polymer.enthalpy(m.temperature, m.pcl_melting), m.pcl_melting)


@quantities.output("%", per_point=True)
def linear_strain(m: Module) -> Scalar:
    """Shear strain up to which the PCL's moduli do not depend on it: the storage modulus has fallen 5 % there."""
    return polymer.linear_strain(m.solid_fraction, m.pcl_linear_range)


@quantities.helper(per_point=True)
def pcl_modes(m: Module) -> motion.Modes:
    """Maxwell elements of the PCL as it loads the joint: relaxation times [s] and stiffnesses [N*m/rad]."""
    return motion.layer_modes(
        polymer.spectrum(m.temperature, m.solid_fraction, m.pcl_rheology), m.pcl_moment, m.pcl_depth
    )


@quantities.helper(per_point=True)
def pcl_moduli(m: Module) -> tuple[Scalar, Scalar]:
    """Storage and loss modulus of the PCL [Pa]."""
    return polymer.moduli(m.temperature, m.solid_fraction, 2.0 * np.pi * m.frequency, m.pcl_rheology)


@quantities.output("Pa", per_point=True)
def storage_modulus(m: Module) -> Scalar:
    """Storage shear modulus of the PCL, G'."""
    return m.pcl_moduli[0]


@quantities.output("Pa", per_point=True)
def loss_modulus(m: Module) -> Scalar:
    """Loss shear modulus of the PCL, G''."""
    return m.pcl_moduli[1]


@quantities.output("1", per_point=True)
def loss_factor(m: Module) -> Scalar:
    """Loss factor of the PCL, tan(delta)."""
    return m.pcl_moduli[1] / m.pcl_moduli[0]


@quantities.helper()
def structure_shear_modulus(m: Module) -> Scalar:
    """Shear modulus of the structure [Pa]."""
    return structure.shear_modulus(m.structure_youngs_modulus, m.structure_poissons_ratio)


@quantities.output("mm", hidden=True)
def pcl_mean_radius(m: Module) -> Scalar:
    """Mean radius of the PCL."""
    return 0.5 * (m.pcl_inner_radius + m.pcl_outer_radius)


@quantities.helper(per_point=True)
def branch_stiffness(m: Module) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness of layer and structure in series [N*m/rad]."""
    loss = layer.loss_stiffness(m.pcl_damping, m.frequency)
    real, imaginary = layer.series_stiffness(m.pcl_stiffness, loss, *m.warm_structure)
    return m.branch_scale * real, m.branch_scale * imaginary


@quantities.output("N*m/rad", per_point=True, at_end="softened_impedance")
def joint_impedance(m: Module) -> Scalar:
    """Magnitude of the joint's dynamic stiffness, springs and damping together."""
    return impedance_beside(m.spring_stiffness, m.branch_stiffness)


def impedance_beside(springs: Scalar, branch: tuple[Scalar, Scalar]) -> Scalar:
    """Return the magnitude [N*m/rad] of springs beside a branch of real and imaginary stiffness."""
    return np.sqrt((springs + branch[0]) ** 2 + branch[1] ** 2)


@quantities.output("N*m/rad", per_point=True, headline=True, at_end="softened_stiffness")
def joint_stiffness(m: Module) -> Scalar:
    """Stiffness of the joint for small motions about rest: springs, parallel to the layer in series with structure."""
    return m.spring_stiffness + m.branch_stiffness[0]


@quantities.output("N*m*s/rad", per_point=True, headline=True, at_end="softened_damping")
def joint_damping(m: Module) -> Scalar:
    """Damping of the joint: the losses of layer and structure in series."""
    return m.branch_stiffness[1] / (2.0 * np.pi * m.frequency)


@quantities.output("Hz", per_point=True, headline=True)
def natural_frequency(m: Module) -> Scalar:
    """Undamped natural frequency of the joint with its load."""
    return motion.natural_frequency(m.joint_stiffness, m.moving_inertia)


@quantities.output("1", per_point=True, headline=True)
def damping_ratio(m: Module) -> Scalar:
    """Damping ratio of the joint with its load; above one it creeps back without ringing."""
    return motion.damping_ratio(m.joint_damping, m.joint_stiffness, m.moving_inertia)


@quantities.output("Hz", sprung=True)
def spring_natural_frequency(m: Module) -> Scalar:
    """Undamped natural frequency on the springs alone."""
    return motion.natural_frequency(m.spring_stiffness, m.moving_inertia)


@quantities.output("N*m*s/rad", sprung=True)
def critical_damping(m: Module) -> Scalar:
    """Damping above which the joint on its springs no longer rings."""
    return motion.critical_damping(m.spring_stiffness, m.moving_inertia)


@quantities.output("1", headline=True, at_end="softened_range")
def impedance_range(m: Module) -> Scalar:
    """Stiffness of the joint cold over hot."""
    return m.joint_stiffness_at_cold / m.joint_stiffness_at_hot


@quantities.output("kg*mm^2", advice=(at_least(0.0, "the module's own parts have more inertia than that"),))
def load_inertia(m: Module) -> Scalar:
    """Inertia that is left for the load: the moving inertia less that of the module's own parts."""
    return m.moving_inertia - m.parts_inertia


holds = QuantityGroup("Hold")

holds.inputs()


@holds.output("N*m")
def hold_torque(m: Module) -> Scalar:
    """Load of the hold; at `hold_share` 1 it turns the springs alone by the stroke."""
    return m.hold_share * m.spring_stiffness * m.stroke


@holds.helper(per_point=True)
def held(m: Module) -> lasting_load.Held:
    """Joint and PCL at the end of the hold."""
    return lasting_load.held(m.hold_torque, m.hold_time, m.spring_stiffness, m.elastic_support, m.pcl_modes)


@holds.output("rad", per_point=True)
def hold_angle(m: Module) -> Scalar:
    """Angle to which the load has turned the joint at the end of the hold."""
    return m.held.angle


@holds.output("N*m/rad")
def creep_stiffness(m: Module) -> Scalar:
    """Torque on the frozen link over the angle that it turns further in an hour, as structure and PCL creep.

    The PCL's creep compliance is at most the reciprocal of its relaxed stiffness, which is taken for it.
    """
    law = plastics.Creep(m.structure_creep_share, m.structure_creep_exponent, m.structure_creep_energy)
    crept = plastics.growth(plastics.aged(plastics.HOUR, m.temperature_at_cold, law), law)
    relaxed = viscoelasticity.relaxation_modulus(plastics.HOUR, m.pcl_modes_at_cold)
    branch = 1.0 / (1.0 / relaxed + (1.0 + crept) / m.elastic_support_at_cold)
    after = 1.0 / (m.spring_stiffness + branch)
    return 1.0 / (after - 1.0 / m.joint_stiffness_at_cold + crept / m.link_stiffness)


@holds.output("1", per_point=True)
def pcl_relaxation(m: Module) -> Scalar:
    """Share of its stress that the PCL loses when it is held at an angle as long; not a share of the impedance."""
    return block.relaxation_loss(m.hold_time, m.pcl_modes)


@holds.output("rad", per_point=True)
def set_angle(m: Module) -> Scalar:
    """Angle at which the PCL is free of stress right after the hold; before, that was at rest."""
    return m.held.set_angle


@holds.output("rad", per_point=True, headline=True)
def backlash(m: Module) -> Scalar:
    """Angle over which only the springs act after the joint was held off rest; none where both faces bond the PCL."""
    return m.parting_share * m.set_angle


@holds.output("1", per_point=True, headline=True)
def relaxation_loss(m: Module) -> Scalar:
    """Share of the torque of a quick turn from rest that is lost once the joint was held where the turn ends.

    A bonded layer that has relaxed takes the whole torque of such a turn: it starts from the stress it has.
    """
    return lasting_load.impedance_loss(m.hold_angle, m.backlash, m.spring_stiffness, m.elastic_support, m.pcl_modes)


@holds.first_oscillation("1")
def contact_lost(m: Module) -> Scalar:
    """Share of the first swing of a released link, up to its second turn, in which no PCL is in contact."""
    return one_sided.out_of_contact(m.touching)
