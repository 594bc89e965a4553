"""The law of a changing layer under load: what freezing and melting do to stress, and that neither makes energy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tvimdesign.physics.layers import lasting_load

Array = NDArray[np.float64]
SUPPORT = lasting_load.Support(5.61, 919.0)
PERMANENT = 1e15  # s


def layer(times: Array, stiffnesses: Array, growth: Array) -> lasting_load.Slices:
    return lasting_load.Slices(list(times), list(stiffnesses), list(growth))


def random_layer(seed: int, count: int = 4, modes: int = 3) -> tuple[lasting_load.Slices, list[Array]]:
    """Slices of any stiffness and pace, all with one torque, shared among the modes at random."""
    draw = np.random.default_rng(seed)
    shape = (modes, count)
    times, stiffnesses = 10.0 ** draw.uniform(-5.0, 10.0, shape), 10.0 ** draw.uniform(0.0, 6.0, shape)
    torques = draw.normal(size=shape)
    torques[0] += draw.normal() - np.sum(torques, axis=0)
    return layer(times, stiffnesses, draw.normal(size=shape)), list(torques)


def test_freezing_leaves_stress_and_melting_loses_it_as_the_modulus() -> None:
    growing = layer(np.full((2, 3), PERMANENT), np.full((2, 3), 500.0), np.full((2, 3), 4.0))
    speed, changes = lasting_load.loaded_rates([np.full(3, 0.1), np.full(3, 0.2)], 0.0, growing, SUPPORT)
    assert speed == pytest.approx(0.0, abs=1e-12)
    assert np.asarray(changes) == pytest.approx(np.zeros((2, 3)), abs=1e-12)
    # Between rigid springs the link cannot move: M' = k'/k M.
    rigid = lasting_load.Support(1e15, 1e15)
    melting = layer(np.full((1, 1), PERMANENT), np.full((1, 1), 500.0), np.full((1, 1), -0.5))
    _, changes = lasting_load.loaded_rates([np.array([0.3])], 0.0, melting, rigid)
    assert changes[0][0] == pytest.approx(-0.5 * 0.3, rel=1e-6)


def test_springs_and_layer_share_a_load_at_once_by_their_stiffness() -> None:
    # Two slices of 600 behind 919: 1/(1/919 + 2/600) = 226.2; with 5.61 beside, 1 N*m turns it by 4.314 mrad.
    solid = layer(np.full((2, 2), PERMANENT), np.full((2, 2), 300.0), np.zeros((2, 2)))
    angle, torques = lasting_load.loaded_start(1.0, solid, SUPPORT)
    assert angle == pytest.approx(4.314e-3, rel=1e-3)
    assert np.sum(torques, axis=0) == pytest.approx(np.full(2, 1.0 - 5.61 * angle), rel=1e-12)
    by_hand = 0.5 * angle * (1.0)  # a load put on springs slowly does half its product with the way
    assert lasting_load.stored_energy(angle, torques, solid, SUPPORT) == pytest.approx(by_hand, rel=1e-12)


@given(st.integers(0, 10_000))
def test_slices_keep_one_torque_and_the_load_is_carried(seed: int) -> None:
    now, torques = random_layer(seed)
    speed, changes = lasting_load.loaded_rates(torques, 0.7, now, SUPPORT)
    # L' = K_s theta' + M', the same M' in every slice.
    left = 0.7 - SUPPORT.spring_stiffness * speed
    scale = np.max(np.abs(changes))
    assert np.sum(changes, axis=0) == pytest.approx(np.full(4, left), abs=1e-9 * scale)


@given(st.integers(0, 10_000))
def test_neither_freezing_nor_melting_makes_energy(seed: int) -> None:
    now, torques = random_layer(seed)
    angle = 0.05
    load = SUPPORT.spring_stiffness * angle + float(np.sum(torques, axis=0)[0])
    speed, changes = lasting_load.loaded_rates(torques, 0.0, now, SUPPORT)
    # Complex step along the motion, the stiffnesses growing as they are said to.
    step = 1e-30j
    later = now._replace(stiffnesses=[k * (1.0 + step * g) for k, g in zip(now.stiffnesses, now.growth, strict=True)])
    moved = [torque + step * change for torque, change in zip(torques, changes, strict=True)]
    growth = np.imag(lasting_load.stored_energy(angle + step * speed, moved, later, SUPPORT)) / 1e-30
    scale = abs(load * speed) + abs(growth)
    assert growth - load * speed <= 1e-9 * scale


def test_equal_slices_are_one_layer() -> None:
    times, whole, growth = np.array([1e-2, 3.0]), np.array([200.0, 50.0]), np.array([0.5, -0.2])
    torques = np.array([0.3, -0.1])
    one = lasting_load.loaded_rates(
        list(torques[:, None]), 0.4, layer(times[:, None], whole[:, None], growth[:, None]), SUPPORT
    )
    many = layer(*(np.repeat(field[:, None], 5, axis=1) for field in (times, 5.0 * whole, growth)))
    five = lasting_load.loaded_rates(list(np.repeat(torques[:, None], 5, axis=1)), 0.4, many, SUPPORT)
    assert five[0] == pytest.approx(one[0], rel=1e-12)
    assert np.asarray(five[1]) == pytest.approx(np.repeat(np.asarray(one[1]), 5, axis=1), rel=1e-12)
