"""Runs of a calorimeter: times that an instrument has rounded, and times that fall."""

import json
from pathlib import Path

import numpy as np
import pytest
from measured_files import found
from numpy.typing import NDArray
from support import ROOT

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.kinds.dsc import Run, runs_of
from tvimdesign.simulation.measurement.reading.data_file import read_data_file


def _read(folder: Path, times: NDArray[np.float64]) -> list[Run]:
    """Cooled from 353 K by 10 K/min; heat as from a peak at 300 K."""
    temperature = 353.0 - np.arange(len(times)) / 6.0
    heat = 100.0 + 1000.0 * np.exp(-(((temperature - 300.0) / 4.0) ** 2))
    rows = [f"{t:g};{kelvin:.12g};{watts:g}" for t, kelvin, watts in zip(times, temperature, heat, strict=True)]
    path = folder / "data.csv"
    path.write_text("\n".join(["time [s];temperature [K];specific_heat_flow [W/kg]", *rows, ""]))
    return runs_of(read_data_file(path).blocks, {})[0]


def test_of_rows_whose_rounded_times_are_the_same_the_first_counts(tmp_path: Path) -> None:
    seconds = np.arange(400.0)
    (run,) = _read(tmp_path, np.floor(seconds / 2.0) * 2.0)
    assert np.all(np.diff(run.time) > 0.0)
    assert run.way == "cooled"
    assert run.rate == pytest.approx(-1.0 / 6.0, rel=1e-9)


def test_times_that_fall_are_refused(tmp_path: Path) -> None:
    seconds = np.arange(400.0)
    seconds[390] = -1e308
    with pytest.raises(InputError, match=r"data\.csv:2: time falls from one row to the next"):
        _read(tmp_path, seconds)


def test_a_glass_does_not_freeze(tmp_path: Path) -> None:
    """A glass transition of 1e9 K ended in a LinAlgError; the campaign of faults found it and keeps the input."""
    kept = json.loads((ROOT / "campaigns/corpus/fits/904f44e4b289/input.json").read_text(encoding="utf-8"))
    (tmp_path / "f.csv").write_text(kept["data"], encoding="utf-8")
    with pytest.raises(InputError, match=r"glass_transition is 1e\+09 K"):
        found(tmp_path / "f.csv", "dsc", **kept["settings"])
