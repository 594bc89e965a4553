"""Heat of a wall at the end of a layer, against conduction in two dimensions by finite volumes."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import csr_matrix, diags
from scipy.sparse.linalg import spsolve

from tvimdesign.device.shear.layer_end import AT_CORNER
from tvimdesign.physics.heat_flow.layer_end import cooled_end, fallen, sheet_end, sheeted_end, walled_end

ACROSS, LONG = 120, 4.0
"""Cells over the layer's thickness; its length, beyond which the wall is not felt."""


def walled_layer(free: float, contact: float = 0.0, lost: float = 0.0) -> NDArray[np.float64]:
    """Temperatures of a layer by column from its end on: near face (first) at 1, far one and wall at 0.

    Each behind a contact as thick as so much of the layer. With `lost` both faces are at 0, and that heat leaves the
    free end, as cos(pi y) falls over it.
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
    right[number[:, 0]] = 0.0 if lost else face
    passed = 1.0 - np.cos(np.pi * np.minimum(np.arange(ACROSS + 1) / ACROSS, free))
    right[number[0]] -= lost * np.diff(passed) / passed[-1]
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
def test_contacts_are_more_free_height_as_in_two_dimensions(free: float, contact: float) -> None:
    into = walled_layer(free, contact)[0, heights() > free] / (0.5 + contact * ACROSS)
    ours = walled_end((free + 2.0 * AT_CORNER * contact) / (1.0 + 2.0 * contact))
    assert ours.wall == pytest.approx(np.sum(into), rel=0.025)


def test_symbols_and_numbers_agree() -> None:
    free = ca.SX.sym("free")
    end = walled_end(free)
    symbolic = ca.Function(
        "end", [free], [ca.vertcat(*end, *sheeted_end(free, 0.5), cooled_end(free, 0.1, 0.3), fallen(free, 0.1, 0.3))]
    )
    plain = walled_end(0.2)
    numbers = [*plain, *sheeted_end(0.2, 0.5), cooled_end(0.2, 0.1, 0.3), fallen(0.2, 0.1, 0.3)]
    assert np.asarray(symbolic(0.2)).ravel() == pytest.approx(numbers, rel=1e-12)


@pytest.mark.parametrize(("free", "layer"), [(0.1, 0.4), (0.2, 0.5), (0.15, 0.25)])
def test_layer_and_sheet_give_the_wall_as_in_two_dimensions(free: float, layer: float) -> None:
    found, ours = walled_layer(free), sheeted_end(free, layer)
    own, above = heights() < layer, heights() > layer
    assert ours.wall == pytest.approx(np.sum(2.0 * found[0, own & (heights() > free)]), rel=0.03)
    assert ours.rim == pytest.approx(np.sum(2.0 * found[0, above]), rel=0.01)
    missed = (1.0 - heights() - found) / ACROSS**2
    mean = 1.0 - 0.5 * layer
    assert 2.0 * mean * ours.colder == pytest.approx(np.sum(missed[:, own]) / layer, rel=0.03)
    assert ours.sheet_colder == pytest.approx(np.sum(missed[:, above]) / (1.0 - layer), rel=0.08)


@pytest.mark.parametrize("layer", [0.25, 0.5])
def test_a_sheet_alone_gives_the_wall_as_in_two_dimensions(layer: float) -> None:
    found, ours = walled_layer(layer), sheet_end(layer)
    assert ours.rim == pytest.approx(np.sum(2.0 * found[0, heights() > layer]), rel=0.015)
    missed = (1.0 - heights() - found)[:, heights() > layer] / ACROSS**2
    assert ours.sheet_colder == pytest.approx(np.sum(missed) / (1.0 - layer), rel=0.08)


def test_a_layer_below_a_sheet_is_as_cold_in_the_mean() -> None:
    layer = 0.4
    ours = sheeted_end(0.1, layer)
    height = (np.arange(4000) + 0.5) / 4000
    # Green's function of a fall that is held at both faces; the layer's mean of it.
    mean = np.where(height < layer, height * (1.0 - 0.5 * layer) - 0.5 * height**2 / layer, 0.0)
    by_slices = 24.0 * ours.deep * np.mean(mean * (1.0 - height))
    from_sheet = ours.rim * layer * (1.0 - layer) / 3.0
    assert by_slices + from_sheet == pytest.approx(ours.colder * (2.0 - layer), rel=1e-3)


def test_heat_from_the_free_end_cools_as_in_two_dimensions() -> None:
    free = 0.15
    found = -walled_layer(free, lost=1.0)
    # What leaves rises with the height, as in sin a near the corner; the near face gives half of it.
    for column in (3, 8, 16):
        ours = 0.5 * cooled_end(free, (column + 0.5) / ACROSS, heights())
        assert found[column] == pytest.approx(ours, abs=0.05 * np.max(found[0]))
