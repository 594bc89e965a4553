"""One yardstick for all studies of a comparison: the mean of what they are drawn with, in any order."""

import pytest
from comparable import COMPRESSION, SHEAR

from tvimdesign.solve import normalization
from tvimdesign.study import read_study_text


def test_it_is_the_geometric_mean_whatever_the_order() -> None:
    starts = [{"module_mass": 0.2, "response_time": 50.0}, None, {"module_mass": 0.8, "response_time": 200.0}]
    for order in (starts, starts[::-1]):
        assert normalization.common(order) == pytest.approx({"module_mass": 0.4, "response_time": 100.0})


def test_of_zeros_it_is_one() -> None:
    assert normalization.common([{"backlash@hot": 0.0}, {"backlash@hot": 0.0}]) == {"backlash@hot": 1.0}
    assert normalization.common([{"backlash@hot": 0.0}, {"backlash@hot": 0.1}]) == pytest.approx({"backlash@hot": 0.1})


def test_a_switch_that_never_ends_counts_as_long_as_it_is_followed() -> None:
    cold = SHEAR.replace("current: 1.5 A", "current: 0.1 A\n  horizon: 900 s")
    found = normalization.at_its_start(read_study_text(cold, "test"))
    assert found is not None
    assert found["response_time"] == 900.0


@pytest.mark.parametrize("text", [SHEAR, COMPRESSION], ids=["shear", "compression"])
def test_only_what_is_minimised_is_measured(text: str) -> None:
    found = normalization.at_its_start(read_study_text(text, "test"))
    assert found is not None
    assert found.keys() == {"module_mass", "response_time"}
    assert all(value > 0.0 for value in found.values())
