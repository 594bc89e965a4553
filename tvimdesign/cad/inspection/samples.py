"""Points spread over the triangles of a part, no two neighbours further apart than a stated spacing."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from tvimdesign.cad.export.mesh import Array
from tvimdesign.cad.inspection.rays import Index, Triangles


@dataclass(frozen=True)
class Samples:
    """Points on a part's surface."""

    point: Array
    normal: Array
    """Out of the part."""
    triangle: Index
    area: Array
    """What of the surface each stands for [mm^2]."""

    def of(self, wanted: NDArray[np.bool_] | Index) -> Samples:
        """Return some of them."""
        return Samples(self.point[wanted], self.normal[wanted], self.triangle[wanted], self.area[wanted])

    def __len__(self) -> int:
        """How many there are."""
        return len(self.point)


def samples(triangles: Triangles, spacing: float, only: Index | None = None) -> Samples:
    """Spread points over all triangles, or some of them, in even strips at most `spacing` [mm] wide and apart."""
    chosen = np.arange(len(triangles.area)) if only is None else only
    all_corners, area = triangles.corners[chosen], triangles.area[chosen]
    sides = np.linalg.norm(all_corners - np.roll(all_corners, 1, axis=1), axis=2)
    # A sliver is divided along its long side only: as many rows as that needs, as many columns as its height needs.
    longest = np.argmax(sides, axis=1)
    length = sides.max(axis=1)
    rows = np.ceil(length / spacing).astype(int)
    columns = np.ceil(2.0 * area / length / spacing).astype(int)
    points, owners, areas = [], [], []
    for shape in np.unique(np.stack((rows, columns), axis=1), axis=0):
        group = np.flatnonzero((rows == shape[0]) & (columns == shape[1]))
        weights, shares = _weights(*(int(number) for number in shape))
        # The longest side goes from the corner before `longest` to it; the apex is the one after.
        turned = (longest[group, None] + np.array([-1, 0, 1])) % 3
        corners = np.take_along_axis(all_corners[group], turned[:, :, None], axis=1)
        points.append(np.einsum("wk,nkc->nwc", weights, corners).reshape(-1, 3))
        owners.append(np.repeat(group, len(weights)))
        areas.append((area[group, None] * shares).ravel())
    triangle = chosen[np.concatenate(owners)]
    return Samples(np.concatenate(points), triangles.normal[triangle], triangle, np.concatenate(areas))


def _weights(rows: int, columns: int) -> tuple[Array, Array]:
    """Weights of a triangle's corners, the first two those of its base, for points in strips of one height above it.

    Returns also the share of the area that each point stands for.
    """
    weights, shares = [], []
    for strip in range(columns):
        height = (strip + 0.5) / columns
        number = max(1, ceil(rows * (1.0 - strip / columns)))
        along = (np.arange(number) + 0.5) / number * (1.0 - height)
        weights.append(np.stack((1.0 - height - along, along, np.full(number, height)), axis=1))
        shares.append(np.full(number, 2.0 * (1.0 - height) / columns / number))
    return np.concatenate(weights), np.concatenate(shares)
