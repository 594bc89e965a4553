"""Mass properties of solids: against textbook bodies, and against the integrals of another library over a mesh."""

import cadquery as cq
import numpy as np
import pytest
import trimesh

from tvimdesign.cad.export.mesh import solid_mesh
from tvimdesign.cad.jobs.rigid_bodies import of_solid, together

DENSITY = 1270.0


def test_inertias_are_the_textbook_s_and_halves_make_the_whole() -> None:
    found = of_solid(cq.Solid.makeBox(30.0, 20.0, 10.0, cq.Vector(5.0, 0.0, 0.0)), DENSITY)
    mass, (a, b, c) = DENSITY * 6e-6, (0.03, 0.02, 0.01)
    assert found.mass == pytest.approx(mass)
    np.testing.assert_allclose(found.centre, [0.02, 0.01, 0.005])
    np.testing.assert_allclose(
        found.inertia, np.diag([b**2 + c**2, a**2 + c**2, a**2 + b**2]) * mass / 12.0, atol=1e-15
    )
    found, mesh = of_solid(_wedge(), DENSITY), solid_mesh(_wedge())
    body = trimesh.Trimesh(mesh.vertices * 1e-3, mesh.faces)
    body.density = DENSITY
    assert found.mass == pytest.approx(body.mass, rel=1e-6)
    np.testing.assert_allclose(found.centre, body.center_mass, rtol=1e-6)
    np.testing.assert_allclose(found.inertia, body.moment_inertia, rtol=1e-6)
    assert np.all(np.abs(found.inertia) > 1e-11)
    halves = [cq.Solid.makeBox(15.0, 20.0, 10.0, cq.Vector(at, 3.0, -4.0)) for at in (0.0, 15.0)]
    whole = of_solid(cq.Solid.makeBox(30.0, 20.0, 10.0, cq.Vector(0.0, 3.0, -4.0)), DENSITY)
    found = together(of_solid(half, DENSITY) for half in halves)
    assert found.mass == pytest.approx(whole.mass)
    np.testing.assert_allclose(found.centre, whole.centre)
    np.testing.assert_allclose(found.inertia, whole.inertia, atol=1e-15)


def _wedge() -> cq.Solid:
    """Return a body without any symmetry, so that every product of inertia counts."""
    return cq.Workplane().polyline([(0, 0), (30, 4), (6, 22)]).close().extrude(9.0).edges(">Z").chamfer(1.0).val()
