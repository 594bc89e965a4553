"""The solid fraction inside the melting range is an interval, outside it a number."""

from dataclasses import replace

import pytest

from tvimdesign.simulation.joint_tests.case import histories_at
from tvimdesign.simulation.working_cycle.melt_history import fractions_at
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_study
from tvimdesign.study import read_study_text

KELVIN = 273.15


@pytest.fixture(scope="module")
def resolved() -> ResolvedModule:
    return resolve_study(read_study_text("mode: shear\n", "a test"))


def test_sixty_degrees_is_liquid_or_third_or_two_thirds_frozen(resolved: ResolvedModule) -> None:
    # 50 to 65 degC nominal, 55 to 70 at the latest: 60 is two thirds and one third of the way.
    low, nominal, high = fractions_at(resolved, 60.0 + KELVIN)
    assert low == 0.0
    assert nominal == pytest.approx(1.0 / 3.0, abs=2e-3)
    assert high == pytest.approx(2.0 / 3.0, abs=2e-3)
    shown = [history for history in histories_at(resolved, 60.0 + KELVIN) if history.shown]
    assert [history.name for history in shown] == ["nominal", "low", "high"]
    assert [history.fraction for history in shown] == [nominal, low, high]


@pytest.mark.parametrize(("celsius", "frozen"), [(30.0, 1.0), (44.9, 1.0), (70.1, 0.0), (100.0, 0.0)])
def test_outside_the_range_of_melting_there_is_one_answer(
    resolved: ResolvedModule, celsius: float, frozen: float
) -> None:
    low, nominal, high = fractions_at(resolved, celsius + KELVIN)
    assert low == nominal == high == pytest.approx(frozen, abs=1e-2)
    assert len(histories_at(resolved, celsius + KELVIN)) == 1


@pytest.mark.parametrize("celsius", [45.1, 69.9])
def test_range_reaches_from_the_lowest_start_to_the_highest_end(resolved: ResolvedModule, celsius: float) -> None:
    low, _, high = fractions_at(resolved, celsius + KELVIN)
    assert low == 0.0
    assert high > low


def test_melting_of_a_study_of_its_own_moves_the_range(resolved: ResolvedModule) -> None:
    own = replace(resolved, values={**resolved.values, "pcl_melting_start": 40.0 + KELVIN})
    assert fractions_at(own, 42.0 + KELVIN)[0] == 0.0
