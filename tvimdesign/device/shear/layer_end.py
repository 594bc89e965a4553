"""Free side of the layer: heat that leaves into the air of the gap, a lip of the plate, or a liner's recess.

A lip touches the layer but for the running clearance below it; what else heats and cools it is in `lip_heat`. The arcs'
ends have no lip; they are taken as having one, as an arc is a strip with as much edge. A liner and its film are as much
more layer there, before the plate; the walls of its recess go on from the lip (`_liner_rim`).

A liner gives heat sideways through the film around it to the walls of its recess in the rotor plate. Layer and liner
end at one cold wall (`end_wall`): the walls of the recess, and below them a lip, if there is
one. The liner's cells give by their own excess over the plate's edge what such a wall takes beside them of an even
fall. The plate is that wall's for a share of its depth (`shape_factors.constriction`).
"""

from typing import NamedTuple

import numpy as np

from tvimdesign.device.shear.floor_heat import CORNER
from tvimdesign.device.shear.melt_lip import NO_LIP
from tvimdesign.device.table import Module, QuantityGroup, Scalar
from tvimdesign.physics.heat_flow import lumps, shape_factors
from tvimdesign.physics.heat_flow.layer_end import WalledEnd, below_lip, sheet_end, sheeted_end, walled_end
from tvimdesign.physics.heat_flow.lumps import Link

quantities = QuantityGroup("Switch")

SPREADER, BESIDE, FLOOR = ("spreader", 0), ("beside", 0), ("around", CORNER)
AT_CORNER = 4.0 / np.pi
"""Free height below a lip that resists as a contact does, over the contact's thickness of layer. Around a corner heat
goes along quarter circles, which at a radius r resist pi r/2: a contact is as 2/pi of it more radius. In a quarter of a
plane whose one face begins at c from the corner it is as if they began at c/2 (the map w = z^2)."""


class ColdEnd(NamedTuple):
    """A lip at the layer's end, and what the layer gives to it [W/m K]."""

    of_layer: Scalar  # From the layer's slices, by their mean excess over the lip
    of_pads: Scalar
    """From the pads' hot side, by its excess; what crowds into the lip's tip beyond what the slices give."""
    near: Scalar  # Part of that which the pads give in the end, over their hot side's excess
    contact: Scalar  # Thickness of layer that conducts as a contact does, over that from pads to plate [1]
    free: Scalar  # Height below the lip over the same [1]
    layer: Scalar  # The layer's thickness over the same [1]


class EndWall(NamedTuple):
    """Plate and lip as one wall at the end of layer and liner."""

    conductivity: Scalar  # Of the layer, the mean of both phases [W/m K]
    height: Scalar
    """From pads to plate: the layer and, as much more layer as conducts alike, contacts, liner and film [m]."""
    layer: Scalar  # Share of the layer with its contacts in that [1]
    sheet: Scalar  # Share of the liner in it [1]
    contacts: Scalar  # Share of both contacts of the layer in it [1]
    free: Scalar  # Share of it that is free below the wall [1]
    width: Scalar  # Of the layer, over that height without the contacts [1]
    end: WalledEnd


@quantities.helper()
def end_wall(m: Module) -> EndWall | None:
    """The wall at the layer's end; none without lips and liner. A contact is as much more layer, where heat crowds as
    well."""
    if m.melt_lip == NO_LIP and m.liner_sheet is None:
        return None
    conductivity = 0.5 * (m.pcl_conductivity_solid + m.pcl_conductivity_melt)
    contacts = conductivity / m.hot_contact + conductivity / m.rotor_contact
    sheet, whole = 0.0, 0.0
    if m.liner_sheet is not None:
        sheet, whole = (
            conductivity * m.pcl_area * resistance for resistance in (m.liner_sheet.resistance, m.liner_sheet.whole)
        )
    height = m.pcl_thickness + contacts + whole
    layer = (m.pcl_thickness + contacts) / height
    if m.melt_lip == NO_LIP:
        free, end = layer, sheet_end(layer)
    else:
        below = np.fmax(m.pcl_thickness - m.lip_height, 0.0)
        free = (below + AT_CORNER * contacts) / height
        end = walled_end(free) if m.liner_sheet is None else sheeted_end(free, layer)
    width = m.pcl_area / m.edge_length / (m.pcl_thickness + whole)
    return EndWall(conductivity, height, layer, sheet / height, contacts / height, free, width, end)


