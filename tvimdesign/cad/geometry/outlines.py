"""Outlines of upright bodies as plain points, and what a kernel makes of them. Lengths in mm."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import cadquery as cq
import numpy as np
from numpy.typing import NDArray

Point = tuple[float, float]
Segment = tuple[Point, Point] | tuple[Point, Point, Point]
"""A line from point to point, or an arc through three."""
Outline = float | Sequence[Segment]
"""A circle about the axis by its radius, or segments that close."""


class Kernel(Protocol):
    """Draws upright bodies between two levels. What it draws has `cut`, `fuse`, `clean` and `moved`, as CadQuery's."""

    def cylinder(self, radius: float, bottom: float, top: float, at: Point) -> Any:
        """A cylinder about an upright axis through a point."""

    def block(self, along_x: Point, width: float, bottom: float, top: float) -> Any:
        """A block across the x axis, between two places on it."""

    def cone(self, radius: float, base: float, tip: float, at: Point) -> Any:
        """A cone about an upright axis through a point, from a disc at one level to its tip at another."""

    def foot(self, radius: float, fillet: float, level: float, at: Point) -> Any:
        """A cylinder about an upright axis through a point, from a level as high as its fillet there is wide."""

    def prism(self, outside: Outline, inside: Sequence[Outline], bottom: float, top: float) -> Any:
        """What lies within an outline, less what lies within others."""

    def rounded(self, body: Any, radius: float) -> Any:
        """A body with every upright edge rounded. Raises GeometryError where that does not fit."""


def placement(location: cq.Location) -> NDArray[np.float64]:
    """4 x 4 matrix of a location."""
    place_of = location.wrapped.Transformation()
    rows = [[place_of.Value(row, column) for column in range(1, 5)] for row in range(1, 4)]
    return np.array([*rows, [0.0, 0.0, 0.0, 1.0]])
