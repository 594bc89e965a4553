"""A squeezed block: stiffness against finite elements, rubber and plain compression; memory against Radau."""

from typing import Any

import bonded_block
import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from tvimdesign.physics import block
from tvimdesign.physics.layer import series_stiffness
from tvimdesign.physics.viscoelasticity import retardation

Modes = list[tuple[float, float]]
MELT = [(2.07e-2, 82.0), (6.5e-3, 104.0), (2.07e-3, 131.0), (6.5e-4, 165.0), (2.07e-4, 207.0), (6.5e-5, 261.0)]
SOLID = [(1e10, 2.1e5), (10.0, 1.8e4), (1.0, 1.7e4), (0.1, 1.9e4), (0.01, 1.9e4), (0.001, 2.6e4)]
HALF = [(300.0, 5.6e3), (0.4, 1.8e3), (0.05, 2.0e3), (8e-3, 2.4e3), (1.5e-3, 2.7e3), (2e-4, 3.5e3)]
NAMED = pytest.mark.parametrize("modes", [MELT, HALF, SOLID], ids=["melt", "half frozen", "solid"])
SPECTRA = st.lists(
    st.tuples(st.floats(-5.0, 10.0), st.floats(-2.0, 6.0)),
    min_size=1,
    max_size=6,
    unique_by=lambda pair: round(pair[0], 1),
).map(lambda pairs: [(10.0**time, 10.0**stiffness) for time, stiffness in pairs])


def test_shape_factor_is_one_loaded_face_over_the_free_sides() -> None:
    # 200 mm^2 of a 20 mm x 10 mm face over 6 mm x 60 mm of sides.
    assert block.shape_factor(20e-3, 10e-3, 6e-3) == pytest.approx(200.0 / 360.0)
    assert block.shape_factor(1.0, 1.0, 1.0) == pytest.approx(0.25)


@pytest.mark.parametrize("poissons_ratio", [0.42, 0.45, 0.48])
def test_slender_block_has_youngs_modulus(poissons_ratio: float) -> None:
    shear = 1.0 / (2.0 * (1.0 + poissons_ratio))
    bulk = block.bulk_modulus(1.0, poissons_ratio)
    assert block.apparent_modulus(shear, bulk, 0.0) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("shape", [3.0, 10.0, 40.0])
def test_flat_block_of_rubber_has_gent_and_lindleys_modulus(shape: float) -> None:
    # Natural rubber: E = 1.5 MPa, bulk modulus 1.2 GPa; 1/E_app = 1/(E (1 + 2 S^2)) + 1/K.
    youngs, bulk = 1.5e6, 1.2e9
    expected = 1.0 / (1.0 / (youngs * (1.0 + 2.0 * shape**2)) + 1.0 / bulk)
    assert block.apparent_modulus(youngs / 3.0, bulk, shape) == pytest.approx(expected, rel=5e-3)


def test_finite_elements_give_plain_compression_without_poissons_ratio() -> None:
    assert bonded_block.apparent_modulus(20.0, 10.0, 6.0, 0.0, (4, 3, 3)) == pytest.approx(1.0, rel=1e-9)


@pytest.mark.parametrize("poissons_ratio", [0.45, 0.4995])
@pytest.mark.parametrize("sides", [(10, 10, 20), (20, 10, 6), (20, 20, 5), (40, 10, 4), (20, 10, 2)])
def test_block_is_within_thirteen_percent_below_finite_elements(
    sides: tuple[float, ...], poissons_ratio: float
) -> None:
    width, height, depth = sides
    elements = bonded_block.apparent_modulus(width, height, depth, poissons_ratio, (10, 10, 7))
    found = block.apparent_modulus(
        1.0 / (2.0 * (1.0 + poissons_ratio)),
        block.bulk_modulus(1.0, poissons_ratio),
        block.shape_factor(width, height, depth),
    )
    assert 0.87 < found / elements < 1.01


def test_stiffness_is_force_times_arm_over_angle() -> None:
    # Four blocks of 200 mm^2, 6 mm deep, at 30 mm: 0.01 rad moves a face 0.3 mm, 5 % of the depth.
    angle, modulus = 0.01, 2e6
    assert block.strain(30e-3, angle, 6e-3) == pytest.approx(0.05)
    torque = 4 * (modulus * 0.05 * 200e-6) * 30e-3
    assert block.stiffness(modulus, 4, 200e-6, 30e-3, 6e-3) * angle == pytest.approx(torque)
    assert block.stress(torque, 4, 200e-6, 30e-3) == pytest.approx(modulus * 0.05)
    assert block.torque_at_stress(modulus * 0.05, 4, 200e-6, 30e-3) == pytest.approx(torque)


def test_modes_and_volume_in_series_are_the_block_at_once_and_at_any_frequency() -> None:
    spectrum, bulk, shape, place = [(1e9, 1e8), (0.3, 4e7)], 1.37e9, 0.7, (4, 200e-6, 30e-3, 6e-3)
    volume = block.stiffness(block.volumetric_modulus(bulk, shape), *place)
    at_once = sum(stiffness for _, stiffness in block.block_modes(spectrum, shape, *place))
    whole = block.stiffness(block.apparent_modulus(1.4e8, bulk, shape), *place)
    assert 1.0 / (1.0 / at_once + 1.0 / volume) == pytest.approx(whole, rel=1e-12)
    modulus = 1.3e8 + 0.2e8j
    factor = block.stiffness(3.0 * block.shape_stiffening(shape), *place)
    parts = series_stiffness(factor * modulus.real, factor * modulus.imag, volume)
    assert complex(*parts) == pytest.approx(block.stiffness(block.apparent_modulus(modulus, bulk, shape), *place))


