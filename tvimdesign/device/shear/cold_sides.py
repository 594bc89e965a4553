"""Ways along the pads' cold sides to what takes their heat: ledges touch a share of them, a sink the rest.

The legs conduct k_x along and k_y up: a slab of the mean k = (k_x k_y)^(1/2), its depth stretched by (k_x/k_y)^(1/2).
The side itself is a sheet on it. Half of a pad's width is the slab's height (`constriction`). Air in the open
windows takes too little heat to count.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import shape_factors
from tvimdesign.physics.heat_flow.peltier import SIDE_SHARE

quantities = QuantityGroup(shared.group)


class ColdSide(NamedTuple):
    """Legs and cold side of the pads as a slab with a sheet on its face."""

    conductance: Scalar
    """Mean conductivity of the legs times the length of the pads' edges [W/K]."""
    sheet: Scalar
    """Of the side, over that conductivity and half of a pad's width [1]."""
    depth: Scalar
    """Of the legs, over half of a pad's width [1]."""


@quantities.helper()
def cold_side_slab(m: Module) -> ColdSide:
    """Legs and cold side, by the pads' conductance up and their conductivity along."""
    width = m.heated_area / m.edge_length
    up = m.pads.conductance / m.heated_area * m.peltier_thickness
    mean = np.sqrt(m.pad_conductivity * up)
    sheet = SIDE_SHARE * m.peltier_thickness * m.pad_conductivity / (mean * width)
    depth = (1.0 - 2.0 * SIDE_SHARE) * m.peltier_thickness * np.sqrt(m.pad_conductivity / up) / width
    return ColdSide(mean * m.edge_length, sheet, depth)


@quantities.helper()
def cold_to_ledges(m: Module) -> Scalar:
    """Resistance from where the cold sides have their mean temperature to the ledges they lie on [K/W]."""
    share = (m.heated_area - m.cold_area) / m.heated_area
    return (
        shape_factors.constriction(share, m.cold_side_slab.sheet, m.cold_side_slab.depth) / m.cold_side_slab.conductance
    )


@quantities.helper()
def cold_to_sink(m: Module) -> Scalar:
    """Resistance from where the cold sides have their mean temperature to a sink in the windows [K/W]."""
    share = m.cold_area / m.heated_area
    return (
        shape_factors.constriction(share, m.cold_side_slab.sheet, m.cold_side_slab.depth) / m.cold_side_slab.conductance
    )
