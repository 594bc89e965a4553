"""Starts of searches, of a made-up module of one number: its switch takes that long, or never ends."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from tvimdesign.base.errors import SimulationError
from tvimdesign.solve.nlp.problem_parts import Free
from tvimdesign.solve.optimizer.multistart import MAX_DRAWS, Multistart
from tvimdesign.study import SolverOptions

LOWER, UPPER, SEED = 1.0, 100.0, 3


def searches(
    starts: int,
    own: float = 2.0,
    takes: Callable[[float], float] = lambda size: size,
    mass: Callable[[float], float] = lambda size: size,
) -> tuple[Multistart, list[str]]:
    """Return starts for a number from 1 to 100 that is `own` in the study, and the progress messages."""
    said: list[str] = []
    table = SimpleNamespace(outputs=(), behind_supplied={"time"})
    model: Any = SimpleNamespace(
        start=np.array([own, 7.0]), index={"size": 0, "other": 1}, table=table, switch_names=["time"]
    )
    model.values = lambda inputs, _: {"mass": mass(inputs[0]), "time": np.nan}

    def simulated(inputs: np.ndarray) -> dict[str, float]:
        return {"time": takes(float(inputs[0]))}

    free = (Free("size", LOWER, UPPER, 2.0),)
    problem = SimpleNamespace(free=free, events=("time",), simulated=simulated, phases=())
    options = SolverOptions(starts=starts, seed=SEED)
    return Multistart(cast(Any, problem), model, options, said.append), said


def sizes(found: Multistart) -> list[float]:
    points = list(found.points())
    assert all(point[1] == 7.0 for point in points)  # what is not free stays as the study has it
    return [float(point[0]) for point in points]


def drawn(count: int) -> np.ndarray:
    """Points evenly drawn in the logarithm, number for number."""
    shares = np.random.default_rng(SEED).random((count, 1))[:, 0]
    return np.asarray(LOWER * (UPPER / LOWER) ** shares)


@pytest.mark.parametrize("starts", [1, 4])
def test_the_study_s_start_comes_first_and_others_are_log_even(starts: int) -> None:
    found, said = searches(starts)
    assert sizes(found) == pytest.approx([2.0, *drawn(starts - 1)])
    assert found.passed_over == {"switch never ends": 0, "no such module": 0}
    assert said == []


def test_points_whose_switch_never_ends_are_skipped_and_counted() -> None:
    found, said = searches(3, own=2.0, takes=lambda size: np.inf if size < 10.0 else size)
    ends = [size for size in drawn(50) if size >= 10.0][:3]
    tried = 1 + list(drawn(50)).index(ends[-1]) + 1
    assert sizes(found) == pytest.approx(ends)
    assert found.passed_over == {"switch never ends": tried - 3, "no such module": 0}
    assert said == ["the switch of the study's own start never ends, or takes no time: starting elsewhere"]


def test_points_without_a_module_are_skipped_unsimulated() -> None:
    simulated: list[float] = []

    def takes(size: float) -> float:
        simulated.append(size)
        return size

    found, _ = searches(4, takes=takes, mass=lambda size: np.nan if size < 10.0 else size)
    whole = [size for size in drawn(50) if size >= 10.0][:3]
    assert sizes(found) == pytest.approx([2.0, *whole])
    assert found.passed_over == {"switch never ends": 0, "no such module": list(drawn(50)).index(whole[-1]) + 1 - 3}
    assert simulated == pytest.approx([2.0, *whole])  # the study's own once


def test_a_point_that_cannot_be_simulated_is_no_start() -> None:
    def takes(size: float) -> float:
        if size > 10.0:
            raise SimulationError("it cannot be simulated")
        return size

    found, _ = searches(3, takes=takes)
    assert sizes(found) == pytest.approx([2.0, *[size for size in drawn(50) if size <= 10.0][:2]])


def test_where_no_point_will_do_the_search_begins_at_the_study_s_own() -> None:
    found, _ = searches(2, takes=lambda _: np.inf)
    assert sizes(found) == [2.0, 2.0]
    assert found.passed_over["switch never ends"] == 1 + 2 * MAX_DRAWS
    found, _ = searches(2, mass=lambda _: np.nan)
    assert sizes(found) == [2.0, 2.0]
    assert found.passed_over["no such module"] == MAX_DRAWS


def test_a_point_that_simulates_replaces_a_start_that_does_not() -> None:
    def takes(size: float) -> float:
        if size < 10.0:
            raise SimulationError("it cannot be simulated")
        return size if size < 40.0 else np.inf

    found, said = searches(2, own=2.0, takes=takes)
    first, second = sizes(found)
    assert 10.0 <= first < 40.0
    assert second == pytest.approx(next(size for size in drawn(50) if 10.0 <= size < 40.0))
    assert found.model.start[0] == first
    assert found.cycle["time"] == first
    assert said == ["the study's own start cannot be simulated: starting elsewhere"]


def test_where_no_point_can_be_simulated_the_error_says_what_to_do() -> None:
    def takes(_: float) -> float:
        raise SimulationError("it cannot be simulated")

    with pytest.raises(SimulationError, match=r"it cannot be simulated; neither can 100 points .* set `module` to"):
        searches(2, takes=takes)
