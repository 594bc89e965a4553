"""Content of a record of the layer's material: a polymer that crystallizes, a metal, a wax or a glass."""

from __future__ import annotations

from tvimdesign.catalog.category import Category, Columns, PowerLaw

POLYMERS = Category(
    values={
        "density_solid": "kg/m^3",
        "density_melt": "kg/m^3",
        "surface_tension": "N/m",
        "specific_heat_solid": "J/kg/K",
        "specific_heat_melt": "J/kg/K",
        "conductivity_solid": "W/m/K",
        "conductivity_melt": "W/m/K",
        "melting_start": "degC",
        "melting_end": "degC",
        "flexural_modulus": "MPa",
        "reference_temperature": "degC",
        "poissons_ratio": "1",
        "linear_strain_solid": "1",
        "tensile_yield": "MPa",
        "bond_strength": "MPa",
        "decomposition_temperature": "degC",
    },
    words={"freezing": ("kinetics", "equilibrium"), "softening": ("melting", "glass")},
    usual_words={"freezing": "kinetics", "softening": "melting"},
    values_of={
        "kinetics": {
            "avrami_exponent": "1",
            "crystallization_half_time": "s",
            "crystallization_reference": "degC",
            "nucleation_constant": "K^2",
            "equilibrium_melting_temperature": "degC",
            "glass_transition": "degC",
            "transport_energy": "kJ/mol",
            "linear_strain_melt": "1",
            "melt_strain_limit": "1",
            "melt_fracture_stress": "MPa",
            "melt_surface_tension": "N/m",
            "normal_stress_ratio": "1",
        },
        "melting": {
            "latent_heat": "kJ/kg",
            "softening_slope": "1/K",
            "softening_onset": "degC",
            "softening_width": "K",
            "flow_activation_energy": "kJ/mol",
            "melt_reference_temperature": "degC",
            "zero_shear_viscosity": "Pa*s",
            "plateau_modulus": "MPa",
        },
        "glass": {
            "glass_transition": "degC",
            "wlf_c1": "1",
            "wlf_c2": "K",
            "glass_activation_energy": "kJ/mol",
            "linear_strain_melt": "1",
            "melt_strain_limit": "1",
        },
    },
    may_have={"resistivity": "ohm*m"},
    tables={
        "melt_spectrum": Columns({"relaxation_time": "s", "modulus": "Pa"}, falling=("relaxation_time",)),
        "solid_spectrum": Columns({"relaxation_time": "s", "relative_modulus": "1"}, falling=("relaxation_time",)),
    },
    paired=("melt_spectrum", "solid_spectrum"),
    instead={
        "melt_spectrum": {
            "plateau_modulus": ("modulus",),
            "zero_shear_viscosity": ("modulus", "relaxation_time"),
        }
    },
    follows={
        "zero_shear_viscosity": PowerLaw(
            "known_viscosity", "molar_mass", "known_molar_mass", "viscosity_exponent", "kg/mol"
        )
    },
    rising=(
        ("density_melt", "density_solid"),
        ("reference_temperature", "melting_start", "melting_end", "decomposition_temperature"),
    ),
    rising_of={
        "kinetics": (
            ("glass_transition", "crystallization_reference", "equilibrium_melting_temperature"),
            ("melting_start", "equilibrium_melting_temperature"),
        ),
        "glass": (("melting_start", "glass_transition", "melting_end"),),
    },
    laws={
        "kinetics of freezing": ("crystallization_half_time", "nucleation_constant", "avrami_exponent"),
        "viscosity of the melt": ("zero_shear_viscosity", "known_viscosity", "molar_mass", "melt_spectrum"),
        "losses of the solid": ("solid_spectrum",),
    },
    own_laws={
        "kinetics": ("kinetics of freezing",),
        "melting": ("viscosity of the melt", "losses of the solid"),
        "glass": ("losses of the solid",),
    },
    material=("melting_start", "melting_end", "density_solid"),
)
