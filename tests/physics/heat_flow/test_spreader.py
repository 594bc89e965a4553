"""The spreader's resistance against a fin's exact solution and against conduction solved in two dimensions."""

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

from tvimdesign.physics.heat_flow import peltier


@pytest.mark.parametrize("conductance", [20.0, 200.0])
def test_it_is_what_a_fins_efficiency_leaves_out_where_the_layer_conducts_little(conductance: float) -> None:
    # Half of a plate is fed, half is a fin of 2 mm that gives heat to a layer: tanh(m w)/(m w) (Incropera, ch. 3).
    k, thickness, width = 167.0, 1e-3, 2e-3
    mw = width * np.sqrt(conductance / (k * thickness))
    exact = 1.0 / (conductance * (0.5 + 0.5 * np.tanh(mw) / mw)) - 1.0 / conductance
    found = peltier.spreading_resistance(2.0 * width, width, 1.0, k, thickness)  # per metre along the edge
    around_the_corner = 0.5 * width / k * peltier.AROUND_CORNER
    assert found - around_the_corner == pytest.approx(exact, rel=0.02)


def in_two_dimensions(fed: float, beside: float, thickness: float, k: float, across: int = 20) -> float:
    """Mean temperature of a plate's upper face that an even flux of 1 W/m^2 leaves, below its fed lower face [K].

    Half a module and half a gap, finite volumes; no heat passes the ends or the lower face beside the module.
    """
    step = thickness / across
    columns, fed_columns = round((fed + beside) / step), round(fed / step)
    count = columns * across
    index = np.arange(count).reshape(columns, across)
    pairs = [(index[:-1].ravel(), index[1:].ravel()), (index[:, :-1].ravel(), index[:, 1:].ravel())]
    a, b = (np.concatenate(side) for side in zip(*pairs, strict=True))
    diagonal = np.zeros(count)
    np.add.at(diagonal, np.concatenate((a, b)), k)
    diagonal[index[:fed_columns, 0]] += 2.0 * k
    flux = np.zeros(count)
    flux[index[:, -1]] = step
    rows, cols = np.concatenate((a, b, np.arange(count))), np.concatenate((b, a, np.arange(count)))
    matrix = coo_matrix((np.concatenate((-k * np.ones(2 * len(a)), diagonal)), (rows, cols))).tocsr()
    return float(np.mean(spsolve(matrix, flux)[index[:, -1]]) + 0.5 * step / k)


@pytest.mark.parametrize("beside", [8e-3, 4e-3, 2e-3])
def test_a_plate_in_two_dimensions_falls_as_far(beside: float) -> None:
    # What the plate adds across its thickness, t/k, is counted apart (`contact_resistance`).
    fed, thickness, k = 4e-3, 0.8e-3, 167.0
    found = peltier.spreading_resistance(fed + beside, fed, 1.0, k, thickness)
    through = thickness / k
    assert found + through == pytest.approx(in_two_dimensions(fed, beside, thickness, k), rel=0.05)


def test_joints_and_plate_are_in_series() -> None:
    # 1e-4 + 1e-3/167 + 1/(0.5 * 2e4) by hand
    found = peltier.spreader_contact_resistance(1e4, 167.0, 1e-3, 0.5, 2e4)
    assert found == pytest.approx(1e-4 + 5.988e-6 + 1e-4, rel=1e-6)


def test_a_plate_that_is_all_fed_spreads_nothing() -> None:
    assert peltier.spreading_resistance(1e-3, 1e-3, 0.1, 167.0, 1e-3) == 0.0
