"""What is said beside the plan of all holes, pins and arcs that are alike, with a leader to one of them."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, degrees, hypot, pi, sin

import cadquery as cq

from tvimdesign.cad.drawing.drawing_requirements import DrawingRequirements
from tvimdesign.cad.drawing.number_text import around, figure
from tvimdesign.cad.drawing.placed_view import PlacedView, apart
from tvimdesign.cad.geometry.features import Cylinder

_BESIDE = 228.0
"""Where the texts begin on the sheet [mm]."""
_PITCH = 5.5
"""Height of a line of them [mm]."""
_CORNER = 2.0
"""Radius up to which an arc is the corner of a pocket [mm]."""


def call_out(
    plan: PlacedView, found: Sequence[Cylinder], solid: cq.Solid, asked: DrawingRequirements, low: float
) -> None:
    """One text for all that are alike; none lower on the sheet than `low` [mm]."""
    from_template: dict[tuple[object, ...], list[Cylinder]] = {}
    for one in found:
        if not (one.is_central and one.is_round):
            pitch = round(hypot(one.x, one.y), 4)
            stands = () if _is_corner(one) else (pitch, one.bottom, one.top)
            key = (round(one.radius, 6), *stands, one.concave, one.is_round)
            from_template.setdefault(key, []).append(one)
    groups = sorted(from_template.values(), key=lambda group: _pointed_at(group)[1])
    box = solid.BoundingBox()
    least = (low - plan.origin[1]) / plan.sheet.scale
    wanted = [max(_pointed_at(group)[1], least) for group in groups]
    places = apart(wanted, plan.paper(_PITCH))
    lift = max(0.0, least - places[0]) if places else 0.0
    x = (_BESIDE - plan.origin[0]) / plan.sheet.scale
    for group, height in zip(groups, (place + lift for place in places), strict=True):
        text = _said_of(group, box.zmin, box.zmax, asked)
        start = _pointed_at(group)
        knee, end = (x - plan.paper(4.0), height), (x, height)
        for points in ((start, knee), (knee, end)):
            plan.line(*points, "DIMENSION")
        plan.sheet.space.add_circle(plan.at(*start), plan.paper(0.5), dxfattribs={"layer": "DIMENSION"})
        place = plan.origin[0] + x * plan.sheet.scale + 1.0, plan.origin[1] + height * plan.sheet.scale
        plan.sheet.text(text, place, align="MIDDLE_LEFT")


def _pointed_at(group: Sequence[Cylinder]) -> tuple[float, float]:
    """Point of the plan to which the leader goes: on one of those that are alike, towards the text."""
    places = []
    for one in group:
        ways = (0.25 * pi,) if one.is_round else tuple(one.middle + share * one.span for share in (-0.35, 0.0, 0.35))
        places += [(one.x + one.radius * cos(way), one.y + one.radius * sin(way)) for way in ways]
    return max(places, key=lambda place: (round(place[0] + 0.5 * place[1], 4), place))


def _said_of(group: Sequence[Cylinder], bottom: float, top: float, asked: DrawingRequirements) -> str:
    """What a call-out says: how many, how large, where, and between which heights."""
    one = group[0]
    if _is_corner(one):
        return f"{len(group)}× R{figure(one.radius)} inner corners"
    size = sized(one, asked)
    if not one.is_round:
        size = f"{size if asked.seat(2.0 * one.radius) else f'R{figure(one.radius)}'} over {figure(degrees(one.span))}°"
    what = ("hole" if one.concave else "boss") if one.is_round else ("inside" if one.concave else "outside")
    through = one.concave and one.is_round and abs(one.bottom - bottom) < 1e-3 and abs(one.top - top) < 1e-3
    deep = "through" if through else f"h {figure(one.bottom - bottom)} to {figure(one.top - bottom)}"
    many = f"{len(group)}× " if len(group) > 1 else ""
    return ", ".join(filter(None, (f"{many}{size} {what}", _where(group), deep)))


def sized(one: Cylinder, asked: DrawingRequirements) -> str:
    """A diameter with its fit or its thread."""
    seat, thread = asked.seat(2.0 * one.radius), asked.thread(one)
    if thread:  # told by its depth, too: a tapped hole may be as wide as one for a dowel pin
        return f"{thread.screw} ⌀{figure(thread.hole)}"
    return f"⌀{figure(seat.size)} {seat.fit}" if seat and seat.fit else f"⌀{figure(2.0 * one.radius)}"


def _is_corner(one: Cylinder) -> bool:
    """Whether it is the rounded corner of a pocket, whose place its walls say."""
    return one.concave and not one.is_round and one.radius <= _CORNER


def _where(group: Sequence[Cylinder]) -> str:
    """Where those that are alike stand: on which circle, from which azimuth on, or at which place."""
    one = group[0]
    pitch = 2.0 * hypot(one.x, one.y)
    if pitch < 1e-3:
        return ""
    if len(group) == 1:
        return f"x {figure(one.x)}, y {figure(one.y)}"
    azimuths = sorted(round(degrees(atan2(other.y, other.x)) % 360.0, 3) % 360.0 for other in group)
    return f"on ⌀{figure(pitch)} {around(azimuths)}"
