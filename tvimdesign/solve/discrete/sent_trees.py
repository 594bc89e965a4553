"""The problems of a search as plain data, from which another process builds the same ones and goes on with them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from tvimdesign.base.deadline import Deadline
from tvimdesign.solve.discrete.discrete_choices import Sizes, discrete_sizes
from tvimdesign.solve.discrete.record_families import families_of
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.discrete.trees import Trees
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.study import Study


class ProblemSpec(NamedTuple):
    """Data that the problems are built from."""

    study: str
    """As JSON."""
    reference: dict[str, float] | None
    objectives: Sequence[str]
    seconds: float
    """Until the time is over."""

    def built(self) -> list[Relaxation]:
        """Return the problems, with nothing solved."""
        study = Study.model_validate_json(self.study)
        sizes, families = discrete_sizes(study, study.table), families_of(study)
        deadline = Deadline(self.seconds)
        return Trees(study, self.reference, lambda _: None, self.objectives, deadline, sizes).of(families)


class SearchState(NamedTuple):
    """Results of the starts of one tree."""

    sizes: Sizes
    optima: list[Run]
    ends: list[Run]
    found_in_boxes: bool

    @classmethod
    def of(cls, trees: Sequence[Relaxation]) -> list[SearchState]:
        """That of each tree."""
        return [cls(tree.sizes, tree.optima, tree.ends, tree.found_in_boxes) for tree in trees]

    def take(self, tree: Relaxation) -> None:
        """Let a tree that was built go on from there."""
        tree.sizes, tree.optima, tree.ends, tree.found_in_boxes = self
