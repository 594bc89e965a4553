"""What stands around the blocks of the compression module as bodies of one temperature, and what passes heat to them.

Blocks, pads and rotor vanes face floor and rotor plate through the still air of the running clearances, and the housing
through the chamber within and without. The pads lean against the housing's vanes. The floor below blocks and pads is
three bodies from its upper face on, as is the rotor plate above them; the floor below the rotor's vanes is one. Floor
and plate at the housing's vanes are three in a row from the pads on, as these are.
"""

from __future__ import annotations

import itertools

import numpy as np

from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import lumps, shape_factors
from tvimdesign.physics.heat_flow.lumps import Body, Link, Place
from tvimdesign.physics.heat_flow.strip import BEYOND, STRIP, WAYS
from tvimdesign.physics.polymers import polymer

quantities = QuantityGroup(shared.group)

FLOOR = (0, 1, 2)
"""Places of the floor's bodies below the blocks, from its upper face on."""
WALLS = (3, 4, 5)
"""The housing's vanes, from the pads on."""
RIM, WITHIN, BELOW_VANES, BELOW_WALLS, ABOVE_WALLS = 6, 7, 8, (9, 10, 11), (12, 13, 14)
"""The last two below and above the housing's vanes, from the pads on."""
BELOW_PADS, ABOVE_PADS, HOUSING = (15, 16, 17), 18, 19
"""The floor's bodies below the pads, from its upper face on; beside the plate's lower one, which is above the
blocks."""
ABOVE_VANES, ABOVE = 0, (1, 2, 3)
"""Places beside the vanes: the rotor plate above them; above blocks and pads, from its lower face on."""
LEGS = ("legs", 0)


@quantities.helper()
def wall_depth(
    pcl_mean_radius: Scalar, vane_count: Scalar, plate_depth: Scalar, block_depth: Scalar, pad_depth: Scalar
) -> Scalar:
    """Half the thickness of a housing vane, which a pad leans against [m]: what is left of the ring at its mean
    radius."""
    return np.pi * pcl_mean_radius / vane_count - plate_depth - block_depth - pad_depth


@quantities.helper()
def ring_width(vane_count: Scalar, block_width: Scalar) -> Scalar:
    """Width of all blocks together [m]: plan area of what stands in the ring over its depth."""
    return 2.0 * vane_count * block_width


@quantities.helper()
def ring_places() -> tuple[Place, Place, Place, Place]:
    """What pads face: floor, rotor plate and housing's vanes; and the housing."""
    return ("around", BELOW_PADS[0]), ("around", ABOVE_PADS), ("around", WALLS[0]), ("around", HOUSING)


@quantities.helper()
def pads_share(heated_length: Scalar, block_depth: Scalar) -> Scalar:
    """What the pads have of the depth of a block and its pad."""
    return 1.0 - block_depth / heated_length


@quantities.helper()
def around_pads(
    pcl_area: Scalar,
    cold_area: Scalar,
    ring_width: Scalar,
    heated_length: Scalar,
    pads_share: Scalar,
    plate_depth: Scalar,
    wall_depth: Scalar,
    running_clearance: Scalar,
    block_height: Scalar,
    plate_around: tuple[Body, ...],
    housing_inner_radius: Scalar,
    floor_thickness: Scalar,
    rotor_thickness: Scalar,
    structure_heat_capacity: Scalar,
    structure_conductivity: Scalar,
    floor_in_air: lumps.Surface,
    housing_rest: Body,
) -> tuple[Body, ...]:
    """Floor below blocks and pads, housing vanes, rotor plate without and within the ring, floor below the rotor's and
    the housing's vanes, rotor plate above the housing's, floor and plate next to the pads, the rest."""
    pads = pads_share * heated_length
    depths = (heated_length - pads, pads, plate_depth, wall_depth)
    deep = floor_thickness / structure_conductivity
    below = [
        Body(ring_width * depth * floor_thickness * structure_heat_capacity,
             floor_in_air._replace(area=ring_width * depth, behind=way * deep))
        for depth, way in zip(depths, (BEYOND, BEYOND, 1.0 / 3.0, 1.0 / 3.0), strict=True)
    ]  # fmt: skip
    blocks, below_pads = ([Body(share * whole.capacity, lumps.NOWHERE) for share in STRIP] for whole in below[:2])
    for bodies, whole in zip((blocks, below_pads), below[:2], strict=True):
        bodies[-1] = bodies[-1]._replace(surface=whole.surface)
    wall = (pcl_area - cold_area) * (1.0 + running_clearance / block_height) * wall_depth * structure_heat_capacity
    walls = [Body(share * wall, lumps.NOWHERE) for share in STRIP]
    below_walls = _divided(below[3])
    above_pads = Body(STRIP[0] * pads * ring_width * rotor_thickness * structure_heat_capacity, lumps.NOWHERE)
    parts = (*blocks, *walls, below[2], *below_walls, *below_pads)
    rest = lumps.less(housing_rest, parts, np.pi * housing_inner_radius**2 - ring_width * sum(depths))
    rim, within, *above_walls = plate_around
    return (*blocks, *walls, rim, within, below[2], *below_walls, *above_walls, *below_pads, above_pads, rest)


