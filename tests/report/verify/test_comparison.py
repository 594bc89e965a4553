"""Rows of the model beside those of FE, and the joint by temperatures of its parts."""

import csv
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from support import ROOT

from tvimdesign.base.errors import InputError
from tvimdesign.cad.fe import model_comparison as comparison
from tvimdesign.cad.fe.run_solvers import Solved
from tvimdesign.cad.fe.warm_joint import WarmJoint, softening_time
from tvimdesign.report import verification_tables as verify_report
from tvimdesign.report import verify_design
from tvimdesign.simulation.working_cycle.resolved_module import resolve_study
from tvimdesign.study import read_study

MODULE = resolve_study(read_study(ROOT / "studies/paper_reconstructed.yaml"))
JOINT = yaml.safe_load((ROOT / "validation/fe_structure/shipped.yaml").read_text())["paper_reconstructed"]["found"]
LINK = yaml.safe_load((ROOT / "validation/fe_link/results.yaml").read_text())["paper_reconstructed_dowelled"]["link"]
with (ROOT / "validation/fe_structure/results.csv").open(newline="") as _file:
    KEPT = {row["quantity"]: row for row in csv.DictReader(_file) if row["study"] == "paper_reconstructed"}

TIMES = {"softening_time": math.inf, "mean_time": 55.0, "far_face_time": 80.0}


def solved(tmp_path: Any, factor: float = 1.0) -> dict[str, Solved]:
    spring = {"rate": float(KEPT["spring_rate"]["fe"]), "fibre_max": 1.0e3, "bend_mises": 1.0e3}
    joint = {**JOINT, "frequency": 180.0, "foot_across": 5.0, "foot_along": 0.5, "plate_mises": 0.5}
    joint["hub"] *= factor
    told = {"unknowns": 1e5, "seconds": 40.0, "gigabytes": 0.7}
    found = {"joint": {**joint, **told}, "spring": {**spring, **told}, "link": {"link": LINK, **told}}
    found |= {"screws": {"friction_radius": 6.0, **told}, "heat": {"mean_time": 50.0, "softening_time": 30.0, **told}}
    return {name: Solved(one, one, tmp_path / name) for name, one in found.items()}


def test_the_rows_are_those_that_the_table_of_fe_has(tmp_path: Any) -> None:
    rows = {row.name: row for row in comparison.compared(MODULE, solved(tmp_path), TIMES)}
    for name in ("hub", "core", "plate", "floor", "spring_rate"):
        assert rows[name].ratio == pytest.approx(float(KEPT[name]["ratio"]), abs=0.006), name
    held = float(MODULE.quantity("holding_torque"))
    for name in ("core_stress", "edge_traction"):
        assert rows[name].fe == pytest.approx(float(KEPT[name]["fe"]) * held, rel=2e-3), name
    assert rows["link"].ratio == pytest.approx(1.0, abs=0.03)
    assert {row.mesh_change for row in rows.values()} == {0.0}


def test_screws_feet_and_plate_are_by_statics(tmp_path: Any) -> None:
    rows = {row.name: row for row in comparison.compared(MODULE, solved(tmp_path), TIMES)}
    # n mu F r with four screws of 3 mm at 55 MPa, friction 0.2; FE at the radius it found.
    force = 55e6 * math.pi / 4.0 * 0.003**2
    assert rows["link_friction_torque"].fe == pytest.approx(4 * 0.2 * force * 6.0e-3, rel=1e-6)
    held = float(MODULE.quantity("holding_torque"))
    assert rows["foot_force"].model == pytest.approx(held / (4 * 0.057), rel=1e-6)
    assert rows["foot_force"].fe == pytest.approx(5.0 * held)
    # All of the torque goes through each cylinder of the plate: tau = T/(2 pi r^2 h), by quadrature over a millimetre.
    held, core, thick = (float(MODULE.quantity(name)) for name in ("holding_torque", "core_radius", "rotor_thickness"))
    radii = [core + (i + 0.5) * 1e-5 for i in range(100)]
    shear = sum(held / (2.0 * math.pi * r**2 * thick) for r in radii) / len(radii)
    # Its fillet of 1.5 mm bears with it over that millimetre, by the same quadrature; what FE has above that is fitted.
    fillet = float(MODULE.table.evaluate(comparison._drawn(MODULE), ["foot_fillet"])["foot_fillet"])
    lefts = [max(fillet - (r - core), 0.0) for r in radii]
    thicker = sum(thick / (thick + fillet - math.sqrt(fillet**2 - one**2)) for one in lefts) / len(lefts)
    above = rows["plate_stress"].model / (math.sqrt(3.0) * shear * thicker * 1e-6)
    assert 1.03 < above < 1.03 * 1.75
    assert rows["plate_stress"].fe == pytest.approx(0.5 * held)


