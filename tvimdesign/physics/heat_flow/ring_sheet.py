"""Floor or rotor plate along a ring of vanes, blocks and pads, in bodies of one temperature.

A row of three bodies in depth stands at the blocks and one at the pads, from the heated face on; a single body at the
rotor's vanes; at the housing's a row of three along the ring, from the pads on. No heat passes the middle of a vane.
Source: the heat equation along a strip, Carslaw and Jaeger, Conduction of Heat in Solids, ch. III.
"""

import itertools
from typing import Any, NamedTuple, TypeAlias

from tvimdesign.physics.heat_flow import lumps, shape_factors
from tvimdesign.physics.heat_flow.lumps import STRIP, WAYS, Link, Place

Row: TypeAlias = tuple[Place, ...]


class Depths(NamedTuple):
    """Lengths along the ring [m], all of a kind together."""

    blocks: Any
    pads: Any
    vanes: Any
    walls: Any


class Along(NamedTuple):
    """Conductances [W/K] along the ring in floor or rotor plate, of rows of bodies at blocks and pads."""

    to_vanes: Any  # From the blocks to the rotor's vanes
    to_pads: Any
    across: Any  # From the pads to the rotor's vanes
    to_walls: Any  # From the pads to the housing's vanes
    uneven: tuple[Any, Any]  # More than those to either vanes, for what bodies differ from the mean of their row


def along_ring(conductivity: Any, thickness: Any, depths: Depths) -> Along:
    """Return the ways along the ring in floor or rotor plate, from its conductivity times the ring's width [W m/K].

    Heat goes from the pads through what is at the blocks, which loses or takes heat evenly on the way. What is at the
    pads has its mean temperature a quarter of its length from either end (a sixth where both ends take as much, a third
    where one takes all), what is heated at its end a third of its length away. What a body of a row differs from its
    row's mean takes the way of a cosine over the depth (`shape_factors.uneven_way`).
    """
    sheet = conductivity * thickness
    across, at_pads = sheet / depths.blocks, 4.0 * sheet / depths.pads
    to_walls = sheet / (0.25 * depths.pads + WAYS[0] * depths.walls)
    ways = lumps.heated_between(across, 3.0 * sheet / depths.vanes, at_pads)
    turned = [shape_factors.uneven_way(depth / thickness) * thickness for depth in (depths.vanes, depths.walls)]
    uneven_vanes = lumps.heated_between(across, sheet / turned[0], at_pads)[0]
    return Along(*ways, to_walls, (uneven_vanes - ways[0], sheet / (0.25 * depths.pads + turned[1]) - to_walls))


def sheet_links(
    conductivity: Any, thickness: Any, depths: Depths, *, blocks: Row, pads: Row, walls: Row, vanes: Place
) -> list[Link]:
    """Return the links along the ring within floor or rotor plate, between its bodies at blocks, pads and vanes.

    The conductivity is times the ring's width [W m/K].
    """
    along = along_ring(conductivity, thickness, depths)
    links = [*_evened(blocks, along.uneven[0]), *_evened(pads, along.uneven[1])]
    rows = ((blocks, depths.blocks / thickness), (pads, depths.pads / thickness), (walls, thickness / depths.walls))
    for row, across in rows:
        pairs = zip(itertools.pairwise(row), WAYS[1:], strict=True)
        links += [Link(*pair, conductivity * across / way) for pair, way in pairs]
    for at_block, at_pad, share in zip(blocks, pads, STRIP, strict=True):
        ways = ((vanes, at_block, along.to_vanes), (at_block, at_pad, along.to_pads), (at_pad, vanes, along.across),
                (at_pad, walls[0], along.to_walls))  # fmt: skip
        links += [Link(first, second, share * way) for first, second, way in ways]
    return links


def _evened(row: Row, conductance: Any) -> list[Link]:
    """Return the links among bodies of a row that leave what it gives by its mean, and take a conductance from what
    each gives by its difference from that: c (T_mean - T_i) to each for its share."""
    pairs = itertools.combinations(zip(row, STRIP, strict=True), 2)
    return [Link(near, far, share * beside * conductance) for (near, share), (far, beside) in pairs]
