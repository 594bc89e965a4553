"""The time limit of a search, and the best design so far."""

import json
import math
import os
import re
import signal
from functools import partial

import numpy as np
import pytest
from explored import SMALL
from small_studies import ALGEBRAIC
from support import sample_text

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import TimeOverError
from tvimdesign.base.interrupts import interrupt_handler
from tvimdesign.report.run.blocks.verdict import verdict
from tvimdesign.report.run.blocks.warnings import warnings_of
from tvimdesign.report.run.run_study import run_study
from tvimdesign.report.run.uncertainty_data import below_yield
from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.nlp.solver_run import ALTERNATIVES, BELOW_YIELD, MARGINS, OPTIMAL
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.solve.search import SearchInterrupted, optimize
from tvimdesign.study import Study, drawn, given, read_study, read_study_text
from tvimdesign.study.written_studies import study_text

SEARCHED = sample_text("limited_in_time")
LISTED = SEARCHED.replace("starts: 6", "starts: 1").replace(
    "wire_diameter: [1.2 mm, 3.2 mm]",
    "wire_diameter: {from: 1.2 mm, to: 3.2 mm, step: 0.05 mm}\n  hub_depth: {from: 0 mm, to: 6 mm, step: 0.5 mm}",
)


LIMIT = 300.0
FOLLOWING = 0.97 * LIMIT
"""When the search's own time is over, and that of what follows it is not."""


class Clock:
    """A clock that stands until a certain progress message, and a deadline by it."""

    def __init__(self, word: str, then: float = FOLLOWING) -> None:
        self.word, self.then, self.now, self.messages = word, then, 0.0, list[str]()
        self.deadline = Deadline(LIMIT, lambda: self.now)

    def say(self, text: str) -> None:
        self.messages.append(text)
        if re.search(self.word, text):
            self.now = max(self.now, self.then)

    def answer(self, study: Study) -> StudyResult:
        return answer(study, self.say, search=partial(optimize, deadline=self.deadline))

    def optimize(self, study: Study) -> Solution:
        return optimize(study, self.say, deadline=self.deadline)


def test_starts_that_are_left_are_counted_and_the_best_design_stays():
    clock = Clock("start 3 of 6")
    answered = clock.answer(read_study_text(SEARCHED))
    solution = answered.solution
    assert (answered.design.status, answered.feasible) == (OPTIMAL, True)
    assert solution.out_of_time == 300.0
    assert len(solution.starts) == 3
    assert any("objective" in text and "so far" in text for text in clock.messages)
    assert any("time limit of 5 min" in warning.text for warning in warnings_of(answered, ()))


def test_combinations_that_are_left_are_counted_as_such():
    clock = Clock("^1 combination solved")
    solution = clock.optimize(read_study_text(LISTED))
    choosing = solution.choosing
    assert solution.status == OPTIMAL
    assert choosing.not_searched > 0
    assert choosing.without_design == 0
    assert choosing.solved + choosing.pruned + choosing.not_searched == choosing.combinations == 41 * 13
    assert not choosing.proven


def test_a_search_without_a_design_when_the_time_is_over_says_what_to_do():
    clock = Clock("start 1 of 6")
    solution = clock.optimize(read_study_text(SEARCHED))
    assert solution.status == "not converged: ran out of time"
    assert solution.conflict_set is None
    assert math.isfinite(solution.objective)
    in_time = optimize(read_study_text(SEARCHED.replace("starts: 6", "starts: 1")))
    assert (in_time.out_of_time, in_time.starts[0].converged) == (None, True)


@pytest.mark.gate
def test_the_search_for_the_conflict_ends_with_the_time():
    clock = Clock("searching for the design of least violation")
    quick = SEARCHED.replace('">= 2 N.m"', '">= 2 N.m", response_time: "<= 1 s"').replace("starts: 6", "starts: 1")
    solution = clock.optimize(read_study_text(quick))
    assert solution.status.startswith("not converged")
    assert any("least violation, from start 1 of" in text for text in clock.messages)
    assert not any("looking for the fewest limits that conflict" in text for text in clock.messages)


ROBUST = ALGEBRAIC.replace("{starts: 1}", "{starts: 1, time_limit: 5 min}") + "robust: {yield: 95 %}\n"


@pytest.mark.gate
@pytest.mark.parametrize(
    ("word", "then"),
    [("preparing the equations", FOLLOWING), ("adding tolerance margins", 1e6)],
    ids=["begun", "moved"],
)
def test_a_search_that_ends_before_its_margins_claims_nothing_of_the_yield(word, then):
    clock = Clock(word, then)
    answered = clock.answer(read_study_text(ROBUST))
    assert (answered.design.status, answered.feasible, answered.has_design) == (BELOW_YIELD, True, True)
    assert answered.solution.out_of_time == LIMIT
    assert MARGINS in clock.deadline.left_out
    missed = below_yield(answered)
    assert "no design found" not in missed
    assert "the time limit of 5 min 00 s ended the search before it had all margins" in missed
    assert "--time-limit" in missed
    if then > LIMIT:
        assert "how many modules satisfy every limit is not known" in missed
        assert verdict(answered, {}, []).text == "Margins not reached: the time limit ended the search"


