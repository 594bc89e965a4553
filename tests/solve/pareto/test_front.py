"""Fronts: the ends are optima of their own, no point is beaten, points are even, and nothing is dropped in silence."""

import itertools
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from comparable import COARSE, COMPRESSION, SHEAR

from tvimdesign.device import table_for
from tvimdesign.report.run.front_report import front_csv, plain
from tvimdesign.simulation.working_cycle.cycle import CycleEngine, Supplied
from tvimdesign.solve.nlp.problem_parts import Objective
from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.nlp.solver_run import Run, meaning
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.pareto.front import Front, completed, trace_front
from tvimdesign.solve.pareto.tradeoff import Failure, Point, Tradeoff
from tvimdesign.solve.search import optimize
from tvimdesign.study import Requirement, read_study_text

TIME, MASS, SIZE = "response_time", "module_mass", "envelope_volume"


class Solved:
    """A study's optimum with what found it, to be traded again and again."""

    def __init__(self, text: str, objectives: tuple[str, ...] = (TIME, MASS, SIZE)) -> None:
        self.study = read_study_text(text, "test")
        self.built: list[tuple[Optimizer, list[Run]]] = []
        self.solution: Solution = optimize(
            self.study, keep=lambda *given: self.built.append(given), objectives=objectives
        )
        assert self.solution.status == "optimal"

    def trade(self, memory: Any = None) -> Tradeoff:
        return Tradeoff(self.study, self.solution, *self.built[0], memory=memory)

    def alone(self, minimize: str, *more: Requirement, begin: Mapping[str, float] | None = None) -> float:
        """Return the least of an output by a search of its own, from the study's start with other numbers."""
        update = {
            "minimize": {minimize: 1.0},
            "require": (*self.study.require, *more),
            "module": {**self.study.module, **(begin or {})},
        }
        return optimize(self.study.model_copy(update=update)).values[minimize]


# 2.5 A: at 1.5 A the three outputs barely conflict, which leaves no front.
# Where the joint is soft while cells still melt one after the other, the grid has optima of its own, 0.3 % high.
SMOOTH = COMPRESSION.replace("response_criterion: softening", "response_criterion: far_face").replace("1.5 A", "2.5 A")


@pytest.fixture(
    scope="module", params=[COARSE, pytest.param(SMOOTH, marks=pytest.mark.slow)], ids=["shear", "compression"]
)
def solved(request: pytest.FixtureRequest) -> Solved:
    return Solved(request.param)


@pytest.fixture(scope="module")
def pair(solved: Solved) -> Front:
    return trace_front(solved.trade(), (TIME, MASS), 7)


class Notes:
    """A memory that forgets everything from some question on."""

    def __init__(self) -> None:
        self.known: dict[int, Point | Failure] = {}
        self.recalled = 0

    def recall(self, number: int, _: Objective) -> Point | Failure | None:
        self.recalled += number in self.known
        return self.known.get(number)

    def keep(self, number: int, _: Objective, point: Point | Failure) -> None:
        self.known[number] = point


@pytest.fixture(scope="module")
def noted(solved: Solved) -> tuple[Front, Notes]:
    """Return a front of three outputs, and what was noted on the way."""
    notes = Notes()
    return trace_front(solved.trade(notes), (TIME, MASS, SIZE), 9), notes


@pytest.fixture(scope="module")
def triple(noted: tuple[Front, Notes]) -> Front:
    return noted[0]


def _numbers(front: Front) -> list[tuple[float, ...]]:
    return [tuple(point.values[name] for name in front.outputs) for point in front.points]


def _beats_itself(front: Front) -> bool:
    """Return whether a point is as good as another in everything."""
    return any(
        all(mine >= theirs for mine, theirs in zip(first, other, strict=True))
        for first, other in itertools.permutations(_numbers(front), 2)
    )


def test_a_front_has_the_points_that_were_asked_for_and_none_is_beaten(pair):
    assert pair.failures == ()
    assert len(pair.points) == 7
    assert not _beats_itself(pair)


def test_points_are_spread_evenly(pair):
    """On lines of one direction, evenly spread over the chord, a gap is up to 2**0.5 times as large as another."""
    numbers = np.array(_numbers(pair))
    shares = (numbers - numbers.min(axis=0)) / np.ptp(numbers, axis=0)
    gaps = np.linalg.norm(np.diff(shares, axis=0), axis=1)
    assert gaps.max() / gaps.mean() < 1.42
    assert pair.spread == pytest.approx(gaps.max() / gaps.mean())