def _divided(whole: Body) -> list[Body]:
    """A strip that is heated at its edge, in three bodies from there on (`strip.STRIP`)."""
    surface = whole.surface
    return [Body(share * whole.capacity, surface._replace(area=share * surface.area)) for share in STRIP]


@quantities.helper()
def plate_around(
    wall_depth: Scalar,
    ring_width: Scalar,
    faced_area: Scalar,
    rotor_thickness: Scalar,
    rotor_radius: Scalar,
    core_radius: Scalar,
    pcl_inner_radius: Scalar,
    pcl_outer_radius: Scalar,
    rotor_coefficient: Scalar,
    surface_emissivity: Scalar,
    structure_heat_capacity: Scalar,
    structure_conductivity: Scalar,
) -> tuple[Body, ...]:
    """Rotor plate without and within the ring, and above the housing's vanes; its upper face is in the air."""
    in_air = lumps.Surface(1.0, rotor_coefficient, surface_emissivity)
    above_walls = ring_width * wall_depth
    within = np.pi * pcl_inner_radius**2 * rotor_thickness
    rim = np.pi * rotor_radius**2 * rotor_thickness - within - (faced_area + above_walls) * rotor_thickness
    areas = (
        np.pi * (rotor_radius**2 - pcl_outer_radius**2),
        np.pi * (pcl_inner_radius**2 - core_radius**2),
        above_walls,
    )
    volumes = (rim, within, above_walls * rotor_thickness)
    behind = (None, None, rotor_thickness / 3.0 / structure_conductivity)
    without, inside, above = (
        Body(volume * structure_heat_capacity, in_air._replace(area=area, behind=way))
        for volume, area, way in zip(volumes, areas, behind, strict=True)
    )
    return (without, inside, *_divided(above))


