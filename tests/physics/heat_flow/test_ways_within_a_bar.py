"""How far the faces of a bar are from its mean, against a third where it is long and conduction in two dimensions."""

import numpy as np
import pytest
from scipy.sparse import diags, identity, kron
from scipy.sparse.linalg import spsolve

from tvimdesign.physics.heat_flow import shape_factors


def in_two_dimensions(slenderness: float, across: int = 60) -> float:
    """Mean of half a bar above that of its face where it loses 1 W/m^2 at k = 1 W/(m K), half its height 1 m.

    Finite volumes; its ends are kept at no temperature, no heat passes its middle.
    """
    along = round(across * slenderness)
    dx, dy = slenderness / along, 1.0 / across
    ends = np.full(along, 2.0)
    ends[[0, -1]] = 3.0  # the end is half a cell away
    x = diags([ends, -np.ones(along - 1), -np.ones(along - 1)], [0, 1, -1]) / dx**2
    sides = np.full(across, 2.0)
    sides[[0, -1]] = 1.0
    y = diags([sides, -np.ones(across - 1), -np.ones(across - 1)], [0, 1, -1]) / dy**2
    lost = np.zeros((along, across))
    lost[:, -1] = -1.0 / dy
    found = spsolve((kron(x, identity(across)) + kron(identity(along), y)).tocsc(), lost.ravel()).reshape(lost.shape)
    face = found[:, -1] - 0.5 * dy
    return float(np.mean(found) - np.mean(face))


@pytest.mark.parametrize("slenderness", [0.7, 1.3, 2.0, 4.0])
def test_faces_are_as_far_from_the_mean_as_conduction_in_two_dimensions_says(slenderness: float) -> None:
    assert shape_factors.way_to_faces(slenderness) == pytest.approx(in_two_dimensions(slenderness), rel=0.01)


def test_a_long_bar_has_its_mean_a_third_of_the_way_from_the_middle_to_its_faces() -> None:
    assert shape_factors.way_to_faces(1e4) == pytest.approx(1.0 / 3.0, rel=1e-3)
