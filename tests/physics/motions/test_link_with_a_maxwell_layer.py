"""Equations of the link between a layer or one-sided blocks: statics, energy against heat, Laplace transforms."""

from collections.abc import Callable

import numpy as np
import pytest
import textbook
from hypothesis import given
from hypothesis import strategies as st

from tvimdesign.physics.motions import motion, one_sided
from tvimdesign.physics.motions.one_sided import Blocks, Touching

JOINT = motion.Joint(4.156e-4, 5.61, 919.0)
MODES = [(2e-2, 150.0), (1e-3, 300.0), (1e10, 40.0)]
angles = st.floats(-1.0, 1.0)
states = st.lists(angles, min_size=3, max_size=3)


def test_modes_and_springs_of_a_layer_by_hand() -> None:
    # 82513.7 Pa * 1.797e-6 m^4/1 mm = 148.28 N*m/rad, the melt's longest mode in the paper's layer.
    (time, stiffness), *_ = motion.layer_modes([(2.068841e-2, 82513.7)], 1.797e-6, 1e-3)
    assert time == 2.068841e-2
    assert stiffness == pytest.approx(148.277, rel=1e-5)
    # 490 N*m/rad behind 919: 319.6 N*m/rad; the layer takes 919/1409 of the angle.
    assert motion.branch_torque(0.1, [0.0, 0.0, 0.0], JOINT, MODES) == pytest.approx(31.96, rel=1e-3)
    assert motion.layer_angle(0.1, [0.0, 0.0, 0.0], JOINT, MODES) == pytest.approx(0.1 * 919.0 / 1409.0)
    assert motion.module_torque(0.1, [0.1, 0.1, 0.1], JOINT, MODES) == pytest.approx(-0.561)
    one = [(1.0, 200.0)]
    phi = (919.0 * 0.1 + 200.0 * 0.02) / 1119.0
    by_hand = 0.5 * (4.156e-4 * 3.0**2 + 5.61 * 0.1**2 + 919.0 * (0.1 - phi) ** 2 + 200.0 * (phi - 0.02) ** 2)
    assert motion.stored_energy(0.1, 3.0, [0.02], JOINT, one) == pytest.approx(by_hand, rel=1e-12)
    speed, acceleration = motion.kelvin_voigt_rates(0.1, 2.0, 0.5, 0.25, 10.0)
    assert (speed, acceleration) == (2.0, pytest.approx(-(0.25 * 2.0 + 10.0 * 0.1) / 0.5))
    assert motion.kelvin_voigt_torque(0.1, 2.0, 0.25, 10.0) == pytest.approx(-1.5)


@given(angles, states)
def test_structure_and_modes_carry_one_torque(angle: float, internal: list[float]) -> None:
    phi = motion.layer_angle(angle, internal, JOINT, MODES)
    carried = sum(k * (phi - q) for (_, k), q in zip(MODES, internal, strict=True))
    assert motion.branch_torque(angle, internal, JOINT, MODES) == pytest.approx(carried, rel=1e-9, abs=1e-9)


@given(angles, st.floats(-100.0, 100.0), states, st.floats(-5.0, 5.0))
def test_energy_grows_by_the_work_done_less_the_heat_made(
    angle: float, speed: float, internal: list[float], torque: float
) -> None:
    state = np.array([angle, speed, *internal])
    rate = np.array(motion.rates(angle, speed, internal, torque, JOINT, MODES))
    # Complex step: the derivative along the motion to machine precision.
    moved = state + 1e-30j * rate
    growth = np.imag(motion.stored_energy(moved[0], moved[1], list(moved[2:]), JOINT, MODES)) / 1e-30
    heat = textbook.dissipation(angle, internal, JOINT, MODES)
    assert heat >= 0.0
    scale = abs(torque * speed) + heat + motion.stored_energy(angle, speed, internal, JOINT, MODES)
    assert growth == pytest.approx(torque * speed - heat, abs=1e-9 * scale + 1e-12)


PAIRS: dict[str, tuple[Callable[[float], float], Callable[[float], float]]] = {
    "one": (lambda s: 1.0 / s, lambda _: 1.0),
    "time": (lambda s: 1.0 / s**2, lambda t: t),
    "root": (lambda s: s**-1.5, lambda t: 2.0 * np.sqrt(t / np.pi)),
    "decay": (lambda s: 1.0 / (s + 0.7), lambda t: np.exp(-0.7 * t)),
    "approach": (lambda s: 0.7 / (s * (s + 0.7)), lambda t: 1.0 - np.exp(-0.7 * t)),
}


@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("time", [0.03, 0.4, 2.0])
def test_what_fades_or_creeps_comes_back_to_the_stated_accuracy(name: str, time: float) -> None:
    transform, expected = PAIRS[name]
    (found,) = motion.inverse(lambda s: (transform(s),), time)
    assert found == pytest.approx(expected(time), rel=4e-4)


def test_the_weights_are_those_that_stehfest_printed() -> None:
    # Communications of the ACM 13 (1970) 47: those of ten terms.
    printed = [1 / 12, -385 / 12, 1279, -46871 / 3, 505465 / 6, -473915 / 2, 1127735 / 3, -1020215 / 3, 328125 / 2,
               -65625 / 2]  # fmt: skip
    assert motion.weights(10) == pytest.approx(printed, rel=1e-12)
    assert motion.TERMS == 10


BLOCKS = Blocks([(2e-2, 150.0), (1e-3, 300.0)], [(1e10, 40.0), (0.5, 80.0), (1e-3, 20.0)])
ALL = [Touching(a, b) for a in (0.0, 1.0) for b in (0.0, 1.0)]
blocks_states = st.lists(angles, min_size=5, max_size=5)


def test_face_of_a_block_stands_where_its_modes_balance() -> None:
    # Means weighted with the stiffness: 13.5/450 and 20/140.
    internal = [0.01, 0.04, 0.1, 0.2, 0.0]
    first, second = one_sided.divided(internal, BLOCKS)
    assert one_sided.surface_angle(first, BLOCKS.first) == pytest.approx(0.03)
    assert one_sided.surface_angle(second, BLOCKS.second) == pytest.approx(1.0 / 7.0)
    assert one_sided.gap(internal, BLOCKS) == pytest.approx(0.03 + 1.0 / 7.0)
    assert one_sided.gap([-0.2] * 5, BLOCKS) == 0.0


def test_blocks_pull_where_the_link_is_ahead_towards_the_other_side() -> None:
    internal = [0.01, 0.04, 0.1, 0.2, 0.0]
    for ahead in (-1e-3, 1e-3):
        assert one_sided.pulls(0.03 + ahead, internal, BLOCKS)[0] == pytest.approx(450.0 * ahead)
        assert one_sided.pulls(-1.0 / 7.0 - ahead, internal, BLOCKS)[1] == pytest.approx(140.0 * ahead)
    # 450 N*m/rad behind 919: 302.1 N*m/rad; 140 behind 919: 121.5 N*m/rad.
    free = [0.0] * 5
    assert one_sided.module_torque(0.1, free, Touching(1.0, 0.0), JOINT, BLOCKS) == pytest.approx(-30.769, rel=1e-4)
    assert one_sided.module_torque(-0.1, free, Touching(0.0, 1.0), JOINT, BLOCKS) == pytest.approx(12.711, rel=1e-4)
    assert one_sided.module_torque(0.1, free, Touching(0.0, 0.0), JOINT, BLOCKS) == pytest.approx(-0.561)


@given(blocks_states)
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
@given(angle=angles, speed=st.floats(-100.0, 100.0), internal=blocks_states)
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
