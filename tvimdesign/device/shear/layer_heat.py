"""Path of the heat in the shear module, and its layer in columns from the middle of an arc to its edge.

Pads, layer and plate lose heat at the edges of the arcs, which are taken as a strip with as much edge for its area. The
plate beside it is a strip that this heats; the floor is in `floor_heat`.
"""

from typing import Any, NamedTuple

import numpy as np

from tvimdesign.device.core.heater_form import CUT
from tvimdesign.device.shear.floor_heat import CORNER, SIDE
from tvimdesign.device.shear.layer_end import ColdEnd
from tvimdesign.device.table import Module, QuantityGroup, Scalar
from tvimdesign.physics.heat_flow import columns, conduction, heat, layer_end, lumps, peltier, shape_factors

quantities = QuantityGroup("Switch")


quantities.field(
    "cold_area", "window_section", "area", "Open area of the pads' cold sides [m^2]: the windows below them", ""
)


@quantities.helper(instant=True)
def moment_now(m: Module) -> Scalar:
    """The layer's moment at an instant [m^4]: sheared, a molten film is as soft as its thickness says."""
    return m.pcl_moment


quantities.same("plate_depth", "rotor_thickness", "Thickness of what is behind the layer [m]: the rotor plate")


@quantities.helper()
def plate_outside(m: Module) -> lumps.Surface:
    """The rotor plate's upper face above the arcs."""
    return lumps.Surface(m.pcl_area, m.rotor_coefficient, m.surface_emissivity)


@quantities.helper()
def plate_mass(m: Module) -> Scalar:
    """Mass of the rotor plate [kg]: above the arcs, and beside them with its lips."""
    return (np.pi * m.rotor_radius**2 * m.rotor_thickness + m.melt_lip_moments.area) * m.structure_density


@quantities.output("mm")
def edge_length(m: Module) -> Scalar:
    """Length of the edges of all arcs together: inner and outer arcs, and their ends."""
    return m.arc_count * (
        2.0 * (m.pcl_outer_radius - m.pcl_inner_radius) + m.arc_span * (m.pcl_inner_radius + m.pcl_outer_radius)
    )


@quantities.helper()
def to_edge(m: Module) -> Scalar:
    """Length of the edges over the way there from where the pads, fed evenly, have their mean temperature [1]."""
    return 3.0 * m.edge_length / (m.pcl_area / m.edge_length)


@quantities.helper()
def plate_slenderness(m: Module) -> Scalar:
    """Of the plate above the arcs as a fin w (h/k t)^(1/2) [1]: the layer heats it, more where it is colder."""
    layer = 0.5 * (m.pcl_conductivity_solid + m.pcl_conductivity_melt) / m.pcl_depth
    return m.pcl_area / m.edge_length * np.sqrt(layer / (m.structure_conductivity * m.backing_depth))


@quantities.helper()
def plate_to_edge(m: Module) -> Scalar:
    """Conductance [W/K] from where the plate above the arcs has its mean temperature to their edges."""
    width, sheet = m.pcl_area / m.edge_length, m.structure_conductivity * m.backing_depth
    return sheet * m.edge_length / (width * shape_factors.way_in_fin(m.plate_slenderness))


@quantities.helper()
def beside_area(m: Module) -> Scalar:
    """Area of the rotor plate beside the arcs [m^2]; the floor below it is taken to be as large."""
    return np.pi * m.rotor_radius**2 - m.pcl_area


@quantities.helper()
def core_share(m: Module) -> Scalar:
    """Share of the conductance to the core that is left from the plate's last body on."""
    across = m.structure_conductivity * m.rotor_thickness * m.edge_length**2 / m.beside_area
    onward = lumps.BEYOND * m.core_and_link.conductance / across
    return 1.0 / (1.0 + onward)


