"""Yield of a spectrum whose times shorten with stress, against closed solutions."""

import math

import numpy as np
import pytest

from tvimdesign.physics.polymers import viscoelasticity, yielding

MODES = [(1e-2, 4e7), (1.0, 3e7), (1e2, 3e7), (1e6, 5e7)]
TAU_0 = 0.6e6


def test_small_strains_relax_as_in_the_linear_spectrum() -> None:
    time = np.geomspace(1e-3, 1e3, 31)
    stress = yielding.stress_of_a_ramp(time, 1e-5, 0.1, MODES, TAU_0)
    assert stress == pytest.approx(viscoelasticity.ramped_stress(time, 1e-5, 0.1, MODES), rel=1e-4)


def test_one_mode_relaxes_as_guiu_and_pratt_integrated_it() -> None:
    # d tau/dt = -(tau_0/t_1) sinh(tau/tau_0): tanh(tau/2 tau_0) = tanh(tau_s/2 tau_0) exp(-t/t_1).
    # Source: Guiu and Pratt, Phys. Stat. Sol. 6 (1964) 111 (stress relaxation by an activated flow).
    relaxation_time, modulus, rise = 1e6, 1e8, 1e-6
    time = np.geomspace(1e-3, 1e6, 19)
    stress = yielding.stress_of_a_ramp(time, 0.05, rise, [(relaxation_time, modulus)], TAU_0)
    start = 0.05 * modulus / TAU_0
    tanh = math.tanh(0.5 * start) * np.exp(-(time - rise) / relaxation_time)
    # Near one the hyperbolic tangent keeps no digits: its complement is 2/(exp(x) + 1).
    complement = 2.0 / (math.exp(start) + 1.0) - np.expm1(-(time - rise) / relaxation_time) * math.tanh(0.5 * start)
    assert stress == pytest.approx(TAU_0 * np.log((1.0 + tanh) / complement), rel=2e-3)


@pytest.mark.parametrize("rate", [1e-3, 1.0])
def test_a_constant_rate_comes_to_its_yield_stress(rate: float) -> None:
    end = 3.0 / rate
    stress = yielding.stress_of_a_ramp(np.array([end]), 3.0, end, MODES, TAU_0)
    assert stress[0] == pytest.approx(yielding.yield_stress(rate, TAU_0, MODES), rel=1e-4)
    # A decade of rate adds tau_0 ln(10), as Eyring's law has it far above tau_0.
    faster = yielding.yield_stress(10.0 * rate, TAU_0, MODES)
    assert faster - stress[0] == pytest.approx(TAU_0 * math.log(10.0), rel=1e-3)


def test_the_activation_stress_gives_back_the_strength_it_is_for() -> None:
    tau_0 = yielding.activation_stress(9.2e6, MODES)
    assert yielding.yield_stress(yielding.SHEET_RATE, tau_0, MODES) == pytest.approx(9.2e6)
    with pytest.raises(ValueError, match="below its yield strength"):
        yielding.activation_stress(9.2e6, [(1.0, 1e6)])
