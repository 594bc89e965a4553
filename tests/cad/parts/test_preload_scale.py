"""The scale of an adjuster: dots around its flange from the tang on, and a mark in the floor beside each pocket."""

from __future__ import annotations

from math import atan2, degrees, hypot

import pytest
from cad_designs import BEARINGS, design_of

from tvimdesign.cad.assembly.assembly import drawn_part
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.features import Cylinder, holes
from tvimdesign.cad.geometry.spring_solids import installed_coil


def test_the_scale_has_dots_every_thirty_degrees_and_a_mark() -> None:
    dims = dimensions(design_of("scale", BEARINGS))
    is_dot = 0.5 * dims.scale_dot_diameter
    dots = [one for one in holes(drawn_part(dims, "adjuster")) if one.radius == pytest.approx(is_dot)]
    tang = atan2(*reversed(installed_coil(dims).tang_position))
    turns = sorted(round((degrees(atan2(one.y, one.x) - tang) % 360.0), 6) for one in dots)
    assert turns == pytest.approx([30.0 * index for index in range(2, 11)])
    assert min(hypot(one.x, one.y) for one in dots) > 0.5 * (dims.coil_diameter + dims.wire_diameter)
    assert all(one.top == pytest.approx(0.0) and one.bottom == pytest.approx(-0.4) for one in dots)
    marks = [one for one in holes(drawn_part(dims, "housing")) if one.radius == pytest.approx(is_dot)]
    assert len(marks) == dims.count("spring_count")
    for azimuth, (x, y) in zip(dims.azimuths("spring_count"), _in_order(marks), strict=True):
        assert (degrees(atan2(y, x) - azimuth) + 180.0) % 360.0 - 180.0 > 0.0


def _in_order(marks: list[Cylinder]) -> list[tuple[float, float]]:
    """Return their places, counted around the axis."""
    return sorted(((one.x, one.y) for one in marks), key=lambda at: atan2(at[1], at[0]) % 6.283185307179586)
