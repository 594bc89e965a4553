"""Values that data cannot tell apart, and joints that are turned."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from measured_files import csv, fit_files, holds, measured, moduli, oscillated, turned

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.kinds.release import period_and_decay


def test_a_pad_at_one_current(tmp_path):
    # One current gives V and the temperatures once: many pairs of S and R have that voltage.
    noise = np.random.default_rng(1)
    columns = {
        "current__A": np.full(8, 1.0), "voltage__V": 4.0 + noise.normal(0.0, 2e-3, 8),
        "hot_side__degC": 28.0 + noise.normal(0.0, 0.03, 8), "cold_side__degC": 2.0 + noise.normal(0.0, 0.03, 8),
    }  # fmt: skip
    result = fit_files(csv(tmp_path / "p.csv", **columns))
    assert result.notes[0].startswith("One current cannot tell Seebeck coefficient, resistance and conductance apart")
    assert not result.record_values
    assert not any("hot_0" in sentence for sentence in result.fit.words)


def test_a_load_that_only_rises_says_nothing_of_friction(tmp_path):
    torque = np.linspace(0.1, 1.0, 10)
    angle = torque / 5.0 + np.random.default_rng(1).normal(0.0, 1e-4, 10)
    result = fit_files(csv(tmp_path / "t.csv", torque__Nm=torque, angle__rad=angle), "torque_angle")
    assert {parameter.name for parameter in result.fit.parameters} == {"stiffness", "zero_angle"}
    assert "friction is not fitted" in result.notes[0]
    assert "a backlash would not be seen" in result.notes[1]


def test_one_hold_of_a_calorimeter_leaves_the_rate_open(tmp_path):
    time = np.linspace(0.0, 600.0, 200)
    fraction = 1.0 - np.exp(-np.log(2.0) * (time / 100.0) ** 3)
    heat = np.gradient(fraction, time) * 60.0 + np.random.default_rng(1).normal(0.0, 1e-3, 200)
    path = csv(tmp_path / "d.csv", time__s=time, temperature__degC=np.full(200, 40.0), dsc__W_per_g=heat)
    result = fit_files(path, "dsc")
    assert "One rate of cooling hardly tells half-time and nucleation constant apart" in " ".join(result.notes)
    assert any("crystallization_half_time and nucleation_constant" in sentence for sentence in result.fit.words)


def test_slow_flow_alone_gives_a_viscosity_and_no_time(tmp_path):
    # G'' = eta w, and a G' of instrument's noise: all that relaxes is a viscosity.
    omega = np.geomspace(0.01, 0.1, 12)
    noise = np.random.default_rng(2)
    storage, loss = (1e-4 * np.exp(noise.normal(0.0, 1.0, 12)), 500.0 * omega * np.exp(noise.normal(0.0, 0.01, 12)))
    result = fit_files(oscillated(tmp_path / "s.csv", omega, storage, loss), "frequency_sweep")
    fit = result.fit
    assert not result.record_tables
    assert list(result.record_values) == ["zero_shear_viscosity"]
    assert {parameter.name for parameter in fit.parameters} == {"fast_viscosity"}
    assert any("The record has the viscosity alone" in note for note in result.notes)
    viscosity = fit["zero_shear_viscosity"]
    assert viscosity.low < 500.0 < (viscosity.high or 0.0) < 1.1 * viscosity.low


def test_a_creep_too_short_to_flow_has_no_viscosity(tmp_path):
    # An elastic answer and nothing else: any longer time does as well.
    time = np.geomspace(1e-3, 1.0, 50)
    compliance = 1e-6 * np.exp(np.random.default_rng(1).normal(0.0, 0.01, 50))
    path = csv(tmp_path / "c.csv", time__s=time, compliance__1_per_Pa=compliance)
    result = fit_files(path, "creep", temperature="30 degC")
    assert result.fit.value("solid_modulus") == pytest.approx(1e6, rel=0.02)
    assert "zero_shear_viscosity" not in {derived.name for derived in result.fit.derived}
    assert any("The data do not flow" in note for note in result.notes)
    assert not result.record_values


MODES = [(0.5, 800.0), (0.05, 1e4), (0.004, 6e4)]
VISCOSITY = sum(tau * modulus for tau, modulus in MODES)


def noise(count: int, share: float, seed: int = 0) -> Any:
    return np.exp(np.random.default_rng(seed).normal(0.0, share, count))


def relaxed(time: Any) -> Any:
    """Generalised Maxwell (Ferry, ch. 3)."""
    return sum(modulus * np.exp(-time / tau) for tau, modulus in MODES)


def test_a_modulus_that_stays_is_a_solid_s_and_no_record(tmp_path):
    time = np.geomspace(1e-3, 1.5, 80)
    path = csv(tmp_path / "r.csv", time__s=time, relaxation_modulus__Pa=(relaxed(time) + 4200.0) * noise(80, 0.02))
    result = fit_files(path, "relaxation", temperature="100 degC")
    assert result.fit.value("solid_modulus") == pytest.approx(4200.0, rel=0.1)
    assert not result.record_values
    assert any("The data do not flow" in note for note in result.notes)


def test_a_viscosity_beside_the_modes_is_the_record_s_alone(tmp_path):
    omega = np.geomspace(0.1, 100.0, 25)
    storage, loss = moduli(omega, MODES)
    loss = (loss + 1500.0 * omega) * noise(25, 0.02, 1)
    result = fit_files(oscillated(tmp_path / "s.csv", omega, storage * noise(25, 0.02), loss), "frequency_sweep")
    assert holds(result.record_values["zero_shear_viscosity"], VISCOSITY + 1500.0)
    assert set(result.record_values) == {"zero_shear_viscosity"}
    assert not result.record_tables


@pytest.mark.parametrize("with_strain", [True, False])
def test_rows_while_the_strain_rises_are_left_out_and_named(tmp_path, with_strain):
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


def test_rows_within_the_inertia_of_an_instrument_are_left_out(tmp_path):
    time = np.geomspace(1e-3, 5.0, 80)
    fluid = time / VISCOSITY + 2e-4 * (1.0 - np.exp(-time / 0.3))
    inert = np.minimum(fluid, np.interp(0.02, time, fluid) * (time / 0.02) ** 2)
    path = csv(tmp_path / "c.csv", time__s=time, compliance__1_per_Pa=inert * noise(80, 0.01),
               temperature__degC=np.full(80, 100.0))  # fmt: skip
    result = fit_files(path, "creep")
    assert any("the compliance rises faster than any melt's" in note for note in result.notes)
    assert holds(result.record_values["zero_shear_viscosity"], VISCOSITY)


def test_no_interval_is_narrower_than_the_last_digit_allows(tmp_path):
    # Whole degrees that lie on a line by chance: each may be off by 0.5 deg, 0.29 deg in the mean square.
    angle = np.array([0, 5, 10, 15, 20, 15, 10, 5, 0])
    fit = fit_files(csv(tmp_path / "t.csv", torque__Nm=angle / 5, angle__deg=angle), "torque_angle").fit
    stiffness = fit["stiffness"]
    slope_deviation = 1.0 / np.sqrt(12.0) / np.sqrt(np.sum((angle / 5.0 - np.mean(angle / 5.0)) ** 2)) / 5.0
    width = (stiffness.high - stiffness.low) / stiffness.value
    assert 2.0 * 1.96 * slope_deviation < width < 2.0 * 3.5 * slope_deviation


def test_rows_that_part_from_the_law_at_an_end_are_no_record_s(tmp_path):
    omega = np.geomspace(0.1, 100.0, 30)
    storage, loss = moduli(omega, MODES)
    bent = storage * np.where(omega > 40.0, 0.6, 1.0)  # as the motor's inertia takes from G'
    path = oscillated(tmp_path / "s.csv", omega, bent * noise(30, 0.01), loss * noise(30, 0.01, 1))
    result = fit_files(path, "frequency_sweep")
    assert "The equations do not describe" in result.fit.misfit or not result.record_tables


SIZES = {"layer_inner_radius": "26 mm", "layer_outer_radius": "40 mm", "layer_span": "49 deg"}
INERTIA, STIFFNESS, DAMPING = 3e-3, 8.0, 0.05


def record(path: Path, hertz: float, seed: int, *, friction: float = 0.0) -> Path:
    return turned(path, hertz, seed, (INERTIA, STIFFNESS, DAMPING, friction), 0.08, (2e-4, 2.5e-3))


def test_two_frequencies_part_inertia_from_stiffness(tmp_path):
    fit = fit_files(
        [record(tmp_path / f"{hertz}.csv", hertz, seed) for seed, hertz in enumerate((1.0, 7.0))], "sine"
    ).fit
    assert fit.value("inertia") == pytest.approx(INERTIA, rel=0.01)
    assert fit.value("stiffness") == pytest.approx(STIFFNESS, rel=5e-3)
    assert fit.value("damping") == pytest.approx(DAMPING, rel=0.03)


def test_a_single_frequency_leaves_stiffness_open_and_a_known_inertia_not(tmp_path):
    path = record(tmp_path / "one.csv", 3.0, 5)
    alone = fit_files(path, "sine")
    omega = 6.0 * np.pi
    assert alone.fit.value("dynamic_stiffness") == pytest.approx(STIFFNESS - INERTIA * omega**2, rel=5e-3)
    assert "stiffness" not in {parameter.name for parameter in alone.fit.parameters}
    assert "One frequency cannot tell inertia and stiffness apart" in " ".join(alone.notes)
    known = fit_files(path, "sine", inertia="3e-3 kg.m^2").fit
    assert known.value("stiffness") == pytest.approx(STIFFNESS, rel=5e-3)


def test_the_loop_that_no_speed_changes_is_friction(tmp_path):
    paths = [record(tmp_path / f"{hertz}.csv", hertz, seed, friction=0.06) for seed, hertz in enumerate((1.0, 7.0))]
    fit = fit_files(paths, "sine").fit
    assert fit.value("friction") == pytest.approx(0.06, rel=0.05)
    assert fit.value("damping") == pytest.approx(DAMPING, rel=0.05)
    # Energy of a cycle at 1 Hz: pi b omega A^2 + 4 T_f A (Den Hartog), over pi A^2 the loss stiffness.
    assert fit.value("loss") == pytest.approx(DAMPING * 2.0 * np.pi + 4.0 * 0.06 / (np.pi * 0.08), rel=0.02)


def test_less_than_a_period_is_refused(tmp_path):
    time = np.linspace(0.0, 0.4, 60)
    columns: dict[str, Any] = {"time__s": time, "angle__rad": 0.1 * np.sin(2.0 * np.pi * time), "torque__Nm": time}
    with pytest.raises(InputError, match="less than one period"):
        fit_files(csv(tmp_path / "s.csv", **columns), "sine")


def test_a_joint_that_slips_has_its_stiffness_and_its_torque(tmp_path):
    angle = np.linspace(0.0, 0.1, 80)
    torque = np.minimum(200.0 * angle, 11.0) + np.random.default_rng(1).normal(0.0, 0.05, 80)
    result = fit_files(csv(tmp_path / "f.csv", angle__rad=angle, torque__Nm=torque), "frozen_torque", **SIZES)
    assert result.fit.value("stiffness") == pytest.approx(200.0, rel=0.01)
    assert result.fit.value("holding_torque") == pytest.approx(11.0, rel=0.01)
    # tau = T r/J, J = 4 (49 deg)/4 (40^4 - 26^4) mm^4 = 1.799e6 mm^4
    assert result.record_values["bond_strength"].value == pytest.approx(11.0 * 0.040 / 1.7985e-6, rel=0.01)


def test_what_breaks_without_bending_is_known_from_several(tmp_path):
    torques = [9.0, 10.0, 11.0, 10.0]
    paths = []
    for i, most in enumerate(torques):
        angle = np.append(np.linspace(0.0, most / 200.0, 40), most / 200.0 + 0.002 * np.arange(1, 4))
        torque = np.append(np.linspace(0.0, most, 40), [0.3, 0.2, 0.2])
        noise = np.random.default_rng(i).normal(0.0, 0.02, 43)
        paths.append(csv(tmp_path / f"{i}.csv", angle__rad=angle, torque__Nm=torque + noise))
    alone = fit_files(paths[0], "frozen_torque", **SIZES)
    assert not alone.record_values
    assert "holds 9" in " ".join(alone.notes)
    held = fit_files(paths, "frozen_torque", **SIZES).fit["holding_torque"]
    assert held.value == pytest.approx(np.exp(np.mean(np.log(torques))), rel=0.01)
    assert holds(held, 9.5)
    assert holds(held, 10.5)


def test_joints_that_give_at_torques_of_their_own_have_one_each(tmp_path):
    torques, angle = [9.0, 10.0, 11.0, 10.5], np.linspace(0.0, 0.1, 60)
    paths = [
        csv(tmp_path / f"{i}.csv", angle__rad=angle,
            torque__Nm=np.minimum(200.0 * angle, most) + np.random.default_rng(i).normal(0.0, 0.03, 60))
        for i, most in enumerate(torques)
    ]  # fmt: skip
    result = fit_files(paths, "frozen_torque", **SIZES)
    assert [result.fit.value(f"holding_torque_{i}") for i in (1, 2, 3, 4)] == pytest.approx(torques, rel=5e-3)
    assert not result.fit.misfit
    # the next value of a normal population: mean and deviation of logarithms, Student's t of 3 degrees of freedom
    logs = np.log(np.array(torques) * 0.040 / 1.7985e-6)
    half = 3.182 * np.std(logs, ddof=1) * np.sqrt(1.25)
    bond = result.record_values["bond_strength"]
    assert [bond.low, bond.high] == pytest.approx(list(np.exp(np.mean(logs) + np.array([-half, half]))), rel=0.01)
    assert not fit_files(paths[:2], "frozen_torque", **SIZES).record_values


def test_a_torque_that_is_largest_in_the_first_row_is_reported(tmp_path):
    file = csv(tmp_path / "f.csv", angle__rad=[0.001, 0.002, 0.003, 0.004], torque__Nm=[5.0, 1e-3, 2e-3, 1e-3])
    with pytest.raises(InputError, match=r"up to its largest torque, 5 N\.m, the joint has one angle, 0\.001 rad"):
        fit_files(file, "frozen_torque")


def test_a_release_that_passes_rest_in_one_sample_has_a_period():
    angle = np.array([1.0, 0.0, -1.0, -0.5, -0.2, -0.08, -0.03, -0.01, 0.0, 0.0, 0.0, 0.0])
    period, decay = period_and_decay(np.arange(angle.size, dtype=float), angle)
    assert period >= 1.0
    assert decay > 0.0