@pytest.mark.parametrize("output", [TIME, MASS])
def test_an_end_is_the_least_that_a_study_with_that_goal_alone_finds(solved, pair, output):
    # A front stops where a hundredth of one buys less than a ten-thousandth of the other.
    least = solved.alone(output)
    assert min(point.values[output] for point in pair.points) == pytest.approx(least, rel=0.01)


def test_a_point_is_what_a_study_with_that_mass_as_a_limit_finds(solved, pair):
    """From its own start, and from the point itself."""
    point = pair.points[3]
    ceiling = Requirement(output=MASS, sense="<=", limit=point.values[MASS], text="")
    there = {name: point.values[name] for name in solved.study.vary}
    least = min(solved.alone(TIME, ceiling), solved.alone(TIME, ceiling, begin=there))
    assert point.values[TIME] == pytest.approx(least, rel=2e-3)


@pytest.mark.gate
def test_a_front_of_three_goes_with_the_front_of_two(pair, triple):
    """Both have the same ends, and no point of one is below one of the other in all three outputs."""
    assert triple.failures == ()
    assert len(triple.points) >= 7
    assert not _beats_itself(triple)
    for output in (TIME, MASS):
        ends = [min(point.values[output] for point in front.points) for front in (pair, triple)]
        assert ends[1] == pytest.approx(ends[0], rel=2e-3)
    for traced, other in ((pair, triple), (triple, pair)):
        for point in traced.points:
            for there in other.points:
                assert not all(there.values[name] < point.values[name] * 0.995 for name in (TIME, MASS, SIZE))


def test_every_completed_point_is_a_design_that_satisfies_the_study(solved, pair):
    table, whole = table_for(solved.study.mode), completed(pair, solved.trade())
    for partly, point in zip(pair.points, whole.points, strict=True):
        assert {TIME, MASS} <= partly.values.keys() < point.values.keys()
        assert set(table.names(solved.study.operating_points)) <= point.values.keys()
        assert np.isfinite(point.values["stiffening_time"])
        # What is simulated a second time with all that rides along is the same to the integration's tolerance.
        assert point.values == pytest.approx(point.values | partly.values, rel=1e-3)
        for requirement in solved.study.require:
            assert point.values[requirement.output] >= requirement.limit * (1.0 - 1e-5)


def test_a_point_takes_few_cycles_from_its_neighbours(solved, monkeypatch):
    solve, run, cycles = Optimizer.solve, CycleEngine.run, list[int]()

    def counted(self: Optimizer, *args: Any, **more: Any) -> Run:
        cycles.append(0)
        return solve(self, *args, **more)

    def simulated(self: CycleEngine, *args: Any, **more: Any) -> Supplied:
        if cycles:
            cycles[-1] += 1
        return run(self, *args, **more)

    monkeypatch.setattr(Optimizer, "solve", counted)
    monkeypatch.setattr(CycleEngine, "run", simulated)
    trace_front(solved.trade(), (TIME, MASS), 12)
    assert len(cycles) <= 18
    assert np.median(cycles) <= 11  # 10; 11.5 where the solver runs on the cycle itself


def test_what_can_be_traded_does_not_change_the_optimum(solved):
    bare = optimize(solved.study)
    assert bare.objective == pytest.approx(solved.solution.objective, rel=1e-5)
    assert bare.reference.keys() == solved.solution.reference.keys() == solved.study.minimize.keys()


@pytest.mark.gate
def test_a_front_goes_on_from_what_is_known_to_the_same_points(solved, noted):
    whole, notes = noted[0], Notes()
    notes.known = {number: point for number, point in noted[1].known.items() if number < 6}
    again = trace_front(solved.trade(notes), (TIME, MASS, SIZE), 9)
    assert notes.recalled == 6
    assert _numbers(again) == _numbers(whole)
    assert [point.values for point in again.points] == [point.values for point in whole.points]


