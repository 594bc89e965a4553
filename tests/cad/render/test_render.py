"""Pictures of placed parts: copies share meshes, each stands in its place, and back faces are not seen."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

from tvimdesign.cad.export.mesh import Array, Instance, Mesh
from tvimdesign.cad.render.render import actors, look, renderer_on_white, write_png

GREEN = (0.0, 0.8, 0.2)
SIZE = (200, 100)


def block() -> Mesh:
    body = trimesh.creation.box((4.0, 6.0, 8.0))
    return Mesh(np.array(body.vertices), np.array(body.faces))


def quarter_turn(x: float) -> Array:
    return np.array([[0.0, -1.0, 0.0, x], [1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 2.0], [0.0, 0.0, 0.0, 1.0]])


def test_copies_of_a_part_share_their_mappers() -> None:
    mesh = block()
    first, second = (actors(mesh, quarter_turn(x), GREEN) for x in (0.0, 50.0))
    for one, other in zip(first, second, strict=True):
        assert one.GetMapper() is other.GetMapper()
    assert first[0].GetBounds() == pytest.approx((-3.0, 3.0, -1.0, 3.0, -2.0, 6.0))
    assert second[1].GetBounds() == pytest.approx((47.0, 53.0, -1.0, 3.0, -2.0, 6.0))


@pytest.mark.parametrize(("inside_out", "seen"), [(False, True), (True, False)])
def test_a_picture_has_its_size_and_faces_are_seen_from_outside_alone(
    tmp_path: Path, inside_out: bool, seen: bool
) -> None:
    corners = np.array([(-4.0, 0.0, -2.0), (4.0, 0.0, -2.0), (4.0, 0.0, 2.0), (-4.0, 0.0, 2.0)])
    faces = np.array([(0, 1, 2), (0, 2, 3)])  # towards a camera that looks along y
    square = Instance(Mesh(corners, faces[:, ::-1] if inside_out else faces), np.eye(4))
    renderer = renderer_on_white()
    renderer.AddActor(actors(square.mesh, square.matrix, GREEN)[0])
    look(renderer, {"square": square}, (0.0, -1.0, 0.0), SIZE[1] / SIZE[0])
    write_png(tmp_path / "square.png", SIZE, [renderer])
    picture = Image.open(tmp_path / "square.png")
    assert picture.size == SIZE
    points = np.asarray(picture.convert("RGB")).astype(int)
    assert points[0, 0].tolist() == [255, 255, 255]
    greener = points[:, :, 1] - points[:, :, 0]
    green = greener > 0.5 * greener.max()
    assert green.mean() == pytest.approx(1.06**-2 if seen else 0.0, abs=0.02)  # but for the margin around it
