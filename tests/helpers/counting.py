"""Volume and inertia of a part by counting points inside it, level by level."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Inside = Callable[[Array, Array], NDArray[np.bool_]]


def count(inside: Inside, outer: float, rims: list[float], rays: int = 1440) -> tuple[float, float]:
    """Area and polar second moment of area of what lies inside, from the middles of a polar grid.

    `rims` are radii on which cells end, so that circles about the axis are counted exactly.
    """
    ends = sorted({0.0, outer, *(rim for rim in rims if rim < outer)})
    edges = np.concatenate([np.linspace(a, b, 200, endpoint=False) for a, b in pairwise(ends)] + [[outer]])
    angle = (np.arange(rays) + 0.37) * 2.0 * np.pi / rays
    r, f = np.meshgrid(0.5 * (edges[1:] + edges[:-1]), angle, indexing="ij")
    cell = np.diff(edges)[:, None] * 2.0 * np.pi / rays * r
    hit = inside(r * np.cos(f), r * np.sin(f))
    return float(np.sum(cell[hit])), float(np.sum((cell * r**2)[hit]))


def near(x: Array, y: Array, radius: float, distance: float, number: int, turn: float = 0.0) -> NDArray[np.bool_]:
    """Inside one of `number` discs whose centres stand around the axis."""
    hit = np.zeros(x.shape, dtype=bool)
    for i in range(number):
        angle = turn + 2.0 * np.pi * i / number
        hit |= (x - distance * np.cos(angle)) ** 2 + (y - distance * np.sin(angle)) ** 2 < radius**2
    return hit


def stack_up(slabs: list[tuple[float, Inside]], outer: float, rims: list[float]) -> tuple[float, float]:
    """Volume and its polar moment of slabs, each a height and what lies inside it."""
    counted = [(height, *count(inside, outer, rims)) for height, inside in slabs]
    return sum(h * area for h, area, _ in counted), sum(h * polar for h, _, polar in counted)
