"""The designs that take a given time do take it, and where none does the line has a gap."""

import math

import numpy as np
import pytest

from tvimdesign.report.paper.paper_case import published_model
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.sensitivity.response_times import PLACES, LevelSet, _root, level_set

pytestmark = pytest.mark.slow

WANTED = 70.0
CURRENTS = [1.4, 1.8, 2.2]  # too weak, enough at every place, too strong at some
THICKNESSES = [0.05e-3, 0.6e-3, 2e-3]


@pytest.fixture(scope="module")
def model() -> DeviceFunctions:
    return published_model()


@pytest.fixture(scope="module")
def found(model: DeviceFunctions) -> LevelSet:
    return level_set(model, "current", CURRENTS, THICKNESSES, WANTED)


def test_a_point_on_a_line_takes_the_time_when_it_is_simulated(model: DeviceFunctions, found: LevelSet) -> None:
    points = 0
    for place in PLACES:
        for current, thickness in zip(found.values, found.line[place], strict=True):
            if math.isnan(thickness):
                continue
            inputs = model.start.copy()
            inputs[model.index["current"]], inputs[model.index["pcl_thickness"]] = current, thickness
            assert Simulator(model).run(inputs).values[place] == pytest.approx(WANTED, rel=2e-4)
            assert THICKNESSES[0] <= thickness <= THICKNESSES[-1]
            points += 1
    assert points >= 4


def test_no_grid_thickness_lies_beside_a_gap_of_the_line(found: LevelSet) -> None:
    gaps = 0
    for place in PLACES:
        for times, thickness in zip(found.times[place], found.line[place], strict=True):
            if math.isnan(thickness):
                assert np.all(times > WANTED) or np.all(times < WANTED)
                gaps += 1
    assert gaps >= 4


def test_a_place_further_from_the_pads_needs_a_thinner_layer(found: LevelSet) -> None:
    near, mean, far = (found.line[f"{place}_time"][1] for place in ("near_face", "mean", "far_face"))
    assert far < mean < near
    assert np.all(np.diff(found.times["far_face_time"], axis=1) > 0.0)


@pytest.mark.parametrize("power", [0.5, 1.0, 4.0])
def test_a_root_is_found_also_where_the_upper_end_is_never(power: float) -> None:
    def function(x: float) -> float:
        return x**power - 2.0 if x < 5.0 ** (1.0 / power) else math.inf

    expected = 2.0 ** (1.0 / power)
    assert _root(function, (0.1, function(0.1)), (30.0, math.inf), 1e-9) == pytest.approx(expected, rel=1e-8)
