"""Bodies of one temperature around the blocks of the compression module, and the links that pass heat to them.

Blocks, pads and rotor vanes face floor and rotor plate through the still air of the running clearances, and the housing
through the chamber within and without. The pads lean against the housing's vanes. Floor and rotor plate are alike:
three bodies in depth at the blocks and three at the pads, from the face in the ring on, one at the rotor's vanes, and
at the housing's three in a row from the pads on, as these are.

The heat goes along the blocks into half of a rotor vane, and up into the plate: by symmetry none passes the middle of
a vane, which a block heats from either side.
"""

import itertools
from collections.abc import Iterable

import numpy as np

from tvimdesign.device.compression.block_impedance import blocks_moment
from tvimdesign.device.core.heater_form import CUT
from tvimdesign.device.table import Module, QuantityGroup, Scalar
from tvimdesign.physics.heat_flow import columns, lumps, shape_factors
from tvimdesign.physics.heat_flow.lumps import BEYOND, STRIP, WAYS, Body, Link, Place
from tvimdesign.physics.heat_flow.ring_sheet import Depths, Row, sheet_links
from tvimdesign.physics.layers import block

quantities = QuantityGroup("Switch")

FLOOR = (0, 1, 2)  # Places of the floor's bodies below the blocks, from its upper face on
WALLS = (3, 4, 5)  # The housing's vanes, from the pads on
RIM, WITHIN, BELOW_VANES, BELOW_WALLS, ABOVE_WALLS = 6, 7, 8, (9, 10, 11), (12, 13, 14)
"""The last two below and above the housing's vanes, from the pads on."""
BELOW_PADS, ABOVE_PADS, HOUSING = (15, 16, 17), (18, 19, 20), 21
"""Bodies of floor and rotor plate at the pads, from the face in the ring on."""
ABOVE_VANES, ABOVE = 0, (1, 2, 3)
"""Places beside the vanes: the rotor plate above them; above the blocks, from its lower face on."""
LEGS = ("legs", 0)


def around(row: Iterable[int]) -> Row:
    """Return the places of bodies around the pads."""
    return tuple(("around", i) for i in row)


BLOCKS, PADS, OUTER = tuple(("beside", i) for i in ABOVE), around(ABOVE_PADS), around(ABOVE_WALLS)
"""Rows of the rotor plate's bodies: above blocks, pads and the housing's vanes."""
CHAIN = tuple(itertools.pairwise((("beside", ABOVE_VANES), *BLOCKS)))
"""Pairs of the plate's bodies that pass heat from one to the next by `rotor_beside`, the first in the vanes' way."""


@quantities.helper(instant=True)
def moment_now(m: Module) -> Scalar:
    """The blocks' moment at an instant [m^4], 3 (1 + 2 (S/p)^2) N A r^2, p the share of them that is soft."""
    share = block.soft_share(*m.slice_moduli)
    return blocks_moment(m.shape_factor / share, m.vane_count, m.block_area, m.pcl_mean_radius)


@quantities.helper()
def column_shares(_: Module) -> tuple[float, ...]:
    """Share of a block's height that each row stands for [1]."""
    return columns.EVEN.shares


@quantities.helper(instant=True)
def layer_temperatures(m: Module) -> list[Scalar]:
    """Temperatures of a block's slices [K], in rows from its lower face to its upper one."""
    count, places = len(m.stack_profile.cells), m.stack_profile._asdict()
    lost = []
    for faced in (("around", FLOOR[0]), ("beside", ABOVE[0])):
        (link,) = (link for link in m.stack.links if (link.first, link.second) == (("layer", 0), faced))
        face = places[faced[0]][faced[1]]
        if link.slope is not None:
            face = face + lumps.risen(link.slope, places, count)
        lost.append(link.conductance / (m.ring_width * m.block_depth) * (m.stack_profile.cells - face))
    depths = (np.arange(count) + 0.5) / count
    across = 0.5 * m.block_height / m.pcl_conductivity_melt
    return [
        m.stack_profile.cells
        - across * columns.row_below_mean(2.0 * place - 1.0, depths, 2.0 * m.block_depth / m.block_height, lost)
        for place in columns.EVEN.places
    ]


@quantities.helper()
def plate_depth(m: Module) -> Scalar:
    """Thickness of what is behind a block [m]: half a rotor vane."""
    return 0.5 * m.vane_thickness


@quantities.helper()
def plate_outside(m: Module) -> lumps.Surface:
    """The middle of the rotor's vanes, which no heat passes; their rims face the chamber (`side_links`)."""
    return lumps.Surface(m.pcl_area, 0.0)