def test_vanes_cup_the_plate_they_hang_from() -> None:
    module = resolve_study(read_study(ROOT / "studies/machined_compression.yaml"))
    thick, core, arm, lean = (
        float(value) for value in (module.values["rotor_thickness"], module.values["core_radius"],
                                   module.quantity("block_between").arm, module.quantity("block_lean_out"))
    )  # fmt: skip
    # A moment M = F a sin x of each of n vanes, F = T/(n r), over the circumference; sheared and bent, by quadrature.
    radius = float(module.quantity("vanes_plate").radius)
    moment = arm * math.sin(lean) / radius / (2.0 * math.pi * (core + 5e-4))
    bent, shear = 6.0 * moment / thick**2, math.sqrt(3.0) / (2.0 * math.pi * thick * core * (core + 1e-3))
    mean = sum(math.hypot(shear, bent * (i + 0.5) / 1000) for i in range(1000)) / 1000
    assert bent > 0.2 * shear
    assert comparison._mean_plate_stress(module, thick, core) == pytest.approx(mean, rel=1e-5)


def test_screws_bear_what_friction_leaves(tmp_path: Any) -> None:
    found = solved(tmp_path)
    for one in (found["joint"].found, found["joint"].coarse):
        one["foot_across"] = 9.0
    rows = {row.name: row for row in comparison.compared(MODULE, found, TIMES)}
    held = float(MODULE.quantity("holding_torque"))
    # M3: 5.03 mm2 and 2.53 mm (ISO 898-1), tightened to 55 MPa over 7.07 mm2. Half of the thread's twist stays, by the
    # friction of thread and head for which the nut factor is 0.2 (VDI 2230-1:2015).
    force = 55.0 * 7.069
    along, across = force + 0.5 * held, 9.0 * held - 0.2 * force
    assert across > 0.0
    head = 0.5 * (5.5 + 3.4)
    friction = (0.2 * 3.0 - 0.16 * 0.5) / (0.58 * 2.675 + 0.5 * head)
    twist = 16.0 * force * (0.16 * 0.5 + 0.58 * 2.675 * friction) / (math.pi * 2.531**3)
    expected = math.sqrt((along / 5.03) ** 2 + 3.0 * (0.5 * twist + across / 5.03) ** 2)
    assert rows["foot_screw_stress"].fe == pytest.approx(expected, rel=3e-3)
    pins = float(MODULE.quantity("link_dowel_circle_radius")) * float(MODULE.values["link_dowel_count"])
    left = held - 4 * 0.2 * 55e6 * math.pi / 4.0 * 0.003**2 * 6.0e-3
    section = math.pi / 4.0 * float(MODULE.values["link_dowel_diameter"]) ** 2
    assert rows["link_pin_shear"].fe == pytest.approx(left / pins / section * 1e-6, rel=1e-6)


def test_the_worst_comes_first_and_what_did_not_come_is_none(tmp_path: Any) -> None:
    names = {row.name for row in comparison.compared(MODULE, solved(tmp_path), TIMES)}
    assert names & set(comparison.TIMES) == {"mean_time"}
    # `machined_compression` is not soft by FE: JSON has no word for infinity.
    heat = Solved({"softening_time": math.inf, "mean_time": 3.0}, {"softening_time": math.inf}, Path())
    told = json.loads(json.dumps(verify_report.verified([], {"heat": heat}), allow_nan=False))
    assert told["solved"]["heat"] == {
        "fine": {"softening_time": None, "mean_time": 3.0},
        "coarse": {"softening_time": None},
    }
    rows = comparison.compared(MODULE, solved(tmp_path, factor=3.0), TIMES)
    assert [abs(math.log(row.ratio)) for row in rows] == sorted((abs(math.log(r.ratio)) for r in rows), reverse=True)
    assert "hub" in verify_report.summary(rows)
    assert len(verify_report.rows_grid(verify_report.verified(rows, {})).rows) == len(rows)
    table = verify_report.table_csv(rows).splitlines()
    assert len(table) == 1 + len(rows)


