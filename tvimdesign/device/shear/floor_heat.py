"""The floor the pads are set in as bodies of one temperature, and what passes heat between it, pads, layer and plate.

Beside the pockets the floor is two strips, as high as the pads and below them, of three bodies each; the ledges the
pads lie on are a body, and what is left of the housing is one. A body that is heated over a face has its mean
temperature a third of its depth behind that face, one that heat passes through half of it.
"""

from __future__ import annotations

import os

import numpy as np

from tvimdesign.device.core.thermal_stack import quantities as shared
from tvimdesign.device.table.quantity import Scalar
from tvimdesign.device.table.quantity_group import QuantityGroup
from tvimdesign.physics.heat_flow import lumps

quantities = QuantityGroup(shared.group)

T = {k: float(os.environ.get(k, v)) for k, v in dict(AIRF=6.0, AIRP=0.0, LEDGE=3.0, TOP=2.0, LOW=3.0, PLATE=3.0, EDGEOFF=1, AIROFF=1, LEDGEOFF=1, PLATEOFF=1, WALL=1).items()}
STRIP = lumps.STRIP
N = len(STRIP)
HALF_HEATED = 0.2714 * float(os.environ.get("HH", 1))
UPPER, LOWER, LEDGE, CORNER, HOUSING = range(N), range(N, 2 * N), 2 * N, 2 * N + 1, 2 * N + 2


@quantities.helper()
def housing_ring(
    housing_inner_radius: Scalar, rotor_radius: Scalar, structure_conductivity: Scalar, floor_thickness: Scalar
) -> Scalar:
    """Conductance of the floor from below the rotor's rim to the housing's wall [W/K]."""
    return 2.0 * np.pi * structure_conductivity * floor_thickness / np.log(housing_inner_radius / rotor_radius)


@quantities.helper()
def around_pads(
    pcl_area: Scalar,
    cold_area: Scalar,
    beside_area: Scalar,
    pad_depth: Scalar,
    floor_web: Scalar,
    housing_outer_radius: Scalar,
    rotor_radius: Scalar,
    rim_level: Scalar,
    foot_height: Scalar,
    floor_thickness: Scalar,
    housing_mass: Scalar,
    structure_density: Scalar,
    structure_specific_heat: Scalar,
    housing_coefficient: Scalar,
    surface_emissivity: Scalar,
) -> tuple[lumps.Body, ...]:
    """What the pads are set in: floor beside them, upper and lower strip; the ledges below; the rest of the housing."""
    volumetric = structure_density * structure_specific_heat
    open_below = lumps.Surface(1.0, housing_coefficient, surface_emissivity)
    first = STRIP[0] / 2.0
    upper = [lumps.Body(share * beside_area * pad_depth * volumetric, lumps.NOWHERE) for share in (first, *STRIP[1:])]
    lower = [
        lumps.Body(area * floor_web * volumetric, open_below._replace(area=area))
        for area in (*(share * beside_area for share in STRIP), pcl_area - cold_area)
    ]
    outside = 2.0 * np.pi * housing_outer_radius * (rim_level + floor_thickness + foot_height)
    outside = outside + np.pi * (housing_outer_radius**2 - rotor_radius**2)
    lower.append(upper[0])
    drawn = sum(body.capacity for body in (*upper, *lower))
    rest = lumps.Body(housing_mass * structure_specific_heat - drawn, open_below._replace(area=outside))
    return (*upper, *lower, rest)


@quantities.helper()
def floor_links(
    pcl_area: Scalar,
    cold_area: Scalar,
    beside_area: Scalar,
    edge_length: Scalar,
    pad_depth: Scalar,
    floor_web: Scalar,
    floor_thickness: Scalar,
    housing_ring: Scalar,
    structure_conductivity: Scalar,
) -> tuple[lumps.Link, ...]:
    """What conducts within the floor."""
    found = []
    for row, depth in ((UPPER, pad_depth), (LOWER, floor_web)):
        across = structure_conductivity * depth * edge_length**2 / beside_area
        for i in range(N - 1):
            way = 0.5 * (STRIP[i] + STRIP[i + 1])
            if row is UPPER and i == 0:
                found.append(lumps.Link(("around", row[i]), ("around", row[i + 1]), across / way / 2.0))
                found.append(lumps.Link(("around", CORNER), ("around", row[i + 1]), across / way / 2.0))
            else:
                found.append(lumps.Link(("around", row[i]), ("around", row[i + 1]), across / way))
        to_wall = housing_ring * depth / floor_thickness
        last = lumps.in_series(across / (0.5 * STRIP[-1]), to_wall)
        found.append(lumps.Link(("around", row[-1]), ("around", HOUSING), last))
    way = pad_depth / 2.0 + floor_web / T["LOW"]
    down = structure_conductivity * STRIP[0] * beside_area / (0.5 * pad_depth)
    found.append(lumps.Link(("around", CORNER), ("around", UPPER[0]), down))
    for i, share in enumerate(STRIP):
        way = pad_depth / (2.0 if i else 4.0) + floor_web / T["LOW"]
        down = structure_conductivity * share * beside_area / way
        found.append(lumps.Link(("around", UPPER[i]), ("around", LOWER[i]), down))
    half_ledge = 0.5 * (pcl_area - cold_area) / edge_length
    half_first = 0.5 * STRIP[0] * beside_area / edge_length
    sideways = structure_conductivity * floor_web * edge_length / (half_ledge + half_first)
    found.append(lumps.Link(("around", LEDGE), ("around", LOWER[0]), T["LEDGEOFF"] * sideways))
    return tuple(found)


