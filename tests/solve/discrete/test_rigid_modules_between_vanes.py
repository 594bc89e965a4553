"""Rigid Peltier modules are chosen together with sizes in compression mode: the best of a list is the best of each."""

from __future__ import annotations

import pytest

from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.search import optimize
from tvimdesign.study import read_study_text

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
