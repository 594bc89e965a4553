"""The controller's law and gains against continuous time, transfer functions and a simulation of its own module."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from robot_models import module_of
from scipy.integrate import solve_ivp

from tvimdesign.simulation.control.controller import (
    ControlledModule,
    Controller,
    Lags,
    ReactionCurve,
    RunningController,
    reaction_curve,
)
from tvimdesign.simulation.control.sizing import controller_of
from tvimdesign.simulation.working_cycle.cycle import Simulator


@cache
def _controller(mode: str) -> Controller:
    controller = controller_of(module_of(mode))
    assert controller is not None
    return controller


def test_the_dead_time_of_lags_is_their_sum():
    curve = reaction_curve(np.zeros((1, 1)), np.array([0.7]), np.array([1.0]), (2.0, 0.3), 0.01, 60.0)
    assert curve.slope == pytest.approx(0.7, rel=1e-6)
    assert curve.dead_time == pytest.approx(2.3 + 0.5 * 0.01, abs=1e-3)


def test_the_gains_have_the_margin_of_simc():
    # S. Skogestad (note on his paper of 2003): closed as quickly as the delay, the gain margin is about 3.
    gain, integral_time = ReactionCurve(0.5, 2.0).gains()
    assert (gain, integral_time) == pytest.approx((1.0 / (0.5 * 4.0), 16.0))
    w = np.geomspace(1e-3, 10.0, 20001)
    loop = gain * (1.0 + 1.0 / (1j * w * integral_time)) * 0.5 / (1j * w) * np.exp(-2.0j * w)
    phase = np.unwrap(np.angle(loop))
    crossing = int(np.flatnonzero((phase[:-1] > -np.pi) & (phase[1:] <= -np.pi))[-1])
    assert 1.0 / abs(loop[crossing]) == pytest.approx(3.0, rel=0.05)


@pytest.mark.gate
def test_the_law_is_a_pi_law_with_an_observer_in_continuous_time():
    period, lag, heating, leak, delay, balance, most = 0.005, 2.0, 0.5, 0.02, 0.3, 1.0, 3.0
    gain, integral_time = ReactionCurve(heating, lag + delay).gains()
    frozen = (1e-6,) * len(_controller("shear").layer_temperature)
    law = replace(
        _controller("shear"), period=period, sensor_lag=lag, heating=heating, balance=balance, gain=gain,
        integral_time=integral_time, observer_sensed=2.0 / lag, observer_near=3.0 / lag, observer_drift=1.0 / lag**2,
        hottest=350.0, profile_time=(0.0, 1.0), profile_current=(most, most), springs=1.0, soft=2.0, band=1.5,
        layer_compliance=frozen, layer_loss=frozen, layer_structure=frozen, layer_structure_loss=frozen,
        layer_softness=tuple((1.0 + np.arange(len(frozen))).tolist()),
    )  # fmt: skip  # a layer that never melts: the set-point stays the highest
    ambient = 300.0

    def right(_: float, y: np.ndarray) -> list[float]:
        heater, near, thermistor, sensed, estimate, drift, integral = y
        wanted = balance + gain * (350.0 - estimate) + integral
        current = min(max(wanted, 0.0), most)
        integrates = current == wanted or (wanted > most) == (estimate > 350.0)
        error = thermistor - sensed
        return [
            (current - heater) / delay,
            heating * heater - leak * (near - ambient),
            (near - thermistor) / lag,
            (estimate - sensed) / lag + 2.0 / lag * error,
            heating * (current - balance) + drift + 3.0 / lag * error,
            error / lag**2,
            gain / integral_time * (350.0 - estimate) if integrates else 0.0,
        ]

    seconds = 120.0
    expected = solve_ivp(
        right, (0.0, seconds), [0.0, *[ambient] * 4, 0.0, 0.0], method="LSODA", rtol=1e-8, atol=1e-8, max_step=0.05,
        dense_output=True,
    ).sol  # fmt: skip
    running, heater, near, thermistor = RunningController(law, ambient), 0.0, ambient, ambient
    differences, nears = [], []
    for k in range(int(seconds / period)):
        current = running.step(thermistor, 0.0)
        heater += period * (current - heater) / delay
        near += period * (heating * heater - leak * (near - ambient))
        thermistor += period * (near - thermistor) / lag
        differences.append(near - expected((k + 1) * period)[1])
        nears.append(near)
    assert np.max(np.abs(differences)) < 0.1
    assert nears[-1] == pytest.approx(350.0, abs=0.1)
    assert max(nears) < 353.0


@pytest.mark.gate
@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_its_estimate_is_the_impedance_of_the_module(mode):
    resolved, controller = module_of(mode), _controller(mode)
    model = resolved.functions
    module = ControlledModule(model, model.start)
    alone = module.uncontrolled(Simulator(model).constant_drive("softening", model.start))
    course = module.switch(controller, Lags(2.0, 0.05), 1.5 * alone)
    actual = controller.soft * controller.band * np.exp(-course.due)
    soft = course.times > 1.2 * alone
    assert course.impedances[soft] == pytest.approx(actual[soft], rel=0.2)
    assert course.soft_after < 1.1 * alone
    assert np.max(course.near) < controller.hottest + 3.0


def test_stiff_cools_as_far_as_the_way_back_does():
    controller = _controller("shear")
    running = RunningController(controller, controller.cooled + 20.0)
    assert running.step(controller.cooled + 20.0, controller.stiff) == -controller.cooling
    for _ in range(2000):
        current = running.step(controller.cooled - 5.0, controller.stiff)
    assert current == 0.0
