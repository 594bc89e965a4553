"""Frozen joints that are turned until they give, by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from measured_files import csv, found

from tvimdesign.base.errors import InputError

SIZES = {"layer_inner_radius": "26 mm", "layer_outer_radius": "40 mm", "layer_span": "49 deg"}


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
    assert held.low is not None
    assert held.low < 9.5
    assert held.high is not None
    assert held.high > 10.5


def test_a_torque_that_is_largest_in_the_first_row_is_told(tmp_path: Path) -> None:
    file = csv(tmp_path / "f.csv", angle__rad=[0.001, 0.002, 0.003, 0.004], torque__Nm=[5.0, 1e-3, 2e-3, 1e-3])
    with pytest.raises(InputError, match=r"up to its largest torque, 5 N\.m, the joint has one angle, 0\.001 rad"):
        found(file, "frozen_torque")
