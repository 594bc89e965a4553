"""Where straight rays meet a triangle mesh: a tree of boxes, walked by compiled code."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tvimdesign.cad.export.mesh import Array, Mesh
from tvimdesign.cad.inspection import ray_code
from tvimdesign.cad.inspection.ray_code import LEAF, ROOM

Index = NDArray[np.int64]


@dataclass(frozen=True)
class Hits:
    """The first triangle each ray meets."""

    distance: Array
    """From where the ray starts [mm]; infinite where it meets nothing."""
    triangle: Index
    """-1 where it meets nothing."""

    @property
    def missed(self) -> NDArray[np.bool_]:
        """Which rays meet nothing."""
        return np.isinf(self.distance)


class Triangles:
    """Triangles with their normals, and the tree of boxes around them."""

    def __init__(self, mesh: Mesh) -> None:
        """Triangles without area are left out: they have no normal."""
        corners = mesh.vertices[mesh.faces]
        crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        twice = np.linalg.norm(crossed, axis=1)
        sound = twice > 1e-9
        self.corners: Array = corners[sound]
        self.area: Array = 0.5 * twice[sound]
        self.normal: Array = crossed[sound] / twice[sound][:, None]
        self.lower, self.upper = self.corners.reshape(-1, 3).min(axis=0), self.corners.reshape(-1, 3).max(axis=0)

    @cached_property
    def _grown(self) -> tuple[Index, Array, Array]:
        """The tree, grown when the first ray is followed: triangles by place in its leaves, its boxes, and these."""
        order, boxes = _tree(self.corners)
        placed = self.corners[order]
        sides = (placed[:, 0], placed[:, 1] - placed[:, 0], placed[:, 2] - placed[:, 0])
        return order, boxes, np.ascontiguousarray(np.concatenate(sides, axis=1))

    def first_hits(self, origins: Array, directions: Array, beyond: float = 1e-6) -> Hits:
        """Return the first triangle each ray meets further than `beyond` [mm] from where it starts; unit directions."""
        order, boxes, triangles = self._grown
        starts, ways = (np.ascontiguousarray(given, dtype=np.float64) for given in (origins, directions))
        distance, place = np.empty(len(starts)), np.empty(len(starts), dtype=np.int64)
        ray_code.first_hits()(
            boxes.ctypes.data, triangles.ctypes.data, len(boxes) // 2, starts.ctypes.data, ways.ctypes.data,
            len(starts), beyond, distance.ctypes.data, place.ctypes.data,
        )  # fmt: skip
        return Hits(distance, np.where(place < 0, -1, order[place]))


def _tree(corners: Array) -> tuple[Index, Array]:
    """Halve triangles along the longest side of their box.

    Returns the triangles leaf by leaf, and the boxes level by level: the halves of box n are 2 n + 1 and 2 n + 2.
    """
    depth = max(0, int(np.ceil(np.log2(max(len(corners), 1) / LEAF))))
    leaves = 2**depth
    # As many as fill all leaves; those that are too many stand for no triangle, and no ray meets their boxes.
    order = np.arange(leaves * LEAF)
    triangle = np.minimum(order, len(corners) - 1)
    middle = np.ascontiguousarray(corners.mean(axis=1).T)[:, triangle]
    groups = order[None, :]
    for _ in range(depth):
        points = middle[:, groups]
        axis = np.argmax(np.ptp(points, axis=2), axis=0)
        along = np.take_along_axis(points, axis[None, :, None], axis=0)[0]
        groups = np.take_along_axis(groups, np.argsort(along, axis=1, kind="stable"), axis=1)
        groups = groups.reshape(2 * len(groups), -1)
    placed = triangle[groups.ravel()]
    empty = (groups.ravel() >= len(corners))[:, None]
    lower = np.minimum(np.minimum(corners[:, 0], corners[:, 1]), corners[:, 2])[placed] - ROOM
    upper = np.maximum(np.maximum(corners[:, 0], corners[:, 1]), corners[:, 2])[placed] + ROOM
    lower, upper = np.where(empty, np.nan, lower), np.where(empty, np.nan, upper)
    boxes: list[Array] = []
    while len(lower) > 1:
        lower, upper = np.fmin(lower[::2], lower[1::2]), np.fmax(upper[::2], upper[1::2])
        boxes.insert(0, np.concatenate((lower, upper), axis=1))
    return placed, np.ascontiguousarray(np.concatenate(boxes[: depth + 1]))
