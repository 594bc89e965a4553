"""The lap joint in the round against its differential equation solved by numbers, and against its limits."""

import numpy as np
import pytest
from scipy.integrate import solve_bvp

from tvimdesign.physics.layers import annular_lap, shear_lag


def solved(coupled: np.ndarray, enters: np.ndarray, lap: annular_lap.AnnularLap) -> tuple[float, float, float, float]:
    """Rises at both edges over T r_o/J, the upper sheet's share, and the traction's mean square over an even one's.

    Of F'' - 3 F'/r = A F - b, F of each layer 0 at the inner edge and 1 at the outer, by numbers.
    """
    a, b, count = lap.inner, lap.outer, len(enters)

    def slopes(r: np.ndarray, y: np.ndarray) -> np.ndarray:
        over, slope = y[:count], y[count : 2 * count]
        pulled = 3.0 * slope / r + coupled @ over - enters[:, None]
        return np.vstack([slope, pulled, (1.0 - over[0]) ** 2 / r**3, slope[0] ** 2 / r**3])

    def ends(at: np.ndarray, to: np.ndarray) -> np.ndarray:
        return np.concatenate([at[:count], to[:count] - 1.0, at[2 * count :]])

    grid = np.linspace(a, b, 100)
    found = solve_bvp(slopes, ends, grid, np.ones((2 * count + 2, grid.size)), tol=1e-6)
    even = 0.25 * (b**4 - a**4) / b
    share = found.sol(b)[-2] / (0.5 * (a**-2 - b**-2))
    square = found.sol(b)[-1] * 0.25 * (b**4 - a**4)
    return found.sol(a)[count] * even / a**2, found.sol(b)[count] * even / b**2, share, square


def agrees(lap: annular_lap.AnnularLap, by_numbers: tuple[float, float, float, float]) -> None:
    at_inner, at_outer, share, square = by_numbers
    found = annular_lap.edge_rises(lap)
    assert found[0] == pytest.approx(at_inner, rel=0.04)
    assert found[1] == pytest.approx(at_outer, rel=0.01)
    assert annular_lap.upper_share(lap) == pytest.approx(share, rel=0.01)
    assert annular_lap.unevenness(lap) == pytest.approx(square, rel=0.03)


@pytest.mark.parametrize("rest", [0.0, 0.16, 0.5, 0.9])
@pytest.mark.parametrize("reach", [0.5, 1.5, 3.4, 5.0])
@pytest.mark.parametrize("inner", [15e-3, 21e-3])
def test_edges_and_sheet_of_a_lap_in_the_round_are_as_its_equation_says(
    rest: float, reach: float, inner: float
) -> None:
    outer = 27.5e-3
    lag = reach / (outer - inner)
    lap = annular_lap.annular_lap(lag**2, 1.0 - rest, rest, (inner, outer))
    agrees(lap, solved(np.array([[lag**2]]), np.array([lag**2 * (1.0 - rest)]), lap))


# Plate, spreader with modules, and floor, printed and milled; layers of PCL and of modules [Pa*m and Pa/m].
@pytest.mark.parametrize("sheets", [(2.9e6, 1.3e7, 1.2e6), (9.8e7, 1.4e7, 4.0e7), (1e8, 3e6, 1e8)])
@pytest.mark.parametrize("layers", [(2.1e11, 1.8e11), (8e10, 1.8e11), (2.1e11, 2e10)])
def test_two_layers_between_three_sheets_are_as_their_equations_say(
    sheets: tuple[float, float, float], layers: tuple[float, float]
) -> None:
    (upper, between, lower), (first, second) = (1.0 / sheet for sheet in sheets), layers
    lap = annular_lap.lap_of_three(layers, (upper, between, lower), (17.4e-3, 29.7e-3))
    coupled = [[first * (upper + between), -first * between], [-second * between, second * (between + lower)]]
    agrees(lap, solved(np.array(coupled), np.array([first * upper, 0.0]), lap))


def test_a_floor_that_is_held_fast_to_its_spreader_is_one_sheet_with_it() -> None:
    radii, layer, upper, between, lower = (17.4e-3, 29.7e-3), 2.1e11, 1e-8, 7e-8, 2.5e-8
    three = annular_lap.lap_of_three((layer, 1e14), (upper, between, lower), radii)
    two = annular_lap.annular_lap(layer, upper, 1.0 / (1.0 / between + 1.0 / lower), radii)
    assert annular_lap.edge_rises(three) == pytest.approx(annular_lap.edge_rises(two), rel=0.03)
    assert annular_lap.upper_share(three) == pytest.approx(annular_lap.upper_share(two), rel=0.03)


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