@quantities.helper()
def pad_links(
    pad_edge: Scalar,
    pcl_area: Scalar,
    cold_area: Scalar,
    beside_area: Scalar,
    edge_length: Scalar,
    pad_depth: Scalar,
    floor_web: Scalar,
    structure_conductivity: Scalar,
) -> tuple[lumps.Link, ...]:
    """From the pads' edges into the walls of their pockets, and from their cold sides into the ledges."""
    half_first = 0.5 * STRIP[0] * beside_area / edge_length
    into = structure_conductivity * edge_length
    wall = T["EDGEOFF"] * lumps.in_series(pad_edge, into * pad_depth / 2.0 / half_first * T["WALL"])
    ledge = T["LEDGEOFF"] * T["LEDGE"] * structure_conductivity * (pcl_area - cold_area) / floor_web
    return (lumps.Link(("hot", 0), ("around", CORNER), wall), lumps.Link(("cold", 0), ("around", UPPER[0]), wall), lumps.Link(("cold", 0), ("around", LEDGE), ledge))


@quantities.helper()
def air_gaps(
    beside_area: Scalar,
    pcl_thickness: Scalar,
    air_conductivity: Scalar,
    housing_coefficient: Scalar,
    surface_emissivity: Scalar,
    ambient_temperature: Scalar,
    pad_depth: Scalar,
    floor_thickness: Scalar,
    rotor_thickness: Scalar,
    structure_conductivity: Scalar,
) -> tuple[tuple[lumps.Link, Scalar], ...]:
    """Air between plate and floor beside the arcs, as thick as the layer; and what passes heat from there on [W/K].

    Before it lies a third of the plate's depth, behind it half of the upper strip's.
    """
    before = (pad_depth / T["TOP"]  + rotor_thickness / T["PLATE"]) / structure_conductivity
    open_below = lumps.Surface(1.0, housing_coefficient, surface_emissivity)
    below = lumps.surface_coefficient(open_below, ambient_temperature, ambient_temperature)
    onward = lumps.in_series(below, structure_conductivity / (floor_thickness - pad_depth / T["TOP"]))
    found = []
    for i, share in enumerate(STRIP):
        area = share * beside_area
        gap = lumps.air_gap(area, pcl_thickness, air_conductivity, surface_emissivity,
                            ("beside", i), ("around", UPPER[i] if i else CORNER))  # fmt: skip
        through = lumps.link_conductance(gap, ambient_temperature, ambient_temperature) * before / area
        k = T["AIROFF"] / (1.0 + through)
        gap = gap._replace(conductance=k * gap.conductance, radiating_area=k * gap.radiating_area)
        found.append((gap, onward * area))
    return tuple(found)


@quantities.helper()
def side_links(
    edge_length: Scalar,
    pcl_thickness: Scalar,
    pcl_conductivity_melt: Scalar,
    hot_contact: Scalar,
    air_conductivity: Scalar,
    structure_conductivity: Scalar,
) -> tuple[lumps.Link, ...]:
    """From the layer's free side through the air of the gap, to the floor's corner and to the plate beside it.

    The layer's side is as hot as the pads below and falls to the plate's temperature above. In a gap between walls of
    one temperature each that is a sum of sines; they bring 2/pi (1 + 1/2 + ... + 1/n) to the wall at the hot end and
    2/pi ln 2 to the other (Carslaw and Jaeger, Conduction of Heat in Solids, sec. 5.2), of which the finest is as fine
    as the contact that keeps pad and layer apart. Layer, air and wall share the way.
    """
    finest = np.log(pcl_thickness * hot_contact / pcl_conductivity_melt * T["AIRF"] / np.pi) + 0.5772
    before = 1.0 / air_conductivity + 1.0 / pcl_conductivity_melt
    floor = lumps.in_series(2.0 / np.pi * edge_length * finest / before,
                            1.5 * np.pi * edge_length * structure_conductivity / finest)
    plate = 2.0 / np.pi * edge_length * np.log(2.0) / before
    return (lumps.Link(("hot", 0), ("around", CORNER), T["AIROFF"] * floor),
            lumps.Link(("hot", 0), ("beside", 0), T["AIROFF"] * plate))  # fmt: skip


@quantities.helper()
def heat_links(
    floor_links: tuple[lumps.Link, ...],
    pad_links: tuple[lumps.Link, ...],
    side_links: tuple[lumps.Link, ...],
    air_gaps: tuple[tuple[lumps.Link, Scalar], ...],
) -> tuple[lumps.Link, ...]:
    """What passes heat between the stack and the bodies beside and around it, and among these."""
    return (*floor_links, *pad_links, *side_links, *(gap for gap, _ in air_gaps))