@quantities.helper()
def plate_mass(m: Module) -> Scalar:
    """Mass of the rotor plate with its vanes [kg]."""
    return (np.pi * m.rotor_radius**2 * m.rotor_thickness + m.rotor_vanes.area * m.vane_height) * m.structure_density


@quantities.helper()
def faced_area(m: Module) -> Scalar:
    """Plan area of rotor's vanes, blocks and pads [m^2]: what of floor and rotor plate they heat."""
    return 2.0 * m.vane_count * m.block_width * (m.plate_depth + m.block_depth + m.pad_depth)


@quantities.helper()
def heated_length(m: Module) -> Scalar:
    """Depth of a block and its pad [m], along the ring."""
    return m.faced_area / m.ring_width - m.plate_depth


@quantities.helper()
def ring_depths(m: Module) -> Depths:
    """Lengths along the ring at half a rotor vane, a block, a pad and half a housing vane [m]."""
    pads = m.pads_share * m.heated_length
    return Depths(m.heated_length - pads, pads, m.plate_depth, m.wall_depth)


@quantities.helper()
def rotor_beside(m: Module) -> tuple[lumps.Lump, ...]:
    """Rotor plate above the vanes, heated by their roots; beside that above the blocks, three bodies in depth."""
    k, capacity = m.structure_conductivity, m.rotor_thickness * m.structure_density * m.structure_specific_heat
    above_vanes, blocks = m.ring_width * m.plate_depth, m.ring_width * m.ring_depths.blocks
    outside = lumps.Surface(1.0, m.rotor_coefficient, m.surface_emissivity)
    # What of a vane stands beside the clearance above the blocks counts as plate.
    upper = (
        (m.rotor_vanes.area * m.vane_height - m.pcl_area * m.plate_depth)
        * m.structure_density
        * m.structure_specific_heat
    )
    vanes = lumps.Lump(
        m.vane_ways[0],
        above_vanes * capacity + upper,
        outside._replace(area=above_vanes, behind=m.rotor_thickness / 3.0 / k),
    )
    bodies = [
        lumps.Lump(sum(link.conductance for link in m.plate_sheet if (link.first, link.second) == pair),
                   share * blocks * capacity, lumps.Surface(share * blocks, 0.0))
        for pair, share in zip(CHAIN, STRIP, strict=True)
    ]  # fmt: skip
    bodies[-1] = bodies[-1]._replace(surface=outside._replace(area=blocks, behind=BEYOND * m.rotor_thickness / k))
    return (vanes, *bodies)


@quantities.helper()
def plate_sheet(m: Module) -> tuple[Link, ...]:
    """Links along the ring within the rotor plate."""
    along, vanes = m.structure_conductivity * m.ring_width, ("beside", ABOVE_VANES)
    return tuple(
        sheet_links(along, m.rotor_thickness, m.ring_depths, blocks=BLOCKS, pads=PADS, walls=OUTER, vanes=vanes)
    )


@quantities.helper()
def uneven_sideways(_: Module) -> None:
    """Let a vane's cells give heat to the plate above by one conductance, their mean and what they differ from it."""


@quantities.helper()
def wall_depth(m: Module) -> Scalar:
    """Half the thickness of a housing vane, which a pad leans against [m]: what is left of the ring at its mean
    radius."""
    return np.pi * m.pcl_mean_radius / m.vane_count - m.plate_depth - m.block_depth - m.pad_depth


@quantities.helper()
def ring_width(m: Module) -> Scalar:
    """Width of all blocks together [m]: plan area of what stands in the ring over its depth."""
    return 2.0 * m.vane_count * m.block_width


@quantities.helper()
def ring_places(_: Module) -> tuple[Place, Place, Place, Place]:
    """Places that pads face: floor, rotor plate and housing's vanes; and the housing."""
    return ("around", BELOW_PADS[0]), ("around", ABOVE_PADS[0]), ("around", WALLS[0]), ("around", HOUSING)


@quantities.helper()
def pads_share(m: Module) -> Scalar:
    """Share of the pads in the depth of a block and its pad."""
    return 1.0 - m.block_depth / m.heated_length


