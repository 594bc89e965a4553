"""Rows of the model beside those of FE, and the page of a verification."""

import csv
import math
from typing import Any

import pytest
import yaml
from support import ROOT, study_path

from tvimdesign.base.errors import InputError
from tvimdesign.cad.fe import model_comparison as comparison
from tvimdesign.cad.fe.model_comparison import Compared
from tvimdesign.cad.fe.run_solvers import Solved
from tvimdesign.report import verify_design as verify_report
from tvimdesign.report.output.command import Command as OutputCommand
from tvimdesign.report.page.page_file import page_html
from tvimdesign.report.verify_design import far, verified, verify_page
from tvimdesign.simulation.working_cycle.device_functions import resolve_study
from tvimdesign.study import read_study

MODULE = resolve_study(read_study(study_path("paper_reconstructed")))
JOINT = yaml.safe_load((ROOT / "validation/fe_structure/shipped.yaml").read_text())["paper_reconstructed"]["found"]
LINK = yaml.safe_load((ROOT / "validation/fe_link/results.yaml").read_text())["paper_reconstructed_dowelled"]["link"]
with (ROOT / "validation/fe_structure/results.csv").open(newline="") as _file:
    FE_ROWS = {row["quantity"]: row for row in csv.DictReader(_file) if row["study"] == "paper_reconstructed"}


def solved(tmp_path: Any, factor: float = 1.0) -> dict[str, Solved]:
    spring = {"rate": float(FE_ROWS["spring_rate"]["fe"]), "fibre_max": 1.0e3, "bend_mises": 1.0e3}
    joint = {**JOINT, "frequency": 180.0, "foot_across": 5.0, "foot_along": 0.5, "plate_mises": 0.5, "tilt": 3e-4}
    joint["hub"] *= factor
    cost = {"unknowns": 1e5, "seconds": 40.0, "gigabytes": 0.7}
    by_solver = {"joint": {**joint, **cost}, "spring": {**spring, **cost}, "link": {"link": LINK, **cost}}
    by_solver["screws"] = {"friction_radius": 6.0, **cost}
    return {name: Solved(values, values, tmp_path / name) for name, values in by_solver.items()}


def test_the_rows_are_those_that_the_table_of_fe_has(tmp_path):
    rows = {row.name: row for row in comparison.compared(MODULE, solved(tmp_path))}
    for name in ("hub", "core", "plate", "floor", "spring_rate"):
        assert rows[name].ratio == pytest.approx(float(FE_ROWS[name]["ratio"]), abs=0.006), name
    held = float(MODULE.quantity("holding_torque"))
    for name in ("core_stress", "edge_traction"):
        assert rows[name].fe == pytest.approx(float(FE_ROWS[name]["fe"]) * held, rel=2e-3), name
    assert rows["link"].ratio == pytest.approx(1.0, abs=0.03)
    assert 1.0 / rows["link_in_play"].fe == pytest.approx(1.0 / rows["hub"].fe + 1.0 / rows["link"].fe + 3e-4)
    assert {row.mesh_change for row in rows.values()} == {0.0}


def test_screws_feet_and_plate_are_by_statics(tmp_path):
    rows = {row.name: row for row in comparison.compared(MODULE, solved(tmp_path))}
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
    thicker = sum(thick / (thick + fillet - math.sqrt(fillet**2 - left**2)) for left in lefts) / len(lefts)
    above = rows["plate_stress"].model / (math.sqrt(3.0) * shear * thicker * 1e-6)
    assert 1.03 < above < 1.03 * 1.75
    assert rows["plate_stress"].fe == pytest.approx(0.5 * held)


def test_vanes_cup_the_plate_they_hang_from():
    module = resolve_study(read_study(study_path("machined_compression")))
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


def test_screws_bear_what_friction_leaves(tmp_path):
    by_solver = solved(tmp_path)
    for values in (by_solver["joint"].fine, by_solver["joint"].coarse):
        values["foot_across"] = 9.0
    rows = {row.name: row for row in comparison.compared(MODULE, by_solver)}
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


def test_the_worst_comes_first(tmp_path):
    rows = comparison.compared(MODULE, solved(tmp_path, factor=3.0))
    assert [abs(math.log(row.ratio)) for row in rows] == sorted((abs(math.log(r.ratio)) for r in rows), reverse=True)
    assert "hub" in verify_report.summary(rows)
    assert len(verify_report.rows_grid(verify_report.verified(rows, {})).rows) == len(rows)
    table = verify_report.table_csv(rows).splitlines()
    assert len(table) == 1 + len(rows)


def test_rigid_modules_in_a_vane_are_refused_by_name():
    for name in ("elbow_printed", "elbow_machined"):  # with a liner
        comparison.refuse_other_parts(resolve_study(read_study(study_path(name))))
    vanes = ROOT / "validation/fe_structure/studies/rigid_modules_compression.yaml"
    with pytest.raises(InputError, match="heater_form is rigid"):
        comparison.refuse_other_parts(resolve_study(read_study(vanes)))


PIXEL = bytes.fromhex(
    "89504e470d0a1a0a0000000d4948445200000001000000010806000000"
    "1f15c4890000000d49444154789c6360000002000001e221bc330000000049454e44ae426082"
)


def test_rows_pictures_and_solvers_are_on_the_page_worst_first(tmp_path):
    rows = [
        Compared("core", "N*m/rad", "core of the rotor", model=87.0, fe=100.0, coarse=102.0),
        Compared("hub", "N*m/rad", "frozen joint", model=500.0, fe=505.0, coarse=505.0),
    ]
    solved = {
        name: Solved({"unknowns": 2e4, "seconds": 33.0, "gigabytes": 0.7}, {}, tmp_path) for name in ("joint", "link")
    }
    with OutputCommand(tmp_path / "out") as command:
        command.folder.write("joint.png", PIXEL)
        page = verify_page(command, "Wrist", verified(rows, solved), rows)
        text = page_html(page).decode()
    assert page.status == "1 OF 2 BEYOND 10 %"
    assert page.tone == "warn"
    assert text.index("core</") < text.index("hub</")
    assert "0.870" in text
    assert "-2.0" in text
    assert text.count("data:image/png") == 1
    assert "Stress in the frozen joint" in text
    assert "20000" in text
    rows = [
        Compared(f"of_{model:g}", "s", "", model=model, fe=100.0, coarse=100.0) for model in (89.0, 91.0, 109.0, 110.5)
    ]
    assert far(rows) == ["of_89", "of_110.5"]
