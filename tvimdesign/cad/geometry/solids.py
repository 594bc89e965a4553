"""Drawing aids: upright cylinders, rings, sectors and slots between two levels. Lengths in mm, angles in rad.

What draws them is a kernel: CadQuery's, unless another one is chosen for a while (`drawn_by`). So exact solids
and drafts share one description of the parts.
"""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from math import acos, asin, cos, pi, sin, sqrt, tan

import cadquery as cq

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.geometry.exact_kernel import Arc, ExactKernel, Kernel, Point, Segment

_UP = cq.Vector(0, 0, 1)
_EXACT: Kernel = ExactKernel()
_KERNEL: ContextVar[Kernel] = ContextVar("kernel", default=_EXACT)


@contextmanager
def drawn_by(kernel: Kernel) -> Iterator[None]:
    """Let another kernel draw, within a `with` block."""
    before = _KERNEL.set(kernel)
    try:
        yield
    finally:
        _KERNEL.reset(before)


def polar(radius: float, azimuth: float) -> Point:
    """Return the point at a radius and an azimuth."""
    return radius * cos(azimuth), radius * sin(azimuth)


def _require(**lengths: float) -> None:
    """Raise GeometryError for a size that is zero or negative; the kernel would draw it inside out, or crash."""
    for name, value in lengths.items():
        if not value > 0.0:
            raise GeometryError(f"{name.replace('_', ' ')} is {value:.4g}; it must be above zero to be drawn")


def cylinder(radius: float, bottom: float, top: float, at: Point = (0.0, 0.0)) -> cq.Solid:
    """Draw upright cylinder between two levels."""
    _require(radius=radius, height=top - bottom)
    return _KERNEL.get().cylinder(radius, bottom, top, at)


def foot(radius: float, fillet: float, level: float, at: Point = (0.0, 0.0)) -> cq.Solid:
    """Draw the foot of an upright cylinder on a level, as high as its fillet is wide."""
    _require(radius=radius, fillet=fillet)
    return _KERNEL.get().foot(radius, fillet, level, at)


def blind_hole(diameter: float, mouth: float, bottom: float, point: float, at: Point = (0.0, 0.0)) -> list[cq.Solid]:
    """Draw what a blind hole takes away between mouth and bottom, above or below that, and a drill's point beyond.

    The point is `point` times the diameter high; none where that is zero.
    """
    hole = cylinder(0.5 * diameter, min(mouth, bottom), max(mouth, bottom), at)
    if not point:
        return [hole]
    tip = bottom + (point if bottom > mouth else -point) * diameter
    return [hole, _KERNEL.get().cone(0.5 * diameter, bottom, tip, at)]


def block(along_x: Point, width: float, bottom: float, top: float) -> cq.Solid:
    """Draw upright block across the x axis, between two places on it and two levels."""
    start, end = along_x
    _require(length=end - start, width=width, height=top - bottom)
    return _KERNEL.get().block(along_x, width, bottom, top)


def tapered_bar(reach: float, width: float, angle: float, bottom: float, top: float) -> cq.Shape:
    """Draw bar along the x axis, of a width at its upper level, its flanks leaning inwards below by an angle."""
    _require(width_of_a_tapered_bar=width - 2.0 * (top - bottom) * tan(angle))
    beside = block((-reach, reach), 2.0 * width, 2.0 * (bottom - top), top - bottom)
    flanks = []
    for side in (1.0, -1.0):
        pivot = cq.Location(cq.Vector(0, 0.5 * side * width, top), cq.Vector(1, 0, 0), -side * angle * 180.0 / pi)
        flanks.append(beside.moved(cq.Location(cq.Vector(0, side * width, 0))).moved(pivot))
    return block((-reach, reach), width, bottom, top).cut(*flanks)


def ring(inner: float, outer: float, bottom: float, top: float) -> cq.Solid:
    """Draw upright ring about the axis between two levels."""
    _require(inner_radius=inner, width_of_a_ring=outer - inner, height=top - bottom)
    return _KERNEL.get().prism(outer, [inner], bottom, top)


