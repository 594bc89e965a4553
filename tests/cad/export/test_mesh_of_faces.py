"""A face that the kernel leaves out at one chord is meshed at a finer one; what it never takes is no part."""

import cadquery as cq
import pytest

from tvimdesign.base.errors import GeometryError
from tvimdesign.cad.export import mesh as meshing
from tvimdesign.cad.export.mesh import CHORD, solid_mesh


@pytest.mark.parametrize(("worst", "meshed"), [(CHORD, True), (0.0, False)])
def test_a_face_left_out_is_meshed_at_a_finer_chord(
    worst: float, meshed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    kernel, box = meshing.BRepMesh_IncrementalMesh, cq.Solid.makeBox(3.0, 2.0, 1.0)

    def mesh_below_worst(shape: object, chord: float, *settings: object) -> None:
        if chord < worst:
            kernel(shape, chord, *settings)

    monkeypatch.setattr(meshing, "BRepMesh_IncrementalMesh", mesh_below_worst)
    if meshed:
        assert len(solid_mesh(box).faces) == 12
    else:
        with pytest.raises(GeometryError, match="no triangles"):
            solid_mesh(box)
