"""The layer of the shear module in columns from the middle of an arc to its edge, which is the last to soften."""

from __future__ import annotations

from typing import Any

import numpy as np

from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.shear.floor_heat import CORNER, SIDE
from tvimdesign.device.shear.layer_end import ColdEnd
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import columns, conduction, heat, peltier, still_air

quantities = QuantityGroup(shared.group)


def across(cold_end: ColdEnd | None) -> columns.Columns:
    """Columns of the layer, with a lip at its end or without."""
    return columns.EVEN if cold_end is None else columns.DENSE


@quantities.helper()
def column_shares(cold_end: ColdEnd | None) -> tuple[float, ...]:
    """What of the arcs' width each column stands for [1]."""
    return across(cold_end).shares


@quantities.helper(instant=True)
def edge_drops(
    stack_profile: heat.Profile,
    stack: heat.Stack,
    heater_form: str,
    pad_wall: Scalar,
    heater_along: Scalar,
    plate_to_edge: Scalar,
    uneven_sideways: Scalar,
    cold_end: ColdEnd | None,
    edge_length: Scalar,
) -> tuple[Scalar, Scalar]:
    """How far the edges of the pads' hot side and of the plate's face are below their means [K], by what they lose."""
    now, corner = stack_profile, stack_profile.around[CORNER]
    side = now.spreader
    if heater_form == CUT:
        upper = peltier.legs_temperatures(now.hot, now.legs[0], now.cold)[1]
        side = SIDE * now.hot + (1.0 - SIDE) * upper
    mean = np.mean(now.plate)
    even = stack.beside[0].conductance * (mean - now.beside[0])
    given = pad_wall * (side - corner)
    if cold_end is not None and now.lip is not None:
        given = given + edge_length * cold_end.near * (now.hot - now.lip.temperature)
    return (
        given / heater_along,
        (even + uneven_sideways * (now.plate[0] - mean)) / plate_to_edge,
    )


@quantities.helper(instant=True)
def layer_temperatures(
    stack_profile: heat.Profile,
    stack: heat.Stack,
    edge_drops: tuple[Scalar, Scalar],
    air_beside: tuple[Scalar, Scalar],
    cold_end: ColdEnd | None,
    plate_slenderness: Scalar,
    pcl_area: Scalar,
    edge_length: Scalar,
    pcl_depth: Scalar,
) -> list[Scalar]:
    """Temperatures of the layer's slices [K], in columns from the middle of an arc to its edge.

    The hot side's edge is colder, and so is the plate's; between them the layer falls evenly. At its free side it gives
    heat to the gap or a lip.
    """
    count = len(stack_profile.cells)
    heights = (np.arange(count) + 0.5) / count
    width = pcl_area / edge_length / pcl_depth
    ends = _at_end(stack_profile, stack, heights, width, air_beside, cold_end)
    pads, plate = edge_drops
    share = columns.way_through(stack, heights)
    found = []
    for place, end in zip(across(cold_end).places, ends, strict=True):
        near, far = pads * columns.fed_evenly(place), plate * columns.in_sheet(place, plate_slenderness)
        found.append(end - (near + (far - near) * share))
    return found


def _at_end(
    now: heat.Profile,
    stack: heat.Stack,
    heights: Any,
    width: Scalar,
    air_beside: tuple[Scalar, Scalar],
    cold_end: ColdEnd | None,
) -> list[Scalar]:
    """Temperatures of the slices in each column [K], by what leaves the layer at its end alone: into a lip and the
    clearance below it, or into the gap."""
    conductivity, slot = air_beside
    if cold_end is not None and now.lip is not None:
        lip = now.lip.temperature
        phases = conduction.Conductivities(stack.conductivity_solid, stack.conductivity_melt)
        end = (heights, width, cold_end.contact, cold_end.layer, cold_end.free)
        to_lip, to_floor = still_air.below_lip(slot)
        through = conductivity * (to_lip * (now.hot - lip) + to_floor * (now.hot - now.around[CORNER]))
        return [
            conduction.shared(warmer, now.cells, lip, phases, stack.melting) - through / phases.melt * below
            for warmer, below in zip(columns.beside_wall(*end), columns.below_wall(*end), strict=True)
        ]
    excess = conductivity / stack.conductivity_melt * (now.hot - now.around[CORNER])
    return [now.cells - excess * columns.at_end(place, heights, width, slot) for place in columns.EVEN.places]
