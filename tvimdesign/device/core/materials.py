"""Materials of the module: the chosen catalogue records and the numbers taken from them."""

from tvimdesign.device.table.quantity import Feature
from tvimdesign.device.table.quantity_group import QuantityGroup

CRYSTALLIZING = (Feature("pcl_freezing", "equilibrium"),)
MELTING = (Feature("pcl_softening", "glass"),)
GLASS = (Feature("pcl_softening", "melting"),)
_KINDS = {
    CRYSTALLIZING: (
        "avrami_exponent", "crystallization_half_time", "crystallization_reference", "nucleation_constant",
        "equilibrium_melting_temperature", "transport_energy", "melt_fracture_stress", "melt_surface_tension",
        "normal_stress_ratio",
    ),
    MELTING: (
        "latent_heat", "softening_slope", "softening_onset", "softening_width", "zero_shear_viscosity",
        "plateau_modulus", "flow_activation_energy", "melt_reference_temperature",
    ),
    GLASS: ("wlf_c1", "wlf_c2", "glass_activation_energy"),
}  # fmt: skip
"""The values of a record that only a material of some kind has."""
_NO_LIMIT = 1e3  # Strain of a liquid that nothing limits [1]

quantities = QuantityGroup("Materials")

quantities.record(
    "stock_spring", "torsion_springs", "none",
    "Torsion spring from stock: its wire, coil and material as a whole; or none, wound to order", others=("none",),
)  # fmt: skip
quantities.record(
    "spring_material", "spring_materials", "music_wire", "Spring steel of the torsion springs",
    stock_record=("stock_spring", "spring_material"),
)  # fmt: skip
quantities.record("process", "processes", "print_petg", "How housing, rotor, link and retainer are made")
quantities.record(
    "structure_material",
    "structure_materials",
    ("process", "structure_material"),
    "Material of housing, rotor, link and retainer",
)
quantities.record("pcl_grade", "polymers", "pcl_80k", "Grade of polycaprolactone, or other material, in the layer")
quantities.option(
    "pcl_freezing",
    ("kinetics", "equilibrium"),
    "How the layer's material freezes: a polymer late and supercooled, a metal or a wax where it melts",
    record=("pcl_grade", "freezing"),
)
quantities.option(
    "pcl_softening",
    ("melting", "glass"),
    "How the layer's material softens: by melting, or through a glass transition without latent heat",
    record=("pcl_grade", "softening"),
)
quantities.record(
    "peltier_module", "peltiers", "flexible_1600", "Heater under the layer: Peltier module, foil or silicone"
)

quantities.record(
    "heater_fuse", "thermal_fuses", "ultimheat_5ma3", "Thermal cut-out in the heater's leads, or none", others=("none",)
)

quantities.record(
    "heat_paths",
    "heat_paths",
    "handbook",
    "How heat passes faces that touch and leaves the module: of handbooks, or its log",
)

quantities.record(
    "joint", "joints", "none", "What swings or sines of the joint told of its inertia, friction and loss, or none",
    others=("none",),
)  # fmt: skip

for name, unit, field, description in (
    ("spring_youngs_modulus", "GPa", "youngs_modulus", "Young's modulus of the spring wire"),
    ("spring_density", "kg/m^3", "density", "Density of the spring wire"),
    ("spring_yield_ratio", "1", "yield_ratio", "Static yield in bending as a share of tensile strength"),
    ("spring_fatigue_ratio", "1", "fatigue_strength_ratio", "Repeated-bending strength at 1e6 cycles over tensile"),
):
    quantities.property(name, unit, ("spring_material", field), description)

