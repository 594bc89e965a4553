"""A soft sheet in a recess of stiff metal, sheared by a layer on its face: at the recess's walls it gives less.

The sheet is glued to the recess's bottom and walls. A layer of G_p/t_p per area shears its face along a wall, so that
it moves as a harmonic function: 0 on the bottom and at the wall, and on the face as heat goes through a surface
resistance. With h = (G_p/t_p)(t/G) of a sheet of the thickness t, the layer's traction at x t from the wall is

tau(x)/tau(far) = 1 + h sum_n c_n exp(-q_n x),  c_n = 2 (1 + h)/(q_n^2 + h^2 + h),  q_n cot q_n = -h.

Source: Carslaw and Jaeger, Conduction of Heat in Solids, 2nd edition, 1959, sections 3.9 and 5.3 (a strip with one face
that radiates, and its roots).
"""

from __future__ import annotations

from typing import Any

import numpy as np

TERMS = 12
"""Of the sum; what they leave out of a mean over a tenth of a thickness from the wall on is a five-hundredth of h."""
_PASSES = 4
"""Of the roots' iteration."""


def _terms(held: Any) -> list[tuple[Any, Any]]:
    """Each c_n and q_n."""
    found = []
    for number in range(TERMS):
        half = (number + 0.5) * np.pi
        root = half
        for _ in range(_PASSES):
            root = half + np.arctan(held / root)
        found.append((2.0 * (1.0 + held) / (root**2 + held**2 + held), root))
    return found


def rim_rise(held: Any, reach: Any) -> Any:
    """Layer's traction over that far from the wall, a mean from the wall to `reach` thicknesses of the sheet [1].

    `held` is h, what the sheet gives over what the layer gives [1].
    """
    shares = [share * (1.0 - np.exp(-root * reach)) / (root * reach) for share, root in _terms(held)]
    return 1.0 + held * sum(shares)


def rim_width(held: Any) -> Any:
    """Width over the sheet's thickness [1] of plain layer that bears as much as what is gained beside a wall."""
    return held * sum(share / root for share, root in _terms(held))
