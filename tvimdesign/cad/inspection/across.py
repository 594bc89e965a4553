"""How wide it is between the walls beside a point, and how high the lower of the two walls reaches."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi, sin

import numpy as np

from tvimdesign.cad.export.mesh import Array
from tvimdesign.cad.inspection.rays import Triangles

_DIRECTIONS = 8
"""In half a turn; a straight gap is measured at most 2 % too wide."""
_OPPOSED = -0.1
"""Two walls are on both sides where they look at each other, however askew; those of a square corner do not."""


def across(
    triangles: Triangles, points: Array, up: Array, along: Sequence[float] = ()
) -> tuple[Array, Array]:  # fmt: skip
    """Return the shortest level way through each point from wall to wall, and the walls' height above it along `up`.

    Both in mm; the way is infinite where there is none. Of the two walls the lower counts, and of a wall the triangle
    that is met. `along` are azimuths [rad] in which ways are looked for besides those of every gap.
    """
    width, height = np.full(len(points), np.inf), np.zeros(len(points))
    tops = (triangles.corners @ up).max(axis=1)
    for angle in (*(pi * step / _DIRECTIONS for step in range(_DIRECTIONS)), *along):
        ahead = np.tile([cos(angle), sin(angle), 0.0], (len(points), 1))
        one, other = triangles.first_hits(points, ahead), triangles.first_hits(points, -ahead)
        way = one.distance + other.distance
        lower = np.minimum(tops[one.triangle], tops[other.triangle]) - points @ up
        facing = np.einsum("ij,ij->i", triangles.normal[one.triangle], triangles.normal[other.triangle])
        shorter = (way < width) & (facing < _OPPOSED)
        width, height = np.where(shorter, way, width), np.where(shorter, lower, height)
    return width, height
