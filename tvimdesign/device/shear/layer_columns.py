"""The layer of the shear module in columns from the middle of an arc to its edge, which is the last to soften."""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.shear.floor_heat import CORNER
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import columns, heat, peltier

quantities = QuantityGroup(shared.group)


@quantities.helper(instant=True)
def edge_drops(
    stack_profile: heat.Profile,
    stack: heat.Stack,
    heater_form: str,
    pad_wall: Scalar,
    heater_along: Scalar,
    plate_to_edge: Scalar,
    uneven_sideways: Scalar,
) -> tuple[Scalar, Scalar]:
    """How far the edges of the pads' hot side and of the plate's face are below their means [K], by what they lose."""
    now, corner = stack_profile, stack_profile.around[CORNER]
    side = now.hot
    if heater_form == CUT:
        side = 0.5 * (now.hot + peltier.legs_temperature(now.hot, now.legs[0], now.cold))
    mean = np.mean(now.plate)
    even = stack.beside[0].conductance * (mean - now.beside[0])
    return (
        pad_wall * (side - corner) / heater_along,
        (even + uneven_sideways * (now.plate[0] - mean)) / plate_to_edge,
    )


@quantities.helper(instant=True)
def layer_temperatures(
    stack_profile: heat.Profile,
    stack: heat.Stack,
    edge_drops: tuple[Scalar, Scalar],
    air_beside: tuple[Scalar, Scalar],
    plate_slenderness: Scalar,
    pcl_area: Scalar,
    edge_length: Scalar,
    pcl_depth: Scalar,
    pcl_conductivity_melt: Scalar,
) -> list[Scalar]:
    """Temperatures of the layer's slices [K], in columns from the middle of an arc to its edge.

    The hot side's edge is colder, and so is the plate's; between them the layer falls evenly. At its free side it gives
    heat to the gap.
    """
    count = len(stack_profile.cells)
    heights = (np.arange(count) + 0.5) / count
    conductivity, slot = air_beside
    width = pcl_area / edge_length / pcl_depth
    excess = conductivity / pcl_conductivity_melt * (stack_profile.hot - stack_profile.around[CORNER])
    pads, plate = edge_drops
    share = columns.way_through(stack, heights)
    found = []
    for place in columns.PLACES:
        near, far = pads * columns.fed_evenly(place), plate * columns.in_sheet(place, plate_slenderness)
        end = excess * columns.at_end(place, heights, width, slot)
        found.append(stack_profile.cells - (near + (far - near) * share + end))
    return found
