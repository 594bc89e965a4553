"""Maxwell elements that stand for a constant loss factor, and a layer in series with them, in the frequency domain."""

import numpy as np
import pytest

from tvimdesign.physics.motions.motion import Joint, Modes
from tvimdesign.simulation.link_motion.lossy_structure import in_series, spectrum, with_loss

MELT = [(1.0, 1.0), (0.1, 20.0), (0.01, 200.0)]
FROZEN = [(1e10, 2e5), (10.0, 2e4), (1.0, 2e4), (0.1, 2e4), (0.01, 2e4), (0.001, 3e4)]


def star(spring: float, modes: Modes, hertz: np.ndarray) -> np.ndarray:
    s = 2j * np.pi * hertz
    return spring + sum(k * s * tau / (1.0 + s * tau) for tau, k in modes)


@pytest.mark.parametrize("loss_factor", [1e-4, 0.04, 0.3, 1.5])
@pytest.mark.parametrize("hertz", [0.1, 1.0, 100.0])
def test_loss_factor_is_the_same_over_three_decades_and_exact_at_the_point(loss_factor: float, hertz: float) -> None:
    spring, elements = spectrum(700.0, 700.0 * loss_factor, hertz)
    assert spring >= 0.0
    assert all(stiffness > 0.0 for _, stiffness in elements)
    band = np.geomspace(0.1, 100.0, 300)
    found = star(spring, elements, band)
    assert found.imag / found.real == pytest.approx(loss_factor, rel=0.01)
    # The law a constant loss factor leaves: (i omega)^alpha, alpha = 2/pi atan(eta).
    law = 700.0 * (1.0 + 1j * loss_factor) * (band / hertz) ** (2.0 / np.pi * np.arctan(loss_factor))
    assert np.max(np.abs(found / law - 1.0)) < 5e-3
    assert star(spring, elements, np.array([hertz]))[0] == pytest.approx(700.0 * (1.0 + 1j * loss_factor), rel=1e-6)


@pytest.mark.parametrize("layer", [MELT, FROZEN, [(0.01, 3.0)]])
@pytest.mark.parametrize("loss_factor", [0.04, 1.5])
def test_modes_in_series_are_those_of_both_one_behind_the_other(layer: Modes, loss_factor: float) -> None:
    spring, elements = spectrum(700.0, 700.0 * loss_factor, 1.0)
    together = in_series(layer, spring, elements)
    assert all(stiffness > 0.0 and tau > 0.0 for tau, stiffness in together)
    hertz = np.geomspace(1e-8, 1e5, 400)
    one, other = star(0.0, layer, hertz), star(spring, elements, hertz)
    assert np.max(np.abs(star(0.0, together, hertz) / (one * other / (one + other)) - 1.0)) < 1e-9


@pytest.mark.parametrize("layer", [MELT, FROZEN])
def test_modes_behind_a_spring_alone_are_those_of_both(layer: Modes) -> None:
    hertz = np.geomspace(1e-8, 1e5, 400)
    together = star(0.0, in_series(layer, 700.0, []), hertz)
    one = star(0.0, layer, hertz)
    assert np.max(np.abs(together / (one * 700.0 / (one + 700.0)) - 1.0)) < 1e-9


def test_layer_and_structure_may_have_a_time_in_common() -> None:
    spring, elements = spectrum(700.0, 28.0, 1.0)
    layer = [(elements[3][0], 90.0), (1e-3, 500.0)]
    hertz = np.geomspace(1e-3, 1e3, 100)
    one, other = star(0.0, layer, hertz), star(spring, elements, hertz)
    together = star(0.0, in_series(layer, spring, elements), hertz)
    assert np.max(np.abs(together / (one * other / (one + other)) - 1.0)) < 1e-5


def test_structure_without_loss_stays_what_it_is() -> None:
    joint = Joint(4e-4, 5.0, 700.0)
    assert with_loss(joint, MELT, 0.0, 1.0) == (joint, MELT)