@quantities.helper()
def floor_links(
    pcl_area: Scalar,
    cold_area: Scalar,
    plate_depth: Scalar,
    wall_depth: Scalar,
    heated_length: Scalar,
    pads_share: Scalar,
    ring_width: Scalar,
    floor_thickness: Scalar,
    pcl_outer_radius: Scalar,
    housing_inner_radius: Scalar,
    structure_conductivity: Scalar,
) -> tuple[Link, ...]:
    """Within the floor, along the ring and out to the housing's wall; and within the housing's vanes.

    Heat goes along the ring from below the pads through what is below the blocks, which loses or takes heat evenly on
    the way. What is below pads has its mean temperature a quarter of its length from either end (a sixth where both
    ends take as much, a third where one takes all), what is heated at its end a third of its length away. What a body
    of a row differs from its row's mean takes the way of a cosine over the depth (`shape_factors.uneven_way`).
    """
    pads = pads_share * heated_length
    blocks, sheet = heated_length - pads, structure_conductivity * floor_thickness * ring_width
    out = 2.0 * np.pi * structure_conductivity * floor_thickness / np.log(housing_inner_radius / pcl_outer_radius)
    out = out / (heated_length + plate_depth + wall_depth)
    to_walls = sheet / (0.25 * pads + WAYS[0] * wall_depth)
    to_vanes, to_pads, across = lumps.heated_between(sheet / blocks, 3.0 * sheet / plate_depth, 4.0 * sheet / pads)
    turned = shape_factors.uneven_way(wall_depth / floor_thickness) * floor_thickness
    uneven_walls = sheet / (0.25 * pads + turned)
    turned = shape_factors.uneven_way(plate_depth / floor_thickness) * floor_thickness
    uneven_vanes = lumps.heated_between(sheet / blocks, sheet / turned, 4.0 * sheet / pads)[0]
    found = []
    found += [*_evened(FLOOR, uneven_vanes - to_vanes), *_evened(BELOW_PADS, uneven_walls - to_walls)]
    first = BELOW_WALLS[0]
    for row, depth, end, along in ((FLOOR, blocks, BELOW_VANES, to_vanes), (BELOW_PADS, pads, first, to_walls)):
        down = structure_conductivity * depth * ring_width / floor_thickness
        found += [_link(row[i - 1], row[i], down / way) for i, way in enumerate(WAYS[1:], 1)]
        for place, share in zip(row, STRIP, strict=True):
            found += [_link(place, HOUSING, share * out * depth), _link(place, end, share * along)]
    for block, pad, share in zip(FLOOR, BELOW_PADS, STRIP, strict=True):
        found += [_link(block, pad, share * to_pads), _link(pad, BELOW_VANES, share * across)]
    found.append(_link(BELOW_VANES, HOUSING, out * plate_depth))
    found += [_link(i, HOUSING, share * out * wall_depth) for i, share in zip(BELOW_WALLS, STRIP, strict=True)]
    inwards = structure_conductivity * (pcl_area - cold_area) / wall_depth
    for strip, across in ((WALLS, inwards), (BELOW_WALLS, sheet / wall_depth)):
        found += [_link(i - 1, i, across / way) for i, way in zip(strip[1:], WAYS[1:], strict=True)]
    return tuple(found)


def _evened(row: tuple[int, ...], conductance: Scalar) -> list[Link]:
    """Links among bodies of a row that leave what it gives by its mean, and take a conductance from what each gives by
    its difference from that: c (T_mean - T_i) to each for its share."""
    shares = dict(zip(row, STRIP, strict=True))
    pairs = itertools.combinations(row, 2)
    return [_link(one, other, shares[one] * shares[other] * conductance) for one, other in pairs]


def _link(first: int, second: int, conductance: Scalar) -> Link:
    return Link(("around", first), ("around", second), conductance)


@quantities.helper()
def slope_share(block_depth: Scalar, plate_depth: Scalar, pads_share: Scalar, heated_length: Scalar) -> Scalar:
    """What lies below a block of the way from the floor below a pad to that below a vane, where heat passes on [1].

    Ways to their mean temperatures as in `floor_links`.
    """
    return block_depth / (block_depth + plate_depth / 3.0 + 0.25 * pads_share * heated_length)


@quantities.helper()
def pad_height(heater_form: str, block_height: Scalar, peltier_width: Scalar) -> Scalar:
    """Height of what heats a block [m]: its pad, or tiles that stand at its lower edge."""
    return block_height if heater_form == CUT else peltier_width


@quantities.helper()
def pad_rows(heated_area: Scalar, pcl_area: Scalar, pad_height: Scalar, block_height: Scalar) -> Scalar:
    """What pads or tiles have of the width of the blocks [1]."""
    return heated_area / pcl_area * block_height / pad_height


