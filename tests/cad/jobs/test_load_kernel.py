"""The CAD kernel is loaded without what nothing here needs, and who wants that afterwards gets it."""

import subprocess
import sys

import pytest

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