@quantities.helper()
def around_pads(m: Module) -> tuple[Body, ...]:
    """Floor below blocks and pads, housing vanes, rotor plate without and within the ring, floor below the rotor's and
    the housing's vanes, rotor plate above the housing's, floor and plate next to the pads, the rest."""
    pads = m.pads_share * m.heated_length
    depths = (m.heated_length - pads, pads, m.plate_depth, m.wall_depth)
    deep = m.floor_thickness / m.structure_conductivity
    below = [
        Body(
            m.ring_width * depth * m.floor_thickness * m.structure_heat_capacity,
            m.floor_in_air._replace(area=m.ring_width * depth, behind=way * deep),
        )
        for depth, way in zip(depths, (BEYOND, BEYOND, 1.0 / 3.0, 1.0 / 3.0), strict=True)
    ]
    blocks, below_pads = ([Body(share * whole.capacity, lumps.NOWHERE) for share in STRIP] for whole in below[:2])
    for bodies, whole in zip((blocks, below_pads), below[:2], strict=True):
        bodies[-1] = bodies[-1]._replace(surface=whole.surface)
    wall = (
        (m.pcl_area - m.cold_area)
        * (1.0 + m.running_clearance / m.block_height)
        * m.wall_depth
        * m.structure_heat_capacity
    )
    walls = [Body(share * wall, lumps.NOWHERE) for share in STRIP]
    below_walls = _divided(below[3])
    plate = pads * m.ring_width * m.rotor_thickness * m.structure_heat_capacity
    above_pads = [Body(share * plate, lumps.NOWHERE) for share in STRIP]
    in_air = lumps.Surface(pads * m.ring_width, m.rotor_coefficient, m.surface_emissivity)
    above_pads[-1] = above_pads[-1]._replace(
        surface=in_air._replace(behind=BEYOND * m.rotor_thickness / m.structure_conductivity)
    )
    parts = (*blocks, *walls, below[2], *below_walls, *below_pads)
    remainder = lumps.less(m.housing_rest, parts, np.pi * m.housing_inner_radius**2 - m.ring_width * sum(depths))
    rim, within, *above_walls = m.plate_around
    return (*blocks, *walls, rim, within, below[2], *below_walls, *above_walls, *below_pads, *above_pads, remainder)


def _divided(whole: Body) -> list[Body]:
    """Return a strip that is heated at its edge, in three bodies from there on (`lumps.STRIP`)."""
    surface = whole.surface
    return [Body(share * whole.capacity, surface._replace(area=share * surface.area)) for share in STRIP]


@quantities.helper()
def plate_around(m: Module) -> tuple[Body, ...]:
    """Rotor plate without and within the ring, and above the housing's vanes; its upper face is in the air."""
    in_air = lumps.Surface(1.0, m.rotor_coefficient, m.surface_emissivity)
    above_walls = m.ring_width * m.wall_depth
    within = np.pi * m.pcl_inner_radius**2 * m.rotor_thickness
    rim = np.pi * m.rotor_radius**2 * m.rotor_thickness - within - (m.faced_area + above_walls) * m.rotor_thickness
    areas = (
        np.pi * (m.rotor_radius**2 - m.pcl_outer_radius**2),
        np.pi * (m.pcl_inner_radius**2 - m.core_radius**2),
        above_walls,
    )
    volumes = (rim, within, above_walls * m.rotor_thickness)
    behind = (None, None, m.rotor_thickness / 3.0 / m.structure_conductivity)
    without, inside, above = (
        Body(volume * m.structure_heat_capacity, in_air._replace(area=area, behind=way))
        for volume, area, way in zip(volumes, areas, behind, strict=True)
    )
    return (without, inside, *_divided(above))


@quantities.helper()
def floor_links(m: Module) -> tuple[Link, ...]:
    """Within the floor, along the ring and out to the housing's wall; and within the housing's vanes."""
    out = (
        2.0 * np.pi * m.structure_conductivity * m.floor_thickness / np.log(m.housing_inner_radius / m.pcl_outer_radius)
    )
    out = out / sum(m.ring_depths)
    housing, vanes = ("around", HOUSING), ("around", BELOW_VANES)
    rows = {"blocks": around(FLOOR), "pads": around(BELOW_PADS), "walls": around(BELOW_WALLS)}
    along = m.structure_conductivity * m.ring_width
    links = sheet_links(along, m.floor_thickness, m.ring_depths, **rows, vanes=vanes)
    for name, row in rows.items():
        depth = getattr(m.ring_depths, name)
        links += [Link(place, housing, share * out * depth) for place, share in zip(row, STRIP, strict=True)]
    links.append(Link(vanes, housing, out * m.plate_depth))
    inwards = m.structure_conductivity * (m.pcl_area - m.cold_area) / m.wall_depth
    pairs = zip(itertools.pairwise(around(WALLS)), WAYS[1:], strict=True)
    return (*links, *(Link(*pair, inwards / way) for pair, way in pairs))


@quantities.helper()
def slope_share(m: Module) -> Scalar:
    """Share that lies at a block of the way in floor or rotor plate from a pad to a vane [1].

    Ways to their mean temperatures as in `along_ring`.
    """
    return m.block_depth / (m.block_depth + m.plate_depth / 3.0 + 0.25 * m.pads_share * m.heated_length)


