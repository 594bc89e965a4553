"""Fronts: the least of one output under a ceiling on another, no point beaten, nothing dropped in silence."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from comparable import COMPRESSION, SHEAR
from hypothesis import given
from hypothesis import strategies as st

from tvimdesign.catalog import Catalog
from tvimdesign.device import table_for
from tvimdesign.solve.front import Front, Point, Tradeoff, undominated, with_ceilings
from tvimdesign.solve.goal import Goal
from tvimdesign.solve.optimizer import EXPAND_FROM, Optimizer, Run
from tvimdesign.solve.search import optimize
from tvimdesign.solve.statuses import meaning
from tvimdesign.study import Requirement, Study, read_study_text

pytestmark = pytest.mark.xdist_group("front")  # its costly fixture is made once, in one process

TIME, MASS, SIZE = "response_time", "module_mass", "envelope_diameter"


def _tradeoff(text: str, **solver: Any) -> tuple[Study, Tradeoff]:
    """The trade-off of a study, around the optimum it has with its usual solver."""
    study = read_study_text(text, "test")
    table = table_for(study.mode)
    solution = optimize(study, Catalog(), table)
    assert solution.status == "optimal"
    hampered = study.model_copy(update={"solver": study.solver.model_copy(update=solver)})
    return study, Tradeoff(hampered, Catalog(), table, solution, (TIME, MASS, SIZE))


@pytest.fixture(scope="module", params=[SHEAR, COMPRESSION], ids=["shear", "compression"])
def traded(request: pytest.FixtureRequest) -> tuple[Study, Front]:
    study, trade = _tradeoff(request.param)
    return study, trade.front(TIME, MASS, 5)


def test_less_mass_costs_more_time_at_every_point(traded: tuple[Study, Front]) -> None:
    front = traded[1]
    assert front.failures == ()
    assert len(front.points) + len(front.dominated) >= 5
    masses = [point.values[MASS] for point in front.points]
    times = [point.values[TIME] for point in front.points]
    assert masses == sorted(masses, reverse=True)
    assert times == sorted(times)
    assert len(set(masses)) == len(masses)


def test_ceilings_are_spread_evenly_and_kept(traded: tuple[Study, Front]) -> None:
    front = traded[1]
    bounds = [point.bound for point in front.points if point.bound is not None]
    ends = front.points[0].values[MASS], front.points[-1].values[MASS]
    assert len(bounds) == 3
    assert bounds == pytest.approx([ends[0] + share * (ends[1] - ends[0]) for share in (0.25, 0.5, 0.75)], rel=1e-9)
    for point in front.points:
        if point.bound is not None:
            assert point.values[MASS] <= point.bound * (1.0 + 1e-5)


def test_every_point_is_a_whole_design_that_keeps_what_the_study_requires(traded: tuple[Study, Front]) -> None:
    study, front = traded
    table = table_for(study.mode)
    for point in front.points:
        assert set(table.names(study.operating_points)) <= point.values.keys()
        for requirement in study.require:
            assert point.values[requirement.output] >= requirement.limit * (1.0 - 1e-5)


def test_a_point_is_what_a_study_with_that_ceiling_finds(traded: tuple[Study, Front]) -> None:
    """The same from a problem of its own, with the ceiling as a requirement and time as the only goal."""
    study, front = traded
    point = front.points[len(front.points) // 2]
    assert point.bound is not None
    ceiling = Requirement(output=MASS, sense="<=", limit=point.bound, text="")
    alone = study.model_copy(update={"require": (*study.require, ceiling), "minimize": {TIME: 1.0}})
    solution = optimize(alone, Catalog(), table_for(study.mode))
    assert solution.values[TIME] == pytest.approx(point.values[TIME], rel=2e-3)


@pytest.mark.parametrize(("output", "place"), [(TIME, 0), (MASS, -1)])
def test_an_end_is_no_worse_than_what_a_study_with_that_goal_alone_finds(
    traded: tuple[Study, Front], output: str, place: int
) -> None:
    """A front stops where a hundredth of one buys less than a ten-thousandth of the other; optima are several."""
    study, front = traded
    alone = optimize(study.model_copy(update={"minimize": {output: 1.0}}), Catalog(), table_for(study.mode))
    assert front.points[place].values[output] <= alone.values[output] * 1.01


def test_a_point_takes_one_run_and_an_end_that_is_known_one_more(monkeypatch: pytest.MonkeyPatch) -> None:
    _, trade = _tradeoff(SHEAR)
    solve, runs = Optimizer.solve, list[Goal]()

    def counted(self: Optimizer, *args: Any, goal: Goal, **more: Any) -> Run:
        runs.append(goal)
        return solve(self, *args, goal=goal, **more)

    monkeypatch.setattr(Optimizer, "solve", counted)
    trade.front(TIME, MASS, 6)
    begins = 2  # the study's start and its one optimum
    assert len(runs) == 2 * begins + 4 + 1  # ends, points between, one back from the light end
    runs.clear()
    trade.front(TIME, SIZE, 6)
    assert len(runs) == begins + 1 + 4 + 1


def test_what_found_the_optimum_serves_for_its_front(
    traded: tuple[Study, Front], monkeypatch: pytest.MonkeyPatch
) -> None:
    """With ceilings that are not felt the optimum is the same, and so is the front, with nothing built again."""
    study, front = traded
    outputs, table, built = (TIME, MASS), table_for(study.mode), list[Optimizer]()
    many = study.model_copy(update={"solver": study.solver.model_copy(update={"starts": EXPAND_FROM})})
    bare = optimize(many, Catalog(), table)
    usual = {name: bare.values[name] for name in outputs}
    solution = optimize(with_ceilings(many, outputs, usual), Catalog(), table, keep=built.append)
    assert solution.objective == pytest.approx(bare.objective, rel=1e-4)

    def refused(*_: Any, **__: Any) -> None:
        raise AssertionError("built again")

    monkeypatch.setattr(Optimizer, "__init__", refused)
    again = Tradeoff(many, Catalog(), table, solution, outputs, built=built[0]).front(TIME, MASS, 5)
    assert again.failures == ()
    for mine, theirs in ((again.points[0], front.points[0]), (again.points[-1], front.points[-1])):
        assert [mine.values[name] for name in outputs] == pytest.approx(
            [theirs.values[name] for name in outputs], rel=5e-3
        )
    with pytest.raises(AssertionError, match="built again"):  # no ceiling on this one
        Tradeoff(many, Catalog(), table, solution, (TIME, MASS, SIZE), built=built[0])


@pytest.mark.parametrize("turn", [0, 2, 4])
def test_points_beyond_a_jump_between_optima_are_those_of_the_light_end(
    monkeypatch: pytest.MonkeyPatch, turn: int
) -> None:
    """Two branches of optima, each followed from its own end: by hand, the second is better from `turn` on."""

    def on_a_branch(*asked: Any) -> Point:
        bound, near = asked[-2:]
        branch = near.values["branch"]
        time = 100.0 - bound + (1.0 if (bound <= 5.0 - turn) != bool(branch) else 0.0)
        return Point(bound, {TIME: time, MASS: bound, "branch": branch}, {})

    trade = object.__new__(Tradeoff)
    trade.progress = lambda _: None
    monkeypatch.setattr(Tradeoff, "_least", on_a_branch)
    quick, light = (Point(None, {TIME: 0.0, MASS: mass, "branch": mass < 1.0}, {}) for mass in (6.0, 0.0))
    found = trade._between(quick, light, TIME, MASS, 7)
    assert [point.values["branch"] for point in found if isinstance(point, Point)] == [
        bound <= 5 - turn for bound in (5, 4, 3, 2, 1)
    ]


def test_a_point_between_that_the_solver_does_not_reach_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    _, trade = _tradeoff(SHEAR)
    solve = Optimizer.solve

    def lost_below_a_ceiling(self: Optimizer, *args: Any, goal: Goal, **more: Any) -> Run:
        run = solve(self, *args, goal=goal, **more)
        if math.isfinite(goal.ceilings[MASS]):
            run.start = replace(run.start, converged=False, status="Restoration_Failed")
        return run

    monkeypatch.setattr(Optimizer, "solve", lost_below_a_ceiling)
    front = trade.front(TIME, MASS, 4)
    assert [failure.reason for failure in front.failures] == [
        f"not converged: {meaning('Restoration_Failed').words}"
    ] * 2
    ends = [front.points[0].values[MASS], front.points[-1].values[MASS]]
    assert [failure.bound for failure in front.failures] == pytest.approx(
        [ends[0] + share * (ends[1] - ends[0]) for share in (1.0 / 3.0, 2.0 / 3.0)]
    )


def test_outputs_that_do_not_conflict_are_one_point_and_said_to_be() -> None:
    """Nothing that is free here changes the envelope's diameter, so the quickest is as small as any."""
    _, trade = _tradeoff(SHEAR.replace("  wire_diameter: [2 mm, 3 mm]\n", "").replace(
        "pcl_outer_radius: [32 mm, 42 mm]", "pcl_inner_radius: [24 mm, 30 mm]"))  # fmt: skip
    front = trade.front(TIME, SIZE, 5)
    assert len(front.points) == 1
    assert "do not conflict" in front.notes[0]


