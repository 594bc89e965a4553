"""The report's sections of a design, made as a run's page has them, to be put into a page that is open."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

from tvimdesign.device import table_for
from tvimdesign.explore.answers.shown import finite_data
from tvimdesign.page.page_fragment import page_fragment
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.run.answered_study import AnsweredStudy
from tvimdesign.report.run.first_screen.screen import Told
from tvimdesign.report.run.run_page.run_page import run_page
from tvimdesign.study.design import Design

PARTS = "parts"
"""Folder of the designs whose CAD was made, each by its own name."""


class DesignFolder(ResultsFolder):
    """The folder of one design that an explorer made parts of, if it did; nothing is claimed in it."""

    def __init__(self, path: Path) -> None:
        """Know the path."""
        self.path = path


def design_name(design: Design) -> str:
    """The name of a design's folder: the same for the same choices and numbers, however they were found."""
    numbers = {
        name: f"{design.values[name]:.9g}"
        for name in sorted(design.values)
        if name.partition("@")[0] in _inputs(design)
    }
    told = json.dumps([design.mode, design.choices, numbers], sort_keys=True)
    return hashlib.sha256(told.encode()).hexdigest()[:16]


def _inputs(design: Design) -> set[str]:
    return {row.name for row in table_for(design.mode).inputs}


def report_fragment(folder: Path, answered: AnsweredStudy) -> dict[str, Any]:
    """First screen and sections as HTML, with what their figures are drawn from."""
    own = folder / PARTS / design_name(answered.result.design)
    told = Told(warnings=answered.warnings, front=answered.front.front)
    page = run_page(DesignFolder(own), answered, told)
    left_out = {"study", "versions", *(() if (own / "cad").is_dir() else ("assembly",))}
    return {"folder": f"{PARTS}/{own.name}", **finite_data(page_fragment(page, left_out))}