def test_liners_and_rigid_modules_in_a_vane_are_refused_by_name() -> None:
    study = read_study(ROOT / "studies/wrist_joint.yaml")
    lined = study.model_copy(update={"module": {**study.module, "liner_material": "peek"}})
    with pytest.raises(InputError, match="liner_material is peek"):
        verify_design.refuse_other_parts(resolve_study(lined))
    verify_design.refuse_other_parts(resolve_study(read_study(ROOT / "studies/elbow_printed.yaml")))
    vanes = ROOT / "validation/fe_structure/studies/rigid_modules_compression.yaml"
    with pytest.raises(InputError, match="heater_form is rigid"):
        verify_design.refuse_other_parts(resolve_study(read_study(vanes)))


NAMES = ("paper_reconstructed", "paper_compression")


def joint_of(name: str) -> WarmJoint:
    module = resolve_study(read_study(ROOT / f"studies/{name}.yaml"))
    return WarmJoint(module.table, module.values)


@pytest.mark.parametrize("name", NAMES)
def test_alike_columns_are_one_and_molten_ones_are_soft(name: str) -> None:
    joint = joint_of(name)
    parts = joint.parts(23.0, 23.0, np.full(8, 23.0), 100.0, 23.0)
    one = joint.stiffness(np.full((1, 4), 100.0), np.ones(1), np.full(4, 0.25), parts)
    many = joint.stiffness(np.full((3, 8), 100.0), np.array([0.2, 0.3, 0.5]), np.full(8, 0.125), parts)
    assert many == pytest.approx(one, rel=1e-12)
    parts = joint.parts(23.0, 23.0, np.full(8, 23.0), 23.0, 23.0)
    alone = float(joint.quantity["spring_stiffness"])
    frozen, molten = (joint.stiffness(np.full((1, 4), at), np.ones(1), np.full(4, 0.25), parts) for at in (23.0, 120.0))
    held = 1.0 / sum(joint.quantity["structure_compliances"]) if name == NAMES[0] else frozen
    assert frozen == pytest.approx(alone + held, rel=0.05)
    assert alone < molten < 0.2 * frozen


def test_a_molten_film_is_in_series_and_uneven_blocks_are_refused() -> None:
    joint = joint_of(NAMES[0])
    parts = joint.parts(23.0, 23.0, np.full(8, 23.0), 23.0, 23.0)
    shares, slices = np.ones(1), np.array([0.1, 0.9])
    alone = float(joint.quantity["spring_stiffness"])
    whole, film = (joint.stiffness(np.array([[120.0, other]]), shares, slices, parts) for other in (120.0, 23.0))
    # Ten times as stiff as the whole layer molten, but for what structure and frozen rest give.
    assert film - alone == pytest.approx(10.0 * (whole - alone), rel=0.15)
    # `block.soft_share` counts slices: thin ones in the melt would make more of it than there is.
    joint = joint_of(NAMES[1])
    parts = joint.parts(23.0, 23.0, np.full(8, 23.0), 23.0, 23.0)
    with pytest.raises(ValueError, match="alike"):
        joint.stiffness(np.full((1, 2), 100.0), np.ones(1), np.array([0.1, 0.9]), parts)


def test_the_time_is_where_the_stiffness_passes_its_limit() -> None:
    joint = joint_of(NAMES[0])
    times, celsius = np.linspace(0.0, 100.0, 201), np.linspace(22.0, 122.0, 201)
    course = {
        "times": times, "columns": celsius[:, None, None] * np.ones((1, 2, 4)), "shares": np.full(2, 0.5),
        "slices": np.full(4, 0.25), "core": np.full(201, 23.0), "edge": np.full(201, 23.0),
        "plate": np.full((201, 8), 23.0), "hot": celsius, "cold": np.full(201, 23.0),
    }  # fmt: skip
    found = softening_time(joint, course)
    at = np.full((2, 4), np.interp(found, times, celsius))
    parts = joint.parts(23.0, 23.0, np.full(8, 23.0), float(at[0, 0]), 23.0)
    assert joint.stiffness(at, course["shares"], course["slices"], parts) == pytest.approx(joint.soft, rel=2e-3)
    cold = {**course, "columns": np.full((201, 2, 4), 22.0)}
    assert softening_time(joint, cold) == np.inf