def test_one_mode_forgets_with_its_exponential() -> None:
    assert block.relaxation_loss(3.0, [(2.0, 70.0)]) == pytest.approx(1.0 - np.exp(-1.5))
    assert block.backlash(0.05, 3.0, [(2.0, 70.0)]) == pytest.approx(0.05 * (1.0 - np.exp(-1.5)))


def test_elastic_block_leaves_no_backlash_and_a_fluid_the_whole_angle() -> None:
    assert block.backlash(0.05, 10.0, [(1e16, 5e4)]) == pytest.approx(0.0, abs=1e-15)
    assert block.backlash(0.05, 1e6, MELT) == pytest.approx(0.05, rel=1e-12)


@given(SPECTRA, st.floats(-4.0, 6.0), st.floats(0.05, 3.0))
def test_longer_hold_never_loses_less(modes: Modes, hold: float, more: float) -> None:
    shorter, longer = 10.0**hold, 10.0 ** (hold + more)
    assert 0.0 <= block.relaxation_loss(shorter, modes) <= block.relaxation_loss(longer, modes) + 1e-12 <= 1.0 + 1e-11
    assert block.backlash(0.05, shorter, modes) <= block.backlash(0.05, longer, modes) + 1e-12 <= 0.05 + 1e-11


@given(SPECTRA, st.floats(-4.0, 6.0), st.floats(0.0, 0.2))
def test_precompression_takes_itself_off_the_backlash(modes: Modes, hold: float, precompression: float) -> None:
    # By hand: the block ahead stands back (0.05 + p) loss - p, the one behind max(p - 0.05, 0) loss - p.
    loss = float(block.relaxation_loss(10.0**hold, modes))
    expected = (0.05 + precompression + max(precompression - 0.05, 0.0)) * loss - 2.0 * precompression
    found = block.backlash(0.05, 10.0**hold, modes, precompression)
    assert found == pytest.approx(max(expected, 0.0), abs=1e-12)


@NAMED
@pytest.mark.parametrize("hold", [1e-3, 0.1, 10.0])
def test_backlash_and_recovery_are_those_of_radau_on_the_torques_of_the_modes(modes: Modes, hold: float) -> None:
    # Other unknowns: torque of each mode, T' = k phi' - T/tau, with sum T = 0 as soon as the block is left.
    tau, k = np.array(modes).T
    torques = solve_ivp(lambda _, y: -y / tau, (0.0, hold), 0.05 * k, method="Radau", rtol=1e-10, atol=1e-10).y[:, -1]
    angle = 0.05 - np.sum(torques) / np.sum(k)
    torques -= k * np.sum(torques) / np.sum(k)
    assert block.backlash(0.05, hold, modes) == pytest.approx(angle, rel=1e-6)

    def free(_: float, y: np.ndarray) -> np.ndarray:
        turning = np.sum(y[1:] / tau) / np.sum(k)
        return np.array([turning, *(k * turning - y[1:] / tau)])

    times = np.array([0.0, 1e-4, 1e-2, 1.0, 30.0])
    reference = solve_ivp(
        free, (0.0, 30.0), np.array([angle, *torques]), method="Radau", t_eval=times, rtol=1e-9, atol=1e-11
    )
    internal = block.held_internal(0.05, hold, modes)
    found = block.recovered_angle(times, internal, modes, retardation(modes))
    assert found == pytest.approx(reference.y[0], abs=1e-7)


def test_standard_linear_solid_recovers_with_its_time_of_retardation() -> None:
    # Findley, ch. 5: springs R and G, time tau; free of load the strain fades with tau (R + G)/R.
    permanent, passing, tau = 200.0, 600.0, 0.5
    modes = [(1e14, permanent), (tau, passing)]
    internal = block.held_internal(0.05, 1.2, modes)
    start = 0.05 * passing * (1.0 - np.exp(-1.2 / tau)) / (permanent + passing)
    for time in (0.0, 0.7, 4.0):
        expected = start * np.exp(-time / (tau * (permanent + passing) / permanent))
        assert block.recovered_angle(time, internal, modes, retardation(modes)) == pytest.approx(expected, rel=1e-6)


def test_maxwells_body_does_not_recover_and_creeps_steadily() -> None:
    modes = [(2.0, 70.0)]
    internal = block.held_internal(0.05, 3.0, modes)
    assert block.recovered_angle(1e3, internal, modes, retardation(modes)) == pytest.approx(internal[0], rel=1e-12)
    assert block.crept_angle(5.0, 7.0, retardation(modes)) == pytest.approx(7.0 / 70.0 * (1.0 + 5.0 / 2.0))


@NAMED
def test_symbols_give_what_floats_give(modes: Modes) -> None:
    names = [ca.SX.sym(name) for name in ("angle", "time", "squeeze", "width", "depth", "shear")]
    angle, time, squeeze, width, depth, shear = names

    def rows(angle: Any, time: Any, squeeze: Any, width: Any, depth: Any, shear: Any) -> list[Any]:
        shape = block.shape_factor(width, 10e-3, depth)
        return [
            block.backlash(angle, time, modes, squeeze),
            block.relaxation_loss(time, modes),
            block.stiffness(
                block.apparent_modulus(shear, block.bulk_modulus(411e6, 0.45), shape), 4, 2e-4, 0.03, depth
            ),
        ]

    numbers = (0.05, 0.02, 0.004, 20e-3, 6e-3, 1.2e8)
    symbolic = ca.vertcat(*rows(angle, time, squeeze, width, depth, shear))
    found = np.asarray(ca.Function("found", names, [symbolic])(*numbers)).ravel()
    assert found == pytest.approx([float(row) for row in rows(*numbers)], rel=1e-12)
