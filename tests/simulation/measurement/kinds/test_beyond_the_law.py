"""Data whose tail leaves the law, of every kind: no record, and the figure says why; or the tail is left out."""

from pathlib import Path

import numpy as np
import pytest
from made_measurements import MADE
from made_measurements.faults import FAULTS, drift
from measured_files import holds

from tvimdesign.report.fit_files import figure_data
from tvimdesign.simulation.measurement.measure_files import Measured, kind_sheet, measure_of
from tvimdesign.simulation.measurement.record_file import NoRecordError, as_recorded, write_records

SIZES = {"torque_angle": {"wire_diameter": "1 mm", "coil_diameter": "9 mm", "coil_count": "4"}}
LEFT_OUT = {"amplitude_sweep": ("linear_strain_melt", 0.3), "flow_curve": ("zero_shear_viscosity", 1500.0)}
"""Kinds whose value lies before the tail, with the value that the data were made with."""


def fitted(kind: str, fault: str) -> Measured:
    blocks, given, _ = MADE[kind](np.random.default_rng(3))
    faulty = FAULTS[fault](kind, blocks, np.random.default_rng(3))
    sheet = kind_sheet(kind)
    measurement = measure_of(sheet)(faulty, sheet.values({**SIZES.get(kind, {}), **given}), profiles=False)
    return Measured(sheet, (), tuple(faulty), measurement)


def is_no_record(done: Measured, place: Path) -> None:
    with pytest.raises(NoRecordError):
        write_records(done, place, "mine")
    assert "\nNo record: " in figure_data(done)["title"]
    assert not list(place.rglob("*.yaml"))


@pytest.mark.parametrize("kind", [
    "torque_angle", "sine", "release", "frozen_torque", "pad", "frequency_sweep", "temperature_ramp", "relaxation",
    pytest.param("creep", marks=pytest.mark.gate), pytest.param("melt", marks=pytest.mark.gate),
    pytest.param("dsc", marks=pytest.mark.gate), pytest.param("heating_log", marks=pytest.mark.gate),
])  # fmt: skip
def test_a_tail_beyond_the_law_is_no_record_s(tmp_path, kind):
    is_no_record(fitted(kind, "tail"), tmp_path)


@pytest.mark.parametrize("kind", LEFT_OUT)
def test_a_tail_beyond_the_value_does_not_move_it(kind):
    name, truth = LEFT_OUT[kind]
    assert holds(as_recorded(fitted(kind, "tail").measurement.record_values[name]), truth)


@pytest.mark.parametrize("kind", ["torque_angle", "frozen_torque", "pad", "flow_curve"])
def test_a_sensor_that_drifts_by_a_twentieth_is_no_record_s(tmp_path, kind):
    done = fitted(kind, "drift")
    is_no_record(done, tmp_path)
    assert drift.__name__ in done.measurement.fit.misfit or "do not describe" in done.measurement.fit.misfit