for name, unit, field, description in (
    ("structure_youngs_modulus", "GPa", "youngs_modulus", "Young's modulus of the structure"),
    ("structure_poissons_ratio", "1", "poissons_ratio", "Poisson's ratio of the structure"),
    ("structure_density", "kg/m^3", "density", "Density of the structure"),
    ("structure_conductivity", "W/m/K", "thermal_conductivity", "Thermal conductivity of the structure"),
    ("structure_specific_heat", "J/kg/K", "specific_heat", "Specific heat of the structure"),
    ("structure_strength", "MPa", "yield_strength", "Yield strength of the structure"),
    ("structure_layer_strength", "MPa", "yield_strength_across_layers", "Yield strength across the layers of a print"),
    ("structure_loss_factor", "1", "loss_factor", "Loss factor of the structure at the pace of a limb, tan(delta)"),
    ("structure_modulus_slope", "1/K", "modulus_slope", "Fall of ln E of the structure per kelvin, far from softening"),
    (
        "structure_softening_temperature",
        "degC",
        "softening_temperature",
        "Middle of the structure's softening, in ln E",
    ),
    ("structure_softening_width", "K", "softening_width", "Width of that softening"),
    ("structure_softened_share", "1", "softened_share", "Modulus of the softened structure over that at 23 degC"),
    ("structure_softening_loss_factor", "1", "softening_loss_factor", "Loss factor in the middle of the softening"),
    ("structure_creep_share", "1", "creep_share", "Creep of the structure in an hour at 23 degC, of its elastic give"),
    ("structure_creep_exponent", "1", "creep_exponent", "Power of time with which the structure creeps"),
    ("structure_creep_energy", "kJ/mol", "creep_energy", "Activation energy by which warmth hastens that creep"),
    ("structure_service_temperature", "degC", "service_temperature", "Highest continuous temperature of the structure"),
):
    quantities.property(name, unit, ("structure_material", field), description)