@pytest.mark.gate
def test_a_point_that_the_solver_does_not_reach_is_named(solved, monkeypatch):
    solve = Optimizer.solve

    def lost_between(self: Optimizer, *args: Any, objective: Objective, **more: Any) -> Run:
        run = solve(self, *args, objective=objective, **more)
        if objective.bounds:
            run.start = replace(run.start, converged=False, status="Restoration_Failed")
        return run

    monkeypatch.setattr(Optimizer, "solve", lost_between)
    front = trace_front(solved.trade(), (TIME, MASS), 4)
    assert len(front.points) == 2
    assert {failure.reason for failure in front.failures} == {f"not converged: {meaning('Restoration_Failed').words}"}
    assert len(front.failures) >= 2


@pytest.mark.parametrize("lost", [(TIME, MASS), (MASS,)], ids=["both", "one"])
def test_a_front_whose_ends_fail_has_what_was_found_and_says_so(solved, lost, monkeypatch):
    """It once ended in an IndexError."""
    solve, trade = Optimizer.solve, solved.trade()
    one_each = trade.weights({TIME: 1.0, MASS: 1.0})

    def lost_at_the_end(self: Optimizer, *args: Any, objective: Objective, **more: Any) -> Run:
        run = solve(self, *args, objective=objective, **more)
        if max(one_each, key=lambda name: objective.weights[name] / one_each[name]) in lost:
            run.start = replace(run.start, converged=False, status="Restoration_Failed")
        return run

    monkeypatch.setattr(Optimizer, "solve", lost_at_the_end)
    front = completed(trace_front(trade, (TIME, MASS), 4), trade)
    assert front.notes[0] == "an end has no design"
    assert [failure.where for failure in front.failures] == [
        f"least {output}, then {other}" for output, other in ((TIME, MASS), (MASS, TIME)) if output in lost
    ]
    assert len(front.points) == 2 - len(lost)
    table = table_for(solved.study.mode)
    reported = plain(front, front.outputs, table)
    assert front_csv(reported).count("\n") == 1 + len(front.points)
    assert reported["in_words"][0] == "An end has no design."


def test_outputs_that_do_not_conflict_are_one_point():
    # A smaller rotor is both lighter and smaller, and there is nothing else to choose.
    text = COARSE.replace("  wire_diameter: [2 mm, 3 mm]\n", "").replace("  pcl_thickness: [0.6 mm, 2 mm]\n", "")
    text = text.replace("module:\n", "module:\n  wire_diameter: 2.9 mm\n")
    front = trace_front(Solved(text).trade(), (MASS, SIZE), 5)
    assert len(front.points) == 1
    assert "do not conflict" in front.notes[0]
    assert front.knee is None


@pytest.mark.parametrize("points", [5, 9])
def test_points_closer_than_the_tolerance_are_left_out_and_counted(points):
    """Mass rises by 1.1 % along the front, stiffness falls by 1.2: of points 0.2 % apart it holds six, not nine.

    Nothing here depends on a switch, so it is quick. The coils alone bend: leg and tang as drawn make it 1.9 %.
    """
    text = "mode: shear\nmodule: {stroke: 0.104 rad, leg_model: ignored}\nsolver: {starts: 1}\n"
    text += "vary: {coil_count: [4, 4.05]}\n"
    outputs = ("springs_mass", "spring_stiffness")
    solved = Solved(f"{text}minimize: {{springs_mass: 1, spring_stiffness: 1}}\n", outputs)
    front = trace_front(solved.trade(), outputs, points)
    numbers = np.array(_numbers(front))
    assert np.all(np.max(np.abs(np.diff(numbers, axis=0)) / numbers[1:], axis=1) > 2e-3)
    count = len(front.points)
    close = f"more points than {count} would be closer than the simulation tells designs apart"
    assert (close in front.notes) == (count < points) == (points == 9)
    assert not any("jump" in note for note in front.notes)
    assert count >= 5


@pytest.mark.slow
def test_listed_sizes_stay_those_of_the_optimum_and_the_report_says_so():
    listed = Solved(SHEAR.replace("wire_diameter: [2 mm, 3 mm]", "wire_diameter: {choose: [2.92 mm, 3 mm]}"))
    front = trace_front(listed.trade(), (TIME, MASS), 3)
    assert {point.values["wire_diameter"] for point in front.points} == {listed.solution.values.get(
        "wire_diameter", listed.trade().optimum.values["wire_diameter"])}  # fmt: skip
    assert "wire_diameter as in the optimum" in front.notes[-1]
