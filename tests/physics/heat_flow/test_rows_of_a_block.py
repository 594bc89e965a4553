"""A block in rows from face to face, and what is uneven over the height of a strip, against conduction in two
dimensions."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import eye, kron
from scipy.sparse.linalg import spsolve

from tvimdesign.physics.heat_flow import columns, lumps, shape_factors
from tvimdesign.physics.heat_flow.lumps import Link, Slope

Array = NDArray[np.float64]


def conduction(count: int, length: float, first: float, last: float) -> Array:
    """Conduction along a row of cells; at either end 2 where it is held at 0, 0 where nothing passes."""
    diagonal = np.full(count, 2.0)
    diagonal[0], diagonal[-1] = 1.0 + first, 1.0 + last
    return (np.diag(diagonal) - np.eye(count, k=1) - np.eye(count, k=-1)) * (count / length) ** 2


@pytest.mark.parametrize("slenderness", [0.8, 2.0, 6.0])
def test_a_row_is_below_the_mean_by_what_conduction_in_two_dimensions_says(slenderness: float) -> None:
    # Half the height and the conductivity are one; both ends are held, the faces lose 1.5 and 0.6.
    deep, high, lost = 120, 120, (1.5, 0.6)
    inside = kron(conduction(deep, slenderness, 2.0, 2.0), eye(high)) + kron(eye(deep), conduction(high, 2.0, 0.0, 0.0))
    source = np.zeros((deep, high))
    source[:, 0], source[:, -1] = -lost[0] * high / 2.0, -lost[1] * high / 2.0
    found = np.asarray(spsolve(inside.tocsc(), source.ravel())).reshape(deep, high)
    below = np.mean(found, axis=1)[:, None] - found
    depths = (np.arange(deep) + 0.5) / deep
    for row, place in enumerate((np.arange(high) + 0.5) / high * 2.0 - 1.0):
        if abs(place) < 0.93:
            ours = columns.row_below_mean(float(place), depths, slenderness, lost)
            assert ours == pytest.approx(below[:, row], abs=0.025)


@pytest.mark.parametrize("slenderness", [0.1, 0.4, 1.5])
def test_what_is_uneven_over_the_height_of_a_strip_passes_its_edge_as_in_two_dimensions(slenderness: float) -> None:
    # Height and conductivity one; the edge is held at a cosine over the height, whose end nothing passes.
    along, high = 400, 80
    edge = np.cos(np.pi * (np.arange(high) + 0.5) / high)
    inside = kron(conduction(along, slenderness, 2.0, 0.0), eye(high)) + kron(
        eye(along), conduction(high, 1.0, 0.0, 0.0)
    )
    source = np.zeros((along, high))
    source[0] = 2.0 * (along / slenderness) ** 2 * edge
    found = np.asarray(spsolve(inside.tocsc(), source.ravel())).reshape(along, high)
    passed = 2.0 * along / slenderness * (edge - found[0])
    assert passed == pytest.approx(
        edge / shape_factors.uneven_way(slenderness), abs=0.01 / shape_factors.uneven_way(slenderness)
    )


def test_a_layer_gives_each_place_of_what_falls_before_it_its_own_heat() -> None:
    # A face at 40 K that is 6 K warmer at the layer's near end than at its far one: 42, 40, 38 K before three cells.
    cells = np.array([90.0, 70.0, 50.0])
    slope = Slope(((("around", 1), 0.25), (("around", 3), 0.75)), ("around", 2), 0.5)
    link = Link(("layer", 0), ("around", 0), 3.0, slope=slope)
    found = lumps.linked([link], {"around": np.array([40.0, 50.0, 35.0, 46.0])}, {"layer": cells})
    assert found["layer"][0] == pytest.approx(np.array([42.0, 40.0, 38.0]) - cells)
    assert found["around"] == pytest.approx([90.0, 0.0, 0.0, 0.0])
