"""What the user writes: reads a study file, says everything that is wrong with it, and resolves it to numbers."""

from tvimdesign.study.model import (
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
from tvimdesign.study.problems import Problem, StudyError
from tvimdesign.study.reader import read_study, read_study_text
from tvimdesign.study.resolve import drawn, given
from tvimdesign.study.template import template_text
from tvimdesign.study.tolerances import standard_tolerances

__all__ = [
    "Options",
    "Problem",
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
    "drawn",
    "given",
    "read_study",
    "read_study_text",
    "standard_tolerances",
    "template_text",
]
