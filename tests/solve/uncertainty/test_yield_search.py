"""Moves of margins: one quantile of every limit, so that the requested share satisfies all of them together."""

from __future__ import annotations

from statistics import NormalDist

import numpy as np
import pytest

from tvimdesign.solve.nlp.constraints import Constraint
from tvimdesign.solve.uncertainty.yield_search import _moves
from tvimdesign.solve.uncertainty.yields import MODULES, Drawn

A, B = Constraint("a", "<=", 1.0, 1.0, "require"), Constraint("b", ">=", 1.0, 1.0, "require")


def _drawn(first: float, second: float) -> Drawn:
    """Two limits whose residuals are independent and normal, with these deviations about zero."""
    rng = np.random.default_rng(3)
    return Drawn((A, B), np.array([[first], [second]]) * rng.standard_normal((2, MODULES)))


def test_two_independent_limits_share_what_may_be_lost() -> None:
    """Both at a share q keep q squared together: 97.5 % each for 95 %, where 95 % each would be 90 %."""
    moves = _moves(_drawn(0.1, 0.1), 0.95, {}, {A.name, B.name})
    expected = 0.1 * NormalDist().inv_cdf(0.957**0.5)  # 95.7 %: the lower end of the interval of 4096 modules is 95 %
    assert moves[A.name] == pytest.approx(expected, rel=0.05)
    assert moves[B.name] == pytest.approx(expected, rel=0.05)


def test_a_limit_whose_spread_is_small_against_its_size_has_its_margin_too() -> None:
    # A diameter of 90 mm that spreads by 0.05 mm.
    moves = _moves(_drawn(5e-4, 0.1), 0.95, {}, {A.name, B.name})
    assert moves[A.name] == pytest.approx(moves[B.name] * 5e-3, rel=0.1)


def test_a_limit_that_does_not_hold_the_design_gets_no_less_than_it_has() -> None:
    drawn = Drawn((A, B), _drawn(0.1, 0.1).residuals - np.array([[0.0], [1.0]]))
    assert set(_moves(drawn, 0.95, {}, {A.name})) == {A.name}
    assert _moves(drawn, 0.95, {B.name: 0.3}, {A.name})[B.name] == pytest.approx(-0.3)
