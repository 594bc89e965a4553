"""Areas, and polar second moments of area about the module's axis, of the flat shapes the parts are cut from."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np


class Section(NamedTuple):
    """A flat shape normal to the axis: area [m^2] and polar second moment of area about the axis [m^4]."""

    area: Any
    polar: Any

    def __sub__(self, other: Section) -> Section:
        """The shape with another one cut out of it."""
        return Section(self.area - other.area, self.polar - other.polar)

    def times(self, count: Any) -> Section:
        """Several of the shape, spread around the axis."""
        return Section(count * self.area, count * self.polar)


def sector(span: Any, inner_radius: Any, outer_radius: Any) -> Section:
    """Annular sector of the angle `span` [rad]; 2 pi makes it a ring."""
    return Section(0.5 * span * (outer_radius**2 - inner_radius**2), 0.25 * span * (outer_radius**4 - inner_radius**4))


def ring(inner_radius: Any, outer_radius: Any) -> Section:
    """Full ring about the axis; inner radius 0 makes it a disc."""
    return sector(2.0 * np.pi, inner_radius, outer_radius)


def disc_at(radius: Any, distance: Any) -> Section:
    """Disc whose centre lies `distance` from the axis (parallel-axis theorem)."""
    area = np.pi * radius**2
    return Section(area, area * (0.5 * radius**2 + distance**2))


def ring_notch(half_width: Any, inner_radius: Any, outer_radius: Any) -> Any:
    """Area [m^2] that a straight opening of the given half width takes from one side of a ring about the axis."""

    def half_segment(radius: Any) -> Any:
        return half_width * np.sqrt(radius**2 - half_width**2) + radius**2 * np.arcsin(half_width / radius)

    return half_segment(outer_radius) - half_segment(inner_radius)


def slot(half_width: Any, length: Any) -> Section:
    """Obround: a strip of the given half width from the axis to `length` with a half disc at each end."""
    b, reach = half_width, length
    strip_area = 2.0 * b * reach
    strip_polar = 2.0 * b * reach**3 / 3.0 + 2.0 * reach * b**3 / 3.0
    half_disc = 0.5 * np.pi * b**2
    centroid = 4.0 * b / (3.0 * np.pi)
    near_polar = 0.25 * np.pi * b**4
    far_polar = near_polar + half_disc * (reach**2 + 2.0 * reach * centroid)
    return Section(strip_area + 2.0 * half_disc, strip_polar + near_polar + far_polar)


def radial_strip(thickness: Any, inner_radius: Any, outer_radius: Any) -> Any:
    """Area [m^2] between two circles about the axis, a radial line and its parallel at the given distance.

    Integral of r arcsin(t/r) dr = r^2/2 arcsin(t/r) + t/2 sqrt(r^2 - t^2): a plate of constant thickness let into the
    side of an annular sector.
    """

    def up_to(radius: Any) -> Any:
        chord = np.sqrt(radius**2 - thickness**2)
        return 0.5 * (radius**2 * np.arcsin(thickness / radius) + thickness * chord)

    return up_to(outer_radius) - up_to(inner_radius)
