"""Solids that tests draw, and checks by what they are about."""

import cadquery as cq

from tvimdesign.cad.cad_report import SolidCheck


def box(x: float, y: float, z: float) -> cq.Workplane:
    """Return a box that stands on z = 0."""
    return cq.Workplane().box(x, y, z, centered=(True, True, False))


def one_solid(work: cq.Workplane) -> cq.Solid:
    solid = work.val()
    assert isinstance(solid, cq.Shape)
    return solid.Solids()[0]


def of(checks: list[SolidCheck]) -> dict[str, SolidCheck]:
    """Return the checks by what they are about."""
    return {check.name.split(": ")[1]: check for check in checks}
