"""Studies that differ in a few values, answered one after another, each from the optimum of the one before."""

from __future__ import annotations

from tvimdesign.report.compare.normalization import at_its_start, common
from tvimdesign.report.output.progress import Progress
from tvimdesign.report.run.answered_study import AnsweredStudy, answer_study
from tvimdesign.solve.warm_search import WarmSearch
from tvimdesign.study import Study
from tvimdesign.study.tree import StudyTree


class AnswerSeries:
    """Answers studies in turn; what is minimised is divided by its value at the start of one of them."""

    def __init__(self, normal: Study) -> None:
        """Simulate the start of the study that the others are measured by."""
        self._search = WarmSearch(common([at_its_start(normal)]) if normal.vary else None)

    @property
    def warm_solves(self) -> int:
        """How many studies were optimised from their neighbour's optimum alone."""
        return self._search.warm_solves

    def answer(self, tree: StudyTree, progress: Progress) -> AnsweredStudy:
        """Read and answer the next study. Raises InputError, and InfeasibleError for what no search can mend."""
        return answer_study(tree, progress, search=self._search)
