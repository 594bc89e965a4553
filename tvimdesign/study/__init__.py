"""The study: reads the user's file, reports every mistake in it, and resolves it to numbers."""

from tvimdesign.study.reader import read_study, read_study_text, read_tree
from tvimdesign.study.resolve import brought_along, brought_along_by, drawn, given
from tvimdesign.study.sections.tolerances import standard_tolerances
from tvimdesign.study.study import Options, ProfileOptions, Range, Requirement, SolverOptions, Study, Tolerance
from tvimdesign.study.text.mistakes import StudyError

__all__ = [
    "Options", "ProfileOptions", "Range", "Requirement", "SolverOptions", "Study", "StudyError", "Tolerance",
    "brought_along", "brought_along_by", "drawn", "given", "read_study", "read_study_text", "read_tree",
    "standard_tolerances",
]  # fmt: skip
