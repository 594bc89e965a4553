"""The free side of the layer: what heat leaves there, into the air of the gap or into a lip of the rotor plate.

A lip touches the layer but for the running clearance below it; what else heats and cools it is in `lip_heat`. The arcs'
ends have no lip; they are taken as having one, as an arc is a strip with as much edge. A liner and its film are as much
more layer there, before the plate; the walls of its recess go on from the lip (`liner_rim`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.shear.floor_heat import CORNER
from tvimdesign.device.shear.melt_lip import NO_LIP
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import lumps, shape_factors
from tvimdesign.physics.heat_flow.liner import Liner
from tvimdesign.physics.heat_flow.lumps import Link
from tvimdesign.physics.heat_flow.still_air import below_lip
from tvimdesign.physics.heat_flow.walled_end import WalledEnd, sheet_end, sheeted_end, walled_end
from tvimdesign.physics.polymers import polymer

quantities = QuantityGroup(shared.group)

HOT, BESIDE, FLOOR = ("hot", 0), ("beside", 0), ("around", CORNER)
AT_CORNER = 4.0 / np.pi
"""Free height below a lip that resists as a contact does, over the contact's thickness of layer. Around a corner heat
goes along quarter circles, which at a radius r resist pi r/2: a contact is as 2/pi of it more radius. In a quarter of a
plane whose one face begins at c from the corner it is as if they began at c/2 (the map w = z^2)."""


class ColdEnd(NamedTuple):
    """A lip at the layer's end, and what the layer gives to it [W/m K]."""

    of_layer: Scalar
    """From the layer's slices, by their mean excess over the lip."""
    of_pads: Scalar
    """From the pads' hot side, by its excess; what crowds into the lip's tip beyond what the slices give."""
    near: Scalar
    """What of that the pads give in the end, over their hot side's excess."""
    contact: Scalar
    """Thickness of layer that conducts as a contact does, over that from pads to plate [1]."""
    free: Scalar
    """Height below the lip over the same [1]."""
    layer: Scalar
    """The layer's thickness over the same [1]."""


class EndWall(NamedTuple):
    """Plate and lip as one wall at the end of layer and liner."""

    conductivity: Scalar
    """Of the layer, the mean of both phases [W/m K]."""
    height: Scalar
    """From pads to plate: the layer and, as much more layer as conducts alike, contacts, liner and film [m]."""
    layer: Scalar
    """What of that the layer is with its contacts [1]."""
    sheet: Scalar
    """What of it the liner is [1]."""
    contacts: Scalar
    """What of it both contacts of the layer are [1]."""
    free: Scalar
    """What of it is free below the wall [1]."""
    width: Scalar
    """Of the layer, over that height without the contacts [1]."""
    end: WalledEnd


@quantities.helper()
def end_wall(
    melt_lip: str,
    lip_height: Scalar,
    pcl_thickness: Scalar,
    pcl_area: Scalar,
    edge_length: Scalar,
    hot_contact: Scalar,
    rotor_contact: Scalar,
    liner_sheet: Liner | None,
    pcl_conductivity_solid: Scalar,
    pcl_conductivity_melt: Scalar,
) -> EndWall | None:
    """The wall at the layer's end; none without lips and liner. A contact is as much more layer, where heat crowds as
    well."""
    if melt_lip == NO_LIP and liner_sheet is None:
        return None
    conductivity = 0.5 * (pcl_conductivity_solid + pcl_conductivity_melt)
    contacts = conductivity / hot_contact + conductivity / rotor_contact
    sheet, whole = 0.0, 0.0
    if liner_sheet is not None:
        sheet, whole = (conductivity * pcl_area * one for one in (liner_sheet.resistance, liner_sheet.whole))
    height = pcl_thickness + contacts + whole
    layer = (pcl_thickness + contacts) / height
    if melt_lip == NO_LIP:
        free, end = layer, sheet_end(layer)
    else:
        below = np.fmax(pcl_thickness - lip_height, 0.0)
        free = (below + AT_CORNER * contacts) / height
        end = walled_end(free) if liner_sheet is None else sheeted_end(free, layer)
    width = pcl_area / edge_length / (pcl_thickness + whole)
    return EndWall(conductivity, height, layer, sheet / height, contacts / height, free, width, end)


