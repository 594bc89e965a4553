"""The benchmark of optimisers gives all contenders the same problem, and tells a right answer from a wrong one."""

from __future__ import annotations

import numpy as np
import pytest
from contenders import Once, by_tvimdesign, lsoda
from optimum import exact
from reference_problem import Reference, study


@pytest.fixture(scope="module")
def reference() -> Reference:
    return Reference(study())


def test_the_functions_of_the_rivals_are_those_of_the_product(reference: Reference) -> None:
    values = reference.optimizer.start_values
    assert lsoda(1e-9)(reference, reference.begin) == pytest.approx(values["response_time"], rel=1e-4)
    rows = reference.rows(reference.begin, values["response_time"])
    assert rows[0] == pytest.approx(3.0)  # three outputs, each over its value at the start
    assert rows[1:] == pytest.approx([limit.residual(values[limit.output]) for limit in reference.limits])


def test_our_own_row_is_an_optimum_to_an_independent_integrator(reference: Reference) -> None:
    found = by_tvimdesign(reference, reference.begin)
    objective, broken = exact(reference, found.design)
    assert broken < 1e-6
    # No feasible step of a thousandth to either side of any variable is better.
    once = Once(reference, lsoda(1e-9))
    for i in range(len(found.design)):
        for step in (-1e-3, 1e-3):
            logs = np.log(found.design) + step * (np.arange(len(found.design)) == i)
            inside = np.all(np.exp(logs) <= reference.upper) and np.all(np.exp(logs) >= reference.lower)
            if inside and np.all(once.room(logs) >= 0.0):
                assert once.objective(logs) > objective * (1.0 - 1e-6)
