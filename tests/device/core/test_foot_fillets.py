"""Fillets at the feet of core and pins: as large as is asked, where legs, rim and pins leave room."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given as drawn
from hypothesis import strategies

from tvimdesign.device import table_for
from tvimdesign.device.core.layout import EVENED, evened_least
from tvimdesign.study import given, read_study_text

MM = 1e-3


def found(rows: list[str], mode: str = "shear", **module: Any) -> dict[str, float]:
    inputs = given(read_study_text(f"mode: {mode}\n", "a test").model_copy(update={"module": module}))
    return {name: float(value) for name, value in table_for(mode).evaluate(inputs, rows).items()}


def test_it_stays_below_the_legs_and_on_the_plate() -> None:
    rows = ["foot_fillet", "coil_end_level", "rotor_top_level", "rotor_radius", "pin_radius"]
    asked = found(rows, largest_foot_fillet=9.0 * MM)
    wire, pin, play = 2.413 * MM, 4.0 * MM, 0.4 * MM
    rooms = [asked["coil_end_level"] - 0.5 * wire - asked["rotor_top_level"] - play,
             asked["rotor_radius"] - asked["pin_radius"] - 0.5 * pin - 0.1 * MM]  # fmt: skip
    assert 0.0 < asked["foot_fillet"] <= min(rooms) + 1e-12
    assert found(rows, largest_foot_fillet=0.3 * MM)["foot_fillet"] == pytest.approx(0.3 * MM)


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_the_strength_of_core_and_pins_counts_it(mode: str) -> None:
    rows = ["core_holding_torque", "pin_foot_safety", "foot_fillet"]
    small, large = (found(rows, mode, largest_foot_fillet=at * MM, radial_clearance=2.5 * MM) for at in (0.5, 2.0))
    assert large["foot_fillet"] == pytest.approx(2.0 * MM)
    assert large["pin_foot_safety"] / small["pin_foot_safety"] == pytest.approx(4.0**0.33243)
    rise = large["core_holding_torque"] / small["core_holding_torque"]
    assert 1.01 < rise < 1.0 / 0.86  # 0.83 to 0.90 by validation/fe_structure/fillets.csv


def test_a_fillet_never_touches_the_rim_or_the_other_fillet() -> None:
    """At the rim two circles that touch left a mesh that does not close; `paper_shear` has its pins that near."""
    rows = ["foot_fillet", "rotor_radius", "pin_radius"]
    near = found(rows, largest_foot_fillet=9.0 * MM, rotor_rim=1.0 * MM)
    rim = near["rotor_radius"] - near["pin_radius"] - 2.0 * MM
    assert near["foot_fillet"] <= max(rim - 0.1 * MM, 0.1 * MM) + 1e-12


@drawn(strategies.floats(-5e-3, 5e-3), strategies.floats(-5e-3, 5e-3))
def test_the_evened_least_is_never_more_than_the_least_and_is_it_away_from_ties(one: float, other: float) -> None:
    found, least = evened_least(one, other), min(one, other)
    assert least - EVENED / 6.0 - 1e-12 <= found <= least
    assert found == evened_least(other, one)
    if abs(one - other) >= EVENED:
        assert found == least


def test_slope_and_curvature_of_the_evened_least_have_no_jump() -> None:
    step = 1e-3 * EVENED
    at = np.arange(-1.5 * EVENED, 1.5 * EVENED, step)
    slope = np.diff(evened_least(at, 0.0)) / step
    curvature = np.diff(slope) / step
    assert np.max(np.abs(np.diff(slope))) < 2e-3  # of one in all
    assert np.max(np.abs(np.diff(curvature))) < 2e-3 / EVENED