@quantities.helper()
def stack_links(
    ring_width: Scalar,
    block_depth: Scalar,
    peltier_thickness: Scalar,
    running_clearance: Scalar,
    block_height: Scalar,
    pad_height: Scalar,
    pad_rows: Scalar,
    pcl_conductivity_melt: Scalar,
    air_conductivity: Scalar,
    surface_emissivity: Scalar,
    floor_thickness: Scalar,
    rotor_thickness: Scalar,
    structure_conductivity: Scalar,
    ambient_temperature: Scalar,
    pcl_melting: polymer.Melting,
    slope_share: Scalar,
    plate_links: tuple[Link, ...],
    vane_links: tuple[Link, ...],
) -> tuple[Link, ...]:
    """Through the running clearances below and above blocks and pads, with what lies on either side of them.

    Of what passes a clearance a tenth is radiation, which from blocks is taken as where the PCL is molten.

    The pads lose heat from their legs, which are as thick as they are, by half from either side at the legs' mean
    temperature. Where legs fall evenly from T_h to T_c the hot side loses two thirds of what is at T_h and a third of
    what is at T_c: 1/12 of the difference more. A clearance between a wall of one temperature and one that changes
    along it conducts along as well, like a strip of a third of its width. Above tiles there is more air.
    """
    blocks, pads = (("around", FLOOR[0]), ("beside", ABOVE[0])), (("around", BELOW_PADS[0]), ("around", ABOVE_PADS))
    to_faces = shape_factors.way_to_faces(2.0 * block_depth / block_height)
    below_pads = tuple((("around", i), share) for i, share in zip(BELOW_PADS, STRIP, strict=True))
    sloping = {blocks[0]: lumps.Slope(below_pads, ("around", BELOW_VANES), slope_share)}
    found = []
    above = running_clearance + block_height - pad_height
    of_pads = (LEGS, pad_rows * peltier_thickness, pads, (running_clearance, above))
    for place, depth, faced, gaps in ((("layer", 0), block_depth, blocks, (running_clearance,) * 2), of_pads):
        area = ring_width * depth
        for face, deep, wide in zip(faced, (floor_thickness, rotor_thickness), gaps, strict=True):
            gap = lumps.air_gap(area, wide, air_conductivity, surface_emissivity, place, face)
            walls = structure_conductivity * area / (WAYS[0] * deep)
            if place == ("layer", 0):
                walls = lumps.in_series(walls, pcl_conductivity_melt * area / (to_faces * 0.5 * block_height))
            through = lumps.behind(gap, walls, ambient_temperature)
            if place == ("layer", 0):
                through = lumps.straightened(through, pcl_melting.end, ambient_temperature)
                through = through._replace(slope=sloping.get(face))
            found.append(through)
    lost = sum(lumps.link_conductance(one, pcl_melting.end, ambient_temperature) for one in found if one.first == LEGS)
    along = air_conductivity * 2.0 / 3.0 * running_clearance * ring_width / peltier_thickness
    return (*plate_links, *vane_links, *found, Link(("hot", 0), ("cold", 0), lost / 12.0 + along))


@quantities.helper()
def open_sides(
    block_height: Scalar,
    vane_count: Scalar,
    housing_coefficient: Scalar,
    surface_emissivity: Scalar,
    ambient_temperature: Scalar,
) -> Scalar:
    """What the inner and outer sides of all blocks give to the chamber, by convection and radiation [W/m K].

    For a metre of their depth, or of the pads' or the rotor vanes'.
    """
    chamber = lumps.Surface(2.0 * vane_count * 2.0 * block_height, housing_coefficient, surface_emissivity)
    return chamber.area * lumps.surface_coefficient(chamber, ambient_temperature, ambient_temperature)


@quantities.helper()
def side_links(
    open_sides: Scalar,
    block_depth: Scalar,
    plate_depth: Scalar,
    peltier_thickness: Scalar,
    block_height: Scalar,
    pad_height: Scalar,
    heated_area: Scalar,
    cold_area: Scalar,
    wall_depth: Scalar,
    structure_conductivity: Scalar,
    spreader_links: tuple[Link, ...],
) -> tuple[Link, ...]:
    """From inner and outer sides through the chamber to the housing; from the cold sides into the housing's vanes.

    Tiles heat a vane over their own height.
    """
    housing, pads = ("around", HOUSING), pad_height / block_height * peltier_thickness * open_sides
    onto = WAYS[0] * wall_depth + shape_factors.constriction(pad_height / block_height) * pad_height
    into_walls = structure_conductivity * (heated_area - cold_area) / onto
    return (
        Link(("layer", 0), housing, open_sides * block_depth),
        Link(("plate", 0), housing, open_sides * plate_depth),
        Link(LEGS, housing, pads),
        Link(("hot", 0), ("cold", 0), pads / 12.0),
        Link(("cold", 0), ("around", WALLS[0]), into_walls),
        *spreader_links,
    )