@pytest.mark.gate
def test_alternatives_that_are_left_out_are_named():
    clock = Clock("simulating the next-best choice", 1e6)
    solution = clock.optimize(read_study_text(LISTED))
    assert solution.status == OPTIMAL
    assert len(solution.choosing.best) < 5
    assert ALTERNATIVES in solution.left_out


def test_without_time_neither_search_nor_simulation_starts():
    with pytest.raises(TimeOverError, match="before the search could start"):
        optimize(read_study_text(SEARCHED), deadline=Deadline(1e-3, lambda: 0.0))
    optimizer = Optimizer(read_study_text(SEARCHED))
    over = Deadline(0.0, lambda: 0.0)
    with pytest.raises(TimeOverError, match="before the working cycle of a design was simulated"):
        optimizer.simulator.run(optimizer.model.start, deadline=over)


def test_a_run_of_the_solver_ends_between_two_iterations():
    # One solver serves a run that has time, one that has not, and one that has time again.
    optimizer, ticks = Optimizer(read_study_text(SEARCHED)), iter(range(10_000))
    whole = optimizer.solve()
    solvers = dict(optimizer._solvers)
    optimizer.deadline = Deadline(8.0, lambda: float(next(ticks)))
    cut = optimizer.solve()
    optimizer.deadline = Deadline()
    again = optimizer.solve()
    assert (cut.start.status, cut.start.converged) == ("Maximum_WallTime_Exceeded", False)
    assert 0 < cut.start.iterations < whole.start.iterations
    assert np.array_equal(again.unknowns, whole.unknowns)
    assert optimizer._solvers == solvers


TWO_STARTS = SMALL.replace("starts: 1", "starts: 2")
LISTED_WIRES = SMALL.replace("pcl_thickness: [0.6", "pcl_thickness: {choose: [0.6").replace("2 mm]", "1 mm, 2 mm]}")


def _interrupted(study: Study, at: str) -> Study | None:
    """Return the best design so far where an interrupt comes at a certain word of the search."""

    def progress(text: str) -> None:
        if at in text:
            os.kill(os.getpid(), signal.SIGTERM)

    with interrupt_handler(), pytest.raises(SearchInterrupted) as interrupted:
        optimize(study, progress)
    return interrupted.value.best


@pytest.mark.gate
@pytest.mark.parametrize("text", [TWO_STARTS, LISTED_WIRES])
def test_the_study_begins_at_a_design_that_keeps_all_limits(text, tmp_path):
    best = _interrupted(read_study_text(text), "so far")
    (tmp_path / "best.yaml").write_text(study_text(best, "the best", tmp_path))
    read = read_study(tmp_path / "best.yaml")
    assert read.vary.keys() == best.vary.keys()
    names = list(best.vary)
    assert [given(read)[name] for name in names] == [given(best)[name] for name in names]
    result, plain = (answer(drawn(study)) for study in (read, read_study_text(text)))
    assert result.feasible
    assert result.design.values["response_time"] < 0.9 * plain.design.values["response_time"]


def test_before_the_first_design_there_is_none():
    assert _interrupted(read_study_text(TWO_STARTS), "start 1 of 2") is None


def test_an_interrupted_run_keeps_it_and_says_where(tmp_path, monkeypatch, capsys):
    path, out = tmp_path / "study.yaml", tmp_path / "out"
    path.write_text(TWO_STARTS)
    best = read_study_text(TWO_STARTS)

    def interrupted(*_: object, **__: object) -> None:
        try:
            os.kill(os.getpid(), signal.SIGTERM)
        except KeyboardInterrupt as interrupt:
            raise SearchInterrupted(best) from interrupt

    monkeypatch.setattr("tvimdesign.report.run.answered_study.answer", interrupted)
    with pytest.raises(KeyboardInterrupt):
        run_study(path, out, overwrite=False, cad=False, plots=False, as_json=False)
    file, printed = out / "best_so_far.yaml", capsys.readouterr().err
    assert f"{file} starts at the best design so far; go on from there: tvimdesign run {file}\n" in printed
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["status"] == "interrupted"
    assert list(manifest["files"]) == ["best_so_far.yaml"]
    assert given(read_study(out / "best_so_far.yaml")) == given(best)


@pytest.mark.gate
def test_a_design_that_is_found_is_kept_until_it_is_written(tmp_path, monkeypatch):
    path, out = tmp_path / "study.yaml", tmp_path / "out"
    path.write_text(SMALL)

    def interrupted(*_: object) -> None:
        os.kill(os.getpid(), signal.SIGTERM)

    monkeypatch.setattr("tvimdesign.report.run.run_page.write_answer", interrupted)
    with pytest.raises(KeyboardInterrupt):
        run_study(path, out, overwrite=False, cad=False, plots=False, as_json=False)
    assert answer(drawn(read_study(out / "best_so_far.yaml"))).feasible
