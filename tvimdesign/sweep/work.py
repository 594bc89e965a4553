"""What a worker needs to answer cells: plain data that goes to another process or machine.

A sweep is one kind of work. `compare`, `tolerate` and the parts of chosen cells are others: each says what is kept of
its cells and who answers them, and goes the same way to processes, batch jobs and clusters.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple, Protocol

from tvimdesign.study.tree import StudyTree
from tvimdesign.sweep.points import Texts


class Cell(NamedTuple):
    """One cell: its key, and what each axis is set to."""

    key: str
    texts: Texts


class CellAnswer(NamedTuple):
    """What a cell came to."""

    status: str
    """`evaluated`, `optimal`, `above_rating`, ... or `infeasible`, `refused`, `crashed`."""
    reason: str
    """Why there is no design, or what it breaks; empty where there is nothing to say."""
    broken: int | None
    """Count of limits that are not kept; None where there is no design."""
    margin: float | None
    """The least margin over all limits, as a share."""
    values: tuple[float | str | None, ...]
    """SI, in the order of the columns; words of what is chosen; None where there is none."""
    warm: bool = False
    """Whether the search began at another cell's optimum and found this one's."""


class Answers(Protocol):
    """Answers cells one after another, in a process of its own or not."""

    def answer(self, cell: Cell) -> CellAnswer:
        """What a cell comes to, whatever was answered before."""


class Work(Protocol):
    """The same for every cell: plain data that can be pickled."""

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the values that are kept of a cell."""

    @property
    def numbers(self) -> tuple[bool, ...]:
        """For each text of a cell: whether what was prepared for another one serves whatever it says."""

    def answers(self) -> Answers:
        """Who answers the cells; called where they are answered."""


@dataclass(frozen=True)
class SweptStudy:
    """A study, and what is set in each of its cells."""

    tree: StudyTree
    names: tuple[str, ...]
    """What is set in each cell, as `--set` takes it."""
    numbers: tuple[bool, ...]
    """Which of them a search can follow from another cell's optimum."""
    columns: tuple[str, ...]
    evaluate: bool


def with_absolute_paths(tree: StudyTree) -> StudyTree:
    """The tree with its folder's whole path: a worker may have begun in another one."""
    return replace(tree, folder=tree.folder.resolve())
