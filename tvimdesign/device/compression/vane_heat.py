"""Heat of rotor plate, vanes and rigid heaters around the blocks of the compression module.

Vanes give heat to floor and rotor plate through their roots, and through the clearance at their other end. A vane
meets them in a strip, from which heat turns to the side as it comes in, as in a ledge (`ledge_ways`).
"""

import numpy as np

from tvimdesign.device.compression import ring_heat
from tvimdesign.device.core.heater_form import CUT, WITH_TILES
from tvimdesign.device.table import Module, QuantityGroup, Scalar
from tvimdesign.physics.heat_flow import lumps, peltier, shape_factors
from tvimdesign.physics.heat_flow.layer_end import Lip
from tvimdesign.physics.heat_flow.lumps import STRIP, WAYS, Body, Link, Place
from tvimdesign.physics.heat_flow.ring_sheet import along_ring

quantities = QuantityGroup("Switch")


@quantities.helper()
def shares_above(m: Module) -> tuple[tuple[Place, Scalar], ...]:
    """Bodies of the rotor plate above the ring, and each one's share of it."""
    ring, depths = sum(m.ring_depths), m.ring_depths
    rows = ((ring_heat.BLOCKS, depths.blocks), (ring_heat.PADS, depths.pads), (ring_heat.OUTER, depths.walls))
    shares = [(place, share * depth / ring) for row, depth in rows for place, share in zip(row, STRIP, strict=True)]
    return (("beside", ring_heat.ABOVE_VANES), m.plate_depth / ring), *shares


@quantities.helper()
def plate_links(m: Module) -> tuple[Link, ...]:
    """Links along the ring within the rotor plate, and to the core, but those of the chain from the vanes."""
    last, core = ring_heat.BLOCKS[-1], ("beside", ring_heat.ABOVE[-1] + 1)
    along = [link for link in m.plate_sheet if (link.first, link.second) not in ring_heat.CHAIN]
    inwards = [
        Link(place, core, share * m.core_and_link.conductance) for place, share in m.shares_above if place != last
    ]
    return (*along, *inwards)


@quantities.helper()
def core_share(m: Module) -> Scalar:
    """Share of the conductance to the core that begins at the last body of the rotor plate."""
    return dict(m.shares_above)["beside", ring_heat.ABOVE[-1]]


@quantities.helper()
def plate_losses(m: Module) -> tuple[lumps.Loss, ...]:
    """Losses of the rotor plate to what is beyond the ring, and of what is above the blocks to what is above the pads
    and on to the housing's vanes.

    What ends free has its mean temperature a third of the way to its end.
    """
    sheet = m.structure_conductivity * m.rotor_thickness * m.ring_width
    pads, *walls = (
        sum(
            surface.area * lumps.surface_coefficient(surface, m.ambient_temperature, m.ambient_temperature)
            for surface in (m.around_pads[i].surface for i in row)
        )
        for row in (ring_heat.ABOVE_PADS[-1:], ring_heat.ABOVE_WALLS)
    )
    along = along_ring(m.structure_conductivity * m.ring_width, m.rotor_thickness, m.ring_depths)
    onward = pads + lumps.in_series(along.to_walls, sheet / ((1.0 / 3.0 - WAYS[0]) * m.wall_depth), *walls)
    losses = [
        lumps.Loss(Link(block, pad, share * along.to_pads), share * onward)
        for block, pad, share in zip(ring_heat.BLOCKS, ring_heat.PADS, STRIP, strict=True)
    ]
    around = 2.0 * np.pi * m.structure_conductivity * m.rotor_thickness
    without = around / np.log(1.0 + (m.rotor_radius - m.pcl_outer_radius) / (3.0 * m.pcl_outer_radius))
    within = -around / np.log(1.0 - (m.pcl_inner_radius - m.core_radius) / (3.0 * m.pcl_inner_radius))
    for beyond, conductance in ((ring_heat.RIM, without), (ring_heat.WITHIN, within)):
        for place, share in m.shares_above:
            link = Link(place, ("around", beyond), share * conductance)
            losses.append(_onward(link, m.around_pads, m.ambient_temperature, share))
    return tuple(losses)


@quantities.helper()
def loss_links(m: Module) -> tuple[Link, ...]:
    """Links from the plate to bodies beyond the ring."""
    return tuple(loss.link for loss in m.plate_losses if loss.link.second[1] in (ring_heat.RIM, ring_heat.WITHIN))


@quantities.helper()
def lip(_: Module) -> Lip | None:
    """No lip stands at a block."""
    return None


def _onward(link: Link, bodies: tuple[Body, ...], ambient: Scalar, share: Scalar) -> lumps.Loss:
    """Return a link to a body that loses a share of its heat to the air behind it."""
    surface = bodies[link.second[1]].surface
    return lumps.Loss(link, share * surface.area * lumps.surface_coefficient(surface, ambient, ambient))


