"""What the user writes: reads a study file, says everything that is wrong with it, and resolves it to numbers."""

from tvimdesign.study.model import Options, ProfileOptions, Range, Requirement, SolverOptions, Study, Vary, WriteOptions
from tvimdesign.study.problems import Problem, StudyError
from tvimdesign.study.reader import read_study, read_study_text
from tvimdesign.study.resolve import drawn, given
from tvimdesign.study.template import template_text

__all__ = [
    "Options",
    "Problem",
    "ProfileOptions",
    "Range",
    "Requirement",
    "SolverOptions",
    "Study",
    "StudyError",
    "Vary",
    "WriteOptions",
    "drawn",
    "given",
    "read_study",
    "read_study_text",
    "template_text",
]
