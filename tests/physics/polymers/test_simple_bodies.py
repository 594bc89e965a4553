"""Kelvin-Voigt, Maxwell and standard linear solid: each one body in oscillation, relaxation and creep."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from tvimdesign.physics.polymers.viscoelasticity import Body, KelvinVoigt, Maxwell, StandardLinearSolid

BODIES = [Maxwell(3.0, 0.6), StandardLinearSolid(2.0, 3.0, 0.6)]


@pytest.mark.parametrize("body", BODIES, ids=lambda body: type(body).__name__)
@pytest.mark.parametrize("time", [0.05, 0.7, 4.0])
def test_creep_and_relaxation_convolve_to_the_time(body: Body, time: float) -> None:
    whole, _ = quad(lambda s: body.relaxation(time - s) * body.creep(s), 0.0, time)
    assert whole == pytest.approx(time, rel=1e-8)


@pytest.mark.parametrize("body", BODIES, ids=lambda body: type(body).__name__)
@pytest.mark.parametrize("omega", [0.4, 5.0])
def test_modulus_is_the_fourier_integral_of_relaxation(body: Body, omega: float) -> None:
    rest = float(body.relaxation(1e9))
    sine, _ = quad(lambda t: body.relaxation(t) - rest, 0.0, np.inf, weight="sin", wvar=omega, limlst=500)
    cosine, _ = quad(lambda t: body.relaxation(t) - rest, 0.0, np.inf, weight="cos", wvar=omega, limlst=500)
    assert body.modulus(omega) == pytest.approx(rest + omega * (sine + 1j * cosine), rel=1e-6)


def test_kelvin_voigt_obeys_its_differential_equation() -> None:
    # sigma = G gamma + eta gamma'; under a constant stress of one, and in a sine.
    body = KelvinVoigt(4.0, 2.0)
    found = solve_ivp(lambda _, strain: (1.0 - 4.0 * strain) / 2.0, (0.0, 1.3), [0.0], rtol=1e-10, atol=1e-12)
    assert body.creep(1.3) == pytest.approx(found.y[0, -1], rel=1e-8)
    assert body.modulus(3.0) == pytest.approx(4.0 + 6.0j)


def test_kelvin_voigt_never_relaxes_and_maxwell_forgets_all() -> None:
    assert KelvinVoigt(4.0, 2.0).relaxation(1e6) == 4.0
    assert Maxwell(4.0, 2.0).relaxation(1e6) == 0.0
    assert KelvinVoigt(4.0, 2.0).creep(1e6) == pytest.approx(0.25)
    assert Maxwell(4.0, 2.0).creep(1e6) == pytest.approx(5e5, rel=1e-6)
