"""Solvers by finite elements: their process, the path of a load, and the surface around a foot."""

import sys
from pathlib import Path

import foot_surface
import numpy as np
import pytest

from tvimdesign.base.errors import InputError, SimulationError
from tvimdesign.cad.fe import run_solvers


def python_that(tmp_path: Path, does: str) -> str:
    """Return a stand-in for an interpreter."""
    fake = tmp_path / "python"
    fake.write_text(f"#!{sys.executable}\n{does}\n")
    fake.chmod(0o755)
    return str(fake)


def test_solvers_are_run_on_both_meshes_or_refused(tmp_path):
    with pytest.raises(InputError, match=r"tvimdesign\[fe\].*--fe-python"):
        run_solvers.require_fe(python_that(tmp_path, "raise SystemExit(1)"))
    with pytest.raises(InputError, match="there is no such program"):
        run_solvers.require_fe(str(tmp_path / "none"))
    python = python_that(
        tmp_path,
        "import json, sys; from pathlib import Path\n"
        "Path(sys.argv[3]).write_text(json.dumps({'link': float(sys.argv[5]), 'field': float('--field' in sys.argv)}))",
    )
    messages: list[str] = []
    results = run_solvers.run_solvers(["link", "joint"], tmp_path, tmp_path, python, messages.append)
    assert results["link"].fine == {"link": 1.0, "field": 1.0}
    assert results["joint"].coarse == {"link": run_solvers.COARSER, "field": 0.0}
    assert len(messages) == 4


@pytest.mark.parametrize("does", ["print('NOT ALL FACES'); import sys", "raise SystemExit('no mesh')"])
def test_a_solver_that_fails_is_named(tmp_path, does):
    with pytest.raises(SimulationError, match=r"verify: link, (fine|coarse) mesh: (no mesh|NOT ALL FACES)"):
        run_solvers.run_solvers(["link"], tmp_path, tmp_path, python_that(tmp_path, does), lambda _: None)


def test_stress_is_read_beside_feet_and_along_fillets_at_each_angle():
    radius, height = foot_surface.places(10.0, 0.0)
    assert radius == pytest.approx(9.98)
    assert (height[0], height[-1]) == pytest.approx((0.025, 0.975))
    along = np.zeros((40, 2))
    along[5:25, 0], along[10:20, 1] = 3.0, 4.0
    assert foot_surface.highest_mean(along) == pytest.approx([3.0, 2.0])


@pytest.mark.parametrize("fillet", [0.1, 0.9, 1.5])
def test_along_a_fillet_it_stays_just_below_the_surface(fillet):
    radius, height = foot_surface.places(10.0, fillet)
    on_fillet = height < fillet
    centre = np.hypot(radius - 10.0 - fillet, height - fillet)
    assert centre[on_fillet] == pytest.approx(fillet + 0.02)
    assert radius[~on_fillet] == pytest.approx(9.98)
    assert height[0] > 0.2 * fillet  # from the middle on, (1 - cos 45 degrees) q
    assert len(radius) == round(20 * (1.0 + fillet))
