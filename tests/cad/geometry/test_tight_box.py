"""The box around a part is the kernel's own, to the bit, wherever the part stands."""

from __future__ import annotations

from typing import Any

import cadquery as cq
import pytest

from tvimdesign.cad.geometry.features import tight_box

SIDES = ("xmin", "xmax", "ymin", "ymax", "zmin", "zmax")


def sides(box: Any) -> list[float]:
    return [getattr(box, side) for side in SIDES]


def pin_on_plate(plate: float) -> cq.Solid:
    """Draw a pin of 4 mm with a fillet of 1.5 mm at its foot, on a square plate of a side [mm]."""
    body = cq.Workplane().box(plate, plate, 4.0).faces(">Z").workplane().circle(2.0).extrude(9.0)
    return body.edges(cq.selectors.RadiusNthSelector(0)).edges("<Z").fillet(1.5).solids().val()


@pytest.mark.parametrize("plate", [7.5, 30.0])
@pytest.mark.parametrize("turn", [0.0, 17.0, 211.3])
def test_a_fillet_within_the_rest_is_left_out(plate: float, turn: float, monkeypatch: pytest.MonkeyPatch) -> None:
    solid = pin_on_plate(plate).rotate(cq.Vector(), cq.Vector(0.2, 0.1, 1.0), turn)
    expected = sides(solid.BoundingBox())
    assert "TORUS" in [face.geomType() for face in solid.Faces()]
    monkeypatch.setattr(cq.Shape, "BoundingBox", lambda _self: pytest.fail("the kernel's search"))
    assert sides(tight_box(solid)) == expected


def test_a_fillet_that_is_outermost_counts() -> None:
    foot = cq.Workplane("XZ").moveTo(1.0, 0.0).lineTo(3.0, 0.0).radiusArc((1.5, 1.5), 1.5).lineTo(1.0, 1.5).close()
    solid = foot.revolve(360.0, (0.0, 0.0), (0.0, 1.0)).solids().val()
    assert sides(tight_box(solid)) == sides(solid.BoundingBox())


def test_round_and_plain_bodies_are_the_kernels() -> None:
    for solid in (cq.Solid.makeTorus(9.0, 2.0), cq.Solid.makeBox(1, 2, 3), cq.Solid.makeSphere(3.0)):
        assert sides(tight_box(solid)) == sides(solid.BoundingBox())
