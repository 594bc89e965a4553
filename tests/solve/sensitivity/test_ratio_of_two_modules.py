"""Sensitivity of two modules' times and their ratio: differences of simulations against the implicit function."""

import numpy as np
import pytest
from event_derivatives import event_gradient

from tvimdesign.base.errors import InputError
from tvimdesign.report.paper import paper_case
from tvimdesign.solve.sensitivity.response_times import Pair, Span, ratio

EVENT = "mean_time"


@pytest.fixture(scope="module")
def pair() -> Pair:
    return paper_case.pair()


@pytest.mark.slow
def test_elasticities_are_those_of_the_implicit_function_theorem(pair: Pair) -> None:
    exact = []
    for model, simulator in zip(pair.models, pair._simulators, strict=True):
        cycle = simulator.run(model.start, phases=["softening"])
        time, gradient = event_gradient(model, cycle, EVENT)
        assert time == pytest.approx(cycle.values[EVENT], rel=5e-4)
        exact.append({name: gradient[i] * model.start[i] / time for name, i in model.index.items()})
    for name in paper_case.ranges():
        shown = pair.output_sensitivities(EVENT, name)
        for of_one, difference in zip(exact, shown, strict=True):
            # To 1e-3; to half a percent of itself where it is large, as by a temperature in kelvin.
            assert difference == pytest.approx(of_one.get(name, 0.0), rel=5e-3, abs=1e-3), name


def test_an_input_that_only_one_module_has_moves_that_one_alone(pair: Pair) -> None:
    at_rest = pair.times(EVENT)
    influence = pair.influence(EVENT, Span("pcl_thickness", 1.2e-3, 1.6e-3))
    assert influence.at_low[1] == influence.at_high[1] == at_rest[1]
    assert influence.at_low[0] < at_rest[0] < influence.at_high[0]
    low, high = influence.ratios
    assert low > ratio(at_rest) > high
    assert influence.reach == pytest.approx(low / high)


def test_an_input_that_both_have_moves_both(pair: Pair) -> None:
    assert np.all(pair.times(EVENT, {"peltier_resistance": 4.0}) > pair.times(EVENT))
    assert np.all(pair.output_sensitivities(EVENT, "peltier_resistance") < -0.5)


def test_an_input_in_which_the_two_differ_cannot_move(pair: Pair) -> None:
    with pytest.raises(InputError, match=r"coil_count has 3\.25 and 6\.6"):
        pair.value("coil_count")
    with pytest.raises(InputError, match="no value at all"):
        pair.value("coil_cout")
