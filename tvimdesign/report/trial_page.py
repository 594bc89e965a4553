"""The page of a virtual test: what was read off, and its curves."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tvimdesign.page.blocks import Block, Drawn, Page, Points, Section
from tvimdesign.report.output.page_sections import grid_of, made_by_words, study_section, there, versions_section
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.output.summary_table import SummaryTable
from tvimdesign.simulation.trial import Trial


def trial_page(
    folder: ResultsFolder, name: str, trial: Trial, findings: SummaryTable, figure: Mapping[str, Any], study: str
) -> Page:
    """The page of one test of the module of that name; `figure` is what its figure is drawn from."""
    drawn = Drawn("curves", "lines.js", trial.title, figure, libraries=["echarts"])
    files = {f"{sheet.name}.csv": f"{sheet.name.replace('_', ' ')} as CSV" for sheet in trial.sheets}
    sections = [Section("curves", "Curves", [drawn]), study_section(study), versions_section(folder)]
    first: list[Block] = [grid_of(findings), Points(trial.notes)]
    return Page(
        f"{name}: {trial.title}", f"virtual test {trial.test}", "TESTED", "", first, None, sections,
        made_by_words(folder), there(folder, files),
    )  # fmt: skip
