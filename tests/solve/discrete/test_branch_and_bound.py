"""Branch and bound against enumeration, on problems whose optimum within a box is known in closed form."""

import itertools
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tvimdesign.base.deadline import Deadline
from tvimdesign.solve.discrete.branch_and_bound import BranchAndBound, Node
from tvimdesign.solve.discrete.discrete_choices import Box, Sizes, discrete_sizes, is_one
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.study import read_study_text


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
    found = []
    for place in range(draw(st.integers(1, 2))):
        weights = draw(st.tuples(*[st.floats(0.1, 10.0)] * count))
        base, least = draw(st.floats(1.0, 50.0)), draw(st.floats(0.5, 40.0))
        found.append(Bowl(place, sizes, draw(numbers), weights, base, least, draw(st.booleans())))
    return found


@settings(deadline=None, derandomize=True, max_examples=40)
@given(trees=bowls(), keep=st.integers(1, 5))
def test_it_finds_the_best_combinations_and_accounts_for_all(trees: list[Bowl], keep: int) -> None:
    search = BranchAndBound(cast("list[Relaxation]", trees), keep)
    search.run()
    expected = sorted(objective for relaxation in trees for objective in relaxation.enumerated())
    found = sorted(run.start.objective for run in search.found.values())
    assert found[:keep] == pytest.approx(expected[:keep], rel=1e-5)
    assert search.inside <= 1e-12
    assert len(found) + search.pruned <= sum(relaxation.sizes.count for relaxation in trees)
    assert len(found) + search.pruned >= len(expected)


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
def test_a_bowl_over_thousands_of_combinations_takes_a_few_runs(
    lists: tuple[tuple[float, ...], ...], centre: tuple[float, ...], weights: tuple[float, ...], most: int
) -> None:
    bowl = Bowl(0, Sizes(tuple("abcd"[: len(lists)]), lists), centre, weights, 5.0, 0.0)
    search = BranchAndBound(cast("list[Relaxation]", [bowl]), 1)
    search.run()
    assert min(run.start.objective for run in search.found.values()) == pytest.approx(min(bowl.enumerated()))
    assert bowl.solved <= most


def _bowl(first: tuple[float, ...], second: tuple[float, ...], centre: tuple[float, ...]) -> Bowl:
    return Bowl(0, Sizes(("a", "b"), (first, second)), centre, (1.0, 1.0), 5.0, 0.0)


def _node(bowl: Bowl, depth: int = 0, *, solved: bool = True) -> Node:
    run = bowl.best_within(bowl.sizes.whole, None)[0] if solved else None
    return Node(cast("Relaxation", bowl), bowl.sizes.whole, 5.0, run, depth, 0)


def test_unsolved_boxes_are_split_in_the_middle_and_lists_ascend() -> None:
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
    for one, other in itertools.pairwise(boxes):
        assert sum(abs(a - b) for (a, _), (b, _) in zip(one, other, strict=True)) == 1
