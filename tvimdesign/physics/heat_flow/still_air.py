"""Shape factors of still air in rooms with a warm and a cold wall: heat over conductivity, length and excess.

By separation of variables (Carslaw and Jaeger, Conduction of Heat in Solids, ch. V) and by conformal maps (ch. XVI);
walls that meet at two temperatures have a slot between them, as in `shape_factors.gap_end`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.heat_flow.shape_factors import gap_end

TERMS = 6
AT_LIP, AT_EDGE, AT_FLOOR = 0.41, 0.16, 0.294
"""Heat that the end of a clearance takes from the pads for the lip above it, far from a floor and less before one; and
less for the floor than if it were as warm as the pads all over, the integral of 2/pi arcsin(y) cot(pi y/2)."""


class Room(NamedTuple):
    """Heat that a room beside tiles passes beyond an even fall from its warm ceiling to its floor."""

    ceiling: Any
    """Heat of the ceiling to the cold wall, beyond the even fall."""
    floor: Any
    """Heat that the wall gets in place of the floor."""
    tile: Any
    """Heat of the tile's side to the cold wall."""


def room(width: Any, slot: Any) -> Room:
    """Return a room of a `width`, over its height, between a tile's side, which falls evenly from ceiling to floor, and
    a wall as cold as the floor, which a `slot` divides from the ceiling.

    The wall takes what falls evenly there, 1 - y/t = sum 2/(n pi) sin(n pi y/t). With x = n pi r of each term comes
    2/(n pi) tanh(x/2) from the ceiling, that with alternating signs from the floor's, and 4/(n pi)/sinh x of the odd
    ones from the tile. A wide room is the end of a gap.
    """
    ceiling, floor = gap_end(slot)
    tile = 0.0
    for n in range(1, TERMS + 1):
        left = 2.0 / (n * np.pi) * (1.0 - np.tanh(0.5 * n * np.pi * width))
        ceiling, floor = ceiling - left, floor + (-1.0) ** n * left
        tile = tile + (n % 2) * 4.0 / (n * np.pi * np.sinh(n * np.pi * width))
    return Room(ceiling, floor, tile)


def below_lip(slot: Any) -> tuple[Any, Any]:
    """Return the heat to lip and floor, from pads and layer, through the clearance below a lip at the layer's end.

    The end falls from the pads' temperature to the lip's as a layer does that a wall closes but for a small free height
    c (`walled_end`): e = 1 - 2/pi arcsin(y/c). Below it the wall is warm, and the floor's own edge a slot of the width
    g = `slot` c away. What the end gives comes from the pads by e, and from what the lip would take through the layer
    by the rest. For an end as warm as the pads the map of a bend (dz/dw = c/pi ((w - g^2/c^2)/(w + 1))^(1/2)/w) brings
    the floor, beyond what passes the slot, 2/pi arctan(g/c) c/g - 1/pi ln(4 g^2/(g^2 + c^2)), and the lip by
    1/pi ln(1 + g^2/c^2) more than without a slot. The rest of both follows conduction in two dimensions, within 0.04 up
    to g = 2 c.
    """
    floor = 2.0 / np.pi * np.arctan(slot) / slot - np.log(4.0 * slot**2 / (1.0 + slot**2)) / np.pi
    lip = AT_LIP - AT_EDGE * np.exp(-2.5 * slot) + np.log(1.0 + slot**2) / np.pi
    return lip, floor - AT_FLOOR / (1.0 + 2.0 * slot**2)
