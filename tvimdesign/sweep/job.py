"""What a worker needs to answer cells: plain data that goes to another process or machine."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from tvimdesign.study.tree import StudyTree
from tvimdesign.sweep.plan import SweepPlan
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


@dataclass(frozen=True)
class Job:
    """The same for every cell of a sweep."""

    tree: StudyTree
    names: tuple[str, ...]
    """What is set in each cell, as `--set` takes it."""
    numbers: tuple[bool, ...]
    """Which of them a search can follow from another cell's optimum."""
    columns: tuple[str, ...]
    evaluate: bool

    @classmethod
    def of(cls, plan: SweepPlan) -> Job:
        """The job of a plan."""
        axes = plan.axes
        return cls(
            plan.tree, tuple(axis.name for axis in axes), tuple(axis.number for axis in axes), plan.columns,
            plan.task == "evaluate",
        )  # fmt: skip
