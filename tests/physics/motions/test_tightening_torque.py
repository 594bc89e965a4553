"""Torque that tightens a screw, against thread and head friction one by one."""

import numpy as np
import pytest

from tvimdesign.physics.motions.contacts import tightened_force, tightening_torque


@pytest.mark.parametrize(("diameter", "pitch"), [(2.0, 0.4), (3.0, 0.5), (4.0, 0.7), (5.0, 0.8)])
def test_a_nut_factor_of_a_fifth_is_a_friction_of_fifteen_hundredths(diameter: float, pitch: float) -> None:
    # Shigley, 10th ed., eq. 8-26: thread of 60 degrees on its pitch diameter, and a head that bears at 1.25 d.
    friction, flank = 0.15, 1.0 / np.cos(np.radians(30.0))
    at = diameter - 0.6495 * pitch  # ISO 724
    slope = pitch / (np.pi * at)
    thread = 0.5 * at * (slope + friction * flank) / (1.0 - friction * slope * flank)
    by_parts = thread + 0.625 * friction * diameter  # mm, of one newton
    assert tightening_torque(1.0, 1e-3 * diameter, 0.2) == pytest.approx(1e-3 * by_parts, rel=0.03)


def test_a_torque_gives_the_tension_it_was_worked_out_from() -> None:
    force = tightened_force(150e6, 3e-3)
    assert tightening_torque(force, 3e-3, 0.2) == pytest.approx(0.2 * 150e6 * np.pi / 4.0 * 27e-9, rel=1e-12)
