"""Currents that a study gives over time: how they are read, and that the module follows them."""

from pathlib import Path

import pytest
from support import Command

from tvimdesign.solve.result import answer
from tvimdesign.study import Study, read_study_text

MODULE = """
mode: shear
module: {current: 1.5 A, cooling_current: 0.3 A}
tolerances: {current: {plus_minus: 5 %}, pcl_thickness: {plus_minus: 0.05 mm}}

solver: {cells: 8}
"""


def study(currents: str) -> Study:
    return read_study_text(f"{MODULE}currents: {currents}", "given", Path())


def test_a_given_current_that_does_not_change_is_the_constant_one() -> None:
    """Compare with constant currents, which are inputs of their own: the two ways share only the integrator."""
    flat = "{softening: {moments: [0 s, 5 s], currents: [1.5 A, 1500 mA]},"
    flat += " stiffening: {moments: [0 s, 1 min], currents: [-0.3 A, -0.3 A]}}"
    given = answer(study(flat)).design.values
    constant = answer(read_study_text(MODULE, "constant", Path())).design.values
    assert given["response_time"] == pytest.approx(constant["response_time"], rel=1e-5)
    assert given["stiffening_energy"] == pytest.approx(constant["stiffening_energy"], rel=1e-4)


def test_the_module_follows_it() -> None:
    """Energy is the integral of power, so twice the current from the middle on heats sooner; none never heats."""
    later = answer(study("{softening: {moments: [0 s, 20 s, 21 s], currents: [1.5 A, 1.5 A, 2.5 A]}}")).design
    assert later.values["response_time"] < answer(read_study_text(MODULE, "c", Path())).design.values["response_time"]
    never = answer(study("{softening: {moments: [0 s, 1 s], currents: [0 A, 0 A]}}")).design
    assert never.values["response_time"] == float("inf")
    assert never.current_profiles == {"softening": {"moments": [0.0, 1.0], "currents": [0.0, 0.0]}}


def test_tolerate_leaves_out_the_constant_current_that_a_profile_replaces(tvimdesign: Command, tmp_path: Path) -> None:
    (tmp_path / "given.yaml").write_text(
        MODULE + "require: {holding_torque: '>= 1 N.m'}\n"
        "currents: {softening: {moments: [0 s, 5 s], currents: [1 A, 1.5 A]}}\n"
    )
    words = ["--out", tmp_path / "spread", "--samples", "256"]
    done = tvimdesign("tolerate", tmp_path / "given.yaml", *words)
    assert done.returncode == 0, done.stderr
    named = (tmp_path / "spread/contributors.csv").read_text()
    assert "pcl_thickness" in named
    assert ",current," not in named
