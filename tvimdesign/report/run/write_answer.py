"""Writes a study into its folder: answered, with tables, curves and the design, or refused, with the reason."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tvimdesign.base.errors import InfeasibleError
from tvimdesign.device import Choice
from tvimdesign.report.output.number_format import FORMAT, UNITS
from tvimdesign.report.output.progress import Progress
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.output.results_format import RefusedRun
from tvimdesign.report.output.tables import curves_csv, results_csv
from tvimdesign.report.run.answered_study import AnsweredStudy
from tvimdesign.report.run.why import why_csv
from tvimdesign.simulation.working_cycle.curves import PHASE_UNITS
from tvimdesign.study import Study
from tvimdesign.study.design import write_design
from tvimdesign.study.tree import StudyTree, study_file


def write_answer(folder: ResultsFolder, answered: AnsweredStudy) -> Path:
    """Write everything but pictures and parts; returns the design's file."""
    result, table = answered.result, answered.study.table
    folder.write("study.yaml", study_file(answered.tree))
    folder.write("study.resolved.json", answered.study.model_dump_json(indent=2) + "\n")
    write_results(folder, answered)
    if result.solution and result.found:
        folder.write("why.csv", why_csv(result, table))
    if answered.sensitivities:
        folder.write("sensitivities.csv", answered.sensitivities)
    for phase, history in result.histories.items():
        folder.write(f"{phase}.csv", curves_csv(history, PHASE_UNITS, "degC"))
    units = {name: table.unit(name.removesuffix("_low").removesuffix("_high")) for name in result.sweep}
    folder.write("impedance.csv", curves_csv(result.sweep, units, "1"))
    answered.front.write(folder, result)
    return write_design(result.design, folder.path / "design.json")


def write_results(folder: ResultsFolder, answered: AnsweredStudy) -> None:
    """Write results.json and results.csv; again once the uncertainty is known."""
    reported = answered.reported
    folder.write_json("results.json", reported)
    intervals = reported["uncertainty"]["intervals"] if "uncertainty" in reported else None
    folder.write("results.csv", results_csv(reported["values"], intervals))


def finish(folder: ResultsFolder, answered: AnsweredStudy) -> None:
    """Write the folder's manifest."""
    result = answered.result
    folder.finish(result.design.status, inputs_of(answered), result.design.study, result.seconds)


def inputs_of(answered: AnsweredStudy) -> dict[str, Path]:
    """Return the files of the study, if it has one, and of the records the design uses."""
    path, choices = answered.tree.path, answered.result.design.choices
    records = {
        f"{row.category}/{choices[row.name]}": answered.study.catalog.path(row.category, choices[row.name])
        for row in answered.study.table.quantities
        if isinstance(row, Choice) and row.category and choices[row.name] not in row.options
    }
    return {"study": path, **records} if path else records


def refused_run(study: Study, error: InfeasibleError) -> RefusedRun:
    """Return the content of results.json for a study that was refused."""
    return {
        "format": FORMAT, "units": UNITS, "name": study.name, "mode": study.mode,
        "status": "infeasible", "feasible": False, "reason": str(error),
    }  # fmt: skip


@contextmanager
def write_failure(
    folder: ResultsFolder, tree: StudyTree, study: Study, progress: Progress, *, as_json: bool
) -> Iterator[None]:
    """Write a study and why it has no design, if it has none, before the error goes on."""
    try:
        yield
    except InfeasibleError as error:
        from tvimdesign.report.output.page_sections import write_page
        from tvimdesign.report.run.run_page import refused_page

        progress("")  # raises KeyboardInterrupt where a solver swallowed one, and its failure looks like a conflict
        refused = refused_run(study, error)
        folder.write("study.yaml", study_file(tree))
        folder.write("study.resolved.json", study.model_dump_json(indent=2) + "\n")
        folder.write_json("results.json", refused)
        folder.write("summary.txt", f"{study.name}: no design.\n{error}\n")
        write_page(folder, refused_page(folder, tree, study, str(error)))
        folder.finish("infeasible", {"study": tree.path} if tree.path else {}, study.model_dump(mode="json"))
        if as_json:
            print(json.dumps({**refused, "folder": str(folder.out)}, indent=2))
        raise
