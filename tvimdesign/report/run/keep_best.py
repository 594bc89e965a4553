"""What is kept of a run that was interrupted in its search: a study that goes on from the best design so far."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from tvimdesign.base.errors import OutputError
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.solve.best_so_far import SearchInterrupted
from tvimdesign.study.result_study import study_text

BEST = "best_so_far.yaml"
_TITLE = "The search was interrupted: this study begins at the best design so far, which was not checked any further"


@contextmanager
def keeping_best(folder: ResultsFolder) -> Iterator[None]:
    """Write that study where a search is interrupted, and say where it is with the interrupt."""
    try:
        yield
    except SearchInterrupted as interrupted:
        if interrupted.best is None:
            raise
        try:
            path = folder.write_at_the_end(BEST, study_text(interrupted.best, _TITLE, folder.path))
        except OutputError:  # no room: the interrupt is what is told
            raise interrupted from None
        raise KeyboardInterrupt(f"the best design so far is where {path} begins") from interrupted
