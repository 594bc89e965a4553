"""Shear lag in a lap joint and over a window: Volkersen's result for like sheets, the equations solved by numbers."""

import csv
from typing import Any

import numpy as np
import pytest
from scipy import sparse
from scipy.integrate import solve_bvp
from scipy.sparse.linalg import spsolve
from support import ROOT

from tvimdesign.physics.layers import shear_lag

with (ROOT / "validation/fe_structure/windows.csv").open(newline="") as file:
    WINDOWS = list(csv.DictReader(file))


@pytest.mark.parametrize("reach", [0.1, 1.0, 4.0])
def test_the_edge_of_a_lap_of_like_sheets_bears_what_volkersen_says(reach: float) -> None:
    layer, width = 5e10, 0.012  # Pa/m, m
    sheet = 0.5 * reach**2 / (layer * width**2)
    # Volkersen 1938, sheets alike: highest over mean stress (p/2) coth(p/2).
    found = shear_lag.edge_rise(layer, sheet, sheet, width)
    assert found == pytest.approx(0.5 * reach / np.tanh(0.5 * reach), rel=1e-12)


def test_stiff_sheets_load_a_layer_evenly() -> None:
    assert shear_lag.edge_rise(1e6, 1e-9, 1e-9, 0.01) == pytest.approx(1.0, rel=1e-6)


@pytest.mark.parametrize(("first", "second"), [(3e-7, 8e-7), (8e-7, 3e-7)])
def test_the_edge_of_a_lap_of_unlike_sheets_agrees_with_its_equation_solved(first: float, second: float) -> None:
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
def test_what_is_borne_over_a_window_agrees_with_its_equation_solved(half: float) -> None:
    layer, sheet = 1.2e11, 1.0 / (0.1e9 * 1.5e-3)

    def slopes(_: np.ndarray, y: np.ndarray) -> np.ndarray:
        moved, flow = y  # of the sheet, whose upper face is driven by one metre through the layer
        return np.vstack([sheet * flow, -layer * (1.0 - moved)])

    grid = np.linspace(0.0, half, 400)
    # Held at the rim; no flow in the middle.
    solved = solve_bvp(slopes, lambda a, b: np.array([a[0], b[1]]), grid, np.zeros((2, grid.size)), tol=1e-9)
    share = solved.sol(0.0)[1] / (layer * half)
    assert shear_lag.borne_over_window(layer, sheet, half) == pytest.approx(share, rel=1e-5)


def test_a_window_of_no_width_costs_nothing() -> None:
    assert shear_lag.borne_over_window(1e11, 1e-5, 0.0) == pytest.approx(1.0, abs=1e-9)


def lost_width(window: float, fine: int) -> float:
    """How much less a strip of the thickness one passes on for a free stretch of its lower face, by differences.

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
def test_a_pad_beside_a_window_is_held_as_a_harmonic_function_has_it(half: float) -> None:
    # The mesh holds up to the last free point, so that its window is half a step narrower: errors fall with the step.
    coarse, fine = (lost_width(half, count) for count in (20, 40))
    share = 1.0 - (2.0 * fine - coarse) / half
    assert shear_lag.held_over_window(1.0, half) == pytest.approx(share, abs=0.004)


def test_beside_a_wide_window_a_strip_of_its_own_width_holds_a_pad() -> None:
    # The fringe of a strip line of no thickness, 2 ln 2/pi of the distance from its plane to the wall beside it.
    assert 10.0 * shear_lag.held_over_window(1.0, 10.0) == pytest.approx(0.4413, abs=1e-4)
    assert shear_lag.held_over_window(1.0, 0.0) == pytest.approx(1.0, abs=1e-5)


@pytest.mark.parametrize("row", WINDOWS, ids=lambda row: "-".join(list(row.values())[:3]))
def test_an_end_of_a_window_is_held_as_strips_in_plane_strain_are(row: dict[str, str]) -> None:
    half, poisson, held = (float(row[name]) for name in ("half_window", "poissons_ratio", "held"))
    fringe = shear_lag.end_fringe(1.0, 2.0 * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson)))
    # Of a thickness; one that keeps its volume leans on more of a ledge that is three thicknesses long.
    leans = 0.07 if row["ledge"] == "3" else 0.04
    assert half * shear_lag.held_over_window(1.0, half, fringe) == pytest.approx(held, abs=leans)


def test_an_end_of_a_window_below_a_pad_of_no_known_bulk_modulus_is_that_of_a_quarter() -> None:
    # Poisson's ratio of a quarter: K = 5 G/3.
    assert shear_lag.end_fringe(3.0, 0.0) == pytest.approx(shear_lag.end_fringe(3.0, 5.0), rel=1e-12)