@quantities.helper()
def pad_height(m: Module) -> Scalar:
    """Height of what heats a block [m]: its pad, or tiles that stand at its lower edge."""
    return m.block_height if m.heater_form == CUT else m.heater_width


@quantities.helper()
def pad_rows(m: Module) -> Scalar:
    """Share of the blocks' width that pads or tiles cover [1]."""
    return m.heated_area / m.pcl_area * m.block_height / m.pad_height


@quantities.helper()
def stack_links(m: Module) -> tuple[Link, ...]:
    """Through the running clearances below and above blocks and pads, with what lies on either side of them.

    Of what passes a clearance a tenth is radiation, which from blocks is taken as where the PCL is molten.

    The pads lose heat from their legs, which are as thick as they are, by half from either side at the legs' mean
    temperature. Where legs fall evenly from T_h to T_c the hot side loses two thirds of what is at T_h and a third of
    what is at T_c: 1/12 of the difference more. A clearance between a wall of one temperature and one that changes
    along it conducts along as well, like a strip of a third of its width. Above tiles there is more air.
    """
    blocks, pads = (("around", FLOOR[0]), ("beside", ABOVE[0])), (("around", BELOW_PADS[0]), ("around", ABOVE_PADS[0]))
    to_faces = shape_factors.way_to_faces(2.0 * m.block_depth / m.block_height)
    vanes = ("around", BELOW_VANES), ("beside", ABOVE_VANES)
    sloping = {
        face: lumps.Slope(tuple(zip(around(row), STRIP, strict=True)), vane, m.slope_share)
        for face, row, vane in zip(blocks, (BELOW_PADS, ABOVE_PADS), vanes, strict=True)
    }
    links = []
    above = m.running_clearance + m.block_height - m.pad_height
    of_pads = (LEGS, m.pad_rows * m.heater_thickness, pads, (m.running_clearance, above))
    for place, depth, faced, gaps in ((("layer", 0), m.block_depth, blocks, (m.running_clearance,) * 2), of_pads):
        area = m.ring_width * depth
        for face, deep, wide in zip(faced, (m.floor_thickness, m.rotor_thickness), gaps, strict=True):
            gap = lumps.air_gap(area, wide, m.air_conductivity, m.surface_emissivity, place, face)
            walls = m.structure_conductivity * area / (WAYS[0] * deep)
            if place == ("layer", 0):
                walls = lumps.in_series(walls, m.pcl_conductivity_melt * area / (to_faces * 0.5 * m.block_height))
            through = lumps.behind(gap, walls, m.ambient_temperature)
            if place == ("layer", 0):
                through = lumps.straightened(through, m.pcl_melting.end, m.ambient_temperature)
                through = through._replace(slope=sloping.get(face))
            links.append(through)
    lost = sum(
        lumps.link_conductance(link, m.pcl_melting.end, m.ambient_temperature) for link in links if link.first == LEGS
    )
    along = m.air_conductivity * 2.0 / 3.0 * m.running_clearance * m.ring_width / m.heater_thickness
    return (*m.plate_links, *m.vane_links, *links, Link(("hot", 0), ("cold", 0), lost / 12.0 + along))


@quantities.helper()
def open_sides(m: Module) -> Scalar:
    """Heat from the inner and outer sides of all blocks to the chamber, by convection and radiation [W/m K].

    For a metre of their depth, or of the pads' or the rotor vanes'.
    """
    chamber = lumps.Surface(2.0 * m.vane_count * 2.0 * m.block_height, m.housing_coefficient, m.surface_emissivity)
    return chamber.area * lumps.surface_coefficient(chamber, m.ambient_temperature, m.ambient_temperature)


@quantities.helper()
def side_links(m: Module) -> tuple[Link, ...]:
    """Links from inner and outer sides through the chamber to the housing, and from cold sides into the housing's
    vanes.

    Tiles heat a vane over their own height.
    """
    housing, pads = ("around", HOUSING), m.pad_height / m.block_height * m.heater_thickness * m.open_sides
    onto = WAYS[0] * m.wall_depth + shape_factors.constriction(m.pad_height / m.block_height) * m.pad_height
    into_walls = m.structure_conductivity * (m.heated_area - m.cold_area) / onto
    return (
        Link(("layer", 0), housing, m.open_sides * m.block_depth),
        Link(("plate", 0), housing, m.open_sides * m.plate_depth),
        Link(LEGS, housing, pads),
        Link(("hot", 0), ("cold", 0), pads / 12.0),
        Link(("cold", 0), ("around", WALLS[0]), into_walls),
        *m.spreader_links,
    )
