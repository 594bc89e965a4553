"""Areas, and polar second moments of area about the module's axis, of the flat shapes the parts are cut from."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np


class Section(NamedTuple):
    """A flat shape normal to the axis: area [m^2] and polar second moment of area about the axis [m^4]."""

    area: Any
    polar: Any

    def __sub__(self, other: Section) -> Section:
        """Return the shape with another one cut out of it."""
        return Section(self.area - other.area, self.polar - other.polar)

    def plus(self, *others: Section) -> Section:
        """Return the shape and others together."""
        return Section(sum((o.area for o in others), self.area), sum((o.polar for o in others), self.polar))

    def times(self, count: Any) -> Section:
        """Return several of the shape, spread around the axis."""
        return Section(count * self.area, count * self.polar)


NOTHING = Section(0.0, 0.0)


class HoleCircle(NamedTuple):
    """Equal round holes, evenly spread on a circle about the axis; a count or a radius of zero means none.

    Radius of a hole and of the circle [m], azimuth of the first hole [rad].
    """

    count: Any
    radius: Any
    circle_radius: Any
    azimuth: Any

    @property
    def section(self) -> Section:
        """Return what the holes take from a plate."""
        return disc_at(self.radius, self.circle_radius).times(self.count)


def stacked(*prisms: tuple[Section, Any]) -> Section:
    """Return the volume [m^3] and polar moment of volume about the axis [m^5] of flat shapes, each with its height [m].

    A negative height takes the shape away.
    """
    return Section(
        area=sum(section.area * height for section, height in prisms),
        polar=sum(section.polar * height for section, height in prisms),
    )


def sector(span: Any, inner_radius: Any, outer_radius: Any) -> Section:
    """Return the annular sector of the angle `span` [rad]; 2 pi makes it a ring."""
    return Section(0.5 * span * (outer_radius**2 - inner_radius**2), 0.25 * span * (outer_radius**4 - inner_radius**4))


def ring(inner_radius: Any, outer_radius: Any) -> Section:
    """Return the full ring about the axis; inner radius 0 makes it a disc."""
    return sector(2.0 * np.pi, inner_radius, outer_radius)


def tooth(span: Any, radius: Any, outer_radius: Any, corner: Any) -> Section:
    """Return what a tooth with radial sides adds outside a disc about the axis, both corners at its root filleted.

    A fillet's centre is R + r from the axis and r beside the side: what it fills is the right triangle of axis, its
    foot on the side and its centre, less a sector of the disc and one of its own circle (plane geometry; the moments by
    integrals in polar coordinates about axis and centre).
    """
    r, reach = corner, radius + corner
    along = np.sqrt(reach**2 - r**2)
    at_axis = np.arcsin(r / reach)
    at_centre = 0.5 * np.pi - at_axis
    area = 0.5 * (along * r - radius**2 * at_axis - r**2 * at_centre)
    own = 0.25 * r**4 * at_centre + 0.5 * r**2 * at_centre * reach**2 - 2.0 / 3.0 * reach * r**3 * np.sin(at_centre)
    polar = 0.25 * along**3 * r + along * r**3 / 12.0 - 0.25 * radius**4 * at_axis - own
    return sector(span, radius, outer_radius).plus(Section(2.0 * area, 2.0 * polar))


def disc_at(radius: Any, distance: Any) -> Section:
    """Return the disc whose centre lies `distance` from the axis (parallel-axis theorem)."""
    area = np.pi * radius**2
    return Section(area, area * (0.5 * radius**2 + distance**2))


def point_at(radius: Any, distance: Any) -> Section:
    """Return what a cone is as a prism of its height: its base a disc whose centre lies `distance` from the axis.

    A cone has a third of the volume and 3/10 of the squared radius of gyration about its own axis.
    """
    area = np.pi * radius**2 / 3.0
    return Section(area, area * (0.3 * radius**2 + distance**2))


def fillet_at_foot(radius: Any, fillet: Any) -> Section:
    """Return the volume [m^3] and its polar moment [m^5] of a fillet around the foot of an upright cylinder about the
    axis.

    At u inwards from its outer end, b = R + r from the axis, it is r - sqrt(r^2 - u^2) high; the moments of that,
    integral of u^k over 0 to r, are r^2 (1 - pi/4), r^3/6, r^4 (1/3 - pi/16) and 7 r^5/60.
    """
    b = radius + fillet
    shares = (1.0 - np.pi / 4.0, 1.0 / 6.0, 1.0 / 3.0 - np.pi / 16.0, 7.0 / 60.0)
    flat, first, second, third = (fillet ** (power + 2) * share for power, share in enumerate(shares))
    polar = b**3 * flat - 3.0 * b**2 * first + 3.0 * b * second - third
    return Section(2.0 * np.pi * (b * flat - first), 2.0 * np.pi * polar)


def rectangle_at(radial: Any, along: Any, distance: Any, corner: Any = 0.0) -> Section:
    """Return the rectangle whose middle lies `distance` from the axis, one side along the ray there, its corners
    rounded.

    Polar moment by the parallel-axis theorem; what the fillets take counts at the corners.
    """
    whole, taken = radial * along, (4.0 - np.pi) * corner**2
    about_middle = (radial**2 + along**2) / 12.0
    at_corners = 0.25 * (radial**2 + along**2)
    return Section(whole - taken, whole * (about_middle + distance**2) - taken * (at_corners + distance**2))


def lens(radius: Any, circle_radius: Any) -> Any:
    """Return the area [m^2] that a disc whose centre lies on a circle has inside that circle.

    b^2 (pi/2 - a) + 2 R^2 a - (b/2) sqrt(4R^2 - b^2), sin a = b/2R: two circles a distance R apart (Weisstein,
    MathWorld, circle-circle intersection; acos(b/2R) is pi/2 - a and acos(1 - b^2/2R^2) is 2 a).
    """
    b, r = radius, circle_radius
    half = np.arcsin(0.5 * b / r)
    return b**2 * (0.5 * np.pi - half) + 2.0 * r**2 * half - 0.5 * b * np.sqrt(4.0 * r**2 - b**2)


def lens_corner(radius: Any, circle_radius: Any, corner: Any) -> Any:
    """Return the area [m^2] that a fillet fills in one of the two corners between such a disc and its circle, inside
    that circle.

    The fillet's centre F is b + r from the disc's B and R - r from the circle's O; the law of cosines gives the angles
    f at O and a at B of the triangle OBF. What lies between the rays OF and BF, both rims and F is a sector of the
    circle, less the triangle, less the disc's part up to where both rims meet (d, e the angles there at O and B); a
    sector of the fillet's circle is left empty:
    R^2 f/2 - R (R - r) sin(f)/2 - b^2 (e - a)/2 - R^2 (d - sin d)/2 - r^2 (a + f)/2.
    """
    b, circle, r = radius, circle_radius, corner
    rim, reach = circle - r, b + r
    at_axis = np.arccos((circle**2 + rim**2 - reach**2) / (2.0 * circle * rim))
    at_disc = np.arccos((circle**2 + reach**2 - rim**2) / (2.0 * circle * reach))
    meet = 2.0 * np.arcsin(0.5 * b / circle)
    disc = b**2 * (0.5 * (np.pi - meet) - at_disc) + circle**2 * (meet - np.sin(meet))
    whole = circle**2 * at_axis - circle * rim * np.sin(at_axis)
    return 0.5 * (whole - disc - r**2 * (at_axis + at_disc))


def _half_strip(half_width: Any, radius: Any) -> Section:
    """Return the half strip |y| < b, x > 0 within a circle about the axis.

    Cut by the angle p = arcsin(b/R) into a sector and two triangles of height c = sqrt(R^2 - b^2): area R^2 p + b c,
    polar moment R^4 p/2 + (b^3 c + b c^3/3)/2 (integrals in polar coordinates).
    """
    b = half_width
    reach, angle = np.sqrt(radius**2 - b**2), np.arcsin(b / radius)
    return Section(radius**2 * angle + b * reach, 0.5 * radius**4 * angle + 0.5 * (b**3 * reach + b * reach**3 / 3.0))


def bar_across(half_width: Any, radius: Any) -> Section:
    """Return what a straight slot through the middle of a disc has in it."""
    return _half_strip(half_width, radius).times(2.0)


def spoke(half_width: Any, disc_radius: Any, length: Any) -> Section:
    """Return what an obround from the axis to `length` adds to a disc about the axis: strip and half disc beyond its
    rim."""
    near_end = Section(0.5 * np.pi * half_width**2, 0.25 * np.pi * half_width**4)
    return slot(half_width, length) - near_end - _half_strip(half_width, disc_radius)


def notch(half_width: Any, inner_radius: Any, outer_radius: Any) -> Section:
    """Return what a straight opening of the given half width takes from one side of a ring about the axis."""
    return _half_strip(half_width, outer_radius) - _half_strip(half_width, inner_radius)


def slot(half_width: Any, length: Any) -> Section:
    """Return the obround: a strip of the given half width from the axis to `length` with a half disc at each end."""
    b, reach = half_width, length
    strip_area = 2.0 * b * reach
    strip_polar = 2.0 * b * reach**3 / 3.0 + 2.0 * reach * b**3 / 3.0
    half_disc = 0.5 * np.pi * b**2
    centroid = 4.0 * b / (3.0 * np.pi)
    near_polar = 0.25 * np.pi * b**4
    far_polar = near_polar + half_disc * (reach**2 + 2.0 * reach * centroid)
    return Section(strip_area + 2.0 * half_disc, strip_polar + near_polar + far_polar)


def mean_square(inner_radius: Any, outer_radius: Any) -> Any:
    """Return the mean of r^2 along a radial line [m^2]."""
    return (inner_radius**2 + inner_radius * outer_radius + outer_radius**2) / 3.0


def radial_strip(thickness: Any, inner_radius: Any, outer_radius: Any) -> Any:
    """Return the area [m^2] between two circles about the axis, a radial line and its parallel at the given distance.

    Integral of r arcsin(t/r) dr = r^2/2 arcsin(t/r) + t/2 sqrt(r^2 - t^2): a plate of constant thickness let into the
    side of an annular sector.
    """

    def up_to(radius: Any) -> Any:
        chord = np.sqrt(radius**2 - thickness**2)
        return 0.5 * (radius**2 * np.arcsin(thickness / radius) + thickness * chord)

    return up_to(outer_radius) - up_to(inner_radius)


def between_planes(span: Any, offset: Any, distance: Any) -> Any:
    """Return the distance [m] of two planes that lie `offset` within the sides of a sector, across its middle at
    `distance`.

    2 (d tan(a/2) - t/cos(a/2)): times a length along the middle, the area of the trapezoid around `distance`.
    """
    return 2.0 * (distance * np.tan(0.5 * span) - offset / np.cos(0.5 * span))


def wedge(span: Any, offset: Any, length: Any, distance: Any, count: Any = 1.0, pitch: Any = 0.0) -> Section:
    """Return the trapezoids in a row along the middle of a sector, between planes `offset` within its sides, around
    `distance`.

    `count` of them, each so long, from middle to middle the `pitch`.

    With the half width y(x) = x tan(a/2) - t/cos(a/2) the area is the length times 2 y(d); the polar moment
    integral of 2 x^2 y dx in closed form, and of 2 y^3/3 dx with y at the middle and y'^2 beside it.
    """
    slope = np.tan(0.5 * span)
    across = between_planes(span, offset, distance)
    along = (length**2 + pitch**2 * (count**2 - 1.0)) / 12.0
    about = across * (distance**2 + along) + 4.0 * distance * slope * along
    beside = across**3 / 12.0 + across * slope**2 * along
    return Section(length * across, length * (about + beside)).times(count)


def wedge_corners(fillet_radius: Any, span: Any) -> Any:
    """Return the area [m^2] that fillets take from a trapezoid whose legs are inclined by `span` to each other.

    In a corner of the angle b a fillet leaves r^2 (cot(b/2) - (pi - b)/2) empty; b is pi/2 plus and minus half of it.
    """
    half = 0.5 * span
    taken = [1.0 / np.tan(0.25 * np.pi + 0.5 * side) - 0.25 * np.pi + 0.5 * side for side in (half, -half)]
    return 2.0 * fillet_radius**2 * sum(taken)


def outer_corner(fillet_radius: Any, circle_radius: Any, offset: Any) -> Any:
    """Return the area [m^2] that a fillet takes from the corner inside a circle about the axis and beside a straight
    line.

    The line passes the axis at the distance `offset`; the shape lies on its far side. With its centre C at R - r from
    the axis and r beside the line, the fillet touches the line at T and the circle on the ray through C: the circle's
    sector from the corner to that ray, less the triangle over the line from T to the corner, the triangle of axis, T
    and C, and the fillet's own sector (plane geometry).
    """
    r, t = fillet_radius, offset
    along = np.sqrt((circle_radius - r) ** 2 - (t + r) ** 2)
    to_corner = np.sqrt(circle_radius**2 - t**2)
    centre, corner = np.arcsin((t + r) / (circle_radius - r)), np.arcsin(t / circle_radius)
    whole = 0.5 * circle_radius**2 * (centre - corner) - 0.5 * t * (to_corner - along)
    return whole - 0.5 * along * r - 0.5 * r**2 * (0.5 * np.pi + centre)


def inner_corner(fillet_radius: Any, circle_radius: Any, offset: Any) -> Any:
    """Return the area [m^2] that a fillet takes from the corner outside a circle about the axis and beside a straight
    line.

    As `outer_corner`, the fillet's centre at R + r from the axis.
    """
    r, t = fillet_radius, offset
    along = np.sqrt((circle_radius + r) ** 2 - (t + r) ** 2)
    to_corner = np.sqrt(circle_radius**2 - t**2)
    centre, corner = np.arcsin((t + r) / (circle_radius + r)), np.arcsin(t / circle_radius)
    whole = 0.5 * (along * r - t * (along - to_corner))
    return whole - 0.5 * circle_radius**2 * (centre - corner) - 0.5 * r**2 * (0.5 * np.pi - centre)


def corners(fillet_radius: Any, inner_radius: Any, outer_radius: Any, offset: Any = 0.0) -> Any:
    """Return the area [m^2] that fillets take from the four corners of an annular sector with sides at `offset` from
    radial."""
    return 2.0 * (outer_corner(fillet_radius, outer_radius, offset) + inner_corner(fillet_radius, inner_radius, offset))


def corners_beyond(fillet_radius: Any, inner_radius: Any, outer_radius: Any, offset: Any, depth: Any) -> Any:
    """Return what of the area [m^2] of `corners` lies further than `depth` from the radial lines; none beyond the
    fillets.

    With the fillet's centre at the height c along the line and y_c = r + t beside it, over the distance y from the
    line: the integral of |sqrt(R^2 - y^2) - (c +- sqrt(r^2 - (y - y_c)^2))| dy from the depth to where the fillet
    touches the circle, on the ray through its centre (plane geometry).
    """
    r, beside = fillet_radius, fillet_radius + offset
    taken = 0.0
    for sign, radius in ((1.0, outer_radius), (-1.0, inner_radius)):
        height = np.sqrt((radius - sign * r) ** 2 - beside**2)
        touch = beside * radius / (radius - sign * r)
        start = np.fmin(depth, touch)
        circle = _under_arc(touch, radius) - _under_arc(start, radius)
        fillet = _under_arc(touch - beside, r) - _under_arc(start - beside, r)
        taken += sign * (circle - height * (touch - start)) - fillet
    return 2.0 * taken


def _under_arc(distance: Any, radius: Any) -> Any:
    """Return the integral of sqrt(r^2 - y^2) from zero to a distance [m^2]."""
    return 0.5 * (distance * np.sqrt(radius**2 - distance**2) + radius**2 * np.arcsin(distance / radius))
