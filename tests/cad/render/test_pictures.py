"""Pictures: parts stand in their places, the section's cut, and a field in colours."""

from math import cos, pi, radians, sin

import matplotlib.image
import numpy as np
import pytest
import trimesh
from PIL import Image
from support import cases_of
from vtkmodules.util.numpy_support import vtk_to_numpy

from tvimdesign.cad.assembly.assembly_note import PlacedPart
from tvimdesign.cad.export.mesh import Array, Instance, Mesh
from tvimdesign.cad.render.pictures import _spring_outside, wedge_of, write_steps
from tvimdesign.cad.render.render import actors, look, renderer_on_white, write_field_picture, write_png, write_view

GREEN = (0.0, 0.8, 0.2)
SIZE = (200, 100)


def block() -> Mesh:
    body = trimesh.creation.box((4.0, 6.0, 8.0))
    return Mesh(np.array(body.vertices), np.array(body.faces))


def quarter_turn(x: float) -> Array:
    return np.array([[0.0, -1.0, 0.0, x], [1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 2.0], [0.0, 0.0, 0.0, 1.0]])


def test_copies_of_a_part_share_their_mappers():
    mesh = block()
    first, second = (actors(mesh, quarter_turn(x), GREEN) for x in (0.0, 50.0))
    for actor, other in zip(first, second, strict=True):
        assert actor.GetMapper() is other.GetMapper()
    assert first[0].GetBounds() == pytest.approx((-3.0, 3.0, -1.0, 3.0, -2.0, 6.0))
    assert second[1].GetBounds() == pytest.approx((47.0, 53.0, -1.0, 3.0, -2.0, 6.0))


@pytest.mark.parametrize(("inside_out", "seen"), [(False, True), (True, False)])
def test_a_picture_has_its_size_and_faces_are_seen_from_outside_alone(tmp_path, inside_out, seen):
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


def _upright(azimuth: float, radius: float = 30.0) -> Instance:
    """Return a closed cylinder whose axis stands at an azimuth [deg]."""
    body = trimesh.creation.cylinder(radius=5.0, height=10.0, sections=64)
    matrix = np.eye(4)
    matrix[:2, 3] = radius * cos(radians(azimuth)), radius * sin(radians(azimuth))
    return Instance(Mesh(np.array(body.vertices), np.array(body.faces)), matrix)


@cases_of("pictures", "wedges")
def test_the_wedge_shows_a_cut_spring_and_cut_polymer(springs, polymer, wedge):
    placed = {f"spring_right_{i}": _upright(at) for i, at in enumerate(springs)}
    placed |= {f"pcl_arc_{i}": _upright(at) for i, at in enumerate(polymer)}
    first, last = wedge_of(placed)
    assert 0.0 < last - first < pi
    assert np.exp(1j * np.array([first, last])) == pytest.approx(np.exp(1j * np.radians(wedge)), abs=1e-6)


def test_springs_are_halved_whole_or_gone_by_their_place():
    first, last = 0.0, radians(135.0)
    cut = vtk_to_numpy(_spring_outside(_upright(0.0), first, last).GetPoints().GetData())
    assert cut[:, 1].max() == pytest.approx(0.0, abs=2e-3)
    assert cut[:, 1].min() == pytest.approx(-5.0, abs=1e-2)
    assert _spring_outside(_upright(250.0), first, last).GetNumberOfPolys() == len(_upright(250.0).mesh.faces)
    assert _spring_outside(_upright(70.0), first, last).GetNumberOfPolys() == 0


def test_numbers_of_the_bill_stand_beside_parts_and_in_the_legend(tmp_path):
    placed = {"rotor": Instance(block(), quarter_turn(0.0)), "link": Instance(block(), quarter_turn(20.0))}
    renderer, plain = renderer_on_white(), renderer_on_white()
    write_view(tmp_path / "plain.png", plain, placed, (0.0, -1.0, 0.5), SIZE)
    write_view(tmp_path / "numbered.png", renderer, placed, (0.0, -1.0, 0.5), SIZE, items={"link": 3, "rotor": 12})
    shown = [renderer.GetViewProps().GetItemAsObject(at) for at in range(renderer.GetViewProps().GetNumberOfItems())]
    assert [text.GetInput() for text in shown] == [" 3", " 12"]
    assert [text.GetPositionCoordinate().GetValue()[0] for text in shown] == [23.0, 3.0]  # the right end of each
    plain, numbered = (matplotlib.image.imread(tmp_path / f"{name}.png") for name in ("plain", "numbered"))
    assert np.any(plain[:50] != numbered[:50])


def test_what_a_step_takes_out_again_is_gone_in_those_after_it(tmp_path):
    placed = {
        name: Instance(block(), quarter_turn(x)) for name, x in (("housing", 0.0), ("rotor", 9.0), ("link", 30.0))
    }
    put = {name: [PlacedPart(name, "above")] for name in placed}
    steps = {"a": put["housing"], "b": put["link"], "c": put["rotor"], "d": put["link"], "e": [PlacedPart("rotor", "")]}
    for folder, left_out in (("with", ""), ("without", "bd")):
        (tmp_path / folder).mkdir()
        shown = {f"{name}.png": parts for name, parts in steps.items() if name not in left_out}
        write_steps(tmp_path / folder, placed, shown)
    c, e = ([(tmp_path / folder / f"{name}.png").read_bytes() for folder in ("with", "without")] for name in "ce")
    assert c[0] != c[1]
    assert e[0] == e[1]


def test_the_picture_has_both_ends_of_the_scale_on_the_body(tmp_path):
    grid = np.stack(np.meshgrid(np.linspace(0, 40, 41), np.linspace(0, 20, 41), indexing="ij"), axis=-1).reshape(-1, 2)
    points = np.column_stack([grid, np.zeros(len(grid))])
    index = np.arange(41 * 41).reshape(41, 41)
    a, b, c, d = index[:-1, :-1].ravel(), index[1:, :-1].ravel(), index[1:, 1:].ravel(), index[:-1, 1:].ravel()
    values = points[:, 0].copy()
    values[0] = 1e6  # one sharp corner
    path = tmp_path / "field.png"
    write_field_picture(path, points, np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])]), values,
                        np.zeros_like(points), "x\nmm")  # fmt: skip
    body = matplotlib.image.imread(path)[:, :1100, :3]
    red, green, blue = body[..., 0], body[..., 1], body[..., 2]
    assert np.mean((red > 0.6) & (green < 0.3) & (blue < 0.3)) > 0.005
    assert np.mean((blue > 0.6) & (red < 0.3)) > 0.005
