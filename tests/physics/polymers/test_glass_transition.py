"""A polymer across its glass transition: how its times shift, and what its moduli follow from."""

import casadi as ca
import numpy as np
import pytest

from tvimdesign.catalog import Catalog
from tvimdesign.device.core.impedance.joint_impedance import solid_modes
from tvimdesign.physics.polymers import polymer, transitions
from tvimdesign.physics.polymers.polymer import PINNED_FREQUENCY

CELSIUS = 273.15
TRANSITION = transitions.GlassTransition(CELSIUS + 60.0, 17.44, 51.6, 300e3)


def pla() -> transitions.Glass:
    record = Catalog().record("polymers", "pla")
    names = ("glass_transition", "wlf_c1", "wlf_c2", "glass_activation_energy")
    transition = transitions.GlassTransition(*(record.value(name) for name in names))
    return transitions.Glass(1e9, record.value("reference_temperature"), transition, solid_modes(record))


@pytest.mark.parametrize(
    ("above", "decades"),
    [(10.0, -2.8312), (20.0, -4.8715), (40.0, -7.6157)],  # 17.44 dT/(51.6 + dT) by hand
)
def test_above_the_transition_times_shift_by_wlf(above: float, decades: float) -> None:
    found = np.log10(transitions.shift(TRANSITION.temperature + above, TRANSITION))
    assert found == pytest.approx(decades, abs=0.01)


def test_below_the_transition_they_shift_by_arrhenius() -> None:
    # 300 kJ/mol, 60 and 20 degC: 300000/8.314463 (1/293.15 - 1/333.15)/ln 10 = 6.4182 decades, by hand.
    assert np.log10(transitions.shift(CELSIUS + 20.0, TRANSITION)) == pytest.approx(6.4182, abs=0.01)


def test_the_corner_is_rounded_within_a_kelvin_and_falls_everywhere() -> None:
    around = np.log10(transitions.shift(TRANSITION.temperature + np.linspace(-3.0, 3.0, 241), TRANSITION))
    assert np.all(np.diff(around) < 0.0)
    # The WLF law has 0.338 decades a kelvin there, the Arrhenius law 0.141: half of a kelvin off at most.
    assert abs(around[120]) < 0.5 * 0.34


def test_the_modulus_is_that_of_the_reference_and_a_thousandth_far_above() -> None:
    one = pla()
    at = polymer.maxwell_moduli(PINNED_FREQUENCY, one.at(one.reference_temperature))
    assert at[0] == pytest.approx(1e9, rel=1e-12)
    rubber = polymer.moduli(CELSIUS + 110.0, 0.0, PINNED_FREQUENCY, one)[0]
    assert rubber == pytest.approx(1e9 * 1.2 / 1045.7, rel=0.02)


def test_the_fraction_that_is_frozen_says_nothing_of_a_glass() -> None:
    assert polymer.spectrum(CELSIUS + 60.0, 0.0, pla()) == polymer.spectrum(CELSIUS + 60.0, 1.0, pla())


def test_slower_at_a_warmer_place_is_the_same() -> None:
    """Time-temperature superposition: a faster test stands for a colder one."""
    one = pla()
    colder, warmer = CELSIUS + 65.0, CELSIUS + 70.0
    faster = transitions.shift(colder, one.transition) / transitions.shift(warmer, one.transition)
    cold = polymer.maxwell_moduli(1.0, one.at(colder))
    warm = polymer.maxwell_moduli(faster, one.at(warmer))
    assert warm == pytest.approx(cold, rel=1e-9)


def test_arrays_and_symbols_are_the_same_as_floats() -> None:
    one, kelvin = pla(), CELSIUS + np.array([20.0, 58.0, 60.6, 75.0, 100.0])
    floats = [polymer.moduli(float(at), 0.5, 6.0, one) for at in kelvin]
    arrays = polymer.moduli(kelvin, 0.5, 6.0, one)
    symbol = ca.SX.sym("T")
    function = ca.Function("moduli", [symbol], list(polymer.moduli(symbol, 0.5, 6.0, one)))
    for i, found in enumerate(floats):
        assert [part[i] for part in arrays] == pytest.approx(list(found), rel=1e-12)
        assert [float(part) for part in function(float(kelvin[i]))] == pytest.approx(list(found), rel=1e-12)
