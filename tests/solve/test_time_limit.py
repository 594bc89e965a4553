"""A search whose time is over ends with the best design found, says so, and claims nothing of what it left."""

import dataclasses
import math
import re

import pytest

from tvimdesign.report.run.first_screen.warnings import warnings_of
from tvimdesign.solve.nlp import deadline
from tvimdesign.solve.optimizer.statuses import OPTIMAL
from tvimdesign.solve.result import answer
from tvimdesign.solve.search import optimize
from tvimdesign.study import StudyError, read_study_text

SEARCHED = """
mode: shear
vary:
  wire_diameter: [1.2 mm, 3.2 mm]
  pcl_thickness: [0.6 mm, 2 mm]
  current: [0.5 A, 2.5 A]
require: {holding_torque: ">= 2 N.m"}
accept: [structure_temperature_margin, stiffening_structure_margin, peltier_temperature_margin]
minimize: {module_mass: 1, response_time: 1}
solver: {starts: 6, cells: 6, elements: 2, time_limit: 5 min}
"""
LISTED = SEARCHED.replace("starts: 6", "starts: 1").replace(
    "wire_diameter: [1.2 mm, 3.2 mm]",
    "wire_diameter: {from: 1.2 mm, to: 3.2 mm, step: 0.05 mm}\n  hub_depth: {from: 0 mm, to: 6 mm, step: 0.5 mm}",
)


class Clock:
    """A clock that stands until a certain thing is said."""

    def __init__(self, word: str) -> None:
        self.word, self.now, self.said = word, 0.0, list[str]()

    def monotonic(self) -> float:
        return self.now

    def say(self, text: str) -> None:
        self.said.append(text)
        if re.search(self.word, text):
            self.now = 1e6


def clock_until(word: str, monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock(word)
    monkeypatch.setattr(deadline, "time", clock)
    return clock


def test_starts_that_are_left_are_told_and_the_best_design_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = clock_until("start 3 of 6", monkeypatch)
    answered = answer(read_study_text(SEARCHED), clock.say)
    solution = answered.solution
    assert solution is not None
    assert (answered.design.status, answered.feasible) == (OPTIMAL, True)
    assert solution.out_of_time == 300.0
    assert len(solution.starts) == 3
    assert any("objective" in text and "so far" in text for text in clock.said)
    told = [say for say, _ in warnings_of(answered, read_study_text(SEARCHED).table, ())]
    assert any("time limit of 5 min" in say for say in told)


def test_combinations_that_are_left_are_counted_as_such(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = clock_until("^[1-9][0-9]* combinations solved", monkeypatch)
    solution = optimize(read_study_text(LISTED), clock.say)
    choosing = solution.choosing
    assert choosing is not None
    assert solution.status == OPTIMAL
    assert choosing.not_searched > 0
    assert choosing.without_design == 0
    assert choosing.solved + choosing.pruned + choosing.not_searched == choosing.combinations == 41 * 13
    assert not choosing.proven


RECORDS = (
    SEARCHED.replace("starts: 6", "starts: 1")
    .replace(
        "vary:",
        "vary:\n  peltier_module: {choose: [flexible_1600, silicone_9ar_08_24v]}\n"
        "  process: {choose: [print_pei_1010, print_pc]}\n  hub_depth: {from: 0 mm, to: 6 mm, step: 0.5 mm}",
    )
    .replace("accept: [", "accept: [current_margin, ")
)


@pytest.mark.gate
def test_the_best_of_mixed_records_is_kept_and_told_as_one_of_them(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = clock_until("^[1-9][0-9]* combinations solved", monkeypatch)
    answered = answer(read_study_text(RECORDS), clock.say)
    solution = answered.solution
    assert solution is not None
    assert solution.choosing is not None
    assert (solution.status, answered.feasible) == (OPTIMAL, True)
    assert solution.choosing.not_searched > 0
    best = solution.choosing.best[0].choices
    assert answered.design.choices["process"] == best["process"]
    assert answered.design.choices["peltier_module"] == best["peltier_module"]


def test_a_search_without_a_design_when_the_time_is_over_says_what_to_do(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = clock_until("start 1 of 6", monkeypatch)
    solution = optimize(read_study_text(SEARCHED), clock.say)
    assert solution.status == "not converged: ran out of time"
    assert solution.conflict_set is None
    assert math.isfinite(solution.objective)


@pytest.mark.gate
def test_the_search_for_the_conflict_ends_with_the_time(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = clock_until("looking for the design that breaks least", monkeypatch)
    quick = SEARCHED.replace('">= 2 N.m"', '">= 2 N.m", response_time: "<= 1 s"').replace("starts: 6", "starts: 1")
    solution = optimize(read_study_text(quick), clock.say)
    assert solution.status.startswith("not converged")
    assert "looking for the smallest set of limits that conflict" not in clock.said


def test_a_search_in_time_says_nothing_of_it() -> None:
    solution = optimize(read_study_text(SEARCHED.replace("starts: 6", "starts: 1")))
    assert solution.out_of_time is None
    assert dataclasses.asdict(solution.starts[0])["converged"]


def test_what_others_solve_meanwhile_does_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = clock_until("others", monkeypatch)
    limit = deadline.Deadline(300.0)
    with limit.paused():
        clock.say("others")
    assert (limit.remaining, limit.passed) == (300.0, False)


def test_the_limit_is_a_time() -> None:
    assert read_study_text(SEARCHED).solver.time_limit == 300.0
    with pytest.raises(StudyError, match=r"solver\.time_limit: '60': say the unit"):
        read_study_text(SEARCHED.replace("5 min", "60"))
    with pytest.raises(StudyError, match=r"solver\.time_limit: 0 should be greater than 0"):
        read_study_text(SEARCHED.replace("5 min", "0 s"))
