"""Answers of the shipped studies, each found once in a process, for all tests that only look at them."""

from functools import cache

from support import study_path

from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import read_study


@cache
def shipped_answer(name: str) -> StudyResult:
    """Return what a study in `studies/` comes to."""
    return answer(read_study(study_path(name)))
