"""Rigid modules and stock springs are searched whole: the best of a list is the best of each alone."""

from pathlib import Path

import pytest

from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.search import optimize
from tvimdesign.study import read_study, read_study_text

MODULES = ("cp30138", "qc_17", "ma10_063_05_1")
STUDY = """
mode: compression
module:
  process: print_pei_1010
  wire_diameter: 2 mm
  coil_diameter: 12 mm
  coil_count: 10.6
  rotor_rim: 4 mm
  CHOSEN
vary:
  LISTED
  vane_count: {from: 3, to: 4}
  pcl_inner_radius: {from: 13 mm, to: 24 mm, start: 16 mm}
  pcl_outer_radius: {from: 26 mm, to: 44 mm, start: 38 mm}
  block_height: {from: 9 mm, to: 15.6 mm, start: 15.3 mm}
  block_depth: [4 mm, 8 mm]
  vane_thickness: [3 mm, 8 mm]
  spreader_thickness: [0.5 mm, 2 mm]
require:
  holding_torque: ">= 8 N.m"
minimize: {module_mass: 1}
solver: {starts: 1, cells: 6, fineness: 0.67}
"""


def solved(chosen: str, listed: str) -> Solution:
    text = STUDY.replace("  CHOSEN\n", f"  {chosen}\n" if chosen else "").replace("  LISTED\n", listed)
    return optimize(read_study_text(text, "a test"), lambda _: None)


@pytest.mark.slow
def test_the_best_module_of_a_list_is_the_best_of_each_alone() -> None:
    best = solved("", f"  peltier_module: {{choose: [{', '.join(MODULES)}]}}\n")
    alone = {name: solved(f"peltier_module: {name}", "") for name in MODULES}
    masses = {name: one.values["module_mass"] for name, one in alone.items() if one.feasible}
    assert len(masses) == 3
    lightest = min(masses, key=masses.__getitem__)
    assert best.feasible
    assert best.values["module_mass"] == pytest.approx(masses[lightest], rel=1e-5)
    assert best.values["heater_count"] == alone[lightest].values["heater_count"]


# Springs of the paper's size, as a maker might list them: d, D, coils.
SPRINGS = {"soft": (2.3, 24.0, 4.25), "middle": (2.4, 24.0, 3.25), "strong": (2.6, 26.0, 3.25)}
SPRING_STUDY = """
mode: shear
catalog: records
CHOSEN
vary:
  LISTED
  pcl_thickness: [0.6 mm, 2 mm]
  pcl_outer_radius: [32 mm, 40 mm]
  current: [0.5 A, 2 A]
  pin_radius_ratio: [0.3, 0.8]
require:
  spring_stiffness: ">= 3 N.m/rad"
  peak_power: "<= 9 W"
accept: [peltier_temperature_margin, structure_temperature_margin, stiffening_structure_margin]
minimize: {module_mass: 1, response_time: 1}
solver: {starts: 1, cells: 6, fineness: 0.67}
"""


def _record(wire: float, coil: float, count: float) -> str:
    sizes = {
        "wire_diameter": (wire, "mm"), "outer_diameter": (coil + wire, "mm"), "coil_diameter": (coil, "mm"),
        "coil_count": (count, '"1"'), "leg_length": (60, "mm"), "largest_torque": (3000, "mN*m"),
        "deflection": (30, "deg"),
    }  # fmt: skip
    lines = [f'  {name}: {{value: {value}, unit: {unit}, status: measured, source: "a test"}}'
             for name, (value, unit) in sizes.items()]  # fmt: skip
    words = "words: {spring_material: music_wire, hands: both, number: own}"
    return "\n".join(["title: A spring of the shelf", "values:", *lines, words])


@pytest.mark.slow
def test_the_best_stock_spring_of_a_list_is_the_best_of_each_alone(tmp_path: Path) -> None:
    folder = tmp_path / "records" / "torsion_springs"
    folder.mkdir(parents=True)
    for name, sizes in SPRINGS.items():
        (folder / f"{name}.yaml").write_text(_record(*sizes), encoding="utf-8")

    def solved(chosen: str, listed: str) -> Solution:
        path = tmp_path / "study.yaml"
        path.write_text(SPRING_STUDY.replace("CHOSEN", chosen).replace("  LISTED\n", listed), encoding="utf-8")
        return optimize(read_study(path))

    best = solved("", f"  stock_spring: {{choose: [{', '.join(SPRINGS)}]}}\n")
    alone = {name: solved(f"module: {{stock_spring: {name}}}", "") for name in SPRINGS}
    # Objectives are over each study's own start; that of the study that lists all is the common measure.
    objectives = {
        name: sum(one.values[weighed] / best.reference[weighed] for weighed in best.reference)
        for name, one in alone.items() if one.feasible
    }  # fmt: skip
    assert len(objectives) >= 2
    name = min(objectives, key=objectives.__getitem__)
    assert best.objective == pytest.approx(objectives[name], rel=1e-5)
    numbers = dict(zip(best.model.names, best.inputs, strict=True))
    found = (1e3 * numbers["wire_diameter"], 1e3 * numbers["coil_diameter"], numbers["coil_count"])
    assert found == pytest.approx(SPRINGS[name])