def sector(inner: float, outer: float, span: float, bottom: float, top: float) -> cq.Solid:
    """Draw upright annular sector about the axis, centred on the x axis, between two levels."""
    _require(inner_radius=inner, width_of_a_sector=outer - inner, span=span, height=top - bottom)
    first, last = -0.5 * span, 0.5 * span
    outline: list[Segment] = [
        (polar(outer, first), polar(outer, 0.0), polar(outer, last)),
        (polar(outer, last), polar(inner, last)),
        (polar(inner, last), polar(inner, 0.0), polar(inner, first)),
        (polar(inner, first), polar(outer, first)),
    ]
    return _KERNEL.get().prism(outline, [], bottom, top)


def wedge(along_x: Point, span: float, inset: float, bottom: float, top: float) -> cq.Solid:
    """Draw upright trapezoid about the x axis, between two places on it, its legs `inset` within a sector of that
    span."""
    _require(length=along_x[1] - along_x[0], span=span, height=top - bottom)
    halves = [x * tan(0.5 * span) - inset / cos(0.5 * span) for x in along_x]
    _require(width_of_a_wedge=min(halves))
    (near, far), (start, end) = halves, along_x
    corners = [(start, -near), (end, -far), (end, far), (start, near)]
    outline = list(zip(corners, [*corners[1:], corners[0]], strict=True))
    return _KERNEL.get().prism(outline, [], bottom, top)


def spoked_disc(
    radius: float, half_width: float, length: float, corner: float, azimuths: Sequence[float], levels: Point,
    around: float = 0.0,
) -> cq.Solid:  # fmt: skip
    """Draw upright disc about the axis with spokes to `length` that end in half discs, and fillets where they begin.

    With a radius `around` it is the ring from there inwards to the disc's, its spokes inwards, too.
    """
    bottom, top = levels
    _require(radius=radius, half_width=half_width, corner=corner, height=top - bottom)
    out = -1.0 if around else 1.0
    # The centre of a fillet touches circle and spoke.
    rim = radius + out * corner
    along = sqrt(rim**2 - (half_width + corner) ** 2)
    touch, beside = radius / rim, half_width + corner

    def at(x: float, y: float, azimuth: float) -> Point:
        return x * cos(azimuth) - y * sin(azimuth), x * sin(azimuth) + y * cos(azimuth)

    def fillet(side: float, azimuth: float) -> tuple[Point, Point, Point]:
        """Return where it touches the circle, its middle, and where it touches the spoke."""
        towards = cq.Vector(-out * along, -out * side * beside, 0.0).normalized() + cq.Vector(0.0, -side, 0.0)
        half = towards.normalized() * corner
        return (
            at(touch * along, side * touch * beside, azimuth),
            at(along + half.x, side * beside + half.y, azimuth),
            at(along, side * half_width, azimuth),
        )

    edges: list[Segment] = []
    for azimuth, following in zip(azimuths, [*azimuths[1:], azimuths[0] + 2.0 * pi], strict=True):
        before, after, later = fillet(-1.0, azimuth), fillet(1.0, azimuth), fillet(-1.0, following)
        near, far = at(length, -half_width, azimuth), at(length, half_width, azimuth)
        edges += [
            before,
            (before[2], near),
            (near, at(length + out * half_width, 0.0, azimuth), far),
            (far, after[2]),
            after[::-1],
            (after[0], at(radius, 0.0, 0.5 * (azimuth + following)), later[0]),
        ]
    return _KERNEL.get().prism(around or edges, [edges] if around else [], bottom, top)


def toothed_disc(radii: Point, corner: float, span: float, azimuths: Sequence[float], levels: Point) -> cq.Solid:
    """Draw upright disc about the axis with teeth of radial sides, from its radius to an outer one, fillets at their
    roots."""
    (radius, outer), (bottom, top) = radii, levels
    _require(radius=radius, length_of_a_tooth=outer - radius, corner=corner, span=span, height=top - bottom)
    reach = radius + corner
    beside, along = asin(corner / reach), sqrt(reach**2 - corner**2)

    def fillet(azimuth: float, side: float) -> tuple[Point, Point, Point]:
        """Return where it touches the disc, its middle, and where it touches the tooth's side at an azimuth."""
        centre, foot_on_side = cq.Vector(*polar(reach, azimuth + side * beside)), cq.Vector(*polar(along, azimuth))
        half = (foot_on_side - centre).normalized() - centre.normalized()
        middle = centre + half.normalized() * corner
        return polar(radius, azimuth + side * beside), (middle.x, middle.y), (foot_on_side.x, foot_on_side.y)

    edges: list[Segment] = []
    for azimuth, following in zip(azimuths, [*azimuths[1:], azimuths[0] + 2.0 * pi], strict=True):
        first, last = azimuth - 0.5 * span, azimuth + 0.5 * span
        before, after, later = fillet(first, -1.0), fillet(last, 1.0), fillet(following - 0.5 * span, -1.0)
        edges += [
            before,
            (before[2], polar(outer, first)),
            (polar(outer, first), polar(outer, azimuth), polar(outer, last)),
            (polar(outer, last), after[2]),
            after[::-1],
            (after[0], polar(radius, 0.5 * (azimuth + following)), later[0]),
        ]
    return _KERNEL.get().prism(edges, [], bottom, top)


