"""Benefit of measurements: the ranges that measured inputs had before, and the intervals from them."""

from __future__ import annotations

from pathlib import Path

import pytest
from support import ROOT

from tvimdesign.catalog import Catalog
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_study
from tvimdesign.solve.uncertainty.design_uncertainty import UncertaintyModel
from tvimdesign.solve.uncertainty.unmeasured import before_measuring, unmeasured_inputs
from tvimdesign.study import read_study

RECORD = """title: "bench module"
based_on: handbook
values:
  rotor_contact: {value: 4000, unit: "W/m^2/K", low: 3000, high: 5000, status: measured, source: "a log"}
"""


@pytest.fixture
def module(tmp_path: Path) -> ResolvedModule:
    folder = tmp_path / "records" / "heat_paths"
    folder.mkdir(parents=True)
    (folder / "bench.yaml").write_text(RECORD)
    study = (ROOT / "studies" / "paper_as_published.yaml").read_text()
    path = tmp_path / "mine.yaml"
    path.write_text(study.replace("\nmodule:", "\ncatalog: records\nmodule:\n  heat_paths: bench", 1))
    return resolve_study(read_study(path))


def test_a_measured_input_knows_the_range_of_the_record_it_is_based_on(module: ResolvedModule) -> None:
    inputs = {one.name: one for one in unmeasured_inputs(module)}
    handbook = Catalog().record("heat_paths", "handbook").entry("rotor_contact")
    measured = inputs["rotor_contact"]
    assert (measured.low, measured.high, measured.status) == (3000.0, 5000.0, "measured")
    assert measured.before == (handbook.low, handbook.high)
    assert [name for name, one in inputs.items() if one.before is not None] == ["rotor_contact"]
    (before,) = [one for one in before_measuring(list(inputs.values())) if one.name == "rotor_contact"]
    assert (before.low, before.high) == (handbook.low, handbook.high)


def test_nothing_is_before_where_nothing_was_measured() -> None:
    module = resolve_study(read_study(ROOT / "studies" / "paper_as_published.yaml"))
    assert all(one.before is None for one in unmeasured_inputs(module))


@pytest.mark.slow
def test_the_interval_was_wider_before(module: ResolvedModule) -> None:
    found = UncertaintyModel(module, ["softening_time"]).at(module, 1 << 5, 1 << 7)
    low, high = found.before["softening_time"]
    now = found.intervals["softening_time"]
    assert now.high - now.low < high - low
