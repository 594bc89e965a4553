"""Tasks of a search over listed choices: the best design within a box, each task answered alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, Protocol

from tvimdesign.solve.discrete.discrete_choices import Box
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.nlp.solver_run import Run


@dataclass(frozen=True, eq=False)
class Task:
    """One box of one tree: searched from a run `near` it, for one combination `exactly`, or `thoroughly` afresh."""

    place: int
    """Of the tree."""
    box: Box
    near: Run | None
    way: Literal["within", "exactly", "thoroughly"]

    @property
    def key(self) -> tuple[int, Box, str, int]:
        """By which the same task is known, as long as its run nearby is kept."""
        return self.place, self.box, self.way, id(self.near)


class Answer(NamedTuple):
    """The best design, and where there is none, whether that is certain."""

    run: Run | None
    certain: bool


class BoxSolver(Protocol):
    """Answers tasks; none depends on another, nor on who answers it."""

    def solve(self, tasks: Sequence[Task], ahead: Sequence[Task] = (), /) -> list[Answer]:
        """Return the answers in the order of the tasks; tasks `ahead` are likely to be asked next."""


@dataclass(frozen=True)
class OneProcess:
    """Answers each task here, one after the other, and none ahead."""

    trees: Sequence[Relaxation]

    def solve(self, tasks: Sequence[Task], _ahead: Sequence[Task] = (), /) -> list[Answer]:
        """Return the answers in the order of the tasks."""
        return [answer(self.trees, task) for task in tasks]


def answer(trees: Sequence[Relaxation], task: Task) -> Answer:
    """Return the best design for a task."""
    tree = trees[task.place]
    if task.way == "thoroughly":
        return Answer(tree.thoroughly(task.box, task.near), certain=True)
    search = tree.exactly if task.way == "exactly" else tree.best_within
    return Answer(*search(task.box, task.near))
