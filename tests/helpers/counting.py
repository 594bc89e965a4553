"""Volume and inertia of a part by counting points inside it, level by level."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

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


def in_stops(x: Array, y: Array, p: dict[str, Any]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Inside the housing's posts, and the rotor's teeth at rest: one tooth in each half circle, between two posts."""
    inner = p["rotor_radius"] + max(p["running_clearance"], p["corner_radius"])
    outer, middle = inner + p["stop_width"], inner + 0.5 * p["stop_width"]
    r, off = np.hypot(x, y), np.abs((np.arctan2(y, x) - np.pi / p["spring_count"] + 0.5 * np.pi) % np.pi - 0.5 * np.pi)
    tooth, way = 0.5 * p["stop_tooth_width"] / middle, p["stroke"] + p["stop_margin"]
    post = (off > tooth + way) & (off < tooth + way + p["stop_post_length"] / middle)
    return post & (r > inner) & (r < outer), (off < tooth) & (r > p["rotor_radius"]) & (r < outer)
