"""The wave spring against the beams it is between, and makers' rounded factor."""

from __future__ import annotations

import numpy as np
import pytest

from tvimdesign.physics.springs import wave_spring

SIZES = (21e-3, 25e-3, 0.2e-3, 3)
YOUNGS = 206e9


def test_the_stress_is_that_of_beams_clamped_at_both_ends() -> None:
    inner, outer, thickness, waves = SIZES
    wave, force, section = np.pi * 0.5 * (inner + outer) / waves, 5.0, 0.5 * (outer - inner) * thickness**2 / 6.0
    # Clamped, loaded in the middle: F L/8 (Shigley, table A-9, 14), each wave bears its share of the force.
    assert wave_spring.stress(force, *SIZES) == pytest.approx(force / waves * wave / 8.0 / section)


def test_the_rate_is_between_beams_that_are_free_to_turn_and_clamped_ones() -> None:
    inner, outer, thickness, waves = SIZES
    wave, moment = np.pi * 0.5 * (inner + outer) / waves, 0.5 * (outer - inner) * thickness**3 / 12.0
    free, clamped = (waves * factor * YOUNGS * moment / wave**3 for factor in (48.0, 192.0))
    found = wave_spring.rate(YOUNGS, *SIZES)
    assert free < found < clamped
    assert found == pytest.approx(2.0 * free * outer / inner)


def test_the_factor_is_the_one_makers_print() -> None:
    # Rotor Clip and others: K = 3.88 for 2.0 to 4.0 waves a turn.
    assert pytest.approx(3.88, abs=0.005) == wave_spring.WAVE_FACTOR
    printed = wave_spring.rate(YOUNGS, *SIZES, factor=3.88)
    assert wave_spring.rate(YOUNGS, *SIZES) == pytest.approx(printed, rel=0.002)
    # B = F K Dm^3/(E SW T^3 Z^4) ID/OD, in millimetres and newtons by hand: 1 mm takes 6.73 N.
    assert printed * 1e-3 == pytest.approx(206e3 * 2.0 * 0.008 * 81.0 / (3.88 * 23.0**3) * 25.0 / 21.0, rel=1e-9)
