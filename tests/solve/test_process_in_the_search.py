"""Optima that the process can make: walls end at its least, a milled module's below a printed one's."""

from __future__ import annotations

import pytest

from tvimdesign.solve.result import answer
from tvimdesign.study import read_study_text

STUDY = """
mode: shear
module: {{process: {process}, key_count: 0}}
vary:
  wall_thickness: [0.8 mm, 5 mm]
  rotor_thickness: [1 mm, 6 mm]
  floor_thickness: [2.5 mm, 6 mm]
accept: [peltier_temperature_margin, structure_temperature_margin, stiffening_structure_margin]
minimize: {{module_mass: 1}}
solver: {{starts: 1}}
"""


@pytest.mark.parametrize(("process", "wall"), [("print_petg", 1.2e-3), ("machine_6061", 1.0e-3)])
def test_walls_end_where_the_process_ends(process: str, wall: float) -> None:
    found = answer(read_study_text(STUDY.format(process=process), "a test")).design
    assert found.status == "optimal"
    assert found.values["wall_thickness"] == pytest.approx(wall, rel=1e-4)
    # Keys in the plate would want more of it; they are left out.
    assert found.values["rotor_thickness"] == pytest.approx(wall, rel=1e-4)
    # The floor keeps that wall below a pad of 1.5 mm; in metal the screws in the core ask for more.
    assert found.values["floor_thickness"] >= 1.5e-3 + wall - 1e-7
