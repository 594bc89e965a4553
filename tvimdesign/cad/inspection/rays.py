"""Rays against a triangle mesh: gaps between walls, points on a surface, and the thickness of a part's walls."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ceil, cos, pi, sin, sqrt

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from tvimdesign.cad.cad_report import Level, SolidCheck, at_least, finding
from tvimdesign.cad.export.mesh import CHORD, Array, Mesh

Index = NDArray[np.int64]
LEAF = 4  # Triangles in a box that is not divided further
ROOM = 1e-7  # Margin around boxes and triangles [mm], so that no ray slips through between two
_BEHIND = 1e-3  # How far behind the nearest triangle so far a box must begin to be left out [mm]
_DEEPEST = 64  # Boxes that wait at once, at most: one for each level of the tree, and one
_FLAT = 1e-12  # A ray and a triangle whose determinant is not above this are parallel


@dataclass(frozen=True)
class Hits:
    """The first triangle each ray meets."""

    distance: Array  # From where the ray starts [mm]; infinite where it meets nothing
    triangle: Index  # -1 where it meets nothing

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
        distance, place = first_hits(boxes, triangles, starts, ways, beyond)
        return Hits(distance, np.where(place < 0, -1, order[place]))


@njit(cache=True, error_model="numpy")
def first_hits(boxes: Array, triangles: Array, starts: Array, ways: Array, beyond: float) -> tuple[Array, Index]:
    """Walk rays through a tree of boxes; return how far each goes [mm], and the place of the triangle that it meets.

    What a ray meets behind the nearest triangle so far is left out. Boxes are met by slabs (Kay and Kajiya 1986),
    triangles by Moeller and Trumbore (1997).
    """
    leaf, waiting_boxes = len(boxes) // 2, np.empty(_DEEPEST, np.int64)
    distance, place = np.full(len(starts), np.inf), np.full(len(starts), -1)
    for ray in range(len(starts)):
        start, way = starts[ray], ways[ray]
        inverse = (1.0 / way[0], 1.0 / way[1], 1.0 / way[2])
        waiting_boxes[0], waiting = 0, 1
        while waiting > 0:
            waiting -= 1
            box = waiting_boxes[waiting]
            if not _meets(boxes, box, start, inverse, distance[ray] + _BEHIND):
                continue
            if box < leaf:
                waiting_boxes[waiting], waiting_boxes[waiting + 1] = 2 * box + 2, 2 * box + 1
                waiting += 2
                continue
            for slot in range(LEAF * (box - leaf), LEAF * (box - leaf + 1)):
                far = _distance(triangles, slot, start, way)
                if beyond < far <= distance[ray] and far < np.inf:
                    distance[ray], place[ray] = far, slot
    return distance, place


@njit(cache=True, error_model="numpy")
def _meets(boxes: Array, box: int, start: Array, inverse: tuple[float, float, float], most: float) -> bool:
    """Return whether a ray meets a box at or after its start, and not beyond `most`; an empty box is not a number.

    Where a ray lies in the plane of a side, 0 x inf is not a number either, and limits nothing.
    """
    near, far = 0.0, np.inf
    for axis in range(3):
        first = (boxes[box, axis] - start[axis]) * inverse[axis]
        second = (boxes[box, axis + 3] - start[axis]) * inverse[axis]
        if first > second:
            first, second = second, first
        near = max(near, first)
        far = min(far, second)
    return far >= near and near <= most and not np.isnan(boxes[box, 0])


@njit(cache=True, error_model="numpy")
def _distance(triangles: Array, slot: int, start: Array, way: Array) -> float:
    """Return how far along a ray it meets a triangle (a corner, the ways to the two others); infinite if not."""
    x, y, z = start[0] - triangles[slot, 0], start[1] - triangles[slot, 1], start[2] - triangles[slot, 2]
    ax, ay, az = triangles[slot, 3], triangles[slot, 4], triangles[slot, 5]
    bx, by, bz = triangles[slot, 6], triangles[slot, 7], triangles[slot, 8]
    px, py, pz = way[1] * bz - way[2] * by, way[2] * bx - way[0] * bz, way[0] * by - way[1] * bx
    volume = ax * px + ay * py + az * pz
    u = (x * px + y * py + z * pz) / volume
    qx, qy, qz = y * az - z * ay, z * ax - x * az, x * ay - y * ax
    v = (way[0] * qx + way[1] * qy + way[2] * qz) / volume
    inside = u >= -ROOM and v >= -ROOM and u + v <= 1.0 + ROOM and abs(volume) > _FLAT
    return (bx * qx + by * qy + bz * qz) / volume if inside else np.inf


def compile_rays() -> None:
    """Load or compile the walk of rays, before a process is forked for each piece of work."""
    first_hits(np.empty((1, 6)), np.empty((LEAF, 9)), np.empty((0, 3)), np.empty((0, 3)), 0.0)


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


_DIRECTIONS = 8  # In half a turn; a straight gap is measured at most 2 % too wide
_OPPOSED = -0.1
"""Two walls are on both sides where they look at each other, however askew; those of a square corner do not."""


def across(triangles: Triangles, points: Array, up: Array, along: Sequence[float] = ()) -> tuple[Array, Array]:
    """Return the shortest level way through each point from wall to wall, and the walls' height above it along `up`.

    Both in mm; the way is infinite where there is none. Of the two walls the lower counts, and of a wall the triangle
    that is met. `along` are azimuths [rad] in which ways are looked for besides those of every gap.
    """
    width, height = np.full(len(points), np.inf), np.zeros(len(points))
    tops = (triangles.corners @ up).max(axis=1)
    for angle in (*(pi * step / _DIRECTIONS for step in range(_DIRECTIONS)), *along):
        ahead = np.tile([cos(angle), sin(angle), 0.0], (len(points), 1))
        hit, other = triangles.first_hits(points, ahead), triangles.first_hits(points, -ahead)
        way = hit.distance + other.distance
        lower = np.minimum(tops[hit.triangle], tops[other.triangle]) - points @ up
        facing = np.einsum("ij,ij->i", triangles.normal[hit.triangle], triangles.normal[other.triangle])
        shorter = (way < width) & (facing < _OPPOSED)
        width, height = np.where(shorter, way, width), np.where(shorter, lower, height)
    return width, height


@dataclass(frozen=True)
class Samples:
    """Points on a part's surface."""

    point: Array
    normal: Array  # Out of the part
    triangle: Index
    area: Array  # Area of the surface that each stands for [mm^2]

    def of(self, wanted: NDArray[np.bool_] | Index) -> "Samples":
        """Return some of them."""
        return Samples(self.point[wanted], self.normal[wanted], self.triangle[wanted], self.area[wanted])

    def __len__(self) -> int:
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
    """Return the weights of a triangle's corners, the first two those of its base, for points in strips of one height
    above it.

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


SPACING = 2.0  # Between samples of the whole surface [mm]
_CLOSER = 4  # How much closer the samples lie around thin walls
_NEIGHBOURS = 1.5  # Samples no further apart than so many of their spacings are neighbours
_AROUND = 40  # Samples with the thinnest walls whose triangles are sampled closer in any case
_FACING = -sqrt(0.5)
"""A ray that comes out at an edge has measured no wall: both faces must look away from each other, within 45 deg.

