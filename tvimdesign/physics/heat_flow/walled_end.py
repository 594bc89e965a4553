"""A layer's end that a wall closes but for a free height at its near face, and the heat that the wall takes there.

The layer conducts between a warm near face and a cold far one; the wall is as cold as the far face. Lengths are over
the layer's thickness, heat over conductivity, length of the end and excess of the near face.

With w = cosh(pi z/t) the layer is half of a plane: its near face w > 1, its free end cos(pi f) < w < 1, wall and far
face the rest. Between two such half lines the heat from the gap's end on is arcosh(u)/pi, with u the place from the
gap's middle over half the gap (conformal maps: Carslaw and Jaeger, Conduction of Heat in Solids, ch. XVI).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_FROM_FREE = 0.5 * (1.0 + _NODES)
_PASSED, _SHARES = _FROM_FREE * (2.0 - _FROM_FREE), _WEIGHTS * (1.0 - _FROM_FREE)
"""Shares of the wall's heat that come into it before a place, and what of it each place stands for: dense at the far
face, where the heat falls to nothing."""


class WalledEnd(NamedTuple):
    """What a wall at the end of a layer takes."""

    near: Any
    """Heat that the near face gives for it [1]."""
    wall: Any
    """Heat that comes into the wall [1]; beyond `near` it is what the far face does not get."""
    deep: Any
    """How deep in the layer that heat comes out of it: the integral of q y (t - y)/(2 t^2) dy [1].

    The layer is colder in the mean by that over its width, whatever its profile, as in `lumps.gap_end_depth`."""


def walled_end(free: Any) -> WalledEnd:
    """The heat at an end of whose height a share is `free`, 0 < free < 1."""
    edge = np.cos(np.pi * free)
    wall = -2.0 / np.pi * np.log(np.tan(0.25 * np.pi * free))
    heights = [
        np.arccos(0.5 * (1.0 + edge - (1.0 - edge) * np.cosh(np.pi * passed * wall))) / np.pi for passed in _PASSED
    ]
    return WalledEnd(
        near=-2.0 / np.pi * np.log(np.sin(0.5 * np.pi * free)),
        wall=wall,
        deep=wall * _mean([0.5 * y * (1.0 - y) for y in heights]),
    )


def fallen(free: Any, away: Any, height: Any) -> Any:
    """What of its excess over the wall a layer has lost at a place [1], where far from the wall it falls evenly.

    At the distance x/t from the wall and the height y/t: with u = (2 cosh(pi z/t) - 1 - a)/(1 - a), a = cos(pi f), the
    temperature is 1 - arccos((|u + 1| - |u - 1|)/2)/pi of the near face's excess, and 1 - y/t far from the wall. Far
    away both sizes are nearly alike, so that their sum stands in place of their difference: 2 Re u/(|u + 1| + |u - 1|).
    """
    edge = np.cos(np.pi * free)
    real = 2.0 * np.cosh(np.pi * away) * np.cos(np.pi * height) - 1.0 - edge
    imaginary = 2.0 * np.sinh(np.pi * away) * np.sin(np.pi * height)
    right, left = ((real + sign * (1.0 - edge)) ** 2 + imaginary**2 for sign in (1.0, -1.0))
    between = 2.0 * real / (np.sqrt(right) + np.sqrt(left))
    return 1.0 - (1.0 - np.arccos(between) / np.pi) / (1.0 - height)


def _mean(values: list[Any]) -> Any:
    """Mean over the wall's heat of what is at the places where it comes in."""
    return sum(share * value for share, value in zip(_SHARES, values, strict=True))
