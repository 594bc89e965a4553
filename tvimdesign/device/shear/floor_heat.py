"""The floor the pads are set in as bodies of one temperature, and what passes heat between it, pads, layer and plate.

Beside the pockets the floor is two strips, as high as the pads and below them, of three bodies each; the upper half of
the upper strip's first body, next to the pads' hot sides, is a body of its own. So are the ledges the pads lie on, and
what is left of the housing. A body that is heated over a face has its mean temperature a third of its depth behind that
face (even heating, Incropera, Fundamentals of Heat and Mass Transfer, ch. 3); one that heat passes through, half of it.

Beside rigid modules, below their spreader, is a room of air that tiles, ledge and the pocket's wall close. Ledges touch
a share of the pads' cold sides, a sink the rest. The legs conduct k_x along and k_y up: a slab of the mean k = (k_x
k_y)^(1/2), its depth stretched by (k_x/k_y)^(1/2). The side itself is a sheet on it. Half of a pad's width is the
slab's height (`constriction`). Air in the open windows takes too little heat to count.
"""

from typing import NamedTuple

import numpy as np

from tvimdesign.device.core.heater_form import CUT, WITH_TILES
from tvimdesign.device.table import Module, QuantityGroup, Scalar
from tvimdesign.physics.heat_flow import lumps, peltier, shape_factors
from tvimdesign.physics.heat_flow.layer_end import room
from tvimdesign.physics.heat_flow.lumps import BEYOND, STRIP, WAYS, Body, Link
from tvimdesign.physics.heat_flow.peltier import SIDE_SHARE
from tvimdesign.physics.heat_flow.shape_factors import ACROSS

quantities = QuantityGroup("Switch")

UPPER, LOWER = (0, 1, 2), (3, 4, 5)  # Places of the strips' bodies, from the pockets' walls on
LEDGES, CORNER, HOUSING = 6, 7, 8
BELOW = (CORNER, *UPPER[1:])  # Body of the floor below each body of the plate's strip
SPREADER = ("spreader", 0)
SIDE = 2.0 * SIDE_SHARE
"""Share of half of a pad's height that is its side, of one temperature; the rest is half of the legs."""
GAP = (("beside", 0), ("around", CORNER))
LEGS, UPPER_LEGS, LOWER_LEGS = (("legs", i) for i in range(3))


@quantities.helper()
def housing_ring(m: Module) -> Scalar:
    """Conductance of the floor from below the rotor's rim to the housing's wall [W/K]."""
    return 2.0 * np.pi * m.structure_conductivity * m.floor_thickness / np.log(m.housing_inner_radius / m.rotor_radius)


@quantities.helper()
def floor_end(m: Module) -> tuple[lumps.Surface, Scalar, Scalar]:
    """Outer end of the lower strip: the last body's surface, its conductance to the housing [W/K], surface [m^2] that
    counts there."""
    along = m.structure_conductivity * m.floor_web * m.edge_length**2 / (BEYOND * m.beside_area)
    face = m.floor_in_air._replace(area=STRIP[-1] * m.beside_area, behind=m.floor_web / 3.0 / m.structure_conductivity)
    return lumps.strip_end(face, along, m.housing_ring * m.floor_web / m.floor_thickness, m.ambient_temperature)


@quantities.helper()
def around_pads(m: Module) -> tuple[Body, ...]:
    """Bodies around the pads: upper and lower strip of the floor, ledges, corner, and the rest of the housing."""
    volumetric = m.structure_heat_capacity
    areas = [share * m.beside_area for share in STRIP]
    corner = Body(0.5 * areas[0] * m.pad_depth * volumetric, lumps.NOWHERE)
    upper = [corner, *(Body(area * m.pad_depth * volumetric, lumps.NOWHERE) for area in areas[1:])]
    face = m.floor_in_air._replace(behind=m.floor_web / 3.0 / m.structure_conductivity)
    lower = [
        Body(area * m.floor_web * volumetric, face._replace(area=area)) for area in (*areas, m.pcl_area - m.cold_area)
    ]
    last, _, at_housing = m.floor_end
    lower[-2] = lower[-2]._replace(surface=last)
    floor = (*upper, *lower, corner)
    below = np.pi * (m.housing_outer_radius**2 - m.rotor_radius**2) + at_housing
    return (*floor, lumps.less(m.housing_rest, floor, below))


