"""Forms of Peltier modules: cut to the outline of the PCL, or rectangles behind a spreader, as they are sold.

A flexible module is cut to the face of the PCL. A rigid one is a rectangle: as many as have room share a pocket, and a
spreader of the PCL's outline lies on them, flush with the structure, and takes their heat to what they do not cover.
Each mode says how many pockets there are (`pocket_count`), how many modules lie in each (`tiles_per_pocket`), and what
the spreader resists (`spreader_resistance`).

Whether the ratings of a Peltier module's data sheet agree with one another.
"""

from __future__ import annotations

from tvimdesign.base.errors import InputError
from tvimdesign.base.record import Record
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Feature, Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import peltier

CUT = "flexible"
WITH_TILES = (Feature("heater_form", CUT),)

kinds = QuantityGroup("Materials")
places, weights = QuantityGroup("Layout", WITH_TILES), QuantityGroup("Size and weight", WITH_TILES)
flows = QuantityGroup("Switch")

kinds.option(
    "heater_form",
    (CUT, "rigid"),
    "How the Peltier modules face the PCL: cut to its outline, or as rectangles behind a spreader",
    record=("peltier_module", "form"),
)
kinds.record(
    "spreader_material", "spreaders", "aluminum_6061", "Sheet between rigid Peltier modules and the PCL",
    requires=WITH_TILES,
)  # fmt: skip
for name, unit, field, description in (
    ("peltier_bulk_modulus", "GPa", "bulk_modulus", "Bulk modulus of a module that is cut to the PCL"),
    ("peltier_length", "mm", "length", "Length of one rectangular Peltier module, along its row"),
    ("peltier_width", "mm", "width", "Width of one rectangular Peltier module, across its row"),
):
    kinds.property(name, unit, ("peltier_module", field), description, default=0.0)
for name, unit, field, description in (
    ("spreader_density", "kg/m^3", "density", "Density of the spreader"),
    ("spreader_conductivity", "W/m/K", "thermal_conductivity", "Thermal conductivity of the spreader"),
    ("spreader_specific_heat", "J/kg/K", "specific_heat", "Specific heat of the spreader"),
    ("spreader_youngs_modulus", "GPa", "youngs_modulus", "Young's modulus of the spreader"),
):
    kinds.property(name, unit, ("spreader_material", field), description)
kinds.property(
    "spreader_shear_modulus",
    "GPa",
    ("spreader_material", "shear_modulus"),
    "Shear modulus of the spreader",
    mode="shear",
)


@places.output("1", default=1.0, requires=())
def heater_count(m: Module) -> Scalar:
    """Peltier modules of the module: one pad at each arc or block, or all its tiles."""
    if m.heater_form != CUT:
        return m.pocket_count * m.tiles_per_pocket
    if m.peltier_module.word("form") != CUT:
        raise InputError(f"heater_form: {CUT} needs a module that can be cut; {m.peltier_module.name} is rigid")
    return m.pocket_count


@places.output("mm")
def spreader_depth(m: Module) -> Scalar:
    """Depth the spreader takes of the pocket behind the PCL; zero without one."""
    return m.spreader_thickness


@places.output("mm", requires=())
def pad_depth(m: Module) -> Scalar:
    """Depth of the pockets for the Peltier modules and the spreader on them."""
    return m.peltier_thickness + m.spreader_depth


@weights.output("g")
def spreader_mass(m: Module) -> Scalar:
    """Mass of all spreaders together; zero without."""
    return m.spreader_volume * m.spreader_density


@flows.output("mm^2")
def heated_area(m: Module) -> Scalar:
    """Area of all Peltier modules towards the layer."""
    return m.pcl_area if m.heater_form == CUT else m.heater_count * m.peltier_area


@flows.output("%")
def heater_coverage(m: Module) -> Scalar:
    """Share of the layer's area that faces Peltier modules."""
    return m.heated_area / m.pcl_area


@flows.helper()
def pad_contact(m: Module) -> Scalar:
    """Conductance from the modules' hot side to the layer [W/m^2 K]: contact, and the spreader where there is one."""
    if m.heater_form == CUT:
        return m.hot_contact
    through = peltier.spreader_contact_resistance(
        m.hot_contact, m.spreader_conductivity, m.spreader_thickness, m.heater_coverage, m.spreader_contact
    )
    return 1.0 / (through + m.spreader_resistance)


@flows.helper()
def to_spreader(m: Module) -> Scalar:
    """Part of that between the modules' hot side and the mean of the spreader [m^2 K/W]; zero without one."""
    return 0.0 if m.heater_form == CUT else 1.0 / (m.heater_coverage * m.spreader_contact) + m.spreader_resistance


@flows.helper(requires=WITH_TILES)
def spreader_capacity(m: Module) -> Scalar:
    """Heat capacity of all spreaders [J/K], counted at the modules' hot side; zero without."""
    return m.spreader_mass * m.spreader_specific_heat


RATINGS_ALIKE = 0.1
"""Share by which ratings of a Peltier module may differ from what the others make of them: makers round that far."""
_RATED = ("seebeck", "resistance", "conductance", "hot_side_temperature", "max_cooling_power")


def contradiction(record: Record) -> str:
    """Return the contradiction of a Peltier module's cooling power with its other ratings; empty if there is none."""
    if not set(_RATED) <= record.entries.keys():
        return ""
    *parameters, hot, stated = (record.value(name) for name in _RATED)
    computed = float(peltier.max_cooling_power(peltier.PeltierModule(*parameters), hot))
    if abs(computed / stated - 1.0) <= RATINGS_ALIKE:
        return ""
    return (
        f"{record.title}: Seebeck coefficient and resistance make a largest cooling power of {computed:.3g} W, the "
        f"sheet says {stated:.3g} W; its cooling may be off by as much. Measure one, or take the lower."
    )