@quantities.helper()
def cold_end(melt_lip: str, end_wall: EndWall | None) -> ColdEnd | None:
    """What the layer gives to a lip at its end; none without lips."""
    if melt_lip == NO_LIP or end_wall is None:
        return None
    k, end, layer, width = end_wall.conductivity, end_wall.end, end_wall.layer, end_wall.width
    # Slices that fall evenly are this much above the wall in their sum, twice as much as the half of a bare layer.
    fall = layer * (2.0 - layer)
    return ColdEnd(
        of_layer=k * layer * shape_factors.sink_of_slices(end.deep / width, end.colder / width) * width,
        of_pads=k * (end.wall - fall * shape_factors.FALLING * end.deep),
        near=k * end.near,
        contact=0.5 * end_wall.contacts,
        free=end_wall.free,
        layer=layer - end_wall.contacts,
    )


@quantities.helper()
def air_beside(
    melt_lip: str,
    pcl_thickness: Scalar,
    running_clearance: Scalar,
    pcl_conductivity_melt: Scalar,
    pad_edge_contact: Scalar,
    air_conductivity: Scalar,
    surface_emissivity: Scalar,
    ambient_temperature: Scalar,
    pcl_melting: polymer.Melting,
) -> tuple[Scalar, Scalar]:
    """Of the gap's air at the layer's free side the conductivity [W/m K], in series with the layer's; and the slot's
    width over the gap's. Below a lip that gap is the running clearance.

    The gap conducts better up than along, as its faces radiate, here as where the PCL is molten: it is an even one of
    the mean conductivity sqrt(k_x k_y), x stretched by sqrt(k_y/k_x). The contact of the pads' edges is a slot of
    still air.
    """
    gap = pcl_thickness if melt_lip == NO_LIP else running_clearance
    across = lumps.air_gap(1.0, gap, air_conductivity, surface_emissivity, HOT, FLOOR)
    up = gap * lumps.link_conductance(across, pcl_melting.end, ambient_temperature)
    evenly = np.sqrt(air_conductivity * up)
    return lumps.in_series(evenly, pcl_conductivity_melt), evenly / (pad_edge_contact * gap)


@quantities.helper()
def side_links(
    edge_length: Scalar,
    air_beside: tuple[Scalar, Scalar],
    melt_lip: str,
    structure_conductivity: Scalar,
    liner_rim: tuple[Link, ...],
) -> tuple[Link, ...]:
    """From the liner's rim to the plate, and from the layer's free side through the air of the gap, to the floor's
    corner and to the plate beside it.

    `gap_end` tells the sums; layer and air lie in series, and the floor takes what comes to its corner. What of
    it comes from within the layer (`gap_end_depth`) the layer gives, the rest the hot side. Below a lip the hot
    side gives it (`still_air.below_lip`), and the lip gets the rest (`lip_heat`).
    """
    conductivity, slot = air_beside
    near, far = shape_factors.gap_end(slot) if melt_lip == NO_LIP else below_lip(slot)[::-1]
    through = edge_length * conductivity
    if melt_lip != NO_LIP:
        return (*liner_rim, Link(HOT, FLOOR, near * through))
    corner = structure_conductivity * edge_length * shape_factors.corner_shape(near)
    inside = shape_factors.FALLING * shape_factors.gap_end_depth(slot) / (near + far)
    to_floor = Link(HOT, FLOOR, lumps.in_series(near * through, corner), of_layer=inside)
    return (*liner_rim, to_floor, Link(HOT, BESIDE, far * through, of_layer=inside))
