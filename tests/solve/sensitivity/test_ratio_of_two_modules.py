"""Sensitivity of two modules' times and their ratio: differences of simulations against exact derivatives."""

import numpy as np
import pytest
from event_derivatives import found_by_engine

from tvimdesign.base.errors import InputError
from tvimdesign.report.paper import paper_case
from tvimdesign.solve.sensitivity.response_times import Pair, Span, ratio

EVENT = "mean_time"


@pytest.fixture(scope="module")
def pair() -> Pair:
    return paper_case.pair()


@pytest.mark.slow
def test_elasticities_are_those_of_exact_derivatives(pair: Pair) -> None:
    exact = []
    for model in pair.models:
        names = [name for name in paper_case.ranges() if name in model.index]
        engine, place = found_by_engine(model, names), model.switch_names.index(EVENT)
        starts = [model.start[model.index[name]] for name in names]
        exact.append(dict(zip(names, engine.slopes[place] * starts / engine.values[place], strict=True)))
    for name in paper_case.ranges():
        shown = pair.output_sensitivities(EVENT, name)
        for of_one, difference in zip(exact, shown, strict=True):
            assert difference == pytest.approx(of_one.get(name, 0.0), rel=1e-3, abs=1e-4), name


def test_inputs_of_one_module_or_both_move_those_alone(pair: Pair) -> None:
    at_rest = pair.times(EVENT)
    influence = pair.influence(EVENT, Span("pcl_thickness", 1.2e-3, 1.6e-3))
    assert influence.at_low[1] == influence.at_high[1] == at_rest[1]
    assert influence.at_low[0] < at_rest[0] < influence.at_high[0]
    low, high = influence.ratios
    assert low > ratio(at_rest) > high
    assert influence.reach == pytest.approx(low / high)
    assert np.all(pair.times(EVENT, {"peltier_resistance": 4.0}) > pair.times(EVENT))
    assert np.all(pair.output_sensitivities(EVENT, "peltier_resistance") < -0.5)
    with pytest.raises(InputError, match=r"coil_count has 3\.25 and 6\.6"):
        pair.value("coil_count")
    with pytest.raises(InputError, match="no value at all"):
        pair.value("coil_cout")
