"""Thickness of the walls of a part: rays from its surface straight into it, to where they come out again."""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from tvimdesign.cad.cad_report import Level, SolidCheck, at_least, finding
from tvimdesign.cad.export.mesh import CHORD, Array
from tvimdesign.cad.inspection.rays import Samples, Triangles, samples

SPACING = 2.0
"""Between samples of the whole surface [mm]."""
_CLOSER = 4
"""How much closer the samples lie around thin walls."""
_NEIGHBOURS = 1.5
"""Samples no further apart than so many of their spacings are neighbours."""
_AROUND = 40
"""Samples with the thinnest walls whose triangles are sampled closer in any case."""
_OPPOSED = -sqrt(0.5)
"""A ray that comes out at an edge has measured no wall: both faces must look away from each other, within 45 deg.

Faces that meet at a wider angle make an edge, such as that of a driver's slot with the round of its post.
"""


def wall_checks(part: str, triangles: Triangles, minimum_wall: float, thinnest_wall: float) -> list[SolidCheck]:
    """Compare the walls of a part with the process [mm], and report edges that taper to nothing."""
    everywhere = samples(triangles, SPACING)
    coarse = wall_thickness(triangles, everywhere)
    thin = coarse < minimum_wall
    thin[np.argsort(coarse)[:_AROUND]] = True
    where = samples(triangles, SPACING / _CLOSER, np.unique(everywhere.triangle[thin]))
    thickness = wall_thickness(triangles, where)
    tapering = _tapering(where, thickness, minimum_wall)
    return [
        _thinnest(part, where.of(~tapering), thickness[~tapering], minimum_wall, thinnest_wall),
        _edges(part, where.of(tapering), thickness[tapering], minimum_wall),
    ]


def slot_check(part: str, triangles: Triangles, least_gap: float) -> SolidCheck:
    """Compare the gaps between faces of one part that look at each other with the process's least [mm].

    A narrower slot closes as it is made; faces that meet in a corner leave none.
    """
    where = samples(triangles, SPACING)
    hits = triangles.first_hits(where.point, where.normal)
    facing = np.einsum("ij,ij->i", where.normal, triangles.normal[hits.triangle])
    gap = np.where(~hits.missed & (facing < _OPPOSED), hits.distance, np.inf)
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
    return np.where(~hits.missed & (facing < _OPPOSED), hits.distance, np.inf)


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


def _thinnest(part: str, where: Samples, thickness: Array, minimum_wall: float, thinnest_wall: float) -> SolidCheck:
    # The mesh lies within CHORD of the part: a round wall of just the least thickness comes out thinner by as much.
    at = int(np.argmin(thickness))
    least = float(thickness[at])
    text = f"the thinnest wall is {least:.3g} mm; the process makes {minimum_wall:.3g} mm"
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
