"""The sheared layer under load, melting and freezing, against quadrature, complex numbers, Radau and passivity."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

from tvimdesign.physics.layers import lasting_load, layer
from tvimdesign.physics.motions.motion import Modes
from tvimdesign.physics.solids.shapes import sector

SPAN, INNER, OUTER = 4.0 * 0.8546, 26e-3, 40e-3
moduli = st.tuples(st.floats(1e2, 1e9), st.floats(1e2, 1e9))


def test_two_slices_in_series_as_worked_by_hand():
    # G1 = 3 + 4i, G2 = 1: the mean of 1/G is ((3 - 4i)/25 + 1)/2 = 0.56 - 0.08i; its inverse 1.75 + 0.25i.
    assert layer.series_modulus(np.array([3.0, 1.0]), np.array([4.0, 0.0])) == pytest.approx((1.75, 0.25), rel=1e-12)


@given(slices=st.lists(moduli, min_size=1, max_size=8))
def test_slices_in_series_add_their_complex_compliances(slices):
    expected = 1.0 / np.mean([1.0 / complex(*pair) for pair in slices])
    storage, loss = layer.series_modulus(*np.array(slices).T)
    assert complex(storage, loss) == pytest.approx(expected, rel=1e-9)


@given(branch=moduli, support=st.floats(1e2, 1e9))
def test_a_branch_behind_a_support_is_the_complex_series(branch, support):
    star = complex(*branch)
    expected = star * support / (star + support)
    assert complex(*layer.series_stiffness(*branch, support)) == pytest.approx(expected, rel=1e-9)


@given(slices=st.lists(moduli, min_size=2, max_size=8))
def test_no_slice_in_series_can_make_the_layer_more_than_its_share_softer(slices):
    # The magnitudes: n |G|_min >= |G| since no compliance is negative, and all lie in one quadrant.
    magnitude = abs(complex(*layer.series_modulus(*np.array(slices).T)))
    softest = min(abs(complex(*pair)) for pair in slices)
    assert softest * (1.0 - 1e-9) <= magnitude <= len(slices) * softest * (1.0 + 1e-9)


def test_strain_and_torque_of_a_layer_by_hand():
    assert layer.shear_strain(50e-3, 0.104, 1e-3) == pytest.approx(5.2, rel=1e-12)
    limit = 2e6
    expected, _ = quad(lambda r: (limit * r / OUTER) * r * SPAN * r, INNER, OUTER, epsabs=0.0, epsrel=1e-12)
    torque = layer.torque_at_traction(limit, sector(SPAN, INNER, OUTER).polar, OUTER)
    assert torque == pytest.approx(expected, rel=1e-10)


SPRINGS, STRUCTURE, LOAD = 5.61, 919.0, 0.583
MELT = [(2.07e-2, 82.0), (6.5e-3, 104.0), (2.07e-3, 131.0), (6.5e-4, 165.0), (2.07e-4, 207.0), (6.5e-5, 261.0)]
SOLID = [(1e10, 2.1e5), (10.0, 1.8e4), (1.0, 1.7e4), (0.1, 1.9e4), (0.01, 1.9e4), (0.001, 2.6e4)]
HALF = [(300.0, 56.0), (0.4, 180.0), (0.05, 200.0), (8e-3, 240.0), (1.5e-3, 270.0), (2e-4, 350.0)]
SPECTRA = {"melt": MELT, "half frozen": HALF, "solid": SOLID, "fluid": [(1.0, 300.0)]}
WITHIN = 4e-4


@pytest.mark.parametrize("time", [1e-3, 0.3, 4.0, 100.0])
def test_one_mode_beside_springs_creeps_as_zeners_solid(time):
    # Findley, ch. 5: springs K_s beside k with a dashpot, retarded with tau (K_s + k)/K_s; the structure rigid.
    k, tau = 300.0, 0.1
    fading = np.exp(-time / (tau * (SPRINGS + k) / SPRINGS))
    angle = LOAD / SPRINGS * (1.0 - k / (SPRINGS + k) * fading)
    creep = lasting_load.held(LOAD, time, SPRINGS, 1e14, [(tau, k)])
    assert creep.angle == pytest.approx(angle, rel=WITHIN)
    # The one dashpot is where the mode is free of stress: theta less its torque over k.
    free = angle - (LOAD - SPRINGS * angle) / k
    assert creep.set_angle == pytest.approx(free, rel=WITHIN)


def by_radau(modes: Modes, time: float) -> tuple[float, float]:
    """Angle, and where the modes are free of stress; unknowns are the angle and the torques of the modes."""
    tau, k = np.array(modes).T
    first = LOAD / (SPRINGS + 1.0 / (1.0 / STRUCTURE + 1.0 / np.sum(k)))

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        lost = np.sum(y[1:] / tau)
        carried = -STRUCTURE * lost / np.sum(k) / (1.0 + STRUCTURE / SPRINGS + STRUCTURE / np.sum(k))
        return np.array([-carried / SPRINGS, *(k * (carried + lost) / np.sum(k) - y[1:] / tau)])

    begin = np.array([first, *((LOAD - SPRINGS * first) * k / np.sum(k))])
    angle, *torques = solve_ivp(rates, (0.0, time), begin, method="Radau", rtol=1e-8, atol=1e-10).y[:, -1]
    return float(angle), float(angle - sum(torques) * (1.0 / STRUCTURE + 1.0 / np.sum(k)))


@pytest.mark.parametrize("time", [1e-3, 0.1, 1.0, 10.0, 1000.0])
@pytest.mark.parametrize("spectrum", SPECTRA)
def test_angle_and_set_are_those_of_radau(spectrum, time):
    modes = SPECTRA[spectrum]
    angle, free = by_radau(modes, time)
    assert lasting_load.held(LOAD, time, SPRINGS, STRUCTURE, modes) == pytest.approx((angle, free), rel=WITHIN)


def test_a_load_is_shared_by_stiffness_and_sets_as_far_as_spectra_relax():
    # 450 behind 919 is 302.1 N*m/rad, beside 5.61.
    borne = lasting_load.first_torque(LOAD, SPRINGS, STRUCTURE, [(1.0, 150.0), (9.0, 300.0)])
    assert borne == pytest.approx(0.583 * 302.09 / 307.70, rel=1e-4)
    later = lasting_load.held(LOAD, 1e-9, SPRINGS, STRUCTURE, [(1.0, 150.0), (9.0, 300.0)]).angle
    assert LOAD - SPRINGS * later == pytest.approx(borne, rel=1e-6)
    assert lasting_load.held(LOAD, 10.0, SPRINGS, STRUCTURE, [(1e16, 300.0)]).set_angle < 1e-15
    assert lasting_load.held(LOAD, 1e6, SPRINGS, STRUCTURE, MELT).set_angle == pytest.approx(LOAD / SPRINGS, rel=1e-9)
    # To 0.1 rad 302.1 + 5.61 N*m/rad take 30.77 N*m; behind a gap of 0.04 rad the branch 18.13 and the springs 0.561.
    loss = lasting_load.impedance_loss(0.1, 0.04, SPRINGS, STRUCTURE, [(1.0, 150.0), (9.0, 300.0)])
    assert loss == pytest.approx(1.0 - (18.13 + 0.561) / 30.77, rel=1e-3)
    assert lasting_load.impedance_loss(0.1, 0.0, SPRINGS, STRUCTURE, MELT) == 0.0


@given(st.floats(-3.0, 5.0), st.floats(0.1, 3.0))
def test_longer_holds_creep_further_and_never_beyond_the_springs(time, more):
    for modes in SPECTRA.values():
        shorter, longer = (lasting_load.held(LOAD, 10.0**t, SPRINGS, STRUCTURE, modes) for t in (time, time + more))
        assert 0.0 <= shorter.set_angle <= longer.set_angle * (1.0 + WITHIN)
        assert longer.set_angle <= longer.angle * (1.0 + WITHIN) <= LOAD / SPRINGS * (1.0 + 2.0 * WITHIN)