@quantities.helper()
def cold_end(m: Module) -> ColdEnd | None:
    """Heat from the layer to a lip at its end; none without lips."""
    if m.melt_lip == NO_LIP or m.end_wall is None:
        return None
    k, end, layer, width = m.end_wall.conductivity, m.end_wall.end, m.end_wall.layer, m.end_wall.width
    # Slices that fall evenly are this much above the wall in their sum, twice as much as the half of a bare layer.
    fall = layer * (2.0 - layer)
    return ColdEnd(
        of_layer=k * layer * shape_factors.sink_of_slices(end.deep / width, end.colder / width) * width,
        of_pads=k * (end.wall - fall * shape_factors.FALLING * end.deep),
        near=k * end.near,
        contact=0.5 * m.end_wall.contacts,
        free=m.end_wall.free,
        layer=layer - m.end_wall.contacts,
    )


@quantities.helper()
def air_beside(m: Module) -> tuple[Scalar, Scalar]:
    """Of the gap's air at the layer's free side the conductivity [W/m K], in series with the layer's; and the slot's
    width over the gap's. Below a lip that gap is the running clearance.

    The gap conducts better up than along, as its faces radiate, here as where the PCL is molten: it is an even one of
    the mean conductivity sqrt(k_x k_y), x stretched by sqrt(k_y/k_x). The contact of the pads' edges is a slot of
    still air.
    """
    gap = m.pcl_thickness if m.melt_lip == NO_LIP else m.running_clearance
    across = lumps.air_gap(1.0, gap, m.air_conductivity, m.surface_emissivity, SPREADER, FLOOR)
    up = gap * lumps.link_conductance(across, m.pcl_melting.end, m.ambient_temperature)
    evenly = np.sqrt(m.air_conductivity * up)
    return lumps.in_series(evenly, m.pcl_conductivity_melt), evenly / (m.pad_edge_contact * gap)


@quantities.helper()
def side_links(m: Module) -> tuple[Link, ...]:
    """Links from the liner's rim to the plate, and from the layer's free side through the gap's air to floor and plate.

    `gap_end` tells the sums; layer and air lie in series, and the floor takes what comes to its corner. What of
    it comes from within the layer (`gap_end_depth`) the layer gives, the rest the hot side. Below a lip the hot
    side gives it (`walled_end.below_lip`), and the lip gets the rest (`lip_heat`).
    """
    conductivity, slot = m.air_beside
    near, far = shape_factors.gap_end(slot) if m.melt_lip == NO_LIP else below_lip(slot)[::-1]
    through = m.edge_length * conductivity
    if m.melt_lip != NO_LIP:
        return (*_liner_rim(m), Link(SPREADER, FLOOR, near * through))
    corner = m.structure_conductivity * m.edge_length * shape_factors.corner_shape(near)
    inside = shape_factors.FALLING * shape_factors.gap_end_depth(slot) / (near + far)
    to_floor = Link(SPREADER, FLOOR, lumps.in_series(near * through, corner), of_layer=inside)
    return (*_liner_rim(m), to_floor, Link(SPREADER, BESIDE, far * through, of_layer=inside))


LINER, PLATE = ("liner", 0), ("plate", 0)


@quantities.helper()
def liner_to_wall(m: Module) -> Scalar:
    """Conductance from a liner to the walls of its recess [W/m K], without the film around it, by its mean excess."""
    if m.liner_sheet is None or m.end_wall is None:
        return 0.0
    above = 1.0 - m.end_wall.layer
    excess = above - 0.5 * m.end_wall.sheet
    return (
        m.end_wall.conductivity
        * m.end_wall.end.rim
        / (excess - shape_factors.AT_WALL * m.end_wall.end.sheet_colder / m.end_wall.width)
    )


def _liner_rim(m: Module) -> tuple[Link, ...]:
    """Links from a liner to the plate's edge, which lies between plate and strip beside it; none without a liner."""
    if m.liner_sheet is None:
        return ()
    film = m.liner_film_conductivity * m.liner_thickness / m.liner_film
    onto = m.structure_conductivity / shape_factors.constriction(m.liner_depth / m.rotor_thickness)
    whole = m.edge_length * lumps.in_series(m.liner_to_wall, film, onto)
    beside = m.rotor_beside[0].conductance / m.plate_to_edge
    return (Link(LINER, PLATE, (1.0 - beside) * whole), Link(LINER, BESIDE, beside * whole))
