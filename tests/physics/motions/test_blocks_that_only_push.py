"""Equations of a link between one-sided blocks: nothing jumps at contact, energy against heat, floats and symbols."""

from typing import Any

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tvimdesign.physics.motions import motion, one_sided
from tvimdesign.physics.motions.one_sided import Blocks, Touching

JOINT = motion.Joint(4.156e-4, 5.61, 919.0)
BLOCKS = Blocks([(2e-2, 150.0), (1e-3, 300.0)], [(1e10, 40.0), (0.5, 80.0), (1e-3, 20.0)])
ALL = [Touching(a, b) for a in (0.0, 1.0) for b in (0.0, 1.0)]
angles = st.floats(-1.0, 1.0)
states = st.lists(angles, min_size=5, max_size=5)


def test_face_of_a_block_stands_where_its_modes_balance() -> None:
    # Means weighted with the stiffness: 13.5/450 and 20/140.
    internal = [0.01, 0.04, 0.1, 0.2, 0.0]
    first, second = one_sided.divided(internal, BLOCKS)
    assert one_sided.surface_angle(first, BLOCKS.first) == pytest.approx(0.03)
    assert one_sided.surface_angle(second, BLOCKS.second) == pytest.approx(1.0 / 7.0)
    assert one_sided.gap(internal, BLOCKS) == pytest.approx(0.03 + 1.0 / 7.0)
    assert one_sided.gap([-0.2] * 5, BLOCKS) == 0.0


def test_block_pulls_exactly_where_the_link_is_ahead_of_its_face() -> None:
    internal = [0.01, 0.04, 0.1, 0.2, 0.0]
    for ahead in (-1e-3, 1e-3):
        assert one_sided.pulls(0.03 + ahead, internal, BLOCKS)[0] == pytest.approx(450.0 * ahead)
        assert one_sided.pulls(-1.0 / 7.0 - ahead, internal, BLOCKS)[1] == pytest.approx(140.0 * ahead)


def test_each_block_pushes_towards_the_other_side() -> None:
    # 450 N*m/rad behind 919: 302.1 N*m/rad; 140 behind 919: 121.5 N*m/rad.
    free = [0.0] * 5
    assert one_sided.module_torque(0.1, free, Touching(1.0, 0.0), JOINT, BLOCKS) == pytest.approx(-30.769, rel=1e-4)
    assert one_sided.module_torque(-0.1, free, Touching(0.0, 1.0), JOINT, BLOCKS) == pytest.approx(12.711, rel=1e-4)
    assert one_sided.module_torque(0.1, free, Touching(0.0, 0.0), JOINT, BLOCKS) == pytest.approx(-0.561)


@given(states)
def test_nothing_jumps_where_a_block_is_left(internal: list[float]) -> None:
    angle = one_sided.surface_angle(internal[:2], BLOCKS.first)
    left, met = (
        [
            *one_sided.rates(angle, 3.0, internal, Touching(touching, 0.0), JOINT, BLOCKS),
            one_sided.stored_energy(angle, 3.0, internal, Touching(touching, 0.0), JOINT, BLOCKS),
        ]
        for touching in (0.0, 1.0)
    )
    assert left == pytest.approx(met, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("touching", ALL)
@given(angle=angles, speed=st.floats(-100.0, 100.0), internal=states)
def test_energy_falls_by_the_heat_of_the_dashpots(
    touching: Touching, angle: float, speed: float, internal: list[float]
) -> None:
    state = np.array([angle, speed, *internal])
    rate = np.array(one_sided.rates(angle, speed, internal, touching, JOINT, BLOCKS))
    moved = state + 1e-30j * rate
    growth = np.imag(one_sided.stored_energy(moved[0], moved[1], list(moved[2:]), touching, JOINT, BLOCKS)) / 1e-30
    heat = sum(k * tau * q**2 for (tau, k), q in zip([*BLOCKS.first, *BLOCKS.second], rate[2:], strict=True))
    scale = heat + one_sided.stored_energy(angle, speed, internal, touching, JOINT, BLOCKS)
    assert growth == pytest.approx(-heat, abs=1e-9 * scale + 1e-12)


def test_symbols_give_what_floats_give() -> None:
    names = [ca.SX.sym(name) for name in ("angle", "speed", "q1", "q2", "q3", "q4", "q5", "first", "second")]

    def rows(angle: Any, speed: Any, *rest: Any) -> list[Any]:
        internal, touching = list(rest[:5]), Touching(*rest[5:])
        return [
            *one_sided.rates(angle, speed, internal, touching, JOINT, BLOCKS),
            *one_sided.pulls(angle, internal, BLOCKS),
            one_sided.gap(internal, BLOCKS),
            one_sided.stored_energy(angle, speed, internal, touching, JOINT, BLOCKS),
        ]

    numbers = (0.1, -2.0, 0.02, 0.05, 0.0, 0.1, 0.3, 1.0, 0.0)
    found = ca.Function("found", names, [ca.vertcat(*rows(*names))])(*numbers)
    assert np.asarray(found).ravel() == pytest.approx([float(row) for row in rows(*numbers)], rel=1e-12)
