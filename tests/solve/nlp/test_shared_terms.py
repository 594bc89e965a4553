"""Derivatives of cells that feel their mean are CasADi's own, and take fewer operations."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.solve.nlp.shared_terms import opened

CELLS = 28


def cells_that_radiate() -> Any:
    """Cells of unlike temperatures that conduct to their neighbors and radiate to a body as one, by their mean; the
    body takes what they give, and a second mean is one of what follows from the first."""
    cells, body, factor = ca.SX.sym("cells", CELLS), ca.SX.sym("body"), ca.SX.sym("factor", 2)
    temperatures = [ca.sqrt(1.0 + cell**2) * ca.exp(factor[0]) for cell in ca.vertsplit(cells)]
    mean = sum(temperatures) / CELLS
    conductance = factor[1] * (mean**2 + body**2) * (mean + body)
    inner = [one**3 * conductance for one in temperatures]
    second = sum(inner) * factor[0]
    along = ca.diff(ca.vertcat(*temperatures))
    rates = ca.vertcat(along, 0.0) - ca.vertcat(0.0, along) - conductance * (ca.vertcat(*temperatures) - body)
    rest = ca.vertcat(conductance * (mean - body) * second, factor[0] / factor[1])
    return ca.Function("rates", [ca.vertcat(cells, body), factor], [ca.vertcat(rates, rest)])


def derivatives(moving: list[list[int]], *, shared: bool) -> tuple[Any, int]:
    """Value, Jacobian and second derivatives as a function, and the count of terms that got symbols."""
    function = cells_that_radiate()
    arguments = [ca.SX.sym("argument", function.sparsity_in(i)) for i in range(function.n_in())]
    entries = [ca.vertsplit(argument) for argument in arguments]
    mu = ca.SX.sym("mu", function.size1_out(0))
    if shared:
        point = opened(function, entries, moving)
        found, terms = [point.whole, point.jacobian(), point.hessian(mu)], point.terms.numel()
    else:
        value = function.call(arguments, True, False)[0]
        moved = ca.vertcat(*(own[row] for own, rows in zip(entries, moving, strict=True) for row in rows))
        found, terms = [value, ca.jacobian(value, moved), ca.hessian(ca.dot(mu, value), moved)[0]], 0
    return ca.Function("derivatives", [*arguments, mu], found), terms


@pytest.mark.parametrize("moving", [[list(range(CELLS + 1)), [0, 1]], [list(range(CELLS)), []], [[0, 1, CELLS], [1]]])
def test_derivatives_through_shared_terms_are_those_of_the_whole(moving: list[list[int]]) -> None:
    random = np.random.default_rng(3)
    at = (random.uniform(0.5, 2.0, CELLS + 1), random.uniform(0.5, 2.0, 2), random.uniform(-1.0, 1.0, CELLS + 2))
    ours, terms = derivatives(moving, shared=True)
    theirs, _ = derivatives(moving, shared=False)
    assert terms == (2 if len(moving[0]) >= CELLS else 0)  # the mean, and what follows from it
    for one, other in zip(ours(*at), theirs(*at), strict=True):
        np.testing.assert_allclose(one.full(), other.full(), rtol=1e-12, atol=1e-12)


def test_they_take_fewer_operations() -> None:
    moving = [list(range(CELLS + 1)), [0, 1]]
    ours, theirs = (derivatives(moving, shared=shared)[0].n_instructions() for shared in (True, False))
    assert ours < 0.7 * theirs
