"""Sines against closed solutions of one degree of freedom, and frozen joints that are turned until they give."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from measured_files import csv, found, holds, turned

from tvimdesign.base.errors import InputError

SIZES = {"layer_inner_radius": "26 mm", "layer_outer_radius": "40 mm", "layer_span": "49 deg"}
INERTIA, STIFFNESS, DAMPING = 3e-3, 8.0, 0.05


def record(path: Path, hertz: float, seed: int, *, friction: float = 0.0) -> Path:
    return turned(path, hertz, seed, (INERTIA, STIFFNESS, DAMPING, friction), 0.08, (2e-4, 2.5e-3))


def test_two_frequencies_part_inertia_from_stiffness(tmp_path: Path) -> None:
    fit = found([record(tmp_path / f"{hertz}.csv", hertz, seed) for seed, hertz in enumerate((1.0, 7.0))], "sine").fit
    assert fit.value("inertia") == pytest.approx(INERTIA, rel=0.01)
    assert fit.value("stiffness") == pytest.approx(STIFFNESS, rel=5e-3)
    assert fit.value("damping") == pytest.approx(DAMPING, rel=0.03)


def test_one_frequency_is_said_not_to_and_a_known_inertia_does(tmp_path: Path) -> None:
    path = record(tmp_path / "one.csv", 3.0, 5)
    alone = found(path, "sine")
    omega = 6.0 * np.pi
    assert alone.fit.value("dynamic_stiffness") == pytest.approx(STIFFNESS - INERTIA * omega**2, rel=5e-3)
    assert "stiffness" not in {one.name for one in alone.fit.parameters}
    assert "One frequency cannot tell inertia and stiffness apart" in " ".join(alone.notes)
    known = found(path, "sine", inertia="3e-3 kg.m^2").fit
    assert known.value("stiffness") == pytest.approx(STIFFNESS, rel=5e-3)


def test_the_loop_that_no_speed_changes_is_friction(tmp_path: Path) -> None:
    paths = [record(tmp_path / f"{hertz}.csv", hertz, seed, friction=0.06) for seed, hertz in enumerate((1.0, 7.0))]
    fit = found(paths, "sine").fit
    assert fit.value("friction") == pytest.approx(0.06, rel=0.05)
    assert fit.value("damping") == pytest.approx(DAMPING, rel=0.05)
    # Energy of a cycle at 1 Hz: pi b omega A^2 + 4 T_f A (Den Hartog), over pi A^2 the loss stiffness.
    assert fit.value("loss") == pytest.approx(DAMPING * 2.0 * np.pi + 4.0 * 0.06 / (np.pi * 0.08), rel=0.02)


def test_less_than_a_period_is_refused(tmp_path: Path) -> None:
    time = np.linspace(0.0, 0.4, 60)
    columns: dict[str, Any] = {"time__s": time, "angle__rad": 0.1 * np.sin(2.0 * np.pi * time), "torque__Nm": time}
    with pytest.raises(InputError, match="less than one period"):
        found(csv(tmp_path / "s.csv", **columns), "sine")


def test_a_joint_that_slips_has_its_stiffness_and_its_torque(tmp_path: Path) -> None:
    angle = np.linspace(0.0, 0.1, 80)
    torque = np.minimum(200.0 * angle, 11.0) + np.random.default_rng(1).normal(0.0, 0.05, 80)
    result = found(csv(tmp_path / "f.csv", angle__rad=angle, torque__Nm=torque), "frozen_torque", **SIZES)
    assert result.fit.value("stiffness") == pytest.approx(200.0, rel=0.01)
    assert result.fit.value("holding_torque") == pytest.approx(11.0, rel=0.01)
    # tau = T r/J, J = 4 (49 deg)/4 (40^4 - 26^4) mm^4 = 1.799e6 mm^4
    assert result.record_values["bond_strength"].value == pytest.approx(11.0 * 0.040 / 1.7985e-6, rel=0.01)


def test_what_breaks_without_bending_is_known_from_several(tmp_path: Path) -> None:
    torques = [9.0, 10.0, 11.0, 10.0]
    paths = []
    for i, most in enumerate(torques):
        angle = np.append(np.linspace(0.0, most / 200.0, 40), most / 200.0 + 0.002 * np.arange(1, 4))
        torque = np.append(np.linspace(0.0, most, 40), [0.3, 0.2, 0.2])
        noise = np.random.default_rng(i).normal(0.0, 0.02, 43)
        paths.append(csv(tmp_path / f"{i}.csv", angle__rad=angle, torque__Nm=torque + noise))
    one = found(paths[0], "frozen_torque", **SIZES)
    assert not one.record_values
    assert "holds 9" in " ".join(one.notes)
    held = found(paths, "frozen_torque", **SIZES).fit["holding_torque"]
    assert held.value == pytest.approx(np.exp(np.mean(np.log(torques))), rel=0.01)
    assert holds(held, 9.5)
    assert holds(held, 10.5)


def test_joints_that_give_at_torques_of_their_own_have_one_each(tmp_path: Path) -> None:
    torques, angle = [9.0, 10.0, 11.0, 10.5], np.linspace(0.0, 0.1, 60)
    paths = [
        csv(tmp_path / f"{i}.csv", angle__rad=angle,
            torque__Nm=np.minimum(200.0 * angle, most) + np.random.default_rng(i).normal(0.0, 0.03, 60))
        for i, most in enumerate(torques)
    ]  # fmt: skip
    result = found(paths, "frozen_torque", **SIZES)
    assert [result.fit.value(f"holding_torque_{i}") for i in (1, 2, 3, 4)] == pytest.approx(torques, rel=5e-3)
    assert not result.fit.misfit
    # the next value of a normal population: mean and deviation of logarithms, Student's t of 3 degrees of freedom
    logs = np.log(np.array(torques) * 0.040 / 1.7985e-6)
    half = 3.182 * np.std(logs, ddof=1) * np.sqrt(1.25)
    bond = result.record_values["bond_strength"]
    assert [bond.low, bond.high] == pytest.approx(list(np.exp(np.mean(logs) + np.array([-half, half]))), rel=0.01)
    assert not found(paths[:2], "frozen_torque", **SIZES).record_values


def test_a_torque_that_is_largest_in_the_first_row_is_told(tmp_path: Path) -> None:
    file = csv(tmp_path / "f.csv", angle__rad=[0.001, 0.002, 0.003, 0.004], torque__Nm=[5.0, 1e-3, 2e-3, 1e-3])
    with pytest.raises(InputError, match=r"up to its largest torque, 5 N\.m, the joint has one angle, 0\.001 rad"):
        found(file, "frozen_torque")
