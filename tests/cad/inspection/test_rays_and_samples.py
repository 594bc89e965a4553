"""Rays against the triangles of a part, and points on its surface."""

import cadquery as cq
import numpy as np
import pytest
from sample_solids import box, one_solid

from tvimdesign.cad.export.mesh import Array, solid_mesh
from tvimdesign.cad.inspection.rays import Triangles, samples


def test_rays_meet_a_box_where_its_faces_are() -> None:
    half = np.array([7.0, 4.0, 2.5])
    triangles = Triangles(solid_mesh(one_solid(cq.Workplane().box(*(2.0 * half)))))
    draw = np.random.default_rng(1)
    origins = draw.uniform(-0.99, 0.99, (500, 3)) * half
    directions = draw.normal(size=(500, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    hits = triangles.first_hits(origins, directions)
    expected = np.min((np.sign(directions) * half - origins) / directions, axis=1)
    assert hits.distance == pytest.approx(expected, abs=1e-9)
    outside = triangles.first_hits(origins + np.array([30.0, 0.0, 0.0]), np.tile([1.0, 0.0, 0.0], (500, 1)))
    assert outside.missed.all()


@pytest.mark.gate
def test_rays_meet_what_every_triangle_held_against_every_ray_says() -> None:
    work = box(23.0, 11.0, 5.0).faces(">Z").workplane().hole(6.0).edges("|Z").fillet(2.0)
    triangles = Triangles(solid_mesh(one_solid(work)))
    draw = np.random.default_rng(7)
    origins = draw.uniform(-1.2, 1.2, (400, 3)) * [11.5, 5.5, 2.5]
    directions = draw.normal(size=(400, 3))
    directions[:120] = np.sign(directions[:120]) * np.eye(3)[draw.integers(0, 3, 120)]
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    hits = triangles.first_hits(origins, directions, beyond=0.5)
    expected = np.array([
        min((far for corners in triangles.corners if (far := _along(origin, way, corners)) > 0.5), default=np.inf)
        for origin, way in zip(origins, directions, strict=True)
    ])  # fmt: skip
    assert np.isfinite(expected).sum() > 150
    assert np.isinf(expected).sum() > 50
    assert hits.distance == pytest.approx(expected, abs=1e-9)
    assert np.all((hits.triangle == -1) == hits.missed)
    met = ~hits.missed
    again = [
        _along(origin, way, triangles.corners[index])
        for origin, way, index in zip(origins[met], directions[met], hits.triangle[met], strict=True)
    ]
    assert again == pytest.approx(expected[met], abs=1e-9)


def _along(origin: Array, way: Array, corners: Array) -> float:
    """Return the distance to a triangle, by Cramer's rule."""
    sides = np.stack((-way, corners[1] - corners[0], corners[2] - corners[0]), axis=1)
    if abs(np.linalg.det(sides)) < 1e-12:
        return np.inf
    far, u, v = np.linalg.solve(sides, origin - corners[0])
    return float(far) if u >= -1e-7 and v >= -1e-7 and u + v <= 1.0 + 1e-7 else np.inf


def test_no_point_of_the_surface_is_further_from_a_sample_than_the_spacing() -> None:
    triangles = Triangles(solid_mesh(one_solid(box(23.0, 11.0, 5.0))))
    found = samples(triangles, 1.5)
    assert found.area.sum() == pytest.approx(2.0 * (23.0 * 11.0 + 23.0 * 5.0 + 11.0 * 5.0))
    asked = np.random.default_rng(2).uniform(-0.5, 0.5, (300, 2)) * [23.0, 11.0]
    top = found.point[found.normal[:, 2] > 0.9][:, :2]
    away = np.linalg.norm(asked[:, None, :] - top[None, :, :], axis=2).min(axis=1)
    assert away.max() < 1.5