@quantities.helper()
def floor_links(m: Module) -> tuple[Link, ...]:
    """Links within the floor, along the strips to the housing's wall and from the upper to the lower one."""
    per_depth = m.structure_conductivity * m.edge_length**2 / m.beside_area
    links = []
    for row, depth in ((UPPER, m.pad_depth), (LOWER, m.floor_web)):
        first, *others = (per_depth * depth / way for way in WAYS[1:])
        if row is UPPER:
            links.append(_link(CORNER, row[1], 0.5 * first))
            first = 0.5 * first
        links += [_link(row[i], row[i + 1], along) for i, along in enumerate((first, *others))]
    to_wall = lumps.in_series(per_depth * m.pad_depth / BEYOND, m.housing_ring * m.pad_depth / m.floor_thickness)
    links += [_link(UPPER[-1], HOUSING, to_wall), _link(LOWER[-1], HOUSING, m.floor_end[1])]
    down = [m.structure_conductivity * share * m.beside_area for share in STRIP]
    links.append(_link(CORNER, UPPER[0], down[0] / (0.5 * m.pad_depth)))
    for i, area in enumerate(down):
        height = m.pad_depth if i else 0.5 * m.pad_depth
        onto, surface = (0.5 * height + m.floor_web / 3.0) / area, m.around_pads[LOWER[i]].surface
        links += shape_factors.through_faces(
            ("around", UPPER[i]),
            ("around", LOWER[i]),
            surface,
            m.ambient_temperature,
            onto,
            ACROSS * m.floor_web / area,
        )
    return tuple(links)


def _link(first: int, second: int, conductance: Scalar) -> Link:
    return Link(("around", first), ("around", second), conductance)


@quantities.helper()
def pad_wall(m: Module) -> Scalar:
    """Conductance [W/K] from one side of the pads into the first body of the floor beside half of their pockets.

    A spreader's edge heats a share of that body's height (`shape_factors.constriction`).
    """
    way = WAYS[0] * m.beside_area / m.edge_length
    along = m.structure_conductivity * 0.5 * m.pad_depth * m.edge_length / way
    if m.heater_form == CUT:
        return lumps.in_series(m.pad_edge, along)
    crowded = shape_factors.constriction(m.spreader_depth / (0.5 * m.pad_depth))
    return lumps.in_series(m.pad_edge, along, m.structure_conductivity * m.edge_length / crowded)


@quantities.helper()
def stack_links(m: Module) -> tuple[Link, ...]:
    """Links from the pads' edges into the walls of their pockets, and from their cold sides through the ledges.

    A pad's upper half meets the floor's corner, its lower half what is below. Tiles stand in air: of them the
    spreader's edge meets a wall, and its back beside them a room of air, which ends at the wall as well (`pad_heat`).
    """
    first, ledge = WAYS[0] * m.beside_area / m.edge_length, (m.heated_area - m.cold_area) / m.edge_length
    bare = (m.pcl_area - m.heated_area) / m.edge_length
    slender, face = ledge / m.floor_web, m.around_pads[LEDGES].surface
    onto, to_root, under = (
        way / (m.structure_conductivity * m.edge_length)
        for way in (*shape_factors.ledge_ways(slender), shape_factors.ledge_across(slender))
    )
    beyond = (bare + first) / (m.structure_conductivity * m.floor_web * m.edge_length)
    upper, lower, ledges = ("around", CORNER), ("around", UPPER[0]), ("around", LEDGES)
    hot, cold = ("hot", 0), ("cold", 0)
    if m.heater_form == CUT:
        halves = ((hot, UPPER_LEGS, upper), (cold, LOWER_LEGS, lower))
        rims = [
            Link(place, wall, share * m.pad_wall)
            for side, legs, wall in halves
            for place, share in ((side, SIDE), (legs, 1.0 - SIDE))
        ]
    else:
        rims = [Link(SPREADER, upper, m.pad_wall), *m.tile_links]
    rested = shape_factors.through_faces(cold, ledges, face, m.ambient_temperature, onto + m.cold_to_ledges, under)
    return (*rims, *rested, _link(LEDGES, LOWER[0], 1.0 / (to_root + beyond)))


