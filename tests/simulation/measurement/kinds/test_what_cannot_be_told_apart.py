"""Data that cannot tell parameters apart, a case for each kind: it is said in words, and no interval pretends.

Releases, sines, frozen joints, amplitude sweeps and logs of a module have theirs beside their other tests.
"""

from pathlib import Path

import numpy as np
import pytest
from measured_files import csv, found, oscillated


def test_a_pad_at_one_current(tmp_path: Path) -> None:
    # One current gives V and the temperatures once: many pairs of S and R have that voltage.
    noise = np.random.default_rng(1)
    columns = {
        "current__A": np.full(8, 1.0), "voltage__V": 4.0 + noise.normal(0.0, 2e-3, 8),
        "hot_side__degC": 28.0 + noise.normal(0.0, 0.03, 8), "cold_side__degC": 2.0 + noise.normal(0.0, 0.03, 8),
    }  # fmt: skip
    result = found(csv(tmp_path / "p.csv", **columns))
    assert result.notes[0].startswith("One current cannot tell Seebeck coefficient, resistance and conductance apart")
    assert not result.record_values
    assert not any("hot_0" in said for said in result.fit.words)


def test_a_load_that_only_rises_says_nothing_of_friction(tmp_path: Path) -> None:
    torque = np.linspace(0.1, 1.0, 10)
    angle = torque / 5.0 + np.random.default_rng(1).normal(0.0, 1e-4, 10)
    result = found(csv(tmp_path / "t.csv", torque__Nm=torque, angle__rad=angle), "torque_angle")
    assert {one.name for one in result.fit.parameters} == {"stiffness", "zero_angle"}
    assert "friction is not fitted" in result.notes[0]
    assert "a backlash would not be seen" in result.notes[1]


def test_one_hold_of_a_calorimeter_leaves_the_rate_open(tmp_path: Path) -> None:
    time = np.linspace(0.0, 600.0, 200)
    fraction = 1.0 - np.exp(-np.log(2.0) * (time / 100.0) ** 3)
    heat = np.gradient(fraction, time) * 60.0 + np.random.default_rng(1).normal(0.0, 1e-3, 200)
    path = csv(tmp_path / "d.csv", time__s=time, temperature__degC=np.full(200, 40.0), dsc__W_per_g=heat)
    result = found(path, "dsc")
    assert "One rate of cooling hardly tells half-time and nucleation constant apart" in " ".join(result.notes)
    assert any("crystallization_half_time and nucleation_constant" in said for said in result.fit.words)


def test_slow_flow_alone_gives_a_viscosity_and_no_time(tmp_path: Path) -> None:
    # G'' = eta w, and a G' of instrument's noise: all that relaxes is a viscosity.
    omega = np.geomspace(0.01, 0.1, 12)
    noise = np.random.default_rng(2)
    storage, loss = (1e-4 * np.exp(noise.normal(0.0, 1.0, 12)), 500.0 * omega * np.exp(noise.normal(0.0, 0.01, 12)))
    result = found(oscillated(tmp_path / "s.csv", omega, storage, loss), "frequency_sweep")
    fit = result.fit
    assert not result.record_tables
    assert list(result.record_values) == ["zero_shear_viscosity"]
    assert {parameter.name for parameter in fit.parameters} == {"fast_viscosity"}
    assert any("The record has the viscosity alone" in note for note in result.notes)
    viscosity = fit["zero_shear_viscosity"]
    assert viscosity.low < 500.0 < (viscosity.high or 0.0) < 1.1 * viscosity.low


def test_a_creep_too_short_to_flow_has_no_viscosity(tmp_path: Path) -> None:
    # An elastic answer and nothing else: any longer time does as well.
    time = np.geomspace(1e-3, 1.0, 50)
    compliance = 1e-6 * np.exp(np.random.default_rng(1).normal(0.0, 0.01, 50))
    path = csv(tmp_path / "c.csv", time__s=time, compliance__1_per_Pa=compliance)
    result = found(path, "creep", temperature="30 degC")
    assert result.fit.value("solid_modulus") == pytest.approx(1e6, rel=0.02)
    assert "zero_shear_viscosity" not in {derived.name for derived in result.fit.derived}
    assert any("The data do not flow" in note for note in result.notes)
    assert not result.record_values
