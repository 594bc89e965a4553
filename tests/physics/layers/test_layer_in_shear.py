"""The sheared layer against quadrature and against complex arithmetic done by Python."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from tvimdesign.physics.bodies.shapes import sector
from tvimdesign.physics.layers import layer

SPAN, INNER, OUTER = 4.0 * 0.8546, 26e-3, 40e-3
moduli = st.tuples(st.floats(1e2, 1e9), st.floats(1e2, 1e9))


def test_two_slices_in_series_as_worked_by_hand() -> None:
    # G1 = 3 + 4i, G2 = 1: the mean of 1/G is ((3 - 4i)/25 + 1)/2 = 0.56 - 0.08i; its inverse 1.75 + 0.25i.
    assert layer.series_modulus(np.array([3.0, 1.0]), np.array([4.0, 0.0])) == pytest.approx((1.75, 0.25), rel=1e-12)


@given(slices=st.lists(moduli, min_size=1, max_size=8))
def test_slices_in_series_add_their_complex_compliances(slices: list[tuple[float, float]]) -> None:
    expected = 1.0 / np.mean([1.0 / complex(*pair) for pair in slices])
    storage, loss = layer.series_modulus(*np.array(slices).T)
    assert complex(storage, loss) == pytest.approx(expected, rel=1e-9)


@given(branch=moduli, support=st.floats(1e2, 1e9))
def test_a_branch_behind_a_support_is_the_complex_series(branch: tuple[float, float], support: float) -> None:
    star = complex(*branch)
    expected = star * support / (star + support)
    assert complex(*layer.series_stiffness(*branch, support)) == pytest.approx(expected, rel=1e-9)


@given(slices=st.lists(moduli, min_size=2, max_size=8))
def test_no_slice_in_series_can_make_the_layer_more_than_its_share_softer(slices: list[tuple[float, float]]) -> None:
    # The magnitudes: n |G|_min >= |G| since no compliance is negative, and all lie in one quadrant.
    magnitude = abs(complex(*layer.series_modulus(*np.array(slices).T)))
    softest = min(abs(complex(*pair)) for pair in slices)
    assert softest * (1.0 - 1e-9) <= magnitude <= len(slices) * softest * (1.0 + 1e-9)


def test_strain_of_50_mm_and_1_mm_at_the_papers_stroke_is_520_percent() -> None:
    assert layer.shear_strain(50e-3, 0.104, 1e-3) == pytest.approx(5.2, rel=1e-12)


def test_torque_at_a_traction_is_the_moment_of_a_linear_traction() -> None:
    limit = 2e6
    expected, _ = quad(lambda r: (limit * r / OUTER) * r * SPAN * r, INNER, OUTER, epsabs=0.0, epsrel=1e-12)
    found = layer.torque_at_traction(limit, sector(SPAN, INNER, OUTER).polar, OUTER)
    assert found == pytest.approx(expected, rel=1e-10)
