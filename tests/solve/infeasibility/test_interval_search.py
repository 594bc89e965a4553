"""Paving against problems whose answer is known: what is empty, and what the least objective is."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tvimdesign.simulation.casadi_setup import ca
from tvimdesign.solve.infeasibility.enclosure import Enclosure
from tvimdesign.solve.infeasibility.interval_search import Objective, Paver
from tvimdesign.solve.nlp.constraints import Constraint

LOW, HIGH = np.array([1.0, 1.0]), np.array([10.0, 10.0])


def _enclosure(**outputs: Any) -> Enclosure:
    """Outputs of x and y, each a function of the two; the face of a model that an enclosure asks for."""

    def compile_(names: list[str]) -> Any:
        inputs, cycle = ca.SX.sym("inputs", 2), ca.SX.sym("cycle", 0)
        found = ca.vertcat(*(outputs[name](inputs[0], inputs[1]) for name in names))
        return ca.Function("outputs", [inputs, cycle], [found])

    model: Any = SimpleNamespace(
        index={"x": 0, "y": 1}, names=["x", "y"], start=np.ones(2), switch_names=(),
        table=SimpleNamespace(supplied=()), outputs=lambda names: compile_(list(names)),
    )  # fmt: skip
    return Enclosure(model, tuple(outputs), ("x", "y"))


def _at_least(output: str, limit: float) -> Constraint:
    return Constraint(output, ">=", limit, abs(limit), "require")


def _at_most(output: str, limit: float) -> Constraint:
    return Constraint(output, "<=", limit, abs(limit), "require")


def _product(x: Any, y: Any) -> Any:
    return x * y


def _sum(x: Any, y: Any) -> Any:
    return x + y


def test_the_bound_comes_to_the_least_sum_of_two_numbers_with_a_product() -> None:
    """x + y with x y >= 16 is least at 4 + 4."""
    enclosure = _enclosure(product=_product, sum=_sum)
    paver = Paver(enclosure, [_at_least("product", 16.0)], 0.0, Objective({"sum": 1.0}))
    found = paver.pave(LOW, HIGH, np.inf, most=250)
    assert not found.empty
    assert 8.0 - 0.02 <= found.bound <= 8.0


def test_a_bound_is_never_above_a_design_that_is_known() -> None:
    enclosure = _enclosure(product=_product, sum=_sum)
    paver = Paver(enclosure, [_at_least("product", 16.0)], 0.0, Objective({"sum": 1.0}))
    for most in (1, 10, 100):
        assert paver.pave(LOW, HIGH, np.inf, most).bound <= 8.0
        assert paver.pave(LOW, HIGH, np.inf, most, below=8.0).bound <= 8.0


@pytest.mark.parametrize(("product", "empty"), [(16.1, True), (15.9, False)])
def test_limits_are_proved_apart_only_where_they_are(product: float, empty: bool) -> None:
    """x + y <= 8 leaves products up to 16."""
    enclosure = _enclosure(product=_product, sum=_sum)
    found = Paver(enclosure, [_at_least("product", product), _at_most("sum", 8.0)], 1e-6).pave(LOW, HIGH, np.inf, 4000)
    assert found.empty is empty
    if empty:
        assert found.cutting == (0, 1)
        assert found.bound == np.inf


def test_a_limit_that_holds_within_the_tolerance_is_not_proved_broken() -> None:
    enclosure = _enclosure(sum=_sum)
    limit = _at_most("sum", 2.0 * (1.0 - 1e-7))
    assert not Paver(enclosure, [limit], 1e-6).pave(LOW, HIGH, np.inf, 200).empty
    assert Paver(enclosure, [limit], 1e-9).pave(LOW, HIGH, np.inf, 200).empty


def test_where_an_output_is_no_number_no_bound_is_claimed_from_its_slopes() -> None:
    """sqrt(x - 5) + y >= 1 exists beyond x = 5 alone; the least x + y there is 6."""
    enclosure = _enclosure(root=lambda x, y: ca.sqrt(x - 5.0) + y, sum=_sum)
    paver = Paver(enclosure, [_at_least("root", 1.0)], 0.0, Objective({"sum": 1.0}))
    assert paver.pave(LOW, HIGH, np.inf, 100).bound <= 6.0


def test_the_least_weighted_sum_counts_every_part_of_the_goal() -> None:
    enclosure = _enclosure(product=_product, sum=_sum)
    found = Paver(enclosure, [], 0.0, Objective({"sum": 2.0, "product": 3.0}, rest=0.5)).pave(LOW, HIGH, np.inf, 100)
    assert found.bound == pytest.approx(2.0 * 2.0 + 3.0 + 0.5, rel=1e-3)
    assert found.bound <= 7.5
