"""The studies of a comparison answered as cells: by the jobs of an array, on a cluster, or where one was stopped."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tvimdesign.base.errors import TvimError
from tvimdesign.report.compare.children import crashed
from tvimdesign.report.compare.comparison_job import ComparisonJob
from tvimdesign.report.output.shared_folder import CellsAsked
from tvimdesign.study import read_tree
from tvimdesign.study.tree import StudyTree
from tvimdesign.sweep.keys import key_of, said_of
from tvimdesign.sweep.work import Cell, CellAnswer, found_anywhere

ANSWERED = "answered"


@dataclass(frozen=True)
class ComparisonWork:
    """The studies, and the points of each front; a cell is set to a study's number."""

    trees: tuple[StudyTree, ...]
    points: int
    columns: tuple[str, ...] = ("found",)
    """What a study's job found, as JSON."""
    numbers: tuple[bool, ...] = (False,)

    def answers(self) -> ComparisonWork:
        """Nothing is prepared: each study is answered for itself."""
        return self

    def answer(self, cell: Cell) -> CellAnswer:
        """Answer one study; what fails of it stands in what was found."""
        own = int(cell.texts[0])
        others = [tree for number, tree in enumerate(self.trees) if number != own]
        found = ComparisonJob(self.trees[own], self.points, lambda: others, lambda _: None).run()
        return CellAnswer(ANSWERED, "", None, None, (json.dumps(found),))


def studies_asked(trees: Sequence[StudyTree], points: int) -> CellsAsked:
    """A cell for each study. What all are minimised by hangs on all of them, so each key does too."""
    work = ComparisonWork(tuple(found_anywhere(tree) for tree in trees), points)
    said = [said_of(read_tree(tree)) for tree in trees]
    keys = [key_of({"number": number, "of": said, "points": points}) for number in range(len(said))]
    return CellsAsked(work, keys, lambda number: (str(number),), "study")


def found_of(asked: CellsAsked, labels: Sequence[str], folder: Path) -> dict[str, dict[str, Any]]:
    """What each study's job found, by label. Raises TvimError where another program wrote the shards."""
    found: dict[str, dict[str, Any]] = {}
    for label, kept in zip(labels, asked.there(folder), strict=True):
        answer = kept.answer
        try:
            found[label] = json.loads(str(answer.values[0])) if answer.status == ANSWERED else crashed(answer.reason)
        except ValueError as error:
            raise TvimError(f"{folder}: {label}: what its shard holds is no answer: {error}") from error
        found[label]["seconds"].setdefault("whole process", kept.seconds)
    return found
