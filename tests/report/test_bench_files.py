"""The bench of a built module: blank tables that `fit` reads, and the way from filled ones to records."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from answers import shipped_answer
from support import Command

from tvimdesign.catalog import Catalog
from tvimdesign.report.bench.bench_files import protocols
from tvimdesign.report.fit.fit_files import from_si_array
from tvimdesign.simulation.measurement import bench_tests
from tvimdesign.simulation.measurement.reading.headings import heading
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_design
from tvimdesign.study.design import read_design, write_design

QUICK = ["weights", "pads", "frozen", "ringing", "thawed"]
RECORDED = {
    "spring_youngs_modulus": ("weights", "spring_materials", "youngs_modulus"),
    "peltier_seebeck": ("pads", "peltiers", "seebeck"), "pcl_bond_strength": ("frozen", "polymers", "bond_strength"),
    "clamped_loss_factor": ("ringing", "joints", "clamped_loss_factor"),
    "rotor_coefficient": ("log", "heat_paths", "rotor_coefficient"),
}  # fmt: skip


@pytest.fixture
def design(tmp_path: Path) -> Path:
    return write_design(shipped_answer("paper_reconstructed").design, tmp_path / "design.json")


def module_of(design: Path) -> ResolvedModule:
    found = read_design(design)
    resolved = resolve_design(found)
    values = {**resolved.values, "response_time": found.value("response_time")}
    return ResolvedModule(resolved.study, values, resolved.current_profiles)


def fill(folder: Path, module: ResolvedModule, name: str, truth: dict[str, float]) -> None:
    """Write values of another module into a blank table, with 0.3 % of noise."""
    columns = bench_tests.TESTS[name][0](module, {key: value for key, value in truth.items()
                                                  if key in bench_tests.explained(name, module)})  # fmt: skip
    noise, cells = np.random.default_rng(2), []
    for column, unit in {**protocols()[name]["set"], **protocols()[name]["measured"]}.items():
        values = from_si_array(columns[column], unit)
        measured = column in protocols()[name]["measured"]
        cells.append(values + (noise.normal(0.0, 3e-3 * np.ptp(values), len(values)) if measured else 0.0))
    path = folder / name / "data.csv"
    head = path.read_text(encoding="utf-8-sig").splitlines()[0]
    rows = [";".join(f"{value:.6g}" for value in row) for row in zip(*cells, strict=True)]
    path.write_text("\n".join([head, *rows]) + "\n")


def round_trip(tvimdesign: Command, design: Path, tests: list[str]) -> None:
    module, place = module_of(design), design.parent
    assert tvimdesign("bench", design, "--no-plots", "--out", "bench", cwd=place).returncode == 0
    factors = {"spring_youngs_modulus": 0.95, "peltier_seebeck": 1.1, "pcl_bond_strength": 1.3,
               "clamped_loss_factor": 1.3, "rotor_coefficient": 1.2}  # fmt: skip
    truth = {name: factor * float(module.values[name]) for name, factor in factors.items()}
    for name in tests:
        fill(place / "bench", module, name, truth)
    done = tvimdesign("bench", design, "--measured", "bench", "--out", "compared", cwd=place)
    assert done.returncode == 0, done.stderr
    assert (place / "compared/bench.png").exists()
    fits = json.loads((place / "compared/bench.json").read_text())["fits"]
    assert set(fits) == set(tests)
    for name, (test, category, value) in RECORDED.items():
        if test in tests:
            entry = Catalog(place / "compared/my_records").record(category, f"bench_{test}").entry(value)
            assert entry.low < truth[name] < entry.high, name


def test_a_bench_has_protocols_blank_tables_and_fields_for_a_doi(tvimdesign: Command, design: Path) -> None:
    done = tvimdesign("bench", design, "--no-plots", "--out", "bench", cwd=design.parent)
    assert done.returncode == 0, done.stderr
    folder = design.parent / "bench"
    text = (folder / "README.md").read_text()
    for name, sheet in protocols().items():
        assert f"## {sheet['title']}" in text
        head = (folder / name / "data.csv").read_text(encoding="utf-8-sig").splitlines()[0]
        read = [heading(text).quantity for text in head.split(";") if text != "specimen"]
        assert read == [column for column in {**sheet["set"], **sheet["measured"]} if column != "specimen"]
        rows = (folder / name / "predicted.csv").read_text(encoding="utf-8-sig").splitlines()
        assert " low [" in rows[0]
        column, unit = next(iter(sheet["measured"].items()))
        low, value, high = (rows[0].split(",").index(f"{column}{end} [{unit}]") for end in (" low", "", " high"))
        for row in (list(map(float, line.split(","))) for line in rows[1:]):
            assert row[low] <= row[value] <= row[high]
    for field in ("DOI of the data", "ORCID", "License", "Instruments, with last calibration"):
        assert f"| {field}" in text or field in text
    refused = tvimdesign("bench", design, "--measured", "bench", "--out", "none", cwd=design.parent)
    assert refused.returncode == 2
    assert "no data.csv has 3 filled rows; write values into its blank columns" in refused.stderr


@pytest.mark.gate
def test_filled_tables_become_records_that_hold_the_truth(tvimdesign: Command, design: Path) -> None:
    round_trip(tvimdesign, design, QUICK)
