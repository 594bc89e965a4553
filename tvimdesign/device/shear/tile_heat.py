"""What Peltier modules and a spreader on them are to the layer in shear: strings, what spreading costs, how far they
give."""

from __future__ import annotations

from tvimdesign.device.core.heat.heater_form import CUT, WITH_TILES
from tvimdesign.device.core.heat.thermal_stack import quantities as shared
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
def pad_compliance(
    heater_form: str,
    peltier_thickness: Scalar,
    peltier_shear_modulus: Scalar,
    held_pads: Scalar,
    tile_section: Section,
    spreader_depth: Scalar,
    spreader_shear_modulus: Scalar,
) -> Scalar:
    """Compliance of the pads in shear about the axis [rad/(N*m)]: modules, and the spreader on them."""
    if heater_form == CUT:
        return peltier_thickness / (peltier_shear_modulus * held_pads)
    tiles = peltier_thickness / (peltier_shear_modulus * tile_section.polar)
    return tiles + spreader_depth / (spreader_shear_modulus * held_pads)


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