@quantities.helper()
def through_clearance(m: Module) -> Scalar:
    """Conductance of a running clearance [W/m^2 K]; a tenth is radiation, taken as where the PCL is molten."""
    gap = lumps.air_gap(1.0, m.running_clearance, m.air_conductivity, m.surface_emissivity, ("plate", 0), ("plate", 0))
    return lumps.link_conductance(gap, m.pcl_melting.end, m.ambient_temperature)


@quantities.helper()
def vane_ways(m: Module) -> tuple[Scalar, Scalar, Scalar]:
    """Conductances [W/K] from the rotor's vanes to the plate above, to the floor below, and from one to the other."""
    k, area = m.structure_conductivity, m.ring_width * m.plate_depth
    above, below = (_into(k * m.ring_width, m.plate_depth, depth) for depth in (m.rotor_thickness, m.floor_thickness))
    below = lumps.in_series(below, m.through_clearance * area)
    # The vane stands beside the clearance before it meets the plate.
    above = lumps.in_series(above, k * m.rotor_vanes.area / m.running_clearance)
    return lumps.heated_between(k * m.rotor_vanes.area / m.block_height, above, below)


@quantities.helper()
def vane_links(m: Module) -> tuple[Link, ...]:
    """Links from the rotor's vanes to the floor, and from the housing's to floor and rotor plate."""
    floor, plate = ("around", ring_heat.BELOW_VANES), ("beside", ring_heat.ABOVE_VANES)
    links = [Link(("plate", 0), floor, m.vane_ways[1]), Link(plate, floor, m.vane_ways[2])]
    k, area = m.structure_conductivity, m.ring_width * m.wall_depth
    whole = (m.pcl_area - m.cold_area) / m.pcl_area
    below = whole * lumps.in_series(
        _into(k * m.ring_width, m.wall_depth, m.floor_thickness), k * area / m.running_clearance
    )
    above = lumps.in_series(_into(k * m.ring_width, m.wall_depth, m.rotor_thickness), m.through_clearance * area)
    to_floor, to_plate, across = lumps.heated_between(k * whole * area / m.block_height, below, above)
    for places in zip(ring_heat.WALLS, ring_heat.BELOW_WALLS, ring_heat.ABOVE_WALLS, STRIP, strict=True):
        wall, floor, plate = (("around", i) for i in places[:3])
        ways = ((wall, floor, to_floor), (wall, plate, to_plate), (floor, plate, across))
        links += [Link(first, second, places[3] * conductance) for first, second, conductance in ways]
    return tuple(links)


def _into(sheet: Scalar, width: Scalar, depth: Scalar) -> Scalar:
    """Return the conductance [W/K] from a strip of a face to the mean of what lies before it, k L of its length."""
    return sheet / shape_factors.ledge_ways(width / depth)[0]


@quantities.output("1")
def heater_strings(m: Module) -> Scalar:
    """Strings of heaters in parallel, which share the current."""
    return {"series": 1.0, "vanes_parallel": m.vane_count, "all_parallel": m.heater_count}[m.heater_wiring]


@quantities.helper()
def cold_to_sink(_: Module) -> Scalar:
    """Resistance along the cold sides to a sink [K/W]: not counted, as the slots leave most of them open."""
    return 0.0


@quantities.helper()
def cold_area(m: Module) -> Scalar:
    """Open area of the modules' cold sides [m^2]: what of them the slots show, rounds of their corners not counted."""
    if m.heater_form == CUT:
        return 2.0 * m.vane_count * m.slot_width * m.slot_height
    return m.heater_count * m.tile_window * m.slot_height


@quantities.output("K*mm^2/W", requires=WITH_TILES)
def spreader_resistance(m: Module) -> Scalar:
    """Resistance of the way along the spreader to what its modules do not cover, times the layer's area.

    The tiles stand at the spreader's lower edge.
    """
    area, tile = m.block_width * m.block_height, (m.heater_length, m.heater_width)
    return peltier.row_spreading_resistance(
        area, m.block_height, m.tiles_per_block, tile, 1, m.spreader_conductivity, m.spreader_thickness
    )


@quantities.helper(requires=WITH_TILES, default=())
def spreader_links(m: Module) -> tuple[Link, ...]:
    """Links from the spreaders' edges to floor, rotor plate and housing, and from their free backs into the vanes.

    Beside the tiles their backs face the vane through the tiles' thickness of still air.
    """
    plate, (floor, above, walls, housing) = ("spreader", 0), m.ring_places
    edges = [
        lumps.air_gap(
            m.ring_width * m.spreader_depth, m.running_clearance, m.air_conductivity, m.surface_emissivity, plate, face
        )
        for face in (floor, above)
    ]
    backs = lumps.air_gap(
        m.pcl_area - m.heated_area, m.heater_thickness, m.air_conductivity, m.surface_emissivity, plate, walls
    )
    return (*edges, backs, Link(plate, housing, m.open_sides * m.spreader_depth))