def bossed_ring(radii: Point, boss: float, corner: float, azimuths: Sequence[float], levels: Point) -> cq.Solid:
    """Draw upright ring between two radii, with discs of radius `boss` on its inner circle and fillets beside them.

    Its inner outline is drawn arc by arc, for the kernel's own fillet between two cylinders is no cylinder.
    """
    (inner, outer), (bottom, top) = radii, levels
    _require(inner_radius=inner, width_of_a_ring=outer - inner, boss=boss, corner=corner, height=top - bottom)
    rim, reach = inner - corner, boss + corner
    # The centre of a fillet touches disc and circle: the law of cosines gives its azimuth beside the disc's.
    beside = acos((inner**2 + rim**2 - reach**2) / (2.0 * inner * rim))

    def at(radius: float, azimuth: float) -> cq.Vector:
        return cq.Vector(*polar(radius, azimuth), bottom)

    def fillet(azimuth: float, side: float) -> tuple[Point, Point, Point]:
        """Return where it touches the circle, its middle, and where it touches the disc."""
        centre, out = at(rim, azimuth + side * beside), at(1.0, azimuth + side * beside) - at(0.0, 0.0)
        towards = (at(inner, azimuth) - centre).normalized()
        touch, middle, end = out * corner, (out + towards).normalized() * corner, towards * corner
        first, second, third = (centre + part for part in (touch, middle, end))
        return (first.x, first.y), (second.x, second.y), (third.x, third.y)

    edges: list[Segment] = []
    for azimuth, following in zip(azimuths, [*azimuths[1:], azimuths[0] + 2.0 * pi], strict=True):
        before, after, later = fillet(azimuth, -1.0), fillet(azimuth, 1.0), fillet(following, -1.0)
        edges += [
            before,
            (before[2], polar(inner - boss, azimuth), after[2]),
            after[::-1],
            (after[0], polar(inner, 0.5 * (azimuth + following)), later[0]),
        ]
    return _KERNEL.get().prism(outer, [edges], bottom, top)


def rounded(body: cq.Shape, radius: float) -> cq.Solid:
    """Draw the one solid of a body with every upright edge rounded."""
    _require(corner_radius=radius)
    return _KERNEL.get().rounded(body, radius)


def slot(half_width: float, length: float, bottom: float, top: float) -> cq.Solid:
    """Draw upright obround from the axis to `length` along x, with a half disc at each end."""
    _require(half_width=half_width, length=length, height=top - bottom)
    b = half_width
    corners = [(0.0, -b), (length, -b), (length, b), (0.0, b)]
    outline: list[Segment] = [
        (corners[0], corners[1]),
        (corners[1], (length + b, 0.0), corners[2]),
        (corners[2], corners[3]),
        (corners[3], (-b, 0.0), corners[0]),
    ]
    return _KERNEL.get().prism(outline, [], bottom, top)


def tube(radius: float, path: Sequence[Arc]) -> cq.Solid:
    """Draw a round wire along arcs in space that follow each other without a kink."""
    _require(radius=radius)
    return _KERNEL.get().tube(radius, path)


def join(body: cq.Shape, others: Iterable[cq.Shape]) -> cq.Shape:
    """Draw one body of several that overlap or touch, without the seams."""
    return body.fuse(*others).clean()


def turned(shape: cq.Shape, azimuth: float, beside: float = 0.0) -> cq.Shape:
    """Draw the shape moved along y, then turned about the axis; the copy shares its geometry with the original."""
    return shape.moved(cq.Location(cq.Vector(*polar(beside, azimuth + 0.5 * pi)), _UP, azimuth * 180.0 / pi))
