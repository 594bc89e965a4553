"""What the product's simulator promises: every value of every study within 2e-4 of CVODES, and what it shows."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from support import STUDIES, fine

from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.cycle import SAMPLES, Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.resolved_module import resolve_study
from tvimdesign.simulation.working_cycle.trajectory import Array, Cycle
from tvimdesign.study import drawn, read_study

QUICK = ("fast_switch", "paper_shear", "wrist_compression")
PROMISED = 2e-4


def model_of(path: Path) -> DeviceFunctions:
    study = drawn(read_study(path))
    return resolve_study(study).functions


def agree(one: Cycle, other: Cycle) -> None:
    assert one.values.keys() == other.values.keys()
    for name, value in other.values.items():
        assert one.values[name] == pytest.approx(value, rel=PROMISED), name
    assert one.trajectories.keys() == other.trajectories.keys()
    assert one.balances.keys() == other.balances.keys()


@pytest.mark.parametrize(
    "path", [pytest.param(one, marks=[] if one.stem in QUICK else pytest.mark.slow, id=one.stem) for one in STUDIES]
)
def test_all_values_of_a_study_s_cycle_are_those_of_cvodes(path: Path) -> None:
    model = model_of(path)
    agree(Simulator(model).run(model.start), fine(model).run(model.start))


@pytest.mark.parametrize("design", ["as it is", "thin", "thick", "aluminium", "sink"])
def test_all_values_of_another_design_are_those_of_cvodes(
    design: str, build: Callable[..., DeviceFunctions], judged: Callable[[str], Cycle]
) -> None:
    model = build(design)
    agree(Simulator(model).run(model.start), judged(design))


def test_a_current_with_corners_gives_the_values_of_cvodes(build: Callable[..., DeviceFunctions]) -> None:
    model = build()
    profiles = {
        "softening": CurrentProfile.in_pieces(2.0, 90.0, (0.8, 2.4, 1.2, 2.0, 1.6)),
        "stiffening": CurrentProfile.in_pieces(1.0, 40.0, (-0.6, -0.1, -0.3)),
    }
    shipped, judge = Simulator(model).run(model.start, profiles), fine(model).run(model.start, profiles)
    agree(shipped, judge)
    for name, profile in profiles.items():
        line = shipped.trajectories[name]
        assert line.currents == pytest.approx(profile.at(line.times), abs=1e-9)
        corner = profile.next_corner(0.0)
        assert np.min(np.abs(line.times - corner)) < 1e-9  # steps end at corners


def test_a_phase_that_never_ends_has_maxima_and_nothing_else(build: Callable[..., DeviceFunctions]) -> None:
    # At 0.4 A the pads cannot hold 100 degC against the losses.
    model = build()
    inputs = model.start.copy()
    inputs[model.index["current"]] = 0.4
    shipped, judge = Simulator(model).run(inputs), fine(model).run(inputs)
    agree(shipped, judge)
    phase = model.phases["softening"]
    reached = {row.name for row in phase.paths if row.reduce == "maximum"}
    assert {name for name, value in shipped.values.items() if np.isfinite(value)} >= reached
    assert shipped.values["response_time"] == shipped.values["switch_energy"] == np.inf
    assert shipped.values["hold_current"] == shipped.values["stiffening_time"] == np.inf
    assert set(shipped.trajectories) == {"softening"}
    assert shipped.balances == {}


@pytest.mark.parametrize("design", ["as it is", "thin", "sink"])
def test_a_trajectory_has_samples_enough_and_runs_as_cvodes_does(
    design: str, build: Callable[..., DeviceFunctions]
) -> None:
    model = build(design)
    shipped, judge = Simulator(model).run_to_show(model.start), fine(model).run_to_show(model.start)
    for name, line in shipped.trajectories.items():
        other = judge.trajectories[name]
        assert line.times[0] == 0.0
        assert np.all(np.diff(line.times) > 0.0)
        assert SAMPLES < len(line.times) < 10 * SAMPLES
        assert line.states.shape == (model.phases[name].state_size, len(line.times))
        assert line.times[-1] == shipped.values[model.phases[name].phase.ends]
        share = np.linspace(0.0, 1.0, 201)
        one, another = (course.at(share * course.times[-1]) for course in (line, other))
        temperatures = [seen(model, name, states, line.currents[0]) for states in (one, another)]
        # The old one's samples are straight between; half a kelvin is what that leaves where cells melt.
        assert np.max(np.abs(temperatures[0] - temperatures[1])) < 0.5, name


def seen(model: DeviceFunctions, phase: str, states: Array, current: float) -> Array:
    """All temperatures at some states, a column each."""
    every = model.phases[phase].temperatures.map(states.shape[1])
    inputs = np.repeat(model.start[:, None], states.shape[1], axis=1)
    return np.asarray(every(states, np.full((1, states.shape[1]), current), inputs))


def test_what_is_shown_is_what_is_simulated(build: Callable[..., DeviceFunctions]) -> None:
    model = build()
    one, other = Simulator(model).run_to_show(model.start), Simulator(model).run(model.start)
    assert one.values == other.values
    assert all(np.array_equal(line.states, other.trajectories[name].states) for name, line in one.trajectories.items())


def test_a_phase_goes_on_beyond_its_end_where_it_is_traced(build: Callable[..., DeviceFunctions]) -> None:
    model = build()
    simulator = Simulator(model)
    ended = simulator.run(model.start, phases=["softening"])
    time = ended.values["response_time"]
    traced = simulator.trace("softening", model.start, None, 3.0 * time)
    assert traced.times[-1] == pytest.approx(3.0 * time, rel=1e-12)
    at_end = traced.at(np.array([1.0 / 3.0]))[:, 0]
    assert at_end == pytest.approx(ended.trajectory.states[:, -1], abs=5e-3)
    judge = fine(model).trace("softening", model.start, None, 3.0 * time)
    assert traced.states[:, -1] == pytest.approx(judge.states[:, -1], rel=1e-4, abs=1e-4)
