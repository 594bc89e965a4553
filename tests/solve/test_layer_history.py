"""The solid fraction inside the melting range is an interval, outside it a number."""

from typing import Any

import pytest

from tvimdesign.catalog import Catalog
from tvimdesign.device import table_for
from tvimdesign.solve.history import fractions_at, histories_at
from tvimdesign.solve.rig import rig_of
from tvimdesign.study import given, read_study_text

TABLE = table_for("shear")
KELVIN = 273.15


@pytest.fixture(scope="module")
def inputs() -> dict[str, Any]:
    return given(read_study_text("mode: shear\n", "a test"), Catalog(), TABLE)


def test_sixty_degrees_is_liquid_or_third_or_two_thirds_frozen(inputs: dict[str, Any]) -> None:
    # 50 to 65 degC nominal, 55 to 70 at the latest: 60 is two thirds and one third of the way.
    low, nominal, high = fractions_at(inputs, TABLE, 60.0 + KELVIN)
    assert low == 0.0
    assert nominal == pytest.approx(1.0 / 3.0, abs=2e-3)
    assert high == pytest.approx(2.0 / 3.0, abs=2e-3)
    assert [history.name for history in histories_at(inputs, TABLE, 60.0 + KELVIN)] == ["nominal", "low", "high"]


@pytest.mark.parametrize(("celsius", "frozen"), [(30.0, 1.0), (44.9, 1.0), (70.1, 0.0), (100.0, 0.0)])
def test_outside_the_range_of_melting_there_is_one_answer(
    inputs: dict[str, Any], celsius: float, frozen: float
) -> None:
    low, nominal, high = fractions_at(inputs, TABLE, celsius + KELVIN)
    assert low == nominal == high == pytest.approx(frozen, abs=1e-2)
    assert len(histories_at(inputs, TABLE, celsius + KELVIN)) == 1


@pytest.mark.parametrize("celsius", [45.1, 69.9])
def test_range_reaches_from_the_lowest_start_to_the_highest_end(inputs: dict[str, Any], celsius: float) -> None:
    low, _, high = fractions_at(inputs, TABLE, celsius + KELVIN)
    assert low == 0.0
    assert high > low


def test_melting_of_a_study_of_its_own_widens_the_range(inputs: dict[str, Any]) -> None:
    own = {**inputs, "pcl_melting_start": 40.0 + KELVIN}
    assert fractions_at(own, TABLE, 42.0 + KELVIN)[0] == 0.0


def test_study_without_points_is_tested_at_the_papers_three_temperatures() -> None:
    rig = rig_of(read_study_text("mode: shear\n", "a test"))
    assert rig.points == ("cold", "melting", "hot")
    assert [rig.value(f"temperature@{point}") for point in rig.points] == pytest.approx([303.15, 333.15, 373.15])
    own = "mode: shear\noperating_points:\n  hot: {temperature: 90 degC, frequency: 2 Hz}\n"
    assert set(rig_of(read_study_text(own, "a test")).points) == {"cold", "hot"}


def test_design_takes_the_place_of_the_studys_start() -> None:
    study = read_study_text("mode: shear\n", "a test")
    assert rig_of(study, design={"pcl_thickness": 2e-3}).value("pcl_thickness") == 2e-3
