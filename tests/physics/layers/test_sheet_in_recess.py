"""What a soft sheet gives beside the wall of its recess: the series against finite differences over its section."""

from __future__ import annotations

import casadi
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import diags_array, eye_array, kron
from scipy.sparse.linalg import spsolve

from tvimdesign.physics.layers import shear_lag

FINE, LONG = 40, 5.0
"""Cells over the sheet's thickness; length of the strip in thicknesses."""


def traction(held: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distance from the wall in thicknesses and the layer's traction over that far away, in the middle of cells.

    The twist of square cells: fixed on the bottom and at the wall, the layer's resistance at the face in series with
    half a cell, nothing through the far end.
    """
    across, along = FINE, round(LONG * FINE)

    def chain(count: int, first: float, last: float) -> object:
        middle = np.full(count, 2.0)
        middle[0], middle[-1] = 1.0 + first, 1.0 + last
        return diags_array([np.full(count - 1, -1.0), middle, np.full(count - 1, -1.0)], offsets=[-1, 0, 1])

    by_layer = 1.0 / (0.5 + FINE / held)
    whole = kron(eye_array(along), chain(across, by_layer, 2.0)) + kron(chain(along, 2.0, 0.0), eye_array(across))
    pulled = np.zeros((along, across))
    pulled[:, 0] = by_layer
    moved = spsolve(whole.tocsr(), pulled.ravel()).reshape(along, across)[:, 0]
    tau = by_layer * (1.0 - moved)
    return (np.arange(along) + 0.5) / FINE, tau / tau[-1]


@pytest.mark.parametrize("held", [0.1, 0.44, 1.0, 3.0])
def test_the_rim_is_that_of_finite_differences(held: float) -> None:
    places, tau = traction(held)
    for reach in (0.25, 0.5, 1.0):
        near = tau[places < reach].mean()
        assert shear_lag.rim_rise(held, reach) == pytest.approx(near, rel=4e-3)
    assert shear_lag.rim_width(held) == pytest.approx((tau - 1.0).sum() / FINE, rel=0.02)


def test_at_the_wall_itself_the_sheet_gives_nothing() -> None:
    for held in (0.2, 1.0):
        assert shear_lag.rim_rise(held, 1e-4) == pytest.approx(1.0 + held, rel=0.02)
        assert shear_lag.rim_rise(held, 100.0) == pytest.approx(1.0 + shear_lag.rim_width(held) / 100.0)


def test_symbols_give_what_floats_do() -> None:
    held, reach = casadi.SX.sym("h"), casadi.SX.sym("s")
    rise = casadi.Function("rise", [held, reach], [shear_lag.rim_rise(held, reach)])
    assert float(rise(0.44, 0.33)) == pytest.approx(shear_lag.rim_rise(0.44, 0.33), rel=1e-12)
