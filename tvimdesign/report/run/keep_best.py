"""Backup of a run that is interrupted before it is written: a study that goes on from the best design so far."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from tvimdesign.base.errors import OutputError
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.solve.best_so_far import SearchInterrupted
from tvimdesign.solve.result import StudyResult
from tvimdesign.study import Study
from tvimdesign.study.written_studies import started_at, study_text

DESIGN = "design.json"
BEST = "best_so_far.yaml"
_TITLE = "The run was interrupted: this study begins at the best design so far, which was not checked any further"


class Best:
    """The answer of a run, once there is one."""

    study: Study | None = None
    """The study started at it."""

    def note(self, result: StudyResult) -> None:
        """Note an answer where it is a design that was searched."""
        if result.found and result.solution:
            design = result.design
            self.study = started_at(Study.model_validate(design.study), design.values, design.choices)


@contextmanager
def keeping_best(folder: ResultsFolder) -> Iterator[Best]:
    """Write that study, and say where, where a run is interrupted before its design is written."""
    best = Best()
    try:
        yield best
    except KeyboardInterrupt as interrupt:
        study = interrupt.best if isinstance(interrupt, SearchInterrupted) else best.study
        if study is not None and not (folder.path / DESIGN).exists():
            with suppress(OutputError, OSError):  # no room, or nobody to tell: the interrupt is what counts
                path = folder.where_if_stopped(BEST)
                folder.write_at_the_end(BEST, study_text(study, _TITLE, path.parent))
                sys.stderr.write(f"the best design so far is where {path} begins\n")
        raise
