"""Way of the frozen torque from the ground to the link's end of the core, by FE of the drawn parts as they are now.

`FE_PYTHON` names a Python that has netgen and ngsolve; without it these tests are skipped.
"""

from __future__ import annotations

import os

import pytest
from support import study_path

from tvimdesign.cad.fe.model_comparison import joint_rows, model_values
from tvimdesign.cad.fe.run_solvers import export_parts, run_solvers
from tvimdesign.simulation.working_cycle.device_functions import resolve_design
from tvimdesign.solve.result import answer
from tvimdesign.study import read_study

SOLVER = os.environ.get("FE_PYTHON", "")
WITHIN = {"hub": 0.10, "floor": 0.10, "plate": 0.10, "core": 0.10, "seat_traction": 0.15, "core_stress": 0.15}
"""Shares by which stiffness and stress may differ."""


@pytest.mark.slow
@pytest.mark.skipif(not SOLVER, reason="FE_PYTHON names no Python with netgen and ngsolve")
@pytest.mark.parametrize("study", ["elbow_printed", "elbow_machined"])
def test_the_way_of_the_torque_is_as_stiff_and_stressed_as_by_fe(study, tmp_path):
    design = answer(read_study(study_path(study))).design
    export_parts(design, tmp_path / "parts")
    by_fe = joint_rows(run_solvers(("joint",), tmp_path / "parts", tmp_path, SOLVER, print)["joint"].fine)
    by_model = model_values(resolve_design(design))
    for name, share in WITHIN.items():
        assert by_model[name] == pytest.approx(by_fe[name], rel=share), name
