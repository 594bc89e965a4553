"""The process that makes parts: how it loads the kernel, what it starts first, and its mass properties."""

import os
import subprocess
import sys

import cadquery as cq
import numpy as np
import psutil
import pytest
import trimesh
from cad_designs import design_of

from tvimdesign.cad.export.mesh import solid_mesh
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.jobs.build_plan import PICTURES, build_plan
from tvimdesign.cad.jobs.rigid_bodies import of_solid, together
from tvimdesign.cad.jobs.worker import Turn
from tvimdesign.cad.make import PartsProcess

CODE = """
import sys

import pytest
from tvimdesign.cad.make import load_kernel
load_kernel()
import cadquery
few = sum(name.startswith("vtkmodules.") for name in sys.modules)
assert cadquery.Solid.makeBox(1, 2, 3).Volume() > 5.9
assert "vtk" not in sys.modules
import vtk
print(few, sum(name.startswith("vtkmodules.") for name in sys.modules), vtk.vtkVersion().GetVTKMajorVersion())
"""


@pytest.mark.gate
def test_vtk_is_not_loaded_whole_with_the_kernel_and_can_be_afterwards():
    counts = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, check=True).stdout
    few, whole, version = (int(word) for word in counts.split())
    assert few < 0.4 * whole
    assert version >= 9


def test_a_worker_that_is_never_given_a_job_ends_with_its_owner():
    with PartsProcess() as waiting:
        process = psutil.Process(waiting.process)
        assert process.is_running()
    assert not process.is_running()


def test_small_parts_come_first_then_pictures_then_makers_files():
    plan = build_plan(dimensions(design_of("paper", {})))
    assert plan[0].name == PICTURES
    assert plan[0].turn is Turn.FIRST
    makers = {work.name for work in plan if work.turn is Turn.LATE}
    assert makers == {f"{name}_for_makers" for name in ("heater", "housing", "link", "pcl_arc", "retainer", "rotor")}
    kinds = set(plan[0].needs)
    order = [work.name for work in sorted(plan, key=lambda work: work.turn) if not work.needs]
    assert order[0] == "housing"
    assert order[1] not in {"housing", "rotor"}
    assert set(order[: len(kinds)]) == kinds  # all others wait for the parts
    assert order[len(kinds) - 1] == "rotor"
    plan = build_plan(dimensions(design_of("toy", {})))
    needed = {name for work in plan for name in work.needs if work.name != "plates"}
    late = {work.name for work in plan if work.turn is Turn.LATE}
    assert late.isdisjoint(needed)
    assert {f"{kind}_for_makers" for kind in ("housing", "rotor", "link")} <= late


@pytest.mark.skipif(not hasattr(os, "getsid"), reason="Windows has no sessions")
def test_parts_are_made_in_the_run_s_session():
    with PartsProcess() as waiting:
        assert os.getsid(waiting.process) == os.getsid(0)
        assert os.getpgid(waiting.process) == waiting.process  # an interrupt at the terminal is the parent's to handle


DENSITY = 1270.0


def test_inertias_are_the_textbook_s_and_halves_make_the_whole():
    properties = of_solid(cq.Solid.makeBox(30.0, 20.0, 10.0, cq.Vector(5.0, 0.0, 0.0)), DENSITY)
    mass, (a, b, c) = DENSITY * 6e-6, (0.03, 0.02, 0.01)
    assert properties.mass == pytest.approx(mass)
    np.testing.assert_allclose(properties.centre, [0.02, 0.01, 0.005])
    np.testing.assert_allclose(
        properties.inertia, np.diag([b**2 + c**2, a**2 + c**2, a**2 + b**2]) * mass / 12.0, atol=1e-15
    )
    properties, mesh = of_solid(_wedge(), DENSITY), solid_mesh(_wedge())
    body = trimesh.Trimesh(mesh.vertices * 1e-3, mesh.faces)
    body.density = DENSITY
    assert properties.mass == pytest.approx(body.mass, rel=1e-6)
    np.testing.assert_allclose(properties.centre, body.center_mass, rtol=1e-6)
    np.testing.assert_allclose(properties.inertia, body.moment_inertia, rtol=1e-6)
    assert np.all(np.abs(properties.inertia) > 1e-11)
    halves = [cq.Solid.makeBox(15.0, 20.0, 10.0, cq.Vector(at, 3.0, -4.0)) for at in (0.0, 15.0)]
    whole = of_solid(cq.Solid.makeBox(30.0, 20.0, 10.0, cq.Vector(0.0, 3.0, -4.0)), DENSITY)
    properties = together(of_solid(half, DENSITY) for half in halves)
    assert properties.mass == pytest.approx(whole.mass)
    np.testing.assert_allclose(properties.centre, whole.centre)
    np.testing.assert_allclose(properties.inertia, whole.inertia, atol=1e-15)


def _wedge() -> cq.Solid:
    """Return a body without any symmetry, so that every product of inertia counts."""
    return cq.Workplane().polyline([(0, 0), (30, 4), (6, 22)]).close().extrude(9.0).edges(">Z").chamfer(1.0).val()