def test_what_the_solver_does_not_reach_is_named() -> None:
    _, trade = _tradeoff(SHEAR, max_iterations=2)
    front = trade.front(TIME, MASS, 4)
    assert len(front.failures) == 2
    assert all("ran out of iterations" in failure.reason for failure in front.failures)
    assert "no design" in front.notes[0]


def test_listed_sizes_stay_those_of_the_optimum_and_that_is_said() -> None:
    listed = SHEAR.replace("wire_diameter: [2 mm, 3 mm]", "wire_diameter: {choose: [2.3 mm, 2.5 mm]}")
    _, trade = _tradeoff(listed)
    front = trade.front(TIME, MASS, 3)
    assert len({point.values["wire_diameter"] for point in front.points}) == 1
    assert "wire_diameter as in the optimum" in front.notes[-1]


@given(st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5), st.integers(0, 5)), max_size=8))
def test_kept_points_are_those_no_other_is_better_than(numbers: list[tuple[int, int, int]]) -> None:
    names = ("a", "b", "c")
    points = [Point(None, dict(zip(names, map(float, triple), strict=True)), {}) for triple in numbers]
    kept, dominated = undominated(points, names)
    assert len(kept) + len(dominated) == len(points)
    triples = {tuple(point.values[name] for name in names) for point in kept}
    assert len(triples) == len(kept)
    for triple in (tuple(map(float, one)) for one in numbers):
        beaten = any(o != triple and all(x <= y for x, y in zip(o, triple, strict=True)) for o in
                     (tuple(map(float, other)) for other in numbers))  # fmt: skip
        assert (triple in triples) == (not beaten)
