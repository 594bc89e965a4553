"""Adhesive that carries the joint's torque past the heaters, and the shear that heaters bear themselves."""

import numpy as np

from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Feature, Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.solids import structure

WITH_PADS = (Feature("heater_form", "rigid"),)
METAL = "milled"

kinds, strengths = QuantityGroup("Materials"), QuantityGroup("Impedance")

kinds.record(
    "heater_adhesive",
    "adhesives",
    "scotch_weld_dp760",
    "Adhesive between the structure and the heaters, or their spreaders",
)
_THAT = "of the heaters' adhesive"
for name, unit, field, mode, description in (
    ("strength", "MPa", "shear_strength", None, f"Shear strength {_THAT} on metal"),
    ("strength_on_plastics", "MPa", "shear_strength_on_plastics", None, f"Shear strength {_THAT} on plastics"),
    ("gap_fill", "mm", "gap_fill", "shear", "Widest gap that the heaters' adhesive fills"),
    ("youngs_modulus", "GPa", "youngs_modulus", "shear", f"Young's modulus {_THAT}"),
    ("poissons_ratio", "1", "poissons_ratio", "shear", f"Poisson's ratio {_THAT}"),
    ("conductivity", "W/m/K", "thermal_conductivity", "shear", f"Thermal conductivity {_THAT}"),
    ("rating", "degC", "service_temperature", "shear", f"Highest continuous temperature {_THAT}"),
):
    kinds.property(f"heater_adhesive_{name}", unit, ("heater_adhesive", field), description, mode)
kinds.property(
    "heater_shear_limit", "MPa", ("peltier_module", "max_shear"), "Shear that a pad bears by its record, or none",
    default=0.0, requires=WITH_PADS,
)  # fmt: skip


@strengths.helper()
def seat_strength(m: Module) -> Scalar:
    """Shear stress that the heaters' adhesive bears on the structure, and the structure beside it, cold [Pa]."""
    adhesive = m.heater_adhesive_strength if m.making_method == METAL else m.heater_adhesive_strength_on_plastics
    return np.fmin(adhesive, structure.shear_yield(m.cold_strength)) / m.holding_safety
