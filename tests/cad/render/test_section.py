"""The cut of the section's picture, and the springs that it leaves."""

from __future__ import annotations

from math import cos, pi, radians, sin

import numpy as np
import pytest
import trimesh
from vtkmodules.util.numpy_support import vtk_to_numpy

from tvimdesign.cad.export.mesh import Instance, Mesh
from tvimdesign.cad.render.pictures import _spring_outside, wedge_of


def _upright(azimuth: float, radius: float = 30.0) -> Instance:
    """Return a closed cylinder whose axis stands at an azimuth [deg]."""
    body = trimesh.creation.cylinder(radius=5.0, height=10.0, sections=64)
    matrix = np.eye(4)
    matrix[:2, 3] = radius * cos(radians(azimuth)), radius * sin(radians(azimuth))
    return Instance(Mesh(np.array(body.vertices), np.array(body.faces)), matrix)


@pytest.mark.parametrize(
    ("springs", "polymer", "wedge"),
    [
        ((0.0, 180.0), (135.0, 315.0), (0.0, 135.0)),
        ((180.0,), (315.0,), (180.0, 315.0)),
        ((90.0,), (330.0,), (-30.0, 90.0)),  # the other way round it would be 240 degrees
        ((0.0, 60.0), (30.0, 200.0), (60.0, 200.0)),
    ],
)  # fmt: skip
def test_the_wedge_shows_a_cut_spring_and_cut_polymer(
    springs: tuple[float, ...], polymer: tuple[float, ...], wedge: tuple[float, float]
) -> None:
    placed = {f"spring_right_{i}": _upright(at) for i, at in enumerate(springs)}
    placed |= {f"pcl_arc_{i}": _upright(at) for i, at in enumerate(polymer)}
    first, last = wedge_of(placed)
    assert 0.0 < last - first < pi
    assert np.exp(1j * np.array([first, last])) == pytest.approx(np.exp(1j * np.radians(wedge)), abs=1e-6)


def test_springs_are_halved_whole_or_gone_by_their_place() -> None:
    first, last = 0.0, radians(135.0)
    cut = vtk_to_numpy(_spring_outside(_upright(0.0), first, last).GetPoints().GetData())
    assert cut[:, 1].max() == pytest.approx(0.0, abs=2e-3)
    assert cut[:, 1].min() == pytest.approx(-5.0, abs=1e-2)
    assert _spring_outside(_upright(250.0), first, last).GetNumberOfPolys() == len(_upright(250.0).mesh.faces)
    assert _spring_outside(_upright(70.0), first, last).GetNumberOfPolys() == 0
