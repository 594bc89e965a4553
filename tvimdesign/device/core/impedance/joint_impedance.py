"""Stiffness and damping of the joint at its operating points: PCL, structure and springs together.

Each mode says in its own room what its PCL and its structure are: `pcl_stiffness` and `pcl_damping`, and for spectra
`pcl_moment` over `pcl_depth` times the shear modulus, in series with `support`. `warm_structure.py` has the structure.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.base.record import Record
from tvimdesign.device.core.materials import CRYSTALLIZING, GLASS
from tvimdesign.device.table.quantity import Rule, Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.layers import layer
from tvimdesign.physics.motions import dynamics, motion
from tvimdesign.physics.polymers import crystallization, glass, polymer
from tvimdesign.physics.solids import structure

quantities = QuantityGroup("Impedance")

quantities.inputs()


@quantities.helper()
def pcl_melting(
    pcl_specific_heat_solid: Scalar,
    pcl_specific_heat_melt: Scalar,
    pcl_latent_heat: Scalar,
    pcl_melting_start: Scalar,
    pcl_melting_end: Scalar,
    enthalpy_smoothing: Scalar,
) -> polymer.Melting:
    """Melting curve of the PCL."""
    return polymer.Melting(pcl_specific_heat_solid, pcl_specific_heat_melt, pcl_latent_heat, pcl_melting_start,
                           pcl_melting_end, enthalpy_smoothing)  # fmt: skip


@quantities.helper(requires=CRYSTALLIZING, default=None)
def pcl_kinetics(
    pcl_avrami_exponent: Scalar,
    pcl_crystallization_half_time: Scalar,
    pcl_crystallization_reference: Scalar,
    pcl_nucleation_constant: Scalar,
    pcl_equilibrium_melting_temperature: Scalar,
    pcl_glass_transition: Scalar,
    pcl_transport_energy: Scalar,
    melting_time: Scalar,
) -> crystallization.Kinetics:
    """Freezing and melting of the PCL in time; none where it freezes as it melts."""
    return crystallization.Kinetics(pcl_avrami_exponent, pcl_crystallization_half_time, pcl_crystallization_reference,
                                    pcl_nucleation_constant, pcl_equilibrium_melting_temperature, pcl_glass_transition,
                                    pcl_transport_energy, melting_time)  # fmt: skip


@quantities.helper()
def pcl_solid_modulus(
    pcl_flexural_modulus: Scalar,
    pcl_reference_temperature: Scalar,
    pcl_softening_slope: Scalar,
    pcl_softening_onset: Scalar,
    pcl_softening_width: Scalar,
    pcl_poissons_ratio: Scalar,
) -> polymer.SolidModulus:
    """Modulus of the frozen PCL."""
    return polymer.SolidModulus(pcl_flexural_modulus, pcl_reference_temperature, pcl_softening_slope,
                                pcl_softening_onset, pcl_softening_width, pcl_poissons_ratio)  # fmt: skip


def melt_modes(pcl_grade: Record, viscosity: Scalar = None, plateau: Scalar = None) -> polymer.Modes:
    """Relaxation spectrum of a melt from viscosity and plateau modulus, the grade's unless others are given.

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
    """Relaxation spectrum of a solid, its moduli relative to one another."""
    return [(row["relaxation_time"], row["relative_modulus"]) for row in pcl_grade.table("solid_spectrum")]


@quantities.helper(requires=GLASS, default=None)
def pcl_glass(
    pcl_solid_modulus: polymer.SolidModulus,
    pcl_grade: Record,
    pcl_glass_transition: Scalar,
    pcl_wlf_c1: Scalar,
    pcl_wlf_c2: Scalar,
    pcl_glass_activation_energy: Scalar,
) -> glass.Glass:
    """Relaxation spectrum of a layer that softens through a glass transition, at any temperature."""
    at_reference = structure.shear_modulus(pcl_solid_modulus.reference_modulus, pcl_solid_modulus.poissons_ratio)
    transition = glass.GlassTransition(pcl_glass_transition, pcl_wlf_c1, pcl_wlf_c2, pcl_glass_activation_energy)
    return glass.Glass(at_reference, pcl_solid_modulus.reference_temperature, transition, solid_modes(pcl_grade))


