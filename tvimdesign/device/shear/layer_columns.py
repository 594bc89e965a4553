"""The layer of the shear module in columns from the middle of an arc to its edge, which is the last to soften."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.shear.floor_heat import CORNER, SIDE
from tvimdesign.device.shear.layer_end import ColdEnd
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import columns, conduction, heat, layer_end, peltier

quantities = QuantityGroup("Switch")


def across(cold_end: ColdEnd | None) -> columns.Columns:
    """Return the columns of the layer, with a lip at its end or without."""
    return columns.EVEN if cold_end is None else columns.DENSE


@quantities.helper()
def column_shares(m: Module) -> tuple[float, ...]:
    """Share of the arcs' width that each column stands for [1]."""
    return across(m.cold_end).shares


@quantities.helper(instant=True)
def edge_drops(m: Module) -> tuple[Scalar, Scalar]:
    """Temperatures of the edges of the pads' hot side and of the plate's face below their means [K]."""
    now, corner = m.stack_profile, m.stack_profile.around[CORNER]
    side = now.spreader
    if m.heater_form == CUT:
        upper = peltier.legs_temperatures(now.hot, now.legs[0], now.cold)[1]
        side = SIDE * now.hot + (1.0 - SIDE) * upper
    mean = np.mean(now.plate)
    even = m.stack.beside[0].conductance * (mean - now.beside[0])
    given = m.pad_wall * (side - corner)
    if m.cold_end is not None and now.lip is not None:
        given = given + m.edge_length * m.cold_end.near * (now.hot - now.lip.temperature)
    return (
        given / m.heater_along,
        (even + m.uneven_sideways * (now.plate[0] - mean)) / m.plate_to_edge,
    )


class LayerSurroundings(NamedTuple):
    """All that the temperatures of the layer's slices follow from, beside what its end does to them."""

    cells: Scalar
    """Mean temperature of each slice over the width [K], an array."""
    through: Scalar
    """Heat from the layer's end into the air beside or below it, over the layer's conductivity [K]."""
    drops: tuple[Scalar, Scalar]
    """Temperatures of the pads' edges and the plate's below their means [K] (`edge_drops`)."""
    in_plate: Scalar
    """Drop of the plate below its mean in each column, over that of its edge [1], an array."""
    share: Scalar
    """Share of the way from pads to plate that lies before each slice [1], an array."""
    lip: Scalar | None
    """Temperature of the lip at the layer's end [K]."""


@quantities.helper(instant=True)
def layer_surroundings(m: Module) -> LayerSurroundings:
    """Surroundings of the layer's slices at an instant."""
    now, (conductivity, slot) = m.stack_profile, m.air_beside
    to_floor, lip = now.hot - now.around[CORNER], None
    if m.cold_end is not None:
        assert now.lip is not None  # a cold end is that of a lip
        lip = now.lip.temperature
        into_lip, into_floor = layer_end.below_lip(slot)
        to_floor = into_lip * (now.hot - lip) + into_floor * to_floor
    return LayerSurroundings(
        cells=now.cells,
        through=conductivity / m.stack.conductivity_melt * to_floor,
        drops=m.edge_drops,
        in_plate=columns.in_sheet(np.array(across(m.cold_end).places), m.plate_slenderness),
        share=columns.way_through(m.stack, heights_of(now)),
        lip=lip,
    )


@quantities.helper(instant=True)
def end_places(m: Module) -> columns.EndPlaces:
    """Positions of the layer's slices from its end: from a lip's wall, or from the gap."""
    width, heights = m.pcl_area / m.edge_length / m.pcl_depth, heights_of(m.stack_profile)
    if m.cold_end is None:
        return columns.gap_places(heights, width, m.air_beside[1])
    return columns.wall_places(heights, width, m.cold_end.contact, m.cold_end.layer, m.cold_end.free)


@quantities.helper(instant=True)
def end_profile(m: Module) -> tuple[list[Scalar], ...]:
    """Effect of the layer's end on its slices, column by column: a wall and the clearance below it, or a gap."""
    return columns.gap_profile(m.end_places) if m.cold_end is None else columns.wall_profile(m.end_places)


@quantities.helper(instant=True)
def layer_temperatures(m: Module) -> list[Scalar]:
    """Temperatures of the layer's slices [K], in columns from the middle of an arc to its edge.

    The hot side's edge is colder, and so is the plate's; between them the layer falls evenly. At its free side it gives
    heat to the gap or a lip.
    """
    (pads, plate), places = m.layer_surroundings.drops, across(m.cold_end).places
    temperatures = []
    for i, (place, end) in enumerate(zip(places, _at_end(m.layer_surroundings, m.end_profile, m.stack), strict=True)):
        near, far = pads * columns.fed_evenly(place), plate * m.layer_surroundings.in_plate[i]
        temperatures.append(end - (near + (far - near) * m.layer_surroundings.share))
    return temperatures


def heights_of(now: heat.Profile) -> Any:
    """Return where the slices are over the layer's depth [1]."""
    count = len(now.cells)
    return (np.arange(count) + 0.5) / count


def _at_end(around: LayerSurroundings, profile: tuple[list[Scalar], ...], stack: heat.Stack) -> list[Scalar]:
    """Return the temperatures of the slices in each column [K], by what leaves the layer at its end alone."""
    if around.lip is None:
        (cooled,) = profile
        return [around.cells - around.through * drop for drop in cooled]
    phases = conduction.Conductivities(stack.conductivity_solid, stack.conductivity_melt)
    lost, cooled = profile
    return [
        conduction.shared(warmer, around.cells, around.lip, phases, stack.melting) - around.through * below
        for warmer, below in zip(columns.beside_wall(lost), columns.below_wall(cooled), strict=True)
    ]
