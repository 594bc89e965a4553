"""Areas and polar second moments by quadrature; other shapes are held by the CAD kernel's volumes and inertias."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import quad

from tvimdesign.physics.solids import shapes


def integrate(function: Callable[[float], float], start: float, end: float) -> float:
    return float(quad(function, start, end, epsabs=0.0, epsrel=1e-10, limit=200)[0])


def by_strips(height: Callable[[float], float], start: float, end: float) -> shapes.Section:
    """Section symmetric about the x axis, of the half height h(x): polar of a strip 2 (x^2 h + h^3/3) dx."""
    area = integrate(lambda x: 2.0 * height(x), start, end)
    polar = integrate(lambda x: 2.0 * (x**2 * height(x) + height(x) ** 3 / 3.0), start, end)
    return shapes.Section(area, polar)


@pytest.mark.parametrize("corner", [0.0, 1.5e-3])
def test_rectangle_off_the_axis_is_its_strips(corner):
    radial, along, distance = 10e-3, 20e-3, 33e-3

    def height(x: float) -> float:
        into_corner = max(corner - min(x - (distance - 0.5 * radial), distance + 0.5 * radial - x), 0.0)
        return 0.5 * along - corner + np.sqrt(corner**2 - into_corner**2)

    strips = by_strips(height, distance - 0.5 * radial, distance + 0.5 * radial)
    section = shapes.rectangle_at(radial, along, distance, corner)
    assert section.area == pytest.approx(strips.area, rel=1e-7)
    assert section.polar == pytest.approx(strips.polar, rel=1e-3 if corner else 1e-8)  # fillets count at the corners


def test_notch_takes_a_straight_opening_from_one_side_of_a_ring():
    half_width, inner, outer = 6e-3, 71e-3, 74e-3
    expected = integrate(lambda y: np.sqrt(outer**2 - y**2) - np.sqrt(inner**2 - y**2), -half_width, half_width)
    assert shapes.notch(half_width, inner, outer).area == pytest.approx(expected, rel=1e-9)
    # Along y the strip from R_i to R_o has the polar moment x^3/3 + x y^2 between its ends.
    ends = [lambda y, r=radius: np.sqrt(r**2 - y**2) for radius in (outer, inner)]
    polar = [integrate(lambda y, x=x: x(y) ** 3 / 3.0 + x(y) * y**2, -half_width, half_width) for x in ends]
    assert shapes.notch(half_width, inner, outer).polar == pytest.approx(polar[0] - polar[1], rel=1e-9)


@pytest.mark.parametrize("offset", [0.0, 1.5e-3])
@pytest.mark.parametrize("radius", [0.2e-3, 1.5e-3])
def test_fillets_take_from_a_sector_what_is_beyond_their_arcs(radius, offset):
    inner, outer = 12e-3, 24e-3

    def touching(circle: float, middle: float) -> tuple[float, tuple[float, float]]:
        """Return where the fillet touches the line, along it, and where it touches the circle."""
        along = np.sqrt(middle**2 - (offset + radius) ** 2)
        return along, (along * circle / middle, (offset + radius) * circle / middle)

    foot, (_, top) = touching(outer, outer - radius)
    # Strips along the line, from the fillet out to the circle.
    taken = integrate(
        lambda y: np.sqrt(outer**2 - y**2) - foot - np.sqrt(max(radius**2 - (y - offset - radius) ** 2, 0.0)),
        offset,
        top,
    )
    assert shapes.outer_corner(radius, outer, offset) == pytest.approx(taken, rel=1e-6)

    foot, (left, _) = touching(inner, inner + radius)
    # Strips across the line: below the fillet, less what lies below the circle.
    fillet = integrate(lambda x: radius - np.sqrt(max(radius**2 - (x - foot) ** 2, 0.0)), left, foot)
    circle = integrate(lambda x: np.sqrt(inner**2 - x**2) - offset, left, np.sqrt(inner**2 - offset**2))
    assert shapes.inner_corner(radius, inner, offset) == pytest.approx(fillet - circle, rel=1e-6)
    four = 2.0 * (taken + fillet - circle)
    assert shapes.corners(radius, inner, outer, offset) == pytest.approx(four, rel=1e-6)


@pytest.mark.parametrize("depth", [2.1e-3, 2.6e-3, 3.4e-3])
def test_beyond_a_depth_fillets_take_what_is_further_from_the_radial_lines(depth):
    inner, outer, offset, radius = 19e-3, 26e-3, 1.03e-3, 1.5e-3
    beside = offset + radius

    def fillet(y: float) -> float:
        return float(np.sqrt(max(radius**2 - (y - beside) ** 2, 0.0)))

    def taken(start: float) -> float:
        far, near = np.sqrt((outer - radius) ** 2 - beside**2), np.sqrt((inner + radius) ** 2 - beside**2)
        ends = beside * outer / (outer - radius), beside * inner / (inner + radius)
        outside = integrate(lambda y: np.sqrt(outer**2 - y**2) - far - fillet(y), min(start, ends[0]), ends[0])
        inside = integrate(lambda y: near - fillet(y) - np.sqrt(inner**2 - y**2), min(start, ends[1]), ends[1])
        return outside + inside

    moment = shapes.corners_beyond(radius, inner, outer, offset, depth)
    assert moment == pytest.approx(2.0 * taken(depth), rel=1e-6, abs=1e-18)
    assert (moment > 0.0) == (depth < 3e-3)  # a fillet ends 2.5 mm from the line, or a little further
    whole = shapes.corners(radius, inner, outer, offset)
    assert shapes.corners_beyond(radius, inner, outer, offset, offset) == pytest.approx(whole, rel=1e-9)


def test_small_corners_and_trapezoids():
    # A fillet takes (1 - pi/4) r^2 from a right angle; sides that point to the axis meet every circle at one.
    assert shapes.corners(0.02e-3, 26e-3, 40e-3) == pytest.approx((4.0 - np.pi) * 0.02e-3**2, rel=1e-3)
    span, inset = np.radians(40.0), 3e-3
    singles = [shapes.wedge(span, inset, 6e-3, 26e-3 + shift) for shift in (-9e-3, 0.0, 9e-3)]
    row = shapes.wedge(span, inset, 6e-3, 26e-3, 3, 9e-3)
    assert row == pytest.approx(singles[0].plus(*singles[1:]), rel=1e-12)


@pytest.mark.parametrize("corner", [0.0, 1.5e-3])
def test_what_lies_between_two_planes_of_a_vane_is_its_strips(corner):
    # From 20 to 28 mm along the middle of a vane of 40 degrees, 3 mm within its sides, corners rounded.
    span, inset, near, far = np.radians(40.0), 3e-3, 20e-3, 28e-3
    tangent, cosine = np.tan(0.5 * span), np.cos(0.5 * span)

    def height(x: float) -> float:
        # Of a rounded corner the outline is the circle that touches end and leg.
        leg = x * tangent - inset / cosine
        for end, inwards in ((near, 1.0), (far, -1.0)):
            centre = end + inwards * corner
            middle = centre * tangent - (inset + corner) / cosine
            touches = centre - corner * np.sin(0.5 * span)
            beyond = x < (centre if inwards > 0.0 else touches) if inwards > 0.0 else x > touches
            if corner and beyond and (inwards < 0.0 or x < touches):
                return float(middle + np.sqrt(max(corner**2 - (x - centre) ** 2, 0.0)))
        return float(leg)

    strips = by_strips(height, near, far)
    whole = shapes.wedge(span, inset, far - near, 0.5 * (near + far))
    assert whole.area - shapes.wedge_corners(corner, span) == pytest.approx(strips.area, rel=1e-7)
    if not corner:
        assert whole.polar == pytest.approx(strips.polar, rel=1e-9)
