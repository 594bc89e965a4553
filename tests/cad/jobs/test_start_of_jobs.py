"""The process that makes parts: how it loads the kernel, and which pieces of work it starts first."""

import os
import subprocess
import sys

import psutil
import pytest
from cad_designs import design_of

from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.jobs.build_plan import PICTURES, build_plan
from tvimdesign.cad.jobs.worker import Turn
from tvimdesign.cad.make import PartsProcess

CODE = """
import sys

import pytest
from tvimdesign.cad.jobs.main import load_kernel
load_kernel()
import cadquery
few = sum(name.startswith("vtkmodules.") for name in sys.modules)
assert cadquery.Solid.makeBox(1, 2, 3).Volume() > 5.9
assert "vtk" not in sys.modules
import vtk
print(few, sum(name.startswith("vtkmodules.") for name in sys.modules), vtk.vtkVersion().GetVTKMajorVersion())
"""


@pytest.mark.gate
def test_vtk_is_not_loaded_whole_with_the_kernel_and_can_be_afterwards() -> None:
    said = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, check=True).stdout
    few, whole, version = (int(word) for word in said.split())
    assert few < 0.4 * whole
    assert version >= 9


def test_a_process_that_is_never_told_what_to_make_is_gone_with_its_owner() -> None:
    with PartsProcess() as waiting:
        process = psutil.Process(waiting.process)
        assert process.is_running()
    assert not process.is_running()


def test_small_parts_come_first_then_pictures_then_makers_files() -> None:
    plan = build_plan(dimensions(design_of("paper", {})))
    assert plan[0].name == PICTURES
    assert plan[0].turn is Turn.FIRST
    makers = {work.name for work in plan if work.turn is Turn.LATE}
    assert makers == {f"{name}_for_makers" for name in plan[0].needs}
    kinds = set(plan[0].needs)
    begun = [work.name for work in sorted(plan, key=lambda work: work.turn) if not work.needs]
    assert begun[0] == "housing"
    assert begun[1] not in {"housing", "rotor"}
    assert set(begun[: len(kinds)]) == kinds  # all others wait for the parts
    assert begun[len(kinds) - 1] == "rotor"
    plan = build_plan(dimensions(design_of("toy", {})))
    needed = {name for work in plan for name in work.needs}
    late = {work.name for work in plan if work.turn is Turn.LATE}
    assert late.isdisjoint(needed)
    assert {f"{kind}_for_makers" for kind in ("housing", "rotor", "link")} <= late


@pytest.mark.skipif(not hasattr(os, "getsid"), reason="Windows has no sessions")
def test_parts_are_made_in_the_run_s_session() -> None:
    with PartsProcess() as waiting:
        assert os.getsid(waiting.process) == os.getsid(0)
        assert os.getpgid(waiting.process) == waiting.process  # an interrupt at the terminal is the parent's to handle
