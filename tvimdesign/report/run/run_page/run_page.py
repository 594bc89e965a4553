"""A run's whole page: its sections in order, those that the run has."""

from __future__ import annotations

from pathlib import Path

from tvimdesign.page.blocks import Page, Points, Section
from tvimdesign.report.output.page_sections import (
    made_by_words,
    study_section,
    there,
    tone_of,
    versions_section,
    write_page,
)
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.run.answered_study import AnsweredStudy
from tvimdesign.report.run.first_screen.screen import Told
from tvimdesign.report.run.first_screen.verdict import status
from tvimdesign.report.run.run_page.cycle_section import cycle_section
from tvimdesign.report.run.run_page.front_section import front_section
from tvimdesign.report.run.run_page.glance import glance, requirements_section
from tvimdesign.report.run.run_page.parts_sections import (
    FOLDER,
    carried_files,
    checks_section,
    materials_section,
    preview,
    solids_section,
    spring_section,
    steps_section,
)
from tvimdesign.report.run.run_page.reasons import assumptions_section, reasons_section
from tvimdesign.report.run.run_page.verification_section import verification_sections
from tvimdesign.study import Study
from tvimdesign.study.tree import StudyTree, study_file

_FILES = {
    "summary.txt": "all tables as text", "results.csv": "every value", "why.csv": "shadow prices",
    "front.csv": "the front", "cad/assembly.step": "the assembly as STEP", "cad/bom.csv": "bill of materials",
    "cad/springs/spring.pdf": "spring sheet", "cad/checks.json": "checks on the solids",
    "design.json": "the design as data",
}  # fmt: skip


def write_run_page(folder: ResultsFolder, answered: AnsweredStudy, told: Told) -> None:
    """Write the page of an answered study beside the files that the folder has by then."""
    write_page(folder, run_page(folder, answered, told))


def run_page(folder: ResultsFolder, answered: AnsweredStudy, told: Told) -> Page:
    """The page of an answered study."""
    answer = answered.result
    said, cad = status(answer), folder.path / FOLDER
    sections = [requirements_section(answered, told)]
    if answer.found:
        sections += _of_a_design(cad, answered, told)
    return Page(
        answer.design.name, f"{answer.design.mode} module", said, tone_of(said), glance(answered, told), preview(cad),
        [*sections, *_last(folder, answered.tree)], made_by_words(folder), there(folder, _FILES), carried_files(cad),
    )  # fmt: skip


def _of_a_design(cad: Path, answered: AnsweredStudy, told: Told) -> list[Section]:
    """What there is to show of a design, and of its parts where they were made."""
    answer, path = answered.result, answered.tree.path
    return [
        solids_section(cad, path.name if path else "STUDY"),
        cycle_section(answer, answered.study.table),
        reasons_section(answered),
        assumptions_section(answered, told.uncertainty),
        *front_section(answered),
        *checks_section(cad),
        *materials_section(cad),
        *steps_section(cad),
        *spring_section(cad),
        *verification_sections(cad.parent),
    ]


def refused_page(folder: ResultsFolder, tree: StudyTree, study: Study, reason: str) -> Page:
    """The page of a study that was refused before there was any design."""
    said = "NO DESIGN FOUND"
    return Page(
        study.name, f"{study.mode} module", said, tone_of(said), [Points(reason.splitlines())], None,
        _last(folder, tree), made_by_words(folder), there(folder, _FILES),
    )  # fmt: skip


def _last(folder: ResultsFolder, tree: StudyTree) -> list[Section]:
    """The study and what made the page."""
    text = study_file(tree)
    return [study_section(text if isinstance(text, str) else text.decode()), versions_section(folder)]
