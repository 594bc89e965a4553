"""A layer that is heated by the current it conducts itself, between the fingers of two combs on the pads' face.

The combs are etched in a flexible sheet that takes the pads' place: a record of the heaters that says `heat_source:
layer`. The layer's material has a `resistivity`. Heat is made evenly over the layer, and a little in the sheet.
"""

from __future__ import annotations

import functools

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Feature, Scalar, at_least
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import shape_factors

PADS = "pads"
LAYER_HEATED = (Feature("heat_source", PADS),)

kinds, flows = QuantityGroup("Materials"), QuantityGroup("Switch")

kinds.option(
    "heat_source",
    (PADS, "layer"),
    "Where the current makes heat: in the pads, or in the layer itself between combs of electrodes",
    record=("peltier_module", "heat_source"),
)
kinds.property(
    "pcl_resistivity", "ohm*m", ("pcl_grade", "resistivity"), "Electrical resistivity of a layer that heats itself",
    requires=LAYER_HEATED,
)  # fmt: skip
for name, description in (
    ("electrode_gap", "Gap between two fingers of the combs that feed the layer"),
    ("electrode_width", "Width of a finger of these combs"),
):
    kinds.property(name, "mm", ("peltier_module", name), description, requires=LAYER_HEATED)


@flows.output("ohm", requires=LAYER_HEATED)
def layer_resistance(m: Module) -> Scalar:
    """Resistance of the whole layer between its combs, wired as the heaters are."""
    if m.heater_form != CUT:
        raise InputError(f"heat_source: layer needs a heater that lies on the layer; {m.peltier_module.name} is rigid")
    whole = shape_factors.comb_resistance(
        m.pcl_resistivity, m.pcl_depth, m.pcl_area, m.electrode_gap, m.electrode_width
    )
    return whole * (m.heater_count / m.heater_strings) ** 2


@flows.output(
    "mm",
    at_least(0.0, "the current stays near the combs, and does not heat the layer's far side"),
    requires=LAYER_HEATED,
)
def electrode_gap_margin(m: Module) -> Scalar:
    """Gap between the fingers of the combs less the layer's depth."""
    return m.electrode_gap - m.pcl_depth


@flows.helper(instant=True)
def hottest_pcl(m: Module) -> Scalar:
    """Highest temperature [K] in the layer: at its face to the pads that heat it, anywhere in one that heats itself."""
    if m.heat_source == PADS:
        return m.stack_profile.near
    cells = [m.stack_profile.cells[i] for i in range(len(m.stack_profile.cells))]
    return functools.reduce(np.fmax, [m.stack_profile.near, *cells])
