"""The floor the pads are set in as bodies of one temperature, and what passes heat between it, pads, layer and plate.

Beside the pockets the floor is two strips, as high as the pads and below them, of three bodies each; the upper half of
the upper strip's first body, next to the pads' hot sides, is a body of its own. So are the ledges the pads lie on, and
what is left of the housing. A body that is heated over a face has its mean temperature a third of its depth behind that
face (even heating, Incropera, Fundamentals of Heat and Mass Transfer, ch. 3); one that heat passes through, half of it.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.device.core.heat.heater_form import CUT
from tvimdesign.device.core.heat.thermal_stack import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import lumps, shape_factors, slab_faces, strip
from tvimdesign.physics.heat_flow.lumps import Body, Link
from tvimdesign.physics.heat_flow.peltier import SIDE_SHARE
from tvimdesign.physics.heat_flow.slab_faces import ACROSS
from tvimdesign.physics.heat_flow.strip import BEYOND, STRIP, WAYS
from tvimdesign.physics.polymers import polymer

quantities = QuantityGroup(shared.group)

UPPER, LOWER = (0, 1, 2), (3, 4, 5)
"""Places of the strips' bodies, from the pockets' walls on."""
LEDGES, CORNER, HOUSING = 6, 7, 8
BELOW = (CORNER, *UPPER[1:])
"""What of the floor is below each body of the plate's strip."""
SPREADER = ("spreader", 0)
SIDE = 2.0 * SIDE_SHARE
"""What of half of a pad's height is its side, of one temperature; the rest is half of the legs."""
GAP = (("beside", 0), ("around", CORNER))
LEGS, UPPER_LEGS, LOWER_LEGS = (("legs", i) for i in range(3))


@quantities.helper()
def housing_ring(
    housing_inner_radius: Scalar, rotor_radius: Scalar, structure_conductivity: Scalar, floor_thickness: Scalar
) -> Scalar:
    """Conductance of the floor from below the rotor's rim to the housing's wall [W/K]."""
    return 2.0 * np.pi * structure_conductivity * floor_thickness / np.log(housing_inner_radius / rotor_radius)


@quantities.helper()
def floor_end(
    beside_area: Scalar,
    edge_length: Scalar,
    floor_web: Scalar,
    floor_thickness: Scalar,
    housing_ring: Scalar,
    structure_conductivity: Scalar,
    ambient_temperature: Scalar,
    floor_in_air: lumps.Surface,
) -> tuple[lumps.Surface, Scalar, Scalar]:
    """Outer end of the lower strip: the last body's surface, its conductance to the housing [W/K], surface [m^2] that
    counts there."""
    along = structure_conductivity * floor_web * edge_length**2 / (BEYOND * beside_area)
    face = floor_in_air._replace(area=STRIP[-1] * beside_area, behind=floor_web / 3.0 / structure_conductivity)
    return strip.end(face, along, housing_ring * floor_web / floor_thickness, ambient_temperature)


@quantities.helper()
def around_pads(
    pcl_area: Scalar,
    cold_area: Scalar,
    beside_area: Scalar,
    pad_depth: Scalar,
    floor_web: Scalar,
    housing_outer_radius: Scalar,
    rotor_radius: Scalar,
    structure_heat_capacity: Scalar,
    structure_conductivity: Scalar,
    floor_in_air: lumps.Surface,
    housing_rest: Body,
    floor_end: tuple[lumps.Surface, Scalar, Scalar],
) -> tuple[Body, ...]:
    """What the pads are set in: upper and lower strip of the floor, ledges, corner, and the rest of the housing."""
    volumetric = structure_heat_capacity
    areas = [share * beside_area for share in STRIP]
    corner = Body(0.5 * areas[0] * pad_depth * volumetric, lumps.NOWHERE)
    upper = [corner, *(Body(area * pad_depth * volumetric, lumps.NOWHERE) for area in areas[1:])]
    face = floor_in_air._replace(behind=floor_web / 3.0 / structure_conductivity)
    lower = [Body(area * floor_web * volumetric, face._replace(area=area)) for area in (*areas, pcl_area - cold_area)]
    last, _, at_housing = floor_end
    lower[-2] = lower[-2]._replace(surface=last)
    floor = (*upper, *lower, corner)
    below = np.pi * (housing_outer_radius**2 - rotor_radius**2) + at_housing
    return (*floor, lumps.less(housing_rest, floor, below))


