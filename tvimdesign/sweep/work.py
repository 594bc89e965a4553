"""Plain data that a worker needs to answer the cells of a sweep, and what it answers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

from tvimdesign.study.tree import StudyTree
from tvimdesign.sweep.plan import SweepPlan
from tvimdesign.sweep.points import Texts


class Cell(NamedTuple):
    """One cell: its key, and what each axis is set to."""

    key: str
    texts: Texts


class CellAnswer(NamedTuple):
    """The answer of a cell."""

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
class SweptStudy:
    """A study, and what is set in each of its cells; it can be pickled."""

    tree: StudyTree
    names: tuple[str, ...]
    """What is set in each cell, as `--set` takes it."""
    numbers: tuple[bool, ...]
    """Which of them a search can follow from another cell's optimum."""
    columns: tuple[str, ...]
    evaluate: bool

    @classmethod
    def of(cls, plan: SweepPlan) -> SweptStudy:
        """Return the work of a plan; its folder is a whole path, since a worker may start in another one."""
        axes = plan.axes
        return cls(
            replace(plan.tree, folder=plan.tree.folder.resolve()), tuple(axis.name for axis in axes),
            tuple(axis.number for axis in axes), plan.columns, plan.task == "evaluate",
        )  # fmt: skip
