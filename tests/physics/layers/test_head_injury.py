"""The Head Injury Criterion against a search over all windows of a known pulse."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize

from tvimdesign.physics.layers.driven import GRAVITY, INJURY_WINDOW, head_injury

PEAK, MASS = 4000.0, 4.0


def _exact(pulse: float) -> float:
    """Return the criterion of a half sine of so many seconds, of integrals over its windows."""

    def negative(window: np.ndarray) -> float:
        start, length = float(window[0]), float(np.clip(window[1], 1e-6, INJURY_WINDOW))
        gained = quad(lambda t: PEAK * max(np.sin(np.pi * t / pulse), 0.0), max(start, 0.0), min(start + length, pulse))
        mean = gained[0] / (MASS * GRAVITY) / length
        return -length * mean**2.5

    tried = [
        minimize(negative, [0.5 * (pulse - length), length], method="Nelder-Mead", options={"xatol": 1e-8})
        for length in (0.4 * pulse, 0.7 * pulse, min(pulse, INJURY_WINDOW))
    ]
    return -min(float(result.fun) for result in tried)


@pytest.mark.parametrize(("steps", "error"), [(16, 0.02), (72, 0.02), (500, 0.002)])
@pytest.mark.parametrize("pulse", [0.004, 0.015, 0.04])
def test_head_injury_is_the_worst_window_of_a_half_sine(pulse, steps, error):
    step = pulse / steps
    forces = [PEAK * np.sin(np.pi * i / steps) for i in range(1, steps + 1)] + [0.0] * steps
    assert head_injury(forces, MASS, step) == pytest.approx(_exact(pulse), rel=error)


def test_head_injury_of_a_constant_push_lasts_15_ms_and_of_none_is_none():
    step, multiple = 0.0005, 50.0
    forces = [multiple * MASS * GRAVITY] * 60  # 30 ms
    assert head_injury(forces, MASS, step) == pytest.approx(0.015 * multiple**2.5, rel=1e-9)
    assert head_injury([0.0] * 5, MASS, 1e-3) == 0.0
