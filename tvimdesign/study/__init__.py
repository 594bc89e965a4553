"""The study: reads the user's file, reports every mistake in it, and resolves it to numbers."""

from tvimdesign.catalog import Catalog
from tvimdesign.study.reader import read_study, read_study_text, read_tree
from tvimdesign.study.resolve import brought_along, brought_along_by, drawn, given
from tvimdesign.study.sections.tolerances import standard_tolerances
from tvimdesign.study.study import (
    Options,
    ProfileOptions,
    Range,
    Requirement,
    Robust,
    SolverOptions,
    Study,
    Tolerance,
    Vary,
    WriteOptions,
)
from tvimdesign.study.text.mistakes import Mistake, StudyError
from tvimdesign.study.written_studies import template_text

__all__ = [
    "Catalog",
    "Mistake",
    "Options",
    "ProfileOptions",
    "Range",
    "Requirement",
    "Robust",
    "SolverOptions",
    "Study",
    "StudyError",
    "Tolerance",
    "Vary",
    "WriteOptions",
    "brought_along",
    "brought_along_by",
    "drawn",
    "given",
    "read_study",
    "read_study_text",
    "read_tree",
    "standard_tolerances",
    "template_text",
]
