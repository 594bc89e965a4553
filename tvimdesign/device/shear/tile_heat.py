"""What Peltier modules and a spreader on them are to the layer in shear: strings, what spreading costs, how far they
give."""

from __future__ import annotations

from tvimdesign.device.core.heat.heater_form import CUT, WITH_TILES
from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import peltier
from tvimdesign.physics.solids import structure

quantities = QuantityGroup(shared.group)

INCOMPRESSIBLE = 3.0
"""Young's modulus of a pad over its shear modulus: pellets in a soft sheet, or ceramic taken alike."""


@quantities.output("1")
def heater_strings(m: Module) -> Scalar:
    """Strings of Peltier modules in parallel, which share the current."""
    return {"series": 1.0, "arcs_parallel": m.arc_count, "all_parallel": m.heater_count}[m.heater_wiring]


@quantities.output("K*mm^2/W", requires=WITH_TILES)
def spreader_resistance(m: Module) -> Scalar:
    """Resistance of the way along the spreader to what its modules do not cover, times the layer's area."""
    outlines = 2.0 * m.heater_count * (m.peltier_length + m.peltier_width)
    return peltier.spreading_resistance(
        m.pcl_area, m.heated_area, outlines, m.spreader_conductivity, m.spreader_thickness
    )


@quantities.helper()
def pad_compliance(m: Module) -> Scalar:
    """Compliance of the pads in shear about the axis [rad/(N*m)]: modules, and the spreader on them."""
    if m.heater_form == CUT:
        return m.peltier_thickness / (m.peltier_shear_modulus * m.held_pads)
    tiles = m.peltier_thickness / (m.peltier_shear_modulus * m.tile_section.polar)
    return tiles + m.spreader_depth / (m.spreader_shear_modulus * m.held_pads)


@quantities.helper()
def pad_foundation(m: Module) -> Scalar:
    """Tension on the layer over how far pads and spreader stretch under it [Pa/m]; a pad has E = 3 G."""
    pad = INCOMPRESSIBLE * m.peltier_shear_modulus / m.peltier_thickness
    if m.heater_form == CUT:
        return pad
    return structure.series(m.heater_coverage * pad, m.spreader_youngs_modulus / m.spreader_thickness)
