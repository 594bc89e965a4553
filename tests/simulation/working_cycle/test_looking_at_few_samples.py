"""Events are looked for at every fifth sample first: the same instants as where all are looked at."""

from __future__ import annotations

import numpy as np
import pytest

from tvimdesign.simulation.working_cycle import phase_simulator
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_simulator import PhaseSimulator
from tvimdesign.simulation.working_cycle.resolved_module import resolve_study
from tvimdesign.study import read_study_text


@pytest.fixture(scope="module", params=["shear", "compression"])
def model(request: pytest.FixtureRequest) -> DeviceFunctions:
    text = f"mode: {request.param}\nmodule: {{response_criterion: softening}}\nsolver: {{cells: 6}}\n"
    resolved = resolve_study(read_study_text(text, "a test"))
    return DeviceFunctions(resolved.table, resolved.values, resolved.points, resolved.study.solver.cells)


def test_a_cycle_is_the_same_where_every_sample_is_looked_at(
    model: DeviceFunctions, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = Simulator(model).run_to_show(model.start)
    monkeypatch.setattr(phase_simulator, "_FEW", 1)
    every = Simulator(model).run_to_show(model.start)
    assert found.values == every.values
    assert sum(np.isfinite(list(found.values.values()))) > 10
    for name, course in found.trajectories.items():
        np.testing.assert_array_equal(course.states, every.trajectories[name].states)


class _Waiting:
    """What one event waits for, by the number of the sample."""

    def __init__(self, course: np.ndarray) -> None:
        self._course = course
        self.looked: set[int] = set()

    def __call__(self, states: np.ndarray, *_: object) -> np.ndarray:
        places = np.atleast_1d(states[0].astype(int))
        self.looked |= set(places.tolist())
        return self._course[None, places]


def looked_at(course: np.ndarray) -> tuple[set[int], np.ndarray]:
    """The samples that are looked at of 51, and what is seen there."""
    simulator = object.__new__(PhaseSimulator)
    waiting = _Waiting(course)
    phase = type("Phase", (), {"state_size": 1})()
    vars(simulator).update(
        _events=["event"], _few=np.arange(0, 51, 5), phase=phase, _waiting=waiting, _waiting_at_few=waiting
    )
    given = phase_simulator._Given(np.zeros(1), np.zeros(0), np.zeros(0))
    seen = simulator._waits(np.arange(51.0)[None], given, np.zeros(51), [True])
    return waiting.looked, seen[0]


def test_few_samples_are_looked_at_where_nothing_happens() -> None:
    looked, seen = looked_at(np.linspace(-2.0, -1.0, 51))
    assert looked == set(range(0, 51, 5))
    assert np.isnan(seen[1])


def test_those_before_an_event_are_looked_at_too() -> None:
    looked, seen = looked_at(np.linspace(-2.3, 2.7, 51))
    assert looked == {*range(0, 51, 5), 21, 22, 23, 24}
    assert int(np.argmax(seen >= 0.0)) == 23


def test_all_are_looked_at_where_one_may_happen_between_two() -> None:
    course = -np.abs(np.arange(51) - 22.0) + 1.0  # zero or more at 21, 22 and 23 alone
    assert np.all(course[::5] < 0.0)
    looked, seen = looked_at(course)
    assert looked == set(range(51))
    assert int(np.argmax(seen >= 0.0)) == 21
