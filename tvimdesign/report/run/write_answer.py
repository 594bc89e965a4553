"""Writes an answered study into its folder: the study, tables, curves and the design, but no plots and no parts."""

from __future__ import annotations

from pathlib import Path

from tvimdesign.device import Choice
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.output.tables import curves_csv, results_csv
from tvimdesign.report.run.answered_study import AnsweredStudy
from tvimdesign.report.run.why import why_csv
from tvimdesign.simulation.working_cycle.curves import PHASE_UNITS
from tvimdesign.study.design import write_design
from tvimdesign.study.tree import study_file


def write_answer(folder: ResultsFolder, answered: AnsweredStudy) -> Path:
    """Write everything but pictures and parts; returns the design's file."""
    found, table = answered.result, answered.study.table
    folder.write("study.yaml", study_file(answered.tree))
    folder.write("study.resolved.json", answered.study.model_dump_json(indent=2) + "\n")
    write_results(folder, answered)
    if found.solution and found.found:
        folder.write("why.csv", why_csv(found, table))
    if answered.sensitivities:
        folder.write("sensitivities.csv", answered.sensitivities)
    for phase, history in found.histories.items():
        folder.write(f"{phase}.csv", curves_csv(history, PHASE_UNITS, "degC"))
    units = {name: table.unit(name.removesuffix("_low").removesuffix("_high")) for name in found.sweep}
    folder.write("impedance.csv", curves_csv(found.sweep, units, "1"))
    answered.front.write(folder, found)
    return write_design(found.design, folder.path / "design.json")


def write_results(folder: ResultsFolder, answered: AnsweredStudy) -> None:
    """Write results.json and results.csv; again once the uncertainty is known."""
    reported = answered.reported
    folder.write_json("results.json", reported)
    intervals = reported["uncertainty"]["intervals"] if "uncertainty" in reported else None
    folder.write("results.csv", results_csv(reported["values"], intervals))


def finish(folder: ResultsFolder, answered: AnsweredStudy) -> None:
    """Write the folder's manifest."""
    found = answered.result
    folder.finish(found.design.status, inputs_of(answered), found.design.study, found.seconds)


def inputs_of(answered: AnsweredStudy) -> dict[str, Path]:
    """Files an answer was made from: the study's, where it has one, and those of the records the design uses."""
    path, choices = answered.tree.path, answered.result.design.choices
    records = {
        f"{row.category}/{choices[row.name]}": answered.study.catalog.path(row.category, choices[row.name])
        for row in answered.study.table.quantities
        if isinstance(row, Choice) and row.category and choices[row.name] not in row.options
    }
    return {"study": path, **records} if path else records
