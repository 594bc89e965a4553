"""Shear lag in a lap joint, over a window and around a seated plate, against equations solved by numbers."""

import csv
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from plane_conduction import in_rectangle
from scipy import sparse
from scipy.integrate import solve_bvp, trapezoid
from scipy.sparse.linalg import spsolve
from support import ROOT

from tvimdesign.physics.heat_flow.shape_factors import constriction
from tvimdesign.physics.layers import shear_lag
from tvimdesign.physics.solids import plates

with (ROOT / "validation/fe_structure/windows.csv").open(newline="") as file:
    WINDOWS = list(csv.DictReader(file))


@pytest.mark.parametrize("reach", [0.1, 1.0, 4.0])
def test_the_edge_of_a_lap_of_like_sheets_bears_what_volkersen_says(reach):
    layer, width = 5e10, 0.012  # Pa/m, m
    sheet = 0.5 * reach**2 / (layer * width**2)
    # Volkersen 1938, sheets alike: highest over mean stress (p/2) coth(p/2).
    rise = shear_lag.edge_rise(layer, sheet, sheet, width)
    assert rise == pytest.approx(0.5 * reach / np.tanh(0.5 * reach), rel=1e-12)


@pytest.mark.parametrize(("first", "second"), [(3e-7, 8e-7), (8e-7, 3e-7)])
def test_the_edge_of_unlike_sheets_solves_its_equation(first, second):
    layer, width = 5e10, 0.012

    def slopes(_: np.ndarray, y: np.ndarray) -> np.ndarray:
        force, slip = y  # of the second sheet, of 1 N/m in all; force in the first is what is left
        return np.vstack([layer * slip, second * force - first * (1.0 - force)])

    grid = np.linspace(0.0, width, 400)
    # The whole force enters the first sheet at 0 and leaves the second at the width.
    solved = solve_bvp(slopes, lambda a, b: np.array([a[0], b[0] - 1.0]), grid, np.zeros((2, grid.size)), tol=1e-9)
    edge = layer * solved.sol(width)[1] * width
    assert shear_lag.edge_rise(layer, first, second, width) == pytest.approx(edge, rel=1e-6)


@pytest.mark.parametrize("half", [0.2e-3, 1e-3, 5e-3])
def test_what_is_borne_over_a_window_agrees_with_its_equation_solved(half):
    layer, sheet = 1.2e11, 1.0 / (0.1e9 * 1.5e-3)

    def slopes(_: np.ndarray, y: np.ndarray) -> np.ndarray:
        moved, flow = y  # of the sheet, whose upper face is driven by one metre through the layer
        return np.vstack([sheet * flow, -layer * (1.0 - moved)])

    grid = np.linspace(0.0, half, 400)
    # Held at the rim; no flow in the middle.
    solved = solve_bvp(slopes, lambda a, b: np.array([a[0], b[1]]), grid, np.zeros((2, grid.size)), tol=1e-9)
    share = solved.sol(0.0)[1] / (layer * half)
    assert shear_lag.borne_over_window(layer, sheet, half) == pytest.approx(share, rel=1e-5)


def lost_width(window: float, fine: int) -> float:
    """Return how much less a strip of the thickness one passes on for a free stretch of its lower face, by differences.

    Its upper face is moved by one, its lower one held beyond the `window`, from x = 0 where it is symmetrical.
    """
    columns, rows = round((window + 3.0) * fine) + 1, fine + 1
    at = np.arange(columns * rows).reshape(columns, rows)
    wide, tall = np.ones(columns), np.ones(rows)
    wide[[0, -1]], tall[[0, -1]] = 0.5, 0.5
    pairs = np.concatenate(
        [np.stack([at[:-1].ravel(), at[1:].ravel()]), np.stack([at[:, :-1].ravel(), at[:, 1:].ravel()])], 1
    )
    flow = np.concatenate([np.tile(tall, columns - 1), np.repeat(wide, rows - 1)])
    whole: Any = sparse.coo_matrix(
        (np.tile(-flow, 2), (pairs.ravel(), pairs[::-1].ravel())), shape=(at.size, at.size)
    ).tocsr()
    whole += sparse.diags(-np.asarray(whole.sum(axis=1)).ravel())
    moved, free = np.zeros(at.size), np.ones(at.size, dtype=bool)
    moved[at[:, -1]] = 1.0
    free[at[:, -1]] = False
    free[at[np.arange(columns) / fine > window - 1e-9, 0]] = False
    moved[free] = spsolve(whole[free][:, free].tocsc(), -whole[free] @ moved)
    return (columns - 1) / fine - float(moved @ (whole @ moved))


