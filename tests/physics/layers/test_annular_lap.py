"""The lap joint in the round against its differential equation solved by numbers, and against its limits."""

import numpy as np
import pytest
from scipy.integrate import solve_bvp

from tvimdesign.physics.layers import annular_lap, shear_lag


def solved(lap: annular_lap.AnnularLap) -> tuple[float, float, float, float]:
    """Rises at both edges over T r_o/J, the upper sheet's share, and the traction's mean square over an even one's.

    Of M'' - 3 M'/r = l^2 (M - n), by numbers.
    """
    a, b = lap.inner, lap.outer

    def slopes(r: np.ndarray, y: np.ndarray) -> np.ndarray:
        torque, slope, _, _ = y
        pulled = 3.0 * slope / r + lap.lag**2 * (torque - lap.rest)
        return np.vstack([slope, pulled, torque**2 / r**3, slope**2 / r**3])

    grid = np.linspace(a, b, 100)
    found = solve_bvp(
        slopes, lambda at, to: np.array([at[0] - 1.0, to[0], at[2], at[3]]), grid, np.ones((4, grid.size)), tol=1e-6
    )
    even = 0.25 * (b**4 - a**4) / b
    share = found.sol(b)[2] / (0.5 * (a**-2 - b**-2))
    square = found.sol(b)[3] * 0.25 * (b**4 - a**4)
    return -found.sol(a)[1] * even / a**2, -found.sol(b)[1] * even / b**2, share, square


@pytest.mark.parametrize("rest", [0.0, 0.16, 0.5, 0.9])
@pytest.mark.parametrize("reach", [0.5, 1.5, 3.4, 5.0])
@pytest.mark.parametrize("inner", [15e-3, 21e-3])
def test_edges_and_sheet_of_a_lap_in_the_round_are_as_its_equation_says(
    rest: float, reach: float, inner: float
) -> None:
    outer = 27.5e-3
    lap = annular_lap.AnnularLap(reach / (outer - inner), rest, inner, outer)
    at_inner, at_outer, share, square = solved(lap)
    found = annular_lap.edge_rises(lap)
    assert found[0] == pytest.approx(at_inner, rel=0.04)
    assert found[1] == pytest.approx(at_outer, rel=0.01)
    assert annular_lap.upper_share(lap) == pytest.approx(share, rel=0.01)
    assert annular_lap.unevenness(lap) == pytest.approx(square, rel=0.03)


def test_between_stiff_sheets_the_traction_goes_with_the_radius() -> None:
    lap = annular_lap.annular_lap(1e10, 1e-12, 2e-12, (15e-3, 27.5e-3))
    assert annular_lap.edge_rises(lap) == pytest.approx((15.0 / 27.5, 1.0), rel=1e-4)


def test_far_from_the_axis_the_lap_is_a_straight_one() -> None:
    # Volkersen's lap joint, of whose load the lower sheet bears 0.7 in the middle.
    layer, upper, lower, width = 5e10, 7e-7, 3e-7, 0.012
    lap = annular_lap.annular_lap(layer, upper, lower, (10.0, 10.0 + width))
    inner, outer = annular_lap.edge_rises(lap)
    assert outer == pytest.approx(shear_lag.edge_rise(layer, upper, lower, width), rel=5e-3)
    assert inner == pytest.approx(shear_lag.edge_rise(layer, lower, upper, width), rel=5e-3)


def test_on_a_rigid_sheet_the_torque_leaves_at_the_inner_edge() -> None:
    # A printed plate on a spreader of aluminum: the bonds of the inner rim bear several times those of the outer.
    lap = annular_lap.annular_lap(1.8e11, 1.0 / 2.9e6, 1.0 / 15e6, (15e-3, 27.5e-3))
    inner, outer = annular_lap.edge_rises(lap)
    assert inner > 3.0 * outer