@quantities.helper()
def open_gaps(m: Module) -> tuple[Link, ...]:
    """Air between plate and floor beside the arcs where no lip stands, as thick as the layer."""
    gaps = []
    for share, covered, above, floor in zip(STRIP, m.lip_over, range(len(STRIP)), BELOW, strict=True):
        area = share * m.beside_area - covered * m.edge_length
        gap = lumps.air_gap(
            area, m.pcl_thickness, m.air_conductivity, m.surface_emissivity, ("beside", above), ("around", floor)
        )
        gaps.append(lumps.behind(gap, area / _plate_faces(m), m.ambient_temperature))
    return tuple(gaps)


quantities.same("loss_links", "open_gaps", "Links from the plate beside the arcs to the floor, its lips apart")


def _plate_faces(m: Module) -> Scalar:
    """Return the resistance behind both faces of that gap [m^2 K/W]: a third of the plate, half of the upper strip."""
    return (m.rotor_thickness / 3.0 + 0.5 * m.pad_depth) / m.structure_conductivity


@quantities.helper()
def below_lips(m: Module) -> tuple[Scalar, ...]:
    """Conductance of the clearance below the lips to the floor, over each body of the strip [W/K]; radiation as at
    melting."""
    gap = lumps.air_gap(1.0, m.running_clearance, m.air_conductivity, m.surface_emissivity, *GAP)
    across = lumps.link_conductance(gap, m.pcl_melting.end, m.ambient_temperature)
    each = lumps.in_series(across, m.structure_conductivity / (0.5 * m.pad_depth))
    return tuple(each * covered * m.edge_length for covered in m.lip_over)


@quantities.helper()
def plate_losses(m: Module) -> tuple[lumps.Loss, ...]:
    """Heat losses of the plate beside the arcs: through that gap, below lips through their clearance, and the floor."""
    open_below = lumps.Surface(1.0, m.housing_coefficient, m.surface_emissivity)
    below = lumps.surface_coefficient(open_below, m.ambient_temperature, m.ambient_temperature)
    onward = lumps.in_series(below, m.structure_conductivity / (m.floor_thickness - 0.5 * m.pad_depth))
    return tuple(
        lumps.Loss(gap._replace(conductance=gap.conductance + lip), onward * share * m.beside_area)
        for gap, lip, share in zip(m.open_gaps, m.below_lips, STRIP, strict=True)
    )


INCOMPRESSIBLE = 3.0  # Young's modulus of a pad over its shear modulus: pellets in a soft sheet, or ceramic taken alike


@quantities.output("1")
def heater_strings(m: Module) -> Scalar:
    """Strings of heaters in parallel, which share the current."""
    return {"series": 1.0, "arcs_parallel": m.arc_count, "all_parallel": m.heater_count}[m.heater_wiring]


@quantities.output("K*mm^2/W", requires=WITH_TILES)
def spreader_resistance(m: Module) -> Scalar:
    """Resistance of the way along the spreader to what its modules do not cover, times the layer's area."""
    width, tile = m.pcl_outer_radius - m.pcl_inner_radius, (m.heater_length, m.heater_width)
    inwards = m.pcl_mean_radius - m.tile_radius
    return peltier.row_spreading_resistance(
        m.pcl_area, width, m.heater_count, tile, 2, m.spreader_conductivity, m.spreader_thickness, inwards
    )


@quantities.helper()
def pad_compliance(m: Module) -> Scalar:
    """Compliance in shear about the axis [rad/(N*m)] of pads, or of spreaders and the adhesive of their seats."""
    if m.heater_form == CUT:
        return m.heater_thickness / (m.heater_shear_modulus * m.held_pads)
    return m.seat_path.adhesive + m.spreader_depth / (m.spreader_shear_modulus * m.held_pads)


