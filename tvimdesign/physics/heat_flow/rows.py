"""A block in rows from its lower face to its upper one: how much colder or warmer than its mean each of them is.

Both faces lose heat to what is below and above; the block's two ends, at the pads and at the vane, are each of one
temperature. By separation of variables (Carslaw and Jaeger, Conduction of Heat in Solids, ch. V).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

TERMS = 6


def below_mean(place: float, depths: Any, slenderness: Any, lost: Sequence[Any]) -> Any:
    """How far a row of a block is below the mean of its height there, over half its height and conductivity [W/m^2].

    `place` goes from -1 at the lower face to 1 at the upper one, `depths` from 0 to 1 from end to end, D over half the
    height is the `slenderness`. What both faces lose is cosines over the height, what one of them loses more is sines:

        q (2 (-1)^n/(n pi)^2 cos(n pi p)),  dq (4 (-1)^n/((2 n + 1) pi)^2 sin((n + 1/2) pi p)),

    each less by cosh(a (x - D/2))/cosh(a D/2) next to the ends, a its wave number.
    """
    both, more = 0.5 * (lost[0] + lost[1]), lost[1] - lost[0]
    found = 0.0
    for n in range(TERMS):
        even, odd = (n + 1.0) * np.pi, (n + 0.5) * np.pi
        found = found - both * 2.0 * (-1.0) ** n / even**2 * np.cos(even * place) * _inside(even * slenderness, depths)
        found = found + more * (-1.0) ** n / odd**2 * np.sin(odd * place) * _inside(odd * slenderness, depths)
    return found


def _inside(waves: Any, depths: Any) -> Any:
    """Share [1] of what is far from both ends."""
    near = np.exp(-waves * depths) + np.exp(-waves * (1.0 - depths))
    return 1.0 - near / (1.0 + np.exp(-waves))