for name, unit, field, description in (
    ("pcl_density", "kg/m^3", "density_solid", "Density of the frozen PCL"),
    ("pcl_melt_density", "kg/m^3", "density_melt", "Density of the molten PCL"),
    ("pcl_specific_heat_solid", "J/kg/K", "specific_heat_solid", "Specific heat of the frozen PCL"),
    ("pcl_specific_heat_melt", "J/kg/K", "specific_heat_melt", "Specific heat of the molten PCL"),
    ("pcl_conductivity_solid", "W/m/K", "conductivity_solid", "Thermal conductivity of the frozen PCL"),
    ("pcl_conductivity_melt", "W/m/K", "conductivity_melt", "Thermal conductivity of the molten PCL"),
    ("pcl_latent_heat", "kJ/kg", "latent_heat", "Latent heat of melting of the semicrystalline PCL"),
    ("pcl_melting_start", "degC", "melting_start", "Temperature at which melting starts"),
    ("pcl_melting_end", "degC", "melting_end", "Temperature at which melting ends"),
    ("pcl_flexural_modulus", "MPa", "flexural_modulus", "Young's modulus of the frozen PCL at its reference"),
    ("pcl_reference_temperature", "degC", "reference_temperature", "Reference temperature of that modulus"),
    ("pcl_softening_slope", "1/K", "softening_slope", "Fall of ln E per kelvin well above the softening onset"),
    ("pcl_softening_onset", "degC", "softening_onset", "Temperature at which the frozen PCL starts to soften"),
    ("pcl_softening_width", "K", "softening_width", "Width of that onset"),
    ("pcl_poissons_ratio", "1", "poissons_ratio", "Poisson's ratio of the frozen PCL"),
    ("pcl_linear_strain_solid", "%", "linear_strain_solid", "Strain at which the frozen PCL's G' has fallen 5 %"),
    ("pcl_linear_strain_melt", "%", "linear_strain_melt", "Strain at which the molten PCL's G' has fallen 5 %"),
    ("pcl_tensile_yield", "MPa", "tensile_yield", "Tensile yield strength of the frozen PCL"),
    (
        "pcl_decomposition_temperature",
        "degC",
        "decomposition_temperature",
        "Temperature at which PCL starts to decompose",
    ),
    ("pcl_zero_shear_viscosity", "Pa*s", "zero_shear_viscosity", "Viscosity of the slowly flowing melt"),
    ("pcl_plateau_modulus", "MPa", "plateau_modulus", "Rubbery plateau of the melt's shear modulus"),
    ("pcl_melt_fracture_stress", "MPa", "melt_fracture_stress", "Shear stress at which a flowing melt breaks"),
    ("pcl_melt_surface_tension", "N/m", "melt_surface_tension", "Surface tension of the melt"),
    ("pcl_normal_stress_ratio", "1", "normal_stress_ratio", "Second over first normal stress difference of the melt"),
    ("pcl_flow_activation_energy", "kJ/mol", "flow_activation_energy", "Flow activation energy of the melt"),
    ("pcl_melt_reference", "degC", "melt_reference_temperature", "Temperature of the melt's relaxation spectrum"),
    ("pcl_avrami_exponent", "1", "avrami_exponent", "Avrami exponent of the freezing PCL"),
    ("pcl_crystallization_half_time", "s", "crystallization_half_time", "Time in which half freezes at its reference"),
    ("pcl_crystallization_reference", "degC", "crystallization_reference", "Reference temperature of that half-time"),
    ("pcl_nucleation_constant", "K^2", "nucleation_constant", "Nucleation constant K_g of the freezing PCL"),
    ("pcl_equilibrium_melting_temperature", "degC", "equilibrium_melting_temperature", "No PCL freezes above that"),
    ("pcl_glass_transition", "degC", "glass_transition", "Glass transition of the PCL"),
    ("pcl_transport_energy", "kJ/mol", "transport_energy", "Activation energy of transport to the growing crystal"),
    ("pcl_wlf_c1", "1", "wlf_c1", "First WLF constant of a glassy layer, at its glass transition"),
    ("pcl_wlf_c2", "K", "wlf_c2", "Second WLF constant of a glassy layer, at its glass transition"),
    ("pcl_glass_activation_energy", "kJ/mol", "glass_activation_energy", "Activation energy below that transition"),
):
    kind = next((kind for kind, fields in _KINDS.items() if field in fields), ())
    least = {"linear_strain_melt": _NO_LIMIT, "glass_transition": 0.0}.get(field)
    quantities.property(name, unit, ("pcl_grade", field), description, requires=kind, default=least)

for name, unit, field, description in (
    ("pcl_bond_strength", "MPa", "bond_strength", "Traction the bond of layer and faces bears"),
    ("pcl_surface_tension", "N/m", "surface_tension", "Surface tension of the molten PCL"),
    ("pcl_melt_strain_limit", "1", "melt_strain_limit", "Shear strain the molten layer bears without tearing"),
):
    unlimited = _NO_LIMIT if field == "melt_strain_limit" else None
    quantities.property(name, unit, ("pcl_grade", field), description, mode="shear", default=unlimited)

for name, unit, field, description in (
    ("peltier_seebeck", "V/K", "seebeck", "Seebeck coefficient of one heater"),
    ("peltier_resistance", "ohm", "resistance", "Electrical resistance of one heater"),
    ("peltier_conductance", "W/K", "conductance", "Thermal conductance of one heater"),
    ("peltier_shear_modulus", "MPa", "shear_modulus", "Shear modulus of the heater as a sheet"),
    ("peltier_thickness", "mm", "thickness", "Thickness of the heater"),
    ("peltier_area", "mm^2", "area", "Area of one heater"),
    ("peltier_unit_mass", "g", "mass", "Mass of one heater"),
    ("peltier_specific_heat", "J/kg/K", "specific_heat", "Specific heat of the heater"),
    ("peltier_max_temperature", "degC", "max_temperature", "Highest temperature the heater is rated for"),
    ("peltier_max_current", "A", "max_current", "Highest current the heater is rated for"),
):
    quantities.property(name, unit, ("peltier_module", field), description)