@quantities.helper()
def pcl_rheology(
    pcl_solid_modulus: polymer.SolidModulus,
    pcl_glass: glass.Glass | None,
    pcl_grade: Record,
    pcl_zero_shear_viscosity: Scalar,
    pcl_plateau_modulus: Scalar,
    pcl_flow_activation_energy: Scalar,
    pcl_melt_reference: Scalar,
    melt_viscosity_factor: Scalar,
) -> polymer.AnyRheology:
    """Relaxation spectrum of the PCL at any temperature and solid fraction.

    Chains of another length relax sooner or later; the melt's plateau modulus is the same (Ferry, ch. 13).
    """
    if pcl_glass is not None:
        return pcl_glass
    solid = solid_modes(pcl_grade)
    modes = melt_modes(pcl_grade, pcl_zero_shear_viscosity, pcl_plateau_modulus)
    melt = [(melt_viscosity_factor * time, modulus) for time, modulus in modes]
    return polymer.Rheology(pcl_solid_modulus, solid, melt, pcl_flow_activation_energy, pcl_melt_reference)


@quantities.helper()
def pcl_linear_range(pcl_linear_strain_solid: Scalar, pcl_linear_strain_melt: Scalar) -> polymer.LinearRange:
    """Strains up to which the PCL's moduli do not depend on strain."""
    return polymer.LinearRange(pcl_linear_strain_solid, pcl_linear_strain_melt)


@quantities.output("1", per_point=True)
def solid_fraction(temperature: Scalar, pcl_melting: polymer.Melting) -> Scalar:
    """Share of the PCL that is frozen, on the equilibrium melting curve."""
    return polymer.solid_fraction(polymer.enthalpy(temperature, pcl_melting), pcl_melting)


@quantities.output("%", per_point=True)
def linear_strain(solid_fraction: Scalar, pcl_linear_range: polymer.LinearRange) -> Scalar:
    """Shear strain up to which the PCL's moduli do not depend on it: the storage modulus has fallen 5 % there."""
    return polymer.linear_strain(solid_fraction, pcl_linear_range)


@quantities.helper(per_point=True)
def pcl_modes(
    temperature: Scalar,
    solid_fraction: Scalar,
    pcl_rheology: polymer.AnyRheology,
    pcl_moment: Scalar,
    pcl_depth: Scalar,
) -> motion.Modes:
    """Maxwell elements of the PCL as it loads the joint: relaxation times [s] and stiffnesses [N*m/rad]."""
    return motion.layer_modes(polymer.spectrum(temperature, solid_fraction, pcl_rheology), pcl_moment, pcl_depth)


@quantities.helper(per_point=True)
def pcl_moduli(
    temperature: Scalar, frequency: Scalar, solid_fraction: Scalar, pcl_rheology: polymer.AnyRheology
) -> tuple[Scalar, Scalar]:
    """Storage and loss modulus of the PCL [Pa]."""
    return polymer.moduli(temperature, solid_fraction, 2.0 * np.pi * frequency, pcl_rheology)


@quantities.output("Pa", per_point=True)
def storage_modulus(pcl_moduli: tuple[Scalar, Scalar]) -> Scalar:
    """Storage shear modulus of the PCL, G'."""
    return pcl_moduli[0]


@quantities.output("Pa", per_point=True)
def loss_modulus(pcl_moduli: tuple[Scalar, Scalar]) -> Scalar:
    """Loss shear modulus of the PCL, G''."""
    return pcl_moduli[1]


@quantities.output("1", per_point=True)
def loss_factor(pcl_moduli: tuple[Scalar, Scalar]) -> Scalar:
    """Loss factor of the PCL, tan(delta)."""
    return pcl_moduli[1] / pcl_moduli[0]


