"""Intervals hold what the data were made with; `benchmarks/fit_coverage.py` counts it over many seeds."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from fit_coverage import MADE, counted, held, kept_in, table

from tvimdesign.simulation.measurement.kind_sheet import kind_sheets


def share(kind: str, seeds: int) -> float:
    inside = [one for seed in range(seeds) for one in held(kind, seed).values()]
    return sum(inside) / len(inside)


def test_every_kind_has_data_made_for_it() -> None:
    assert set(MADE) == set(kind_sheets())


@pytest.mark.parametrize("kind", ["torque_angle", "pad", "frozen_torque", "amplitude_sweep", "relaxation"])
def test_few_intervals_of_95_percent_miss_the_truth(kind: str) -> None:
    # Parameters of one fit miss together: of ten seeds two or three may, four do in one of a thousand sets of them.
    assert share(kind, 10) > 0.65


@pytest.mark.slow
@pytest.mark.parametrize(
    "kind", ["release", "sine", "frequency_sweep", "temperature_ramp", "creep", "melt", "dsc", "heating_log"]
)
def test_few_intervals_of_longer_fits_miss_the_truth(kind: str) -> None:
    assert share(kind, 10) > 0.65


def test_a_count_goes_on_where_it_was_left(tmp_path: Path) -> None:
    kept = tmp_path / "kept.jsonl"
    whole = json.dumps({"kind": "pad", "seed": 0, "held": {"seebeck": True, "resistance": False}})
    kept.write_text(whole + "\n" + whole.replace('"seed": 0', '"seed": 1')[:-4])  # the second was cut short
    found = kept_in(kept)
    assert list(found) == [("pad", 0)]
    assert list(table(found))[2:] == ["| `pad` | 1 | seebeck 1, resistance 0 |"]
    assert counted(["pad"], 1, 1, kept) == found
