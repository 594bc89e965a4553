"""Bodies of the drawn solids: as heavy and as inert as the table says, and their meshes where the parts are."""

from __future__ import annotations

from pathlib import Path

import pytest
import trimesh
from cad_designs import CASES, design_of, whole

from tvimdesign.report.robot.joint_model import make_bodies
from tvimdesign.study.design import write_design


@pytest.mark.slow
@pytest.mark.parametrize("case", ["paper", "blocks", "bearings"])
def test_the_bodies_have_the_table_s_mass_and_inertia(case: str, tmp_path: Path) -> None:
    mode, overrides = CASES[case]
    design = whole(design_of(case, overrides, mode))
    base, moving, report = make_bodies(write_design(design, tmp_path / "design.json"), tmp_path)
    assert not report.failed
    assert base.mass + moving.mass == pytest.approx(design.value("module_mass"), rel=1e-5)
    assert moving.about_axis() == pytest.approx(design.value("parts_inertia"), rel=1e-5)
    for body in (base, moving):
        mesh = trimesh.load(tmp_path / body.mesh)
        assert (tmp_path / body.mesh).stat().st_size < 2e6
        assert all(low < at < high for low, at, high in zip(mesh.bounds[0], body.centre, mesh.bounds[1], strict=True))
        assert max(abs(mesh.bounds[:, :2].ravel())) <= 0.5 * design.value("envelope_diameter") * 1.001
