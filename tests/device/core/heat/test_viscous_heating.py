"""Heat of the joint's motion: the work of a period, and where the layer takes it up."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from stiff_when_warm import STIFF_WHEN_WARM

from tvimdesign.device import table_for
from tvimdesign.device.table.phases import SOFTENING
from tvimdesign.physics.heat_flow import heat
from tvimdesign.physics.layers import layer

TABLE = table_for("shear")


def test_a_dashpot_takes_up_the_work_of_its_period() -> None:
    # T = b dphi/dt over a period of phi = A sin(2 pi f t): b A^2 2 pi^2 f^2, integrated here; a rigid support.
    damping, amplitude, frequency = 1.85, 0.104, 1.0
    turns = np.linspace(0.0, 1.0, 20001)
    speed = 2.0 * np.pi * frequency * amplitude * np.cos(2.0 * np.pi * turns)
    work = np.trapezoid(damping * speed**2, turns / frequency)
    alone = (0.0, layer.loss_stiffness(damping, frequency))
    assert layer.dissipation(alone, alone, amplitude, frequency) == pytest.approx(frequency * work, rel=1e-6)


def test_a_soft_support_takes_motion_from_the_dashpot() -> None:
    # A spring in series with a dashpot of the same stiffness at this frequency: half of the motion's square is left.
    stiffness, amplitude = 10.0, 0.1
    behind = layer.series_stiffness(0.0, stiffness, stiffness)
    heat_alone = layer.dissipation((0.0, stiffness), (0.0, stiffness), amplitude, 2.0)
    assert layer.dissipation((0.0, stiffness), behind, amplitude, 2.0) == pytest.approx(0.5 * heat_alone, rel=1e-12)


def test_molten_slices_take_up_the_heat() -> None:
    shares = layer.loss_shares(np.array([1e4, 1e8]), np.array([2e4, 4e6]))
    assert np.sum(shares) == pytest.approx(1.0)
    assert shares[1] < 1e-4


def test_the_paper_s_module_heats_by_a_watt_at_one_hertz(inputs: dict[str, Any]) -> None:
    # An independent reading of the published module, whose melt had 2.8 kPa s then, found 1.1 W.
    frequencies = {"frequency@hot": 1.0, "frequency@cold": 1.0, "pcl_zero_shear_viscosity": 2.8e3}
    given = {**inputs, **STIFF_WHEN_WARM, "temperature@hot": 373.15, "temperature@cold": 303.15, **frequencies}
    hot, cold = TABLE.evaluate(given, ["viscous_heating@hot", "viscous_heating@cold"]).values()
    assert hot == pytest.approx(1.1, rel=0.1)
    assert cold < 0.01 * hot  # the torque that turns the hot joint by its stroke hardly turns the frozen one


def test_motion_heats_the_layer_and_nothing_else(inputs: dict[str, Any]) -> None:
    given = {**inputs, **STIFF_WHEN_WARM, "temperature@hot": 373.15, "frequency@hot": 2.0}
    stack = TABLE.evaluate(given, ["stack"])["stack"]
    instant = {**given, "phase": SOFTENING, "state": heat.initial_state(stack, 5, 373.15), "drive_current": 0.0}
    still, moving = (
        TABLE.evaluate({**instant, "motion": motion}, ["state_rates"])["state_rates"]
        for motion in ("at_rest", "moving")
    )
    gained = moving - still
    cell = stack.density * stack.area * stack.thickness / 5.0
    watts = TABLE.evaluate(given, ["viscous_heating@hot"])["viscous_heating@hot"]
    assert heat.ENTHALPY_SCALE * cell * np.sum(gained[2:7]) == pytest.approx(watts, rel=1e-3)
    assert np.all(np.delete(gained, slice(2, 7)) == 0.0)
