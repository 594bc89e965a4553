"""Tests that do not see all: a solid, faster flow, the strain's rise, an instrument's inertia, the last digit."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from measured_files import csv, found, holds, measured, moduli, oscillated

MODES = [(0.5, 800.0), (0.05, 1e4), (0.004, 6e4)]
VISCOSITY = sum(tau * modulus for tau, modulus in MODES)


def noise(count: int, share: float, seed: int = 0) -> Any:
    return np.exp(np.random.default_rng(seed).normal(0.0, share, count))


def relaxed(time: Any) -> Any:
    """Generalised Maxwell (Ferry, ch. 3)."""
    return sum(modulus * np.exp(-time / tau) for tau, modulus in MODES)


def test_a_modulus_that_stays_is_a_solid_s_and_no_record(tmp_path: Path) -> None:
    time = np.geomspace(1e-3, 1.5, 80)
    path = csv(tmp_path / "r.csv", time__s=time, relaxation_modulus__Pa=(relaxed(time) + 4200.0) * noise(80, 0.02))
    result = found(path, "relaxation", temperature="100 degC")
    assert result.fit.value("solid_modulus") == pytest.approx(4200.0, rel=0.1)
    assert not result.record_values
    assert any("The data do not flow" in note for note in result.notes)


def test_a_viscosity_beside_the_modes_is_the_record_s_alone(tmp_path: Path) -> None:
    omega = np.geomspace(0.1, 100.0, 25)
    storage, loss = moduli(omega, MODES)
    loss = (loss + 1500.0 * omega) * noise(25, 0.02, 1)
    result = found(oscillated(tmp_path / "s.csv", omega, storage * noise(25, 0.02), loss), "frequency_sweep")
    assert holds(result.record_values["zero_shear_viscosity"], VISCOSITY + 1500.0)
    assert set(result.record_values) == {"zero_shear_viscosity"}
    assert not result.record_tables


@pytest.mark.parametrize("with_strain", [True, False])
def test_rows_while_the_strain_rises_are_left_out_and_named(tmp_path: Path, with_strain: bool) -> None:
    time = np.geomspace(1e-3, 5.0, 80)
    rise = 1.0 - np.exp(-((time / 0.02) ** 2))
    columns = (
        {"stress__Pa": 0.05 * relaxed(time) * rise * noise(80, 0.02), "strain__1": 0.05 * rise}
        if with_strain
        else {"relaxation_modulus__Pa": relaxed(time) * rise * noise(80, 0.02)}
    )
    done = measured(csv(tmp_path / "r.csv", time__s=time, **columns, temperature__degC=np.full(80, 100.0)))
    assert done.kind.name == "relaxation"
    assert any("the strain rises for 0.0" in note and "left out" in note for note in done.measurement.notes)
    assert done.measurement.fit.value("plateau_modulus") < 1e5
    assert not done.measurement.record_values


def test_rows_within_the_inertia_of_an_instrument_are_left_out(tmp_path: Path) -> None:
    time = np.geomspace(1e-3, 5.0, 80)
    fluid = time / VISCOSITY + 2e-4 * (1.0 - np.exp(-time / 0.3))
    inert = np.minimum(fluid, np.interp(0.02, time, fluid) * (time / 0.02) ** 2)
    path = csv(tmp_path / "c.csv", time__s=time, compliance__1_per_Pa=inert * noise(80, 0.01),
               temperature__degC=np.full(80, 100.0))  # fmt: skip
    result = found(path, "creep")
    assert any("the compliance rises faster than any melt's" in note for note in result.notes)
    assert holds(result.record_values["zero_shear_viscosity"], VISCOSITY)


def test_no_interval_is_narrower_than_the_last_digit_allows(tmp_path: Path) -> None:
    # Whole degrees that lie on a line by chance: each may be off by 0.5 deg, 0.29 deg in the mean square.
    angle = np.array([0, 5, 10, 15, 20, 15, 10, 5, 0])
    fit = found(csv(tmp_path / "t.csv", torque__Nm=angle / 5, angle__deg=angle), "torque_angle").fit
    stiffness = fit["stiffness"]
    slope_deviation = 1.0 / np.sqrt(12.0) / np.sqrt(np.sum((angle / 5.0 - np.mean(angle / 5.0)) ** 2)) / 5.0
    width = (stiffness.high - stiffness.low) / stiffness.value
    assert 2.0 * 1.96 * slope_deviation < width < 2.0 * 3.5 * slope_deviation


def test_rows_that_part_from_the_law_at_an_end_are_no_record_s(tmp_path: Path) -> None:
    omega = np.geomspace(0.1, 100.0, 30)
    storage, loss = moduli(omega, MODES)
    bent = storage * np.where(omega > 40.0, 0.6, 1.0)  # as the motor's inertia takes from G'
    path = oscillated(tmp_path / "s.csv", omega, bent * noise(30, 0.01), loss * noise(30, 0.01, 1))
    result = found(path, "frequency_sweep")
    assert "The equations do not describe" in result.fit.misfit or not result.record_tables
