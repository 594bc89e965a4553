"""Branch and bound, and boxes without a design."""

import itertools
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import yaml
from choosing import with_each_record
from hypothesis import given, settings
from hypothesis import strategies as st
from support import ROOT, sample_text

from tvimdesign.base.deadline import Deadline
from tvimdesign.solve.discrete.branch_and_bound import BranchAndBound, Node
from tvimdesign.solve.discrete.discrete_choices import Box, Sizes, discrete_sizes, is_one
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.infeasibility.feasibility_screen import NOWHERE
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.nlp.solver_run import NO_DESIGN, NO_MODULE, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.search import optimize
from tvimdesign.study import Study, read_study_text, read_tree
from tvimdesign.study.tree import tree_of_text, with_settings


@dataclass
class Bowl:
    """Stands in for a tree: sum of w (x - c)^2 plus a base, the first number no less than `least`.

    Where `fails` is true, boxes of more than one combination are never solved, as where the solver does not converge.
    """

    place: int
    sizes: Sizes
    centre: tuple[float, ...]
    weights: tuple[float, ...]
    base: float
    least: float
    fails: bool = False
    optima: list[Run] = field(default_factory=list)
    optimizer: Any = field(default_factory=lambda: SimpleNamespace(progress=lambda _: None, deadline=Deadline()))
    solved: int = 0

    def __post_init__(self) -> None:
        whole, _ = self.best_within(self.sizes.whole, None)
        self.optima = [] if whole is None else [whole]

    def at(self, point: tuple[float, ...]) -> float:
        return self.base + sum(w * (x - c) ** 2 for w, x, c in zip(self.weights, point, self.centre, strict=True))

    def values(self, run: Any) -> dict[str, float]:
        return dict(run.values)

    def best_within(self, box: Box, _near: Any) -> tuple[Any, bool]:
        ends = list(self.sizes.ends(box).values())
        if ends[0][1] < self.least:
            return None, True
        if self.fails and not is_one(box):
            return None, False
        ends[0] = (max(ends[0][0], self.least), ends[0][1])
        point = tuple(min(max(c, low), high) for c, (low, high) in zip(self.centre, ends, strict=True))
        self.solved += 1
        values = dict(zip(self.sizes.names, point, strict=True))
        start = SimpleNamespace(converged=True, objective=self.at(point))
        return SimpleNamespace(values=values, start=start, unknowns=np.array(point)), True

    def exactly(self, box: Box, near: Any) -> tuple[Any, bool]:
        return self.best_within(box, near)

    def note(self, run: Any) -> None:
        """Record that a tree has its best; a bowl has none."""

    def thoroughly(self, box: Box, near: Any) -> Any:
        return self.best_within(box, near)[0]

    def enumerated(self) -> list[float]:
        return [self.at(point) for point in itertools.product(*self.sizes.sizes) if point[0] >= self.least]


_LISTS = st.lists(st.integers(1, 60), min_size=1, max_size=7, unique=True).map(lambda n: tuple(sorted(map(float, n))))


@st.composite
def bowls(draw: st.DrawFn) -> list[Bowl]:
    """Return one tree or two of the same lists, each with a bowl of its own."""
    count = draw(st.integers(1, 3))
    sizes = Sizes(tuple("abc"[:count]), tuple(draw(_LISTS) for _ in range(count)))
    numbers = st.tuples(*[st.floats(0.5, 65.0)] * count)
    bowls = []
    for place in range(draw(st.integers(1, 2))):
        weights = draw(st.tuples(*[st.floats(0.1, 10.0)] * count))
        base, least = draw(st.floats(1.0, 50.0)), draw(st.floats(0.5, 40.0))
        bowls.append(Bowl(place, sizes, draw(numbers), weights, base, least, draw(st.booleans())))
    return bowls


@settings(deadline=None, derandomize=True, max_examples=40)
@given(trees=bowls(), keep=st.integers(1, 5))
def test_it_finds_the_best_combinations_and_accounts_for_all(trees, keep):
    search = BranchAndBound(cast("list[Relaxation]", trees), keep)
    search.run()
    expected = sorted(objective for relaxation in trees for objective in relaxation.enumerated())
    objectives = sorted(run.start.objective for run in search.runs.values())
    assert objectives[:keep] == pytest.approx(expected[:keep], rel=1e-5)
    assert search.inside <= 1e-12
    assert len(objectives) + search.pruned <= sum(relaxation.sizes.count for relaxation in trees)
    assert len(objectives) + search.pruned >= len(expected)


