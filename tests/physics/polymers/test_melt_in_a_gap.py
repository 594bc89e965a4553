"""Melt in a thin gap: against Stokes' equation on a grid, a squeeze film integrated in time, and water between
plates."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tvimdesign.physics.polymers import melt


def profile_mean(gradient: float, gap: float, viscosity: float, cells: int = 400) -> float:
    """Mean speed [m/s] of eta u'' = -g between two walls at rest, by finite volumes."""
    step = gap / cells
    matrix = np.diag(np.full(cells, -2.0)) + np.diag(np.ones(cells - 1), 1) + np.diag(np.ones(cells - 1), -1)
    matrix[0, 0] = matrix[-1, -1] = -3.0  # the wall is half a cell away
    return float(np.mean(np.linalg.solve(matrix, np.full(cells, -gradient * step**2 / viscosity))))


def test_the_speed_in_a_gap_is_that_of_stokes() -> None:
    expected = profile_mean(1.05e4, 1e-3, 2825.0)
    assert melt.gap_speed(1.05e4, 1e-3, 2825.0) == pytest.approx(expected, rel=1e-4)


def test_two_gaps_in_series_pass_the_same_flow() -> None:
    length, gap, lip, narrow, viscosity, pressure = 14e-3, 1e-3, 1.5e-3, 0.4e-3, 2825.0, 150.0
    speed = melt.gap_speed(pressure / melt.gaps_in_series(length, gap, lip, narrow), gap, viscosity)
    inside = 12.0 * viscosity * speed / gap**2 * length
    below = 12.0 * viscosity * (speed * gap / narrow) / narrow**2 * lip  # the same volume through a narrower gap
    assert inside + below == pytest.approx(pressure, rel=1e-12)


def test_a_strip_is_squeezed_as_long_as_reynolds_equation_says() -> None:
    force, viscosity, length, width, start, end = 0.5, 2825.0, 0.113, 14e-3, 1.1e-3, 1.0e-3

    def closing(_: float, h: np.ndarray) -> list[float]:
        # h^3 p'' = 12 eta h', p = 0 at both edges: solved on a grid for a unit speed, which the force scales.
        cells = 300
        step = width / cells
        matrix = np.diag(np.full(cells - 1, -2.0)) + np.diag(np.ones(cells - 2), 1) + np.diag(np.ones(cells - 2), -1)
        pressure = np.linalg.solve(matrix, np.full(cells - 1, -12.0 * viscosity / h[0] ** 3 * step**2))
        return [-force / (length * step * float(pressure.sum()))]

    def done(_: float, h: np.ndarray) -> float:
        return float(h[0]) - end

    done.terminal = True
    run = solve_ivp(closing, (0.0, 1e4), [start], events=done, rtol=1e-7, atol=1e-12)
    found = melt.squeeze_time(force, viscosity, length, width, end, start)
    assert found == pytest.approx(run.t_events[0][0], rel=1e-3)


def test_a_surface_holds_what_it_lifts_between_plates() -> None:
    # Water at 20 degC, 72.8 mN/m and 998 kg/m3, wets glass plates a millimetre apart and rises 14.9 mm (handbook).
    assert melt.meniscus_pressure(0.0728, 1e-3) / (998.0 * 9.807) == pytest.approx(14.9e-3, rel=0.005)
