"""What a wall takes at the end of a layer, against conduction in two dimensions by finite volumes."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import csr_matrix, diags
from scipy.sparse.linalg import spsolve

from tvimdesign.device.shear.layer_end import AT_CORNER
from tvimdesign.physics.heat_flow.walled_end import fallen, walled_end

ACROSS, LONG = 120, 4.0
"""Cells over the layer's thickness; its length, beyond which the wall is not felt."""


def walled_layer(free: float, contact: float = 0.0) -> NDArray[np.float64]:
    """Temperatures of a layer by column from its end on: near face (first) at 1, far one and wall at 0.

    Each behind a contact as thick as so much of the layer.
    """
    face = 1.0 / (0.5 + contact * ACROSS)
    number = np.arange(int(LONG * ACROSS) * ACROSS).reshape(-1, ACROSS)
    pairs = [(number[:-1].ravel(), number[1:].ravel()), (number[:, :-1].ravel(), number[:, 1:].ravel())]
    first, second = (np.concatenate(ends) for ends in zip(*pairs, strict=True))
    diagonal = np.bincount(first, minlength=number.size) + np.bincount(second, minlength=number.size).astype(float)
    diagonal[number[:, 0]] += face
    diagonal[number[:, -1]] += face
    diagonal[number[0, heights() > free]] += face
    right = np.zeros(number.size)
    right[number[:, 0]] = face
    off = csr_matrix((np.ones(len(first)), (first, second)), shape=(number.size, number.size))
    return np.asarray(spsolve((diags(diagonal) - off - off.T).tocsc(), right)).reshape(number.shape)


def heights() -> NDArray[np.float64]:
    return (np.arange(ACROSS) + 0.5) / ACROSS


@pytest.mark.parametrize("free", [0.1, 0.25, 0.5])
def test_the_wall_takes_what_conduction_in_two_dimensions_says(free: float) -> None:
    found, ours = walled_layer(free), walled_end(free)
    assert ours.near == pytest.approx(np.sum(2.0 * (1.0 - found[:, 0])) - LONG, rel=0.02)
    into = 2.0 * found[0, heights() > free]
    assert ours.wall == pytest.approx(np.sum(into), rel=0.02)
    even = 1.0 - heights()
    assert ours.deep == pytest.approx(np.sum(even - found) / ACROSS**2, rel=0.015)
    for column in (3, 20, 60):
        lost = 1.0 - found[column] / even
        assert fallen(free, (column + 0.5) / ACROSS, heights()) == pytest.approx(lost, abs=0.02)


@pytest.mark.parametrize(("free", "contact"), [(0.1, 0.02), (0.2, 0.02), (0.1, 0.04)])
def test_contacts_are_as_much_more_free_height_as_conduction_in_two_dimensions_says(
    free: float, contact: float
) -> None:
    into = walled_layer(free, contact)[0, heights() > free] / (0.5 + contact * ACROSS)
    ours = walled_end((free + 2.0 * AT_CORNER * contact) / (1.0 + 2.0 * contact))
    assert ours.wall == pytest.approx(np.sum(into), rel=0.025)


def test_symbols_and_numbers_agree() -> None:
    free = ca.SX.sym("free")
    end = walled_end(free)
    symbolic = ca.Function("end", [free], [ca.vertcat(*end, fallen(free, 0.1, 0.3))])
    plain = walled_end(0.2)
    numbers = [*plain, fallen(0.2, 0.1, 0.3)]
    assert np.asarray(symbolic(0.2)).ravel() == pytest.approx(numbers, rel=1e-12)