@quantities.helper()
def floor_links(
    beside_area: Scalar,
    edge_length: Scalar,
    pad_depth: Scalar,
    floor_web: Scalar,
    floor_thickness: Scalar,
    housing_ring: Scalar,
    floor_end: tuple[lumps.Surface, Scalar, Scalar],
    structure_conductivity: Scalar,
    ambient_temperature: Scalar,
    around_pads: tuple[Body, ...],
) -> tuple[Link, ...]:
    """What conducts within the floor, along the strips to the housing's wall and from the upper to the lower one."""
    per_depth = structure_conductivity * edge_length**2 / beside_area
    found = []
    for row, depth in ((UPPER, pad_depth), (LOWER, floor_web)):
        first, *others = (per_depth * depth / way for way in WAYS[1:])
        if row is UPPER:
            found.append(_link(CORNER, row[1], 0.5 * first))
            first = 0.5 * first
        found += [_link(row[i], row[i + 1], along) for i, along in enumerate((first, *others))]
    to_wall = lumps.in_series(per_depth * pad_depth / BEYOND, housing_ring * pad_depth / floor_thickness)
    found += [_link(UPPER[-1], HOUSING, to_wall), _link(LOWER[-1], HOUSING, floor_end[1])]
    down = [structure_conductivity * share * beside_area for share in STRIP]
    found.append(_link(CORNER, UPPER[0], down[0] / (0.5 * pad_depth)))
    for i, area in enumerate(down):
        height = pad_depth if i else 0.5 * pad_depth
        onto, surface = (0.5 * height + floor_web / 3.0) / area, around_pads[LOWER[i]].surface
        found += slab_faces.through_faces(
            ("around", UPPER[i]), ("around", LOWER[i]), surface, ambient_temperature, onto, ACROSS * floor_web / area
        )
    return tuple(found)


def _link(first: int, second: int, conductance: Scalar) -> Link:
    return Link(("around", first), ("around", second), conductance)


@quantities.helper()
def pad_wall(
    heater_form: str,
    pad_edge: Scalar,
    beside_area: Scalar,
    edge_length: Scalar,
    pad_depth: Scalar,
    spreader_depth: Scalar,
    structure_conductivity: Scalar,
) -> Scalar:
    """Conductance [W/K] from one side of the pads into the first body of the floor beside half of their pockets.

    A spreader's edge heats a share of that body's height (`shape_factors.constriction`).
    """
    way = WAYS[0] * beside_area / edge_length
    along = structure_conductivity * 0.5 * pad_depth * edge_length / way
    if heater_form == CUT:
        return lumps.in_series(pad_edge, along)
    crowded = shape_factors.constriction(spreader_depth / (0.5 * pad_depth))
    return lumps.in_series(pad_edge, along, structure_conductivity * edge_length / crowded)


@quantities.helper()
def stack_links(
    heater_form: str,
    pad_wall: Scalar,
    pcl_area: Scalar,
    heated_area: Scalar,
    cold_area: Scalar,
    beside_area: Scalar,
    edge_length: Scalar,
    floor_web: Scalar,
    structure_conductivity: Scalar,
    cold_to_ledges: Scalar,
    tile_links: tuple[Link, ...],
    ambient_temperature: Scalar,
    around_pads: tuple[Body, ...],
) -> tuple[Link, ...]:
    """From the pads' edges into the walls of their pockets, and by their cold sides through the ledges.

    A pad's upper half meets the floor's corner, its lower half what is below. Tiles stand in air: of them the
    spreader's edge meets a wall, and its back beside them a room of air, which ends at the wall as well (`tile_room`).
    """
    first, ledge = WAYS[0] * beside_area / edge_length, (heated_area - cold_area) / edge_length
    bare = (pcl_area - heated_area) / edge_length
    slender, face = ledge / floor_web, around_pads[LEDGES].surface
    onto, to_root, under = (
        way / (structure_conductivity * edge_length)
        for way in (*shape_factors.ledge_ways(slender), slab_faces.ledge_across(slender))
    )
    beyond = (bare + first) / (structure_conductivity * floor_web * edge_length)
    upper, lower, ledges = ("around", CORNER), ("around", UPPER[0]), ("around", LEDGES)
    hot, cold = ("hot", 0), ("cold", 0)
    if heater_form == CUT:
        halves = ((hot, UPPER_LEGS, upper), (cold, LOWER_LEGS, lower))
        rims = [
            Link(place, wall, share * pad_wall)
            for side, legs, wall in halves
            for place, share in ((side, SIDE), (legs, 1.0 - SIDE))
        ]
    else:
        rims = [Link(SPREADER, upper, pad_wall), *tile_links]
    rested = slab_faces.through_faces(cold, ledges, face, ambient_temperature, onto + cold_to_ledges, under)
    return (*rims, *rested, _link(LEDGES, LOWER[0], 1.0 / (to_root + beyond)))


