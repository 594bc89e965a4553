"""A search whose time is over ends with the best design found, says so, and claims nothing of what it left."""

import dataclasses
import math
import re
from functools import partial

import pytest

from tvimdesign.base.deadline import Deadline
from tvimdesign.report.run.first_screen.warnings import warnings_of
from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.optimizer.statuses import OPTIMAL
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.solve.search import optimize
from tvimdesign.study import Study, StudyError, read_study_text

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


LIMIT = 300.0
FOLLOWING = 0.97 * LIMIT
"""When the search's own time is over, and that of what follows it is not."""


class Clock:
    """A clock that stands until a certain thing is said, and a deadline by it."""

    def __init__(self, word: str, then: float = FOLLOWING) -> None:
        self.word, self.then, self.now, self.said = word, then, 0.0, list[str]()
        self.deadline = Deadline(LIMIT, lambda: self.now)

    def say(self, text: str) -> None:
        self.said.append(text)
        if re.search(self.word, text):
            self.now = max(self.now, self.then)

    def answer(self, study: Study) -> StudyResult:
        return answer(study, self.say, search=partial(optimize, deadline=self.deadline))

    def optimize(self, study: Study) -> Solution:
        return optimize(study, self.say, deadline=self.deadline)


def test_starts_that_are_left_are_told_and_the_best_design_is_kept() -> None:
    clock = Clock("start 3 of 6")
    answered = clock.answer(read_study_text(SEARCHED))
    solution = answered.solution
    assert solution is not None
    assert (answered.design.status, answered.feasible) == (OPTIMAL, True)
    assert solution.out_of_time == 300.0
    assert len(solution.starts) == 3
    assert any("objective" in text and "so far" in text for text in clock.said)
    told = [say for say, _ in warnings_of(answered, read_study_text(SEARCHED).table, ())]
    assert any("time limit of 5 min" in say for say in told)


def test_combinations_that_are_left_are_counted_as_such() -> None:
    clock = Clock("^[1-9][0-9]* combinations solved")
    solution = clock.optimize(read_study_text(LISTED))
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
def test_the_best_of_mixed_records_is_kept_and_told_as_one_of_them() -> None:
    clock = Clock("^[1-9][0-9]* combinations solved")
    answered = clock.answer(read_study_text(RECORDS))
    solution = answered.solution
    assert solution is not None
    assert solution.choosing is not None
    assert (solution.status, answered.feasible) == (OPTIMAL, True)
    assert solution.choosing.not_searched > 0
    best = solution.choosing.best[0].choices
    assert answered.design.choices["process"] == best["process"]
    assert answered.design.choices["peltier_module"] == best["peltier_module"]


def test_a_search_without_a_design_when_the_time_is_over_says_what_to_do() -> None:
    clock = Clock("start 1 of 6")
    solution = clock.optimize(read_study_text(SEARCHED))
    assert solution.status == "not converged: ran out of time"
    assert solution.conflict_set is None
    assert math.isfinite(solution.objective)


@pytest.mark.gate
def test_the_search_for_the_conflict_ends_with_the_time() -> None:
    clock = Clock("looking for the design that breaks least")
    quick = SEARCHED.replace('">= 2 N.m"', '">= 2 N.m", response_time: "<= 1 s"').replace("starts: 6", "starts: 1")
    solution = clock.optimize(read_study_text(quick))
    assert solution.status.startswith("not converged")
    assert "looking for the smallest set of limits that conflict" not in clock.said


def test_a_search_in_time_says_nothing_of_it() -> None:
    solution = optimize(read_study_text(SEARCHED.replace("starts: 6", "starts: 1")))
    assert solution.out_of_time is None
    assert dataclasses.asdict(solution.starts[0])["converged"]


def test_what_others_solve_meanwhile_does_not_count() -> None:
    clock = Clock("others")
    part = clock.deadline.leaving(20.0)
    with part.paused():
        clock.say("others")
    assert (clock.deadline.remaining, part.remaining, part.passed) == (300.0, 280.0, False)


def test_the_limit_is_a_time() -> None:
    assert read_study_text(SEARCHED).solver.time_limit == 300.0
    with pytest.raises(StudyError, match=r"solver\.time_limit: '60': say the unit"):
        read_study_text(SEARCHED.replace("5 min", "60"))
    with pytest.raises(StudyError, match=r"solver\.time_limit: 0 should be greater than 0"):
        read_study_text(SEARCHED.replace("5 min", "0 s"))