@quantities.helper()
def structure_shear_modulus(structure_youngs_modulus: Scalar, structure_poissons_ratio: Scalar) -> Scalar:
    """Shear modulus of the structure [Pa]."""
    return structure.shear_modulus(structure_youngs_modulus, structure_poissons_ratio)


@quantities.helper()
def pcl_mean_radius(pcl_inner_radius: Scalar, pcl_outer_radius: Scalar) -> Scalar:
    """Mean radius of the PCL [m]."""
    return 0.5 * (pcl_inner_radius + pcl_outer_radius)


@quantities.helper(per_point=True)
def branch_stiffness(
    pcl_stiffness: Scalar, pcl_damping: Scalar, frequency: Scalar, warm_structure: tuple[Scalar, Scalar]
) -> tuple[Scalar, Scalar]:
    """Real and imaginary stiffness of layer and structure in series [N*m/rad]."""
    loss = layer.loss_stiffness(pcl_damping, frequency)
    return layer.series_stiffness(pcl_stiffness, loss, *warm_structure)


@quantities.output("N*m/rad", per_point=True)
def joint_impedance(spring_stiffness: Scalar, branch_stiffness: tuple[Scalar, Scalar]) -> Scalar:
    """Magnitude of the joint's dynamic stiffness, springs and damping together."""
    return np.sqrt((spring_stiffness + branch_stiffness[0]) ** 2 + branch_stiffness[1] ** 2)


@quantities.output("N*m/rad", per_point=True, headline=True)
def joint_stiffness(spring_stiffness: Scalar, branch_stiffness: tuple[Scalar, Scalar]) -> Scalar:
    """Stiffness of the joint: springs, parallel to the layer in series with the structure."""
    return spring_stiffness + branch_stiffness[0]


@quantities.output("N*m*s/rad", per_point=True, headline=True)
def joint_damping(branch_stiffness: tuple[Scalar, Scalar], frequency: Scalar) -> Scalar:
    """Damping of the joint: the losses of layer and structure in series."""
    return branch_stiffness[1] / (2.0 * np.pi * frequency)


@quantities.output("Hz", per_point=True, headline=True)
def natural_frequency(joint_stiffness: Scalar, moving_inertia: Scalar) -> Scalar:
    """Undamped natural frequency of the joint with its load."""
    return dynamics.natural_frequency(joint_stiffness, moving_inertia)


@quantities.output("1", per_point=True, headline=True)
def damping_ratio(joint_damping: Scalar, joint_stiffness: Scalar, moving_inertia: Scalar) -> Scalar:
    """Damping ratio of the joint with its load; above one it creeps back without ringing."""
    return dynamics.damping_ratio(joint_damping, joint_stiffness, moving_inertia)


@quantities.output("Hz")
def spring_natural_frequency(spring_stiffness: Scalar, moving_inertia: Scalar) -> Scalar:
    """Undamped natural frequency on the springs alone."""
    return dynamics.natural_frequency(spring_stiffness, moving_inertia)


@quantities.output("N*m*s/rad")
def critical_damping(spring_stiffness: Scalar, moving_inertia: Scalar) -> Scalar:
    """Damping above which the joint on its springs no longer rings."""
    return dynamics.critical_damping(spring_stiffness, moving_inertia)


@quantities.output("1", headline=True)
def impedance_range(joint_stiffness_at_cold: Scalar, joint_stiffness_at_hot: Scalar) -> Scalar:
    """Stiffness of the joint cold over hot."""
    return joint_stiffness_at_cold / joint_stiffness_at_hot


@quantities.output("1")
def damping_range(joint_damping_at_cold: Scalar, joint_damping_at_hot: Scalar) -> Scalar:
    """Damping of the joint cold over hot."""
    return joint_damping_at_cold / joint_damping_at_hot


@quantities.output(
    "kg*mm^2", advice=(Rule(sense=">=", value=0.0, reason="the module's own parts have more inertia than that"),)
)
def load_inertia(moving_inertia: Scalar, parts_inertia: Scalar) -> Scalar:
    """Inertia that is left for the load: the moving inertia less that of the module's own parts."""
    return moving_inertia - parts_inertia
