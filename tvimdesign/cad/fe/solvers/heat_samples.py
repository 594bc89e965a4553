"""Readings of the course of temperatures: of the polymer by columns, of the structure's parts, of the outside."""

from pathlib import Path
from typing import Any

import heat_lines
import ngsolve as ng
import numpy as np
from heat_equation import Meshed
from heat_grid import PADS

SLICES = 48
"""Even slices of the layer, between whose cells' faces temperatures are straight: a molten film is thinner than a
cell, and how a squeezed one flows shows in slices that are alike."""


class Layer:
    """The polymer by columns from its pads to its far face."""

    def __init__(self, grid: heat_lines.Grid, found: Meshed, points: Any) -> None:
        self.found, self.grid = found, grid
        own = found.cells["layer"]
        self.axis = 1 if grid.upright else 2
        across = [axis for axis in range(3) if axis != self.axis]
        _, column = np.unique(own[across], axis=1, return_inverse=True)
        order = np.lexsort((own[self.axis], column.ravel()))
        count = len(np.unique(own[self.axis]))
        if len(order) % count:
            raise ValueError("the layer's columns are not alike: a part stands in some of them")
        self.own = own[:, order].reshape(3, -1, count)
        volumes = _volumes(points)[tuple(self.own)]
        middles = np.hypot(*_middles(points)[tuple(self.own)][..., :2].transpose(2, 0, 1))
        # Area r^2 over depth: blocks between radial faces are as deep as they are far out.
        turned = np.sum(volumes * (np.ones_like(middles) if grid.upright else middles**2), axis=1)
        self.shares, self.weights, self.volume = turned / turned.sum(), volumes / volumes.sum(), float(volumes.sum())
        """Share of each column in the joint's stiffness where all are alike warm, and of each cell in the volume."""
        self.slices = np.full(SLICES, 1.0 / SLICES)
        ends = np.concatenate([[0.0], np.cumsum(volumes.sum(axis=0)) / volumes.sum()])
        middles = (np.arange(SLICES) + 0.5) / SLICES
        self.at_slices = np.array([np.interp(middles, ends, one) for one in np.eye(len(ends))])
        """What each face between the cells counts in each slice."""
        self.pads = sum(float(_volumes(points)[tuple(found.cells[name])].sum()) for name in PADS)

    def course(self, states: Any) -> tuple[Any, Any, Any]:
        """Return temperatures [degC]: of slices of the cells, shape (times, columns, slices), the mean, and that of
        the far
        face."""
        faces = self._face(self.own, 0, states), self._face(self.own, 1, states)
        slices = np.concatenate([faces[0][..., :1], faces[1]], axis=-1) @ self.at_slices
        far = self._face(self.own[:, :, 0 if self.grid.upright else -1], 0 if self.grid.upright else 1, states)
        mean = np.sum(0.5 * (faces[0] + faces[1]) * self.weights, axis=(1, 2))
        return slices, mean, far @ self.weights.sum(axis=1)

    def _face(self, cells: Any, side: int, states: Any) -> Any:
        """Return mean temperature of the cells' faces at a side along the columns."""
        shift = np.eye(3, dtype=int).reshape(3, 3, *(1,) * (cells.ndim - 1))
        corners = [cells + side * shift[self.axis]]
        for axis in range(3):
            if axis != self.axis:
                corners += [one + shift[axis] for one in corners]
        return np.mean([states[:, self.found.corners[tuple(one)]] for one in corners], axis=0)


def _of_cells(found: Meshed, own: Any, states: Any) -> Any:
    """Return the mean of the corners of each cell at each time."""
    ways = [(a, b, c) for a in (0, 1) for b in (0, 1) for c in (0, 1)]
    return np.mean(
        [states[:, found.corners[tuple(own[axis] + way[axis] for axis in range(3))]] for way in ways], axis=0
    )


def _middles(points: Any) -> Any:
    sums = points
    for axis in range(3):
        sums = 0.5 * (
            np.take(sums, range(1, sums.shape[axis]), axis) + np.take(sums, range(sums.shape[axis] - 1), axis)
        )
    return sums


def _volumes(points: Any) -> Any:
    """Return of all cells [m3], by the edges at their middles."""
    edges = []
    for axis in range(3):
        edge = np.diff(points, axis=axis)
        for other in range(3):
            if other != axis:
                edge = 0.5 * (np.take(edge, range(1, edge.shape[other]), other)
                              + np.take(edge, range(edge.shape[other] - 1), other))  # fmt: skip
        edges.append(edge)
    return np.abs(np.sum(np.cross(edges[0], edges[1]) * edges[2], axis=-1))


def parts(found: Meshed, grid: heat_lines.Grid, states: Any, points: Any) -> dict[str, Any]:
    """Return mean temperatures [degC] of the structure's parts at each time; of what lies on the layer in slices."""
    mm, volumes = grid.mm, _volumes(points)
    rotor = found.cells["rotor"]
    r, z = grid.along.middles[rotor[0]], grid.up.middles[rotor[2]]

    def mean(own: Any) -> Any:
        weights = volumes[tuple(own)]
        return _of_cells(found, own, states) @ weights / weights.sum()

    means = {"core": mean(rotor[:, (r < mm["core_radius"]) & (z > mm["rotor_bottom_level"])]),
             "hot": mean(found.cells["hot"]), "cold": mean(found.cells["cold"])}  # fmt: skip
    ring = (r > mm["pcl_inner_radius"]) & (r < mm["pcl_outer_radius"])
    if grid.upright:
        plate = rotor[:, ring & (z > mm["rotor_bottom_level"])]
        held = rotor[:, ring & (z < mm["rotor_bottom_level"])]
        return means | {"edge": mean(plate), "plate": _sliced(held, 1, grid.around, mean)}
    plate = (z > mm["rotor_bottom_level"]) & (z < mm["rotor_top_level"])
    beside = plate & (r < mm["pcl_inner_radius"]) & (r > mm["pcl_inner_radius"] - mm["rotor_thickness"])
    over = plate & ring & (grid.around.middles[rotor[1]] < 0.5 * mm["arc_span"])
    return means | {"edge": mean(rotor[:, beside]), "plate": _sliced(rotor[:, over], 2, grid.up, mean)}


def _sliced(own: Any, axis: int, along: heat_lines.Lines, mean: Any) -> Any:
    """Return the temperatures of eight even slices in depth, shape (times, 8), the first beside the layer."""
    levels = np.unique(own[axis])
    each = np.array([mean(own[:, own[axis] == level]) for level in levels])
    depths = np.diff(along.ends)[levels]
    middles = (np.cumsum(depths) - 0.5 * depths) / depths.sum()
    at = (np.arange(8) + 0.5) / 8
    at = 1.0 - at if axis == 1 else at
    return np.array([np.interp(at, middles, one) for one in each.T])


def write_field(path: Path, found: Meshed, state: Any) -> None:
    """Write the outside with its temperatures."""
    quads = np.array([[corner.nr for corner in one.vertices] for one in found.mesh.Elements(ng.BND)])
    places = np.array([vertex.point for vertex in found.mesh.vertices]) * 1e3
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    np.savez_compressed(path, points=places, triangles=triangles, values=state, ways=np.zeros_like(places))
