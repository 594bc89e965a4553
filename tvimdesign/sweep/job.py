"""The work of a sweep: the study of each cell is read, and evaluated or optimised."""

from __future__ import annotations

from dataclasses import dataclass

from tvimdesign.sweep.plan import SweepPlan
from tvimdesign.sweep.work import Answers, SweptStudy, with_absolute_paths


@dataclass(frozen=True)
class Job(SweptStudy):
    """The same for every cell of a sweep."""

    @classmethod
    def of(cls, plan: SweepPlan) -> Job:
        """The job of a plan."""
        axes = plan.axes
        return cls(
            with_absolute_paths(plan.tree), tuple(axis.name for axis in axes), tuple(axis.number for axis in axes),
            plan.columns, plan.task == "evaluate",
        )  # fmt: skip

    def answers(self) -> Answers:
        """Where cells are answered, CasADi is loaded; where they are handed out and gathered, it is not."""
        from tvimdesign.sweep.answers import CellAnswers

        return CellAnswers(self)