@quantities.helper()
def rotor_beside(m: Module) -> tuple[lumps.Lump, ...]:
    """Rotor plate beside the arcs: a strip along their edges, deeper by its lips where these stand.

    Heat goes along it through plate and lip, beside one another.
    """
    capacity = m.structure_density * m.structure_specific_heat
    chain = lumps.strip_bodies(
        m.beside_area,
        m.rotor_thickness * capacity,
        m.structure_conductivity * m.rotor_thickness * m.edge_length**2 / m.beside_area,
        lumps.Surface(
            1.0, m.rotor_coefficient, m.surface_emissivity, m.rotor_thickness / 3.0 / m.structure_conductivity
        ),
    )
    first, *others = (
        lump._replace(
            conductance=1.0 / (1.0 / lump.conductance + way / (m.structure_conductivity * m.edge_length)),
            capacity=lump.capacity + covered / m.rotor_rim * m.melt_lip_moments.area * capacity,
        )
        for lump, covered, way in zip(chain, m.lip_over, m.lip_ways, strict=True)
    )
    return (first._replace(conductance=lumps.in_series(m.plate_to_edge, first.conductance)), *others)


@quantities.helper()
def uneven_sideways(m: Module) -> Scalar:
    """Conductance sideways for what the plate's temperature differs over its depth from its mean [W/K].

    Its slowest mode, a cosine over the depth, dies down within that over pi beside the arc.
    """
    return lumps.in_series(m.plate_to_edge, m.structure_conductivity * m.edge_length * np.pi)


@quantities.helper()
def heater_along(m: Module) -> Scalar:
    """Conductance [W/K] along half of the pads' thickness, or the spreader, from its mean temperature to its edge."""
    if m.heater_form != CUT:
        return m.spreader_conductivity * m.spreader_depth * m.to_edge
    return m.pad_conductivity * 0.5 * m.heater_thickness * m.to_edge


@quantities.helper()
def pad_edge(m: Module) -> Scalar:
    """Conductance from one side of the pads to the walls of their pockets [W/K]: along the pads, and into the wall.

    Tiles stand in air there; the spreader on them meets the wall through its seat, and at its ends a slot.
    """
    if m.heater_form == CUT:
        return lumps.in_series(m.heater_along, m.pad_edge_contact * 0.5 * m.heater_thickness * m.edge_length)
    seat = m.heater_adhesive_conductivity / m.spreader_gap * m.seat_length
    ends = m.pad_edge_contact * (m.edge_length - m.seat_length)
    return lumps.in_series(m.heater_along, (seat + ends) * m.spreader_depth)


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
        given = given + m.edge_length * m.cold_end.near * (now.spreader - now.lip.temperature)
    return (given / m.heater_along, (even + m.uneven_sideways * (now.plate[0] - mean)) / m.plate_to_edge)


class LayerSurroundings(NamedTuple):
    """All that the temperatures of the layer's slices follow from, beside what its end does to them."""

    cells: Scalar  # Mean temperature of each slice over the width [K], an array
    through: Scalar  # Heat from the layer's end into the air beside or below it, over the layer's conductivity [K]
    drops: tuple[Scalar, Scalar]  # Temperatures of the pads' edges and the plate's below their means [K] (`edge_drops`)
    in_plate: Scalar  # Drop of the plate below its mean in each column, over that of its edge [1], an array
    share: Scalar  # Share of the way from pads to plate that lies before each slice [1], an array
    lip: Scalar | None  # Temperature of the lip at the layer's end [K]


@quantities.helper(instant=True)
def layer_surroundings(m: Module) -> LayerSurroundings:
    """Surroundings of the layer's slices at an instant."""
    now, (conductivity, slot) = m.stack_profile, m.air_beside
    to_floor, lip = now.spreader - now.around[CORNER], None
    if m.cold_end is not None:
        assert now.lip is not None  # a cold end is that of a lip
        lip = now.lip.temperature
        into_lip, into_floor = layer_end.below_lip(slot)
        to_floor = into_lip * (now.spreader - lip) + into_floor * to_floor
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
