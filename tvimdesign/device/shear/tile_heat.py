"""What Peltier modules and a spreader on them are to the layer: area, contact, capacity, and how far they give.

A flexible module is a pad of the layer's area on the layer. Rigid ones cover a part of it; the spreader takes their
heat to the rest, at a resistance in series with the layer's own contact.
"""

from __future__ import annotations

from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.shear.tiles import CUT, WITH_TILES
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.bodies.shapes import Section
from tvimdesign.physics.heat_flow import spreader
from tvimdesign.physics.solids import structure

quantities = QuantityGroup(shared.group)

INCOMPRESSIBLE = 3.0
"""Young's modulus of a pad over its shear modulus: pellets in a soft sheet, or ceramic taken alike."""


@quantities.output("1")
def heater_strings(heater_wiring: str, arc_count: Scalar, heater_count: Scalar) -> Scalar:
    """Strings of Peltier modules in parallel, which share the current."""
    return {"series": 1.0, "arcs_parallel": arc_count, "all_parallel": heater_count}[heater_wiring]


@quantities.output("mm^2")
def heated_area(heater_form: str, pcl_area: Scalar, heater_count: Scalar, peltier_area: Scalar) -> Scalar:
    """Area of all Peltier modules towards the layer."""
    return pcl_area if heater_form == CUT else heater_count * peltier_area


@quantities.output("%")
def heater_coverage(heated_area: Scalar, pcl_area: Scalar) -> Scalar:
    """Share of the layer's area that lies above Peltier modules."""
    return heated_area / pcl_area


@quantities.output("K*mm^2/W", requires=WITH_TILES)
def spreader_resistance(
    pcl_area: Scalar,
    heated_area: Scalar,
    heater_count: Scalar,
    peltier_length: Scalar,
    peltier_width: Scalar,
    spreader_conductivity: Scalar,
    spreader_thickness: Scalar,
) -> Scalar:
    """Resistance of the way along the spreader to what its modules do not cover, times the layer's area."""
    outlines = 2.0 * heater_count * (peltier_length + peltier_width)
    return spreader.spreading_resistance(pcl_area, heated_area, outlines, spreader_conductivity, spreader_thickness)


@quantities.helper()
def pad_contact(
    heater_form: str,
    hot_contact: Scalar,
    spreader_conductivity: Scalar,
    spreader_thickness: Scalar,
    heater_coverage: Scalar,
    spreader_contact: Scalar,
    spreader_resistance: Scalar,
) -> Scalar:
    """Conductance from the modules' hot side to the layer [W/m^2 K]: contact, and the spreader where there is one."""
    if heater_form == CUT:
        return hot_contact
    through = spreader.contact_resistance(
        hot_contact, spreader_conductivity, spreader_thickness, heater_coverage, spreader_contact
    )
    return 1.0 / (through + spreader_resistance)


@quantities.helper(requires=WITH_TILES)
def spreader_capacity(spreader_mass: Scalar, spreader_specific_heat: Scalar) -> Scalar:
    """Heat capacity of all spreaders [J/K], counted at the modules' hot side; zero without."""
    return spreader_mass * spreader_specific_heat


@quantities.helper()
def pad_compliance(
    heater_form: str,
    peltier_thickness: Scalar,
    peltier_shear_modulus: Scalar,
    held_polar_moment: Scalar,
    tile_section: Section,
    spreader_depth: Scalar,
    spreader_shear_modulus: Scalar,
) -> Scalar:
    """Compliance of the pads in shear about the axis [rad/(N*m)]: modules, and the spreader on them."""
    if heater_form == CUT:
        return peltier_thickness / (peltier_shear_modulus * held_polar_moment)
    tiles = peltier_thickness / (peltier_shear_modulus * tile_section.polar)
    return tiles + spreader_depth / (spreader_shear_modulus * held_polar_moment)


@quantities.helper()
def pad_foundation(
    heater_form: str,
    peltier_shear_modulus: Scalar,
    peltier_thickness: Scalar,
    heater_coverage: Scalar,
    spreader_thickness: Scalar,
    spreader_youngs_modulus: Scalar,
) -> Scalar:
    """Tension on the layer over how far pads and spreader stretch under it [Pa/m]; a pad has E = 3 G."""
    pad = INCOMPRESSIBLE * peltier_shear_modulus / peltier_thickness
    if heater_form == CUT:
        return pad
    return structure.series(heater_coverage * pad, spreader_youngs_modulus / spreader_thickness)
