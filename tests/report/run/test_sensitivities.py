"""The table and the heat map of sensitivities: what was asked for, in units people read, and no more."""

import csv
import io
from pathlib import Path

import pytest
from support import Command

from tvimdesign.report.run.answered_study import heat_map, sensitivities, sensitivities_csv
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule
from tvimdesign.solve.result import answer
from tvimdesign.solve.sensitivity.output_sensitivity import OutputSensitivities
from tvimdesign.study import read_study_text

pytestmark = pytest.mark.slow

STUDY = """
mode: shear
vary:
  wire_diameter: [1.5 mm, 3 mm]
  current: [0.5 A, 2 A]
require: {spring_stiffness: ">= 5 N.m/rad", peltier_temperature_margin: ">= 0 K"}
minimize: {module_mass: 1, response_time: 1}
solver: {starts: 1, cells: 8, fineness: 0.67}
"""


@pytest.fixture(scope="module")
def found() -> tuple[OutputSensitivities, ResolvedModule]:
    return sensitivities(answer(read_study_text(STUDY, "a test")))


def test_a_derivative_in_reading_units_adds_what_one_percent_more_does(
    found: tuple[OutputSensitivities, ResolvedModule],
) -> None:
    lines = list(csv.DictReader(io.StringIO(sensitivities_csv(*found))))
    by = {(line["output"], line["variable"]): line for line in lines}
    line = by["envelope_diameter", "placement_radius"]  # 1 mm farther out is 2 mm more across
    assert float(line["derivative"]) == pytest.approx(2.0, rel=1e-5)
    assert line["derivative_unit"] == "mm / mm"
    assert float(line["per_percent"]) == pytest.approx(0.02 * 57.0, rel=1e-5)
    assert line["unit"] == "mm"
    reserve = by["peltier_temperature_margin", "current"]
    assert reserve["log_derivative"] == ""
    assert float(reserve["derivative"]) < 0.0
    assert reserve["derivative_unit"] == "K / A"


def test_the_heat_map_has_no_empty_rows_and_columns(found: tuple[OutputSensitivities, ResolvedModule]) -> None:
    data = heat_map(*found)
    assert "Peltier temperature margin" not in data["outputs"]
    assert {"module mass", "response time", "spring stiffness"} <= set(data["outputs"])
    assert all(any(abs(value) >= 5e-3 for value in row) for row in data["values"])
    assert all(any(abs(value) >= 5e-3 for value in column) for column in zip(*data["values"], strict=True))
    assert "stiffness_over_stroke" not in data["outputs"]  # nothing changes it in this module


@pytest.mark.slow
def test_a_run_writes_them_where_the_study_or_the_command_asks(tvimdesign: Command, tmp_path: Path) -> None:
    plain, asked = tmp_path / "plain.yaml", tmp_path / "asked.yaml"
    accepting = STUDY + "accept: [structure_temperature_margin, stiffening_structure_margin]\n"  # PETG at 100 degC
    plain.write_text(accepting)
    asked.write_text(accepting + "write: {sensitivities: true}\n")
    for study, options in ((plain, ["--sensitivities"]), (asked, [])):
        out = tmp_path / study.stem
        done = tvimdesign("run", study, "--no-cad", "--out", out, *options)
        assert done.returncode == 0, done.stderr
        assert (out / "sensitivities.csv").exists()
        assert (out / "plots/sensitivities.png").stat().st_size > 10_000