@quantities.helper()
def pad_foundation(m: Module) -> Scalar:
    """Tension on the layer over how far a pad stretches under it, E = 3 G, or a spreader bends between its rims [Pa/m].

    Modules in grease do not hold a spreader down: it is a strip as wide as an arc, simply supported along both rims, of
    the mean deflection q w^4/(120 D) (Young and Budynas, Roark's Formulas, table 8.1).
    """
    if m.heater_form == CUT:
        return INCOMPRESSIBLE * m.heater_shear_modulus / m.heater_thickness
    poisson = 0.5 * m.spreader_youngs_modulus / m.spreader_shear_modulus - 1.0
    rigidity = m.spreader_youngs_modulus * m.spreader_depth**3 / (12.0 * (1.0 - poisson**2))
    return 120.0 * rigidity / m.arc_width**4


BELOW_PADS = ("around", LEDGES)
WALL = (("around", CORNER), ("around", UPPER[0]))


@quantities.helper()
def tile_links(m: Module) -> tuple[Link, ...]:
    """Links from the spreader's back and the tiles' sides through that room; none where pads are cut to the arcs.

    As wide as what the tiles leave of the strip, and as the slot beside the spreader. It conducts better up than along,
    as in `layer_end.air_beside`. The tiles' sides have the mean temperature of their legs.
    """
    if m.heater_form == CUT:
        return ()
    down = lumps.air_gap(
        m.pcl_area - m.heated_area, m.heater_thickness, m.air_conductivity, m.surface_emissivity, SPREADER, BELOW_PADS
    )
    across = lumps.air_gap(1.0, m.heater_thickness, m.air_conductivity, m.surface_emissivity, SPREADER, BELOW_PADS)
    up = m.heater_thickness * lumps.link_conductance(across, m.pcl_melting.end, m.ambient_temperature)
    evenly, slot = np.sqrt(m.air_conductivity * up), m.air_conductivity / m.pad_edge_contact
    width = ((m.pcl_area - m.heated_area) / m.edge_length + slot) / m.heater_thickness * up / evenly
    beside = room(width, evenly / (m.pad_edge_contact * m.heater_thickness))
    through = evenly * m.edge_length
    corner = m.structure_conductivity * m.edge_length * shape_factors.corner_shape(beside.ceiling)
    to_wall = lumps.in_series((beside.ceiling + beside.floor) * through, corner)
    sides = [Link(LEGS, place, beside.tile * through) for place in WALL]
    return (
        down._replace(conductance=down.conductance - beside.floor * through),
        Link(SPREADER, WALL[0], to_wall),
        *sides,
    )


class ColdSide(NamedTuple):
    """Legs and cold side of the pads as a slab with a sheet on its face."""

    conductance: Scalar  # Mean conductivity of the legs times the length of the pads' edges [W/K]
    sheet: Scalar  # Of the side, over that conductivity and half of a pad's width [1]
    depth: Scalar  # Of the legs, over half of a pad's width [1]

    def to_share(self, share: Scalar) -> Scalar:
        """Return the resistance from where the face has its mean temperature to a share of it [K/W]."""
        return shape_factors.constriction(share, self.sheet, self.depth) / self.conductance


@quantities.helper()
def cold_side_slab(m: Module) -> ColdSide:
    """Legs and cold side, by the pads' conductance up and their conductivity along."""
    width = m.heated_area / m.edge_length
    up = m.pads.conductance / m.heated_area * m.heater_thickness
    mean = np.sqrt(m.pad_conductivity * up)
    sheet = SIDE_SHARE * m.heater_thickness * m.pad_conductivity / (mean * width)
    depth = (1.0 - 2.0 * SIDE_SHARE) * m.heater_thickness * np.sqrt(m.pad_conductivity / up) / width
    return ColdSide(mean * m.edge_length, sheet, depth)


@quantities.helper()
def cold_to_ledges(m: Module) -> Scalar:
    """Resistance from where the cold sides have their mean temperature to the ledges they lie on [K/W]."""
    return m.cold_side_slab.to_share((m.heated_area - m.cold_area) / m.heated_area)


@quantities.helper()
def cold_to_sink(m: Module) -> Scalar:
    """Resistance from where the cold sides have their mean temperature to a sink in the windows [K/W]."""
    return m.cold_side_slab.to_share(m.cold_area / m.heated_area)