@pytest.mark.parametrize("half", [0.5, 1.0, 2.0, 3.5])
def test_a_pad_beside_a_window_is_held_as_a_harmonic_function_has_it(half):
    # The mesh holds up to the last free point, so that its window is half a step narrower: errors fall with the step.
    coarse, fine = (lost_width(half, count) for count in (20, 40))
    share = 1.0 - (2.0 * fine - coarse) / half
    assert shear_lag.held_over_window(1.0, half) == pytest.approx(share, abs=0.004)


def test_windows_beside_their_limits():
    # The fringe of a strip line of no thickness, 2 ln 2/pi of the distance from its plane to the wall beside it.
    assert 10.0 * shear_lag.held_over_window(1.0, 10.0) == pytest.approx(0.4413, abs=1e-4)
    assert shear_lag.held_over_window(1.0, 0.0) == pytest.approx(1.0, abs=1e-5)
    # Poisson's ratio of a quarter: K = 5 G/3.
    assert shear_lag.end_fringe(3.0, 0.0) == pytest.approx(shear_lag.end_fringe(3.0, 5.0), rel=1e-12)


@pytest.mark.parametrize("row", WINDOWS, ids=lambda row: "-".join(list(row.values())[:3]))
def test_an_end_of_a_window_is_held_as_strips_in_plane_strain_are(row):
    half, poisson, held = (float(row[name]) for name in ("half_window", "poissons_ratio", "held"))
    fringe = shear_lag.end_fringe(1.0, 2.0 * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson)))
    # Of a thickness; one that keeps its volume leans on more of a ledge that is three thicknesses long.
    leans = 0.07 if row["ledge"] == "3" else 0.04
    assert half * shear_lag.held_over_window(1.0, half, fringe) == pytest.approx(held, abs=leans)


FINE, LONG = 40, 5.0
"""Cells over the sheet's thickness; length of the strip in thicknesses."""