THIRTEEN, POWERS = tuple(float(i) for i in range(1, 14)), tuple(4.0**power for power in range(8))


@pytest.mark.parametrize(
    ("lists", "centre", "weights", "most"),
    [
        ((THIRTEEN,) * 3, (6.4, 3.2, 9.7), (1.0, 2.0, 0.5), 12),
        # Divided where it costs most: 27 runs if the first number that is no size is divided.
        ((THIRTEEN,) * 4, (6.4, 3.2, 9.7, 2.49), (0.01, 2.0, 0.5, 5.0), 18),
        # Two lists whose sizes are as good as one another are divided last.
        ((POWERS, POWERS, THIRTEEN), (2.0, 5.0, 6.4), (1e-9, 1e-9, 1.0), 15),
    ],
)
def test_a_bowl_over_thousands_of_combinations_takes_a_few_runs(lists, centre, weights, most):
    bowl = Bowl(0, Sizes(tuple("abcd"[: len(lists)]), lists), centre, weights, 5.0, 0.0)
    search = BranchAndBound(cast("list[Relaxation]", [bowl]), 1)
    search.run()
    assert min(run.start.objective for run in search.runs.values()) == pytest.approx(min(bowl.enumerated()))
    assert bowl.solved <= most


def _bowl(first: tuple[float, ...], second: tuple[float, ...], centre: tuple[float, ...]) -> Bowl:
    return Bowl(0, Sizes(("a", "b"), (first, second)), centre, (1.0, 1.0), 5.0, 0.0)


def _node(bowl: Bowl, depth: int = 0, *, solved: bool = True) -> Node:
    run = bowl.best_within(bowl.sizes.whole, None)[0] if solved else None
    return Node(cast("Relaxation", bowl), bowl.sizes.whole, 5.0, run, depth, 0)


def test_unsolved_boxes_are_split_in_the_middle_and_lists_ascend():
    bowl = _bowl((1.0, 2.0, 8.0), (10.0, 20.0, 30.0, 40.0), (2.1, 13.0))
    search, node = BranchAndBound(cast("list[Relaxation]", [bowl]), 1), _node(bowl, solved=False)
    assert search._division(node).halves(node.box) == (((0, 2), (0, 1)), ((0, 2), (2, 3)))
    study = read_study_text(
        "mode: shear\nminimize: module_mass\nvary:\n  wire_diameter: {choose: [2.5 mm, 2 mm]}\n"
        "  pcl_grade: {choose: [pcl_80k, pcl_50k]}\n  current: [1 A, 2 A]\n",
        "a test",
    )
    assert discrete_sizes(study, study.table) == Sizes(("wire_diameter",), ((0.002, 0.0025),))
    sizes = Sizes(("a", "b", "c"), ((1.0, 2.0), (1.0, 2.0, 3.0), (1.0, 2.0)))
    boxes = list(sizes.each())
    assert len(set(boxes)) == sizes.count == 12
    for box, other in itertools.pairwise(boxes):
        assert sum(abs(a - b) for (a, _), (b, _) in zip(box, other, strict=True)) == 1


def test_sizes_around_a_value_are_the_next_below_and_above():
    sizes = Sizes(("a", "b"), ((1.0, 2.0, 3.0), (1.0, 2.0)))
    assert list(sizes.around({"a": 2.4, "b": 0.5})) == [((1, 1), (0, 0)), ((2, 2), (0, 0))]
    assert list(sizes.around({"a": 2.0, "b": 2.5})) == [((0, 0), (1, 1)), ((1, 1), (1, 1))]


SOLVER = ("solver.starts=2", "solver.cells=6", "solver.fineness=0.67", "solver.alternatives=32")
SHELVES = yaml.safe_load((ROOT / "tests/cases/shelves.yaml").read_text(encoding="utf-8"))
"""Studies of `benchmarks/` with shorter lists."""


def shelf(name: str) -> Study:
    text = (ROOT / f"benchmarks/{name}.yaml").read_text(encoding="utf-8")
    return read_tree(with_settings(tree_of_text(text, f"{name}.yaml", name, Path()), [*SHELVES[name], *SOLVER]))


SEVERAL = 3
"""Starts of each combination alone."""
STEPS = 1e-5
"""Share of an objective that other steps in time change at this fineness: 37 and 39 of them are 3e-6 apart."""