Faces that meet at a wider angle make an edge, such as that of a driver's slot with the round of its post.
"""


def wall_checks(
    part: str, triangles: Triangles, minimum_wall: float, thinnest_wall: float, what: str = "wall"
) -> list[SolidCheck]:
    """Compare the walls of a part with the process [mm], and report edges that taper to nothing."""
    everywhere = samples(triangles, SPACING)
    coarse = wall_thickness(triangles, everywhere)
    thin = coarse < minimum_wall
    thin[np.argsort(coarse)[:_AROUND]] = True
    where = samples(triangles, SPACING / _CLOSER, np.unique(everywhere.triangle[thin]))
    thickness = wall_thickness(triangles, where)
    tapering = _tapering(where, thickness, minimum_wall)
    return [
        _thinnest(part, where.of(~tapering), thickness[~tapering], minimum_wall, thinnest_wall, what),
        _edges(part, where.of(tapering), thickness[tapering], minimum_wall),
    ]


def slot_check(part: str, triangles: Triangles, least_gap: float) -> SolidCheck:
    """Compare the gaps between faces of one part that look at each other with the process's least [mm].

    A narrower slot closes as it is made; faces that meet in a corner leave none.
    """
    where = samples(triangles, SPACING)
    hits = triangles.first_hits(where.point, where.normal)
    facing = np.einsum("ij,ij->i", where.normal, triangles.normal[hits.triangle])
    gap = np.where(~hits.missed & (facing < _FACING), hits.distance, np.inf)
    at = int(np.argmin(gap))
    least = min(float(gap[at]), float(np.hypot(*(triangles.upper - triangles.lower)[:2])))
    text = f"the narrowest slot is {least:.3g} mm; the process makes {least_gap:.3g} mm"
    return finding(
        part, "slot", least, least_gap, "mm", at_least(least, least_gap - CHORD), text,
        place=where.point[at] + 0.5 * least * where.normal[at], resolution=SPACING,
    )  # fmt: skip


def wall_thickness(triangles: Triangles, where: Samples) -> Array:
    """Return the thickness of the part under each sample [mm].

    Infinite where the ray comes out at an edge, not through a wall.
    """
    hits = triangles.first_hits(where.point, -where.normal)
    facing = np.einsum("ij,ij->i", where.normal, triangles.normal[hits.triangle])
    return np.where(~hits.missed & (facing < _FACING), hits.distance, np.inf)


def _tapering(where: Samples, thickness: Array, minimum_wall: float) -> NDArray[np.bool_]:
    """Return which samples lie by an edge at which two faces meet almost flat: no wall, the part just ends there.

    It differs from a wall by thinning down to nothing: of thin samples that are neighbours some have no thickness.
    """
    tapering = np.zeros(len(where), dtype=bool)
    thin = np.flatnonzero(thickness < minimum_wall)
    nothing = thickness[thin] < CHORD
    if not nothing.any() or nothing.all():
        return tapering
    pairs = KDTree(where.point[thin]).query_pairs(_NEIGHBOURS * SPACING / _CLOSER, output_type="ndarray")
    links = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(thin), len(thin)))
    _, patch = connected_components(links, directed=False)
    tapering[thin] = np.isin(patch, patch[nothing])
    return tapering


def _thinnest(
    part: str, where: Samples, thickness: Array, minimum_wall: float, thinnest_wall: float, what: str
) -> SolidCheck:
    # The mesh lies within CHORD of the part: a round wall of just the least thickness comes out thinner by as much.
    at = int(np.argmin(thickness))
    least = float(thickness[at])
    text = f"the thinnest {what} is {least:.3g} mm; the process makes {minimum_wall:.3g} mm"
    return finding(
        part, "wall", least, minimum_wall, "mm", at_least(least, minimum_wall - CHORD, thinnest_wall - 1e-6), text,
        place=where.point[at] - 0.5 * least * where.normal[at], resolution=SPACING,
    )  # fmt: skip


def _edges(part: str, where: Samples, thickness: Array, minimum_wall: float) -> SolidCheck:
    area = float(where.area.sum())
    text = "no edge tapers to nothing"
    if area:
        text = f"edges taper to nothing and come out ragged: {area:.3g} mm2 on less than {minimum_wall:.3g} mm"
    place = where.point[int(np.argmin(thickness))] if area else None
    level: Level = "warning" if area else "pass"
    return finding(part, "edge", area, 0.0, "mm^2", level, text, place=place, resolution=SPACING / _CLOSER)
