"""Rows of the model beside those of FE: the published module, with what FE found of its exported parts."""

from __future__ import annotations

import csv
import math
from typing import Any

import pytest
import yaml
from support import ROOT

from tvimdesign.base.errors import InputError
from tvimdesign.cad.fe.run_solvers import Solved
from tvimdesign.report.verify import comparison, verify_design
from tvimdesign.simulation.working_cycle.resolved_module import resolve_study
from tvimdesign.study import read_study

MODULE = resolve_study(read_study(ROOT / "studies/paper_as_published.yaml"))
JOINT = yaml.safe_load((ROOT / "validation/fe_structure/shipped.yaml").read_text())["paper_as_published"]["found"]
LINK = yaml.safe_load((ROOT / "validation/fe_link/results.yaml").read_text())["paper_as_published_dowelled"]["link"]
with (ROOT / "validation/fe_structure/results.csv").open(newline="") as _file:
    KEPT = {row["quantity"]: row for row in csv.DictReader(_file) if row["study"] == "paper_as_published"}


def solved(tmp_path: Any, factor: float = 1.0) -> dict[str, Solved]:
    spring = {"rate": float(KEPT["spring_rate"]["fe"]), "fibre_max": 1.0e3, "bend_mises": 1.0e3}
    joint = {**JOINT, "swung": 10.0}
    joint["hub"] *= factor
    told = {"unknowns": 1e5, "seconds": 40.0, "gigabytes": 0.7}
    found = {"joint": {**joint, **told}, "spring": {**spring, **told}, "link": {"link": LINK, **told}}
    return {name: Solved(one, one, tmp_path / name) for name, one in found.items()}


def test_the_rows_are_those_that_the_table_of_fe_has(tmp_path: Any) -> None:
    rows = {row.name: row for row in comparison.compared(MODULE, solved(tmp_path))}
    for name in ("hub", "core", "plate", "floor", "spring_rate"):
        assert rows[name].ratio == pytest.approx(float(KEPT[name]["ratio"]), abs=0.006), name
    held = float(MODULE.quantity("holding_torque"))
    for name in ("core_stress", "edge_traction"):
        assert rows[name].fe == pytest.approx(float(KEPT[name]["fe"]) * held, rel=2e-3), name
    assert rows["link"].ratio == pytest.approx(1.0, abs=0.03)
    assert {row.mesh_change for row in rows.values()} == {0.0}


def test_the_natural_frequency_is_that_of_an_oscillator(tmp_path: Any) -> None:
    row = next(one for one in comparison.compared(MODULE, solved(tmp_path)) if one.name == "natural_frequency")
    stiffness = float(MODULE.quantity("spring_stiffness")) + JOINT["hub"]
    inertia = MODULE.values["moving_inertia"] - float(MODULE.quantity("rotor_inertia")) + 10e-6
    assert row.fe == pytest.approx(math.sqrt(stiffness / inertia) / (2.0 * math.pi), rel=0.02)


def test_the_worst_comes_first_and_is_named(tmp_path: Any) -> None:
    rows = comparison.compared(MODULE, solved(tmp_path, factor=3.0))
    assert [abs(math.log(row.ratio)) for row in rows] == sorted((abs(math.log(r.ratio)) for r in rows), reverse=True)
    assert "hub" in verify_design.summary(rows)
    page = verify_design.page("x", rows, solved(tmp_path), pictures=True)
    assert page.count("\n| ") == 2 + len(rows) + 3
    assert "![joint](joint.png)" in page
    table = verify_design.table_csv(rows).splitlines()
    assert len(table) == 1 + len(rows)


@pytest.mark.parametrize(("study", "drawn"), [("rigid_modules", True), ("rigid_modules_compression", False)])
def test_rigid_modules_are_refused_in_a_vane_alone(study: str, drawn: bool) -> None:
    module = resolve_study(read_study(ROOT / f"studies/{study}.yaml"))
    if drawn:
        verify_design.refuse_other_parts(module)
        return
    with pytest.raises(InputError, match="heater_form is rigid"):
        verify_design.refuse_other_parts(module)