@pytest.mark.slow
@pytest.mark.parametrize("name", SHELVES)
def test_no_combination_in_them_has_one(name, monkeypatch):
    left: list[tuple[Relaxation, Box]] = []
    searched = Relaxation.best_within

    def watched(self: Relaxation, box: Box, near: Run | None) -> tuple[Run | None, bool]:
        run, certain = searched(self, box, near)
        if run is None and certain:
            left.append((self, box))
        return run, certain

    monkeypatch.setattr(Relaxation, "best_within", watched)
    study = shelf(name)
    solution = optimize(study)
    choosing = solution.choosing
    alone = with_each_record(study, solution.reference, SEVERAL)
    assert 0 < len(alone) < choosing.combinations
    assert any(not is_one(box) for _, box in left)
    assert not {tuple(tree.choices(places).values()) for tree, box in left for places in _each(box)} & alone.keys()
    objectives = {tuple(candidate.choices.values()): candidate.objective for candidate in choosing.best}
    assert all(objectives[places] <= objective * (1.0 + STEPS) for places, objective in alone.items())
    assert choosing.without_design + len(objectives) == choosing.combinations


def _each(box: Box) -> list[Box]:
    """Return every combination in a box."""
    places = [range(first, last + 1) for first, last in box]
    return [tuple((place, place) for place in combination) for combination in itertools.product(*places)]


STUDY = sample_text("chosen_in_a_tree")
OVER = "Maximum_Iterations_Exceeded"


@pytest.fixture(scope="module")
def tree() -> tuple[Relaxation, Run]:
    study = read_study_text(STUDY, "test")
    relaxation = Relaxation(0, Optimizer(study), {}, discrete_sizes(study, study.table), SolverEffort())
    return relaxation, relaxation.optimizer.solve()


@pytest.mark.parametrize(
    ("cold", "box", "certain", "searches"),
    [(NO_DESIGN, ((1, 1),), True, 2), (OVER, ((1, 1),), False, 2), (NO_DESIGN, ((0, 1),), False, 1)],
)
def test_a_warm_run_cut_short_leaves_several_combinations_open(tree, monkeypatch, cold, box, certain, searches):
    """Several are searched from one place alone: their halves are asked the same."""
    relaxation, near = tree
    statuses: list[str] = []

    def ending(status: str) -> Callable[..., Any]:
        def ended(*_: Any, **_begin: Any) -> Run:
            statuses.append(status)
            return replace(near, start=replace(near.start, status=status, converged=False))

        return ended

    monkeypatch.setattr(relaxation, "_screened", lambda *_: False)
    monkeypatch.setattr(relaxation, "_beside", ending(OVER))
    monkeypatch.setattr(relaxation, "_solved", ending(cold))
    assert relaxation.best_within(box, near) == (None, certain)
    assert statuses == [OVER] + [cold] * searches


def beginning_nowhere(relaxation: Relaxation, monkeypatch: pytest.MonkeyPatch, near: Run) -> list[str]:
    """Let the first run within a box begin at no module; the endings of all runs."""
    solved, endings = relaxation._solved, list[str]()

    def first_fails(*known: Any, **words: Any) -> Run:
        run = solved(*known, **words)
        if not endings:
            run = replace(near, start=replace(near.start, status=NO_MODULE, converged=False))
        endings.append(run.start.status)
        return run

    monkeypatch.setattr(relaxation, "_screened", lambda *_: False)
    monkeypatch.setattr(relaxation, "_solved", first_fails)
    return endings


def test_if_no_run_can_start_differential_evolution_finds_a_module(tree, monkeypatch):
    """Legs that do not reach their pins, say: the run nearby with another size in it is no module."""
    relaxation, near = tree
    endings = beginning_nowhere(relaxation, monkeypatch, near)
    run, certain = relaxation.best_within(((1, 1),), None)
    assert certain
    assert run.start.converged
    assert run.start.end["coil_count"] == pytest.approx(4.0)
    assert len(endings) == 2


def test_no_module_by_differential_evolution_is_certainly_no_design(tree, monkeypatch):
    relaxation, near = tree
    endings = beginning_nowhere(relaxation, monkeypatch, near)
    monkeypatch.setattr(relaxation._screen, "worst", lambda unknowns: np.full(unknowns.shape[1], NOWHERE))
    assert relaxation.best_within(((1, 1),), None) == (None, True)
    assert endings == [NO_MODULE]