def traction(held: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distance from the wall in thicknesses and the layer's traction over that far away, in the middle of cells.

    The twist of square cells: fixed on the bottom and at the wall, the layer's resistance at the face in series with
    half a cell, nothing through the far end.
    """
    across, along = FINE, round(LONG * FINE)

    by_layer = 1.0 / (0.5 + FINE / held)
    pulled = np.zeros((along, across))
    pulled[:, 0] = by_layer
    moved = in_rectangle(pulled, (along, 2.0, 0.0), (across, by_layer, 2.0))[:, 0]
    tau = by_layer * (1.0 - moved)
    return (np.arange(along) + 0.5) / FINE, tau / tau[-1]


@pytest.mark.parametrize("held", [0.1, 0.44, 1.0, 3.0])
def test_the_rim_is_that_of_finite_differences(held):
    places, tau = traction(held)
    for reach in (0.25, 0.5, 1.0):
        near = tau[places < reach].mean()
        assert shear_lag.rim_rise(held, reach) == pytest.approx(near, rel=4e-3)
    assert shear_lag.rim_width(held) == pytest.approx((tau - 1.0).sum() / FINE, rel=0.02)


def test_at_the_wall_itself_the_sheet_gives_nothing():
    for held in (0.2, 1.0):
        assert shear_lag.rim_rise(held, 1e-4) == pytest.approx(1.0 + held, rel=0.02)
        assert shear_lag.rim_rise(held, 100.0) == pytest.approx(1.0 + shear_lag.rim_width(held) / 100.0)


DEPTH = 1.5e-3


def solved(coupled: np.ndarray, enters: np.ndarray, lap: shear_lag.AnnularLap) -> tuple[float, float, float, float]:
    """Return rises at edges over T r_o/J, the upper sheet's share, and the traction's mean square over an even one.

    Rises are means over `DEPTH`. Of F'' - 3 F'/r = A F - b, F of each layer 0 at the inner edge and 1 at the outer.
    """
    a, b, count = lap.inner, lap.outer, len(enters)

    def slopes(r: np.ndarray, y: np.ndarray) -> np.ndarray:
        over, slope = y[:count], y[count : 2 * count]
        pulled = 3.0 * slope / r + coupled @ over - enters[:, None]
        return np.vstack([slope, pulled, (1.0 - over[0]) ** 2 / r**3, slope[0] ** 2 / r**3])

    def ends(at: np.ndarray, to: np.ndarray) -> np.ndarray:
        return np.concatenate([at[:count], to[:count] - 1.0, at[2 * count :]])

    grid = np.linspace(a, b, 100)
    solution = solve_bvp(slopes, ends, grid, np.ones((2 * count + 2, grid.size)), tol=1e-6)
    even = 0.75 * (b**4 - a**4) / b
    inner = solution.sol(a + DEPTH)[0] * even / ((a + DEPTH) ** 3 - a**3)
    outer = (1.0 - solution.sol(b - DEPTH)[0]) * even / (b**3 - (b - DEPTH) ** 3)
    share = solution.sol(b)[-2] / (0.5 * (a**-2 - b**-2))
    square = solution.sol(b)[-1] * 0.25 * (b**4 - a**4)
    return inner, outer, share, square


def agrees(lap: shear_lag.AnnularLap, by_numbers: tuple[float, float, float, float]) -> None:
    at_inner, at_outer, share, square = by_numbers
    rises = shear_lag.edge_rises(lap, DEPTH)
    assert rises[0] == pytest.approx(at_inner, rel=0.04)
    assert rises[1] == pytest.approx(at_outer, rel=0.01)
    assert shear_lag.upper_share(lap) == pytest.approx(share, rel=0.01)
    assert shear_lag.unevenness(lap) == pytest.approx(square, rel=0.03)


@pytest.mark.parametrize("outer_share", [0.0, 0.16, 0.5, 0.9])
@pytest.mark.parametrize("reach", [0.5, 1.5, 3.4, 5.0])
@pytest.mark.parametrize("inner", [15e-3, 21e-3])
def test_edges_and_sheet_of_a_lap_in_the_round_are_as_its_equation_says(outer_share, reach, inner):
    outer = 27.5e-3
    lag = reach / (outer - inner)
    lap = shear_lag.annular_lap(lag**2, 1.0 - outer_share, outer_share, (inner, outer))
    agrees(lap, solved(np.array([[lag**2]]), np.array([lag**2 * (1.0 - outer_share)]), lap))


@pytest.mark.parametrize("inward", [0.1, 0.5])
def test_a_lower_sheet_that_hands_torque_on_inward_keeps_less(inward):
    # F'' - 3 F'/r = k (a_below (F - b) - a_above (1 - F)), by numbers: b leaves the lower sheet at the inner edge.
    radii, layer, upper, lower = (15e-3, 27.5e-3), 2.1e11, 1e-8, 7e-8
    lap = shear_lag.annular_lap(layer, upper, lower, radii, inward)
    agrees(lap, solved(np.array([[layer * (upper + lower)]]), np.array([layer * (upper + inward * lower)]), lap))


def test_limits_of_an_annular_lap():
    lap = shear_lag.annular_lap(1e10, 1e-12, 2e-12, (15e-3, 27.5e-3))
    assert shear_lag.edge_rises(lap, 1e-5) == pytest.approx((15.0 / 27.5, 1.0), rel=1e-3)
    # Volkersen's lap joint, of whose load the lower sheet bears 0.7 in the middle.
    layer, upper, lower, width = 5e10, 7e-7, 3e-7, 0.012
    lap = shear_lag.annular_lap(layer, upper, lower, (10.0, 10.0 + width))
    inner, outer = shear_lag.edge_rises(lap, 1e-5)
    assert outer == pytest.approx(shear_lag.edge_rise(layer, upper, lower, width), rel=5e-3)
    assert inner == pytest.approx(shear_lag.edge_rise(layer, lower, upper, width), rel=5e-3)
    # A printed plate on a spreader of aluminum: the bonds of the inner rim bear several times those of the outer.
    lap = shear_lag.annular_lap(1.8e11, 1.0 / 2.9e6, 1.0 / 15e6, (15e-3, 27.5e-3))
    inner, outer = shear_lag.edge_rises(lap, 1e-5)
    assert inner > 3.0 * outer


def test_ends_of_an_arc_bear_what_a_plate_brings_in_over_the_gap():
    # E h u'' = k u - f above an arc, -f over the gap, by numbers; u' is 0 in the middle of both.
    layer, sheet, arc, gap = 7.6e10, 8.5e6, 14e-3, 2.6e-3
    x = np.linspace(0.0, 1.0, 50)

    def slopes(_: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.vstack([y[1] * arc, (layer * y[0] - 1.0) / sheet * arc])

    bar = solve_bvp(slopes, lambda at, to: np.array([at[1], to[1] - gap / sheet]), x, np.ones((2, x.size)), tol=1e-6)
    traction = layer * bar.sol(x)[0]
    assert shear_lag.end_rise(layer, sheet, arc, gap) == pytest.approx(traction[-1] / trapezoid(traction, x), rel=1e-3)
    assert shear_lag.end_rise(layer, 1e6 * sheet, arc, gap) == pytest.approx(1.0, rel=1e-3)  # a stiff one turns as one
    assert shear_lag.end_rise(layer, sheet, arc, 0.0) == pytest.approx(1.0)


RADII, AROUND = (15e-3, 27.5e-3), 3 * 1.9


def seat(floor: float = 0.85e9) -> plates.Seat:
    return plates.Seat(0.5e-3, 0.9e-3, constriction(0.9 / 6.5), 0.72e9, floor)


def test_in_a_stiff_floor_adhesive_is_sheared_as_the_radius():
    # Volkersen's layer without stretch: tau = G theta r/g on the areas 2 pi s r t, so T = G theta t s (a^3 + b^3)/g.
    path = plates.path(seat(1e16), AROUND, RADII, 0.0)
    turned = 0.5e-3 / (0.72e9 * 0.9e-3 * AROUND * (RADII[0] ** 3 + RADII[1] ** 3))
    assert path.adhesive == pytest.approx(turned, rel=1e-6)
    assert path.floor == pytest.approx(0.0, abs=1e-6 * turned)
    for traction, radius in ((path.inner_traction, RADII[0]), (path.outer_traction, RADII[1])):
        assert traction == pytest.approx(0.72e9 * turned * radius / 0.5e-3, rel=1e-6)


@pytest.mark.parametrize("between", [0.0, 1e-5, 1e-3])
def test_both_rims_together_bear_the_torque(between):
    path = plates.path(seat(), AROUND, RADII, between)
    areas = [AROUND * radius * 0.9e-3 for radius in RADII]
    borne = path.inner_traction * areas[0] * RADII[0] + path.outer_traction * areas[1] * RADII[1]
    assert borne == pytest.approx(1.0, rel=1e-12)
    assert path.inward == pytest.approx(path.inner_traction * areas[0] * RADII[0], rel=1e-12)


def test_the_torque_takes_the_ways_that_give_least():
    # Castigliano: of all shares the one that is taken stores the least energy.
    between, bonded = 2e-5, seat()
    path = plates.path(bonded, AROUND, RADII, between)
    inner, outer = (sum(plates.slips(bonded)) / (AROUND * radius**3) for radius in RADII)

    def stored(share: float) -> float:
        return share**2 * (inner + between) + (1.0 - share) ** 2 * outer

    shares = np.linspace(0.0, 1.0, 2001)
    assert path.inward == pytest.approx(shares[np.argmin([stored(share) for share in shares])], abs=5e-4)
    assert path.adhesive + path.floor == pytest.approx(stored(path.inward), rel=1e-12)