@quantities.helper()
def open_gaps(
    beside_area: Scalar,
    lip_over: tuple[Scalar, ...],
    edge_length: Scalar,
    pcl_thickness: Scalar,
    air_conductivity: Scalar,
    surface_emissivity: Scalar,
    ambient_temperature: Scalar,
    plate_faces: Scalar,
) -> tuple[Link, ...]:
    """Air between plate and floor beside the arcs where no lip stands, as thick as the layer."""
    found = []
    for share, covered, above, floor in zip(STRIP, lip_over, range(len(STRIP)), BELOW, strict=True):
        area = share * beside_area - covered * edge_length
        gap = lumps.air_gap(area, pcl_thickness, air_conductivity, surface_emissivity,
                            ("beside", above), ("around", floor))  # fmt: skip
        found.append(lumps.behind(gap, area / plate_faces, ambient_temperature))
    return tuple(found)


@quantities.helper()
def loss_links(open_gaps: tuple[Link, ...]) -> tuple[Link, ...]:
    """What passes heat from the plate beside the arcs to the floor, its lips apart."""
    return open_gaps


@quantities.helper()
def plate_faces(rotor_thickness: Scalar, pad_depth: Scalar, structure_conductivity: Scalar) -> Scalar:
    """What lies behind both faces of that gap [m^2 K/W]: a third of the plate's depth and half of the upper strip's."""
    return (rotor_thickness / 3.0 + 0.5 * pad_depth) / structure_conductivity


@quantities.helper()
def below_lips(
    lip_over: tuple[Scalar, ...],
    edge_length: Scalar,
    running_clearance: Scalar,
    pad_depth: Scalar,
    air_conductivity: Scalar,
    surface_emissivity: Scalar,
    ambient_temperature: Scalar,
    pcl_melting: polymer.Melting,
    structure_conductivity: Scalar,
) -> tuple[Scalar, ...]:
    """What the clearance below the lips conducts between the floor and their lower face, over each body of the strip
    [W/K]; its faces radiate as where the PCL is molten."""
    gap = lumps.air_gap(1.0, running_clearance, air_conductivity, surface_emissivity, *GAP)
    across = lumps.link_conductance(gap, pcl_melting.end, ambient_temperature)
    each = lumps.in_series(across, structure_conductivity / (0.5 * pad_depth))
    return tuple(each * covered * edge_length for covered in lip_over)


@quantities.helper()
def plate_losses(
    beside_area: Scalar,
    open_gaps: tuple[Link, ...],
    below_lips: tuple[Scalar, ...],
    housing_coefficient: Scalar,
    surface_emissivity: Scalar,
    ambient_temperature: Scalar,
    pad_depth: Scalar,
    floor_thickness: Scalar,
    structure_conductivity: Scalar,
) -> tuple[lumps.Loss, ...]:
    """How the plate beside the arcs loses heat: through that gap, below lips through their clearance, and the floor."""
    open_below = lumps.Surface(1.0, housing_coefficient, surface_emissivity)
    below = lumps.surface_coefficient(open_below, ambient_temperature, ambient_temperature)
    onward = lumps.in_series(below, structure_conductivity / (floor_thickness - 0.5 * pad_depth))
    return tuple(
        lumps.Loss(gap._replace(conductance=gap.conductance + lip), onward * share * beside_area)
        for gap, lip, share in zip(open_gaps, below_lips, STRIP, strict=True)
    )
