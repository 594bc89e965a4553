"""One tolerance analysis, from a study or a design to a finished folder and what the terminal says."""

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tvimdesign.base.errors import InfeasibleError, InputError
from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.device import Table
from tvimdesign.page.blocks import Points
from tvimdesign.report.output.command import Command, design_file
from tvimdesign.report.output.numbers import csv_text
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.output.tables import soft_of_module
from tvimdesign.report.output.terminal import Progress
from tvimdesign.report.run.reasons import complaint
from tvimdesign.report.tolerate.tolerance_data import contributor_rows, figure_data, limit_rows, output_rows, reported
from tvimdesign.report.tolerate.tolerance_report import FILES, sections_of, sentences, verdict
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_design, resolve_study
from tvimdesign.solve.nlp.spread import power_of_two
from tvimdesign.solve.result import answer
from tvimdesign.solve.uncertainty.tolerance import Spread, Tolerancing
from tvimdesign.study import Study, read_study, standard_tolerances
from tvimdesign.study.design import Design, read_design, write_design

FEWEST, MOST = 1 << 8, 1 << 22
"""Modules that may be drawn."""


@dataclass(frozen=True)
class TolerancedModule:
    """Module to analyse, the design it was optimised to, and a note on where it came from."""

    resolved: ResolvedModule
    design: Design | None
    notes: tuple[str, ...]


def tolerate_study(path: Path, out: Path, samples: int, *, overwrite: bool, as_json: bool) -> None:
    """Analyse a study's or a design's tolerances and write a folder. Raises InputError, InfeasibleError,
    and TvimError once all but the figure is done.
    """
    if not FEWEST <= samples <= MOST:
        raise InputError(f"--samples {samples}: must be {FEWEST} to {MOST}")
    count, threads = power_of_two(samples), os.cpu_count() or 1
    source = design_file(path)
    study = _study(source)
    with Command(out, overwrite=overwrite, as_json=as_json, plots=study.write.plots) as command:
        folder, progress = command.folder, command.progress
        subject = _subject(source, study, progress)
        analysis, seed = Tolerancing(subject.resolved, progress, threads), subject.resolved.study.solver.seed
        spread, preload = analysis.analyse(count, seed), analysis.preload(count, seed)
        table, study = subject.resolved.table, subject.resolved.study
        data = reported(spread, preload, table, study, count)
        data["notes"] = [*subject.notes, f"Soft is {soft_of_module(subject.resolved)}."]
        data["sentences"] = sentences(spread, preload, table)
        _write(folder, source, subject, data, spread, table)
        command.begin_plots([Drawing("spread", "analysis_figures.spread", figure_data(spread, table))], study.name)
        command.finish_plots()
        page = command.page(
            study.name, "tolerances", verdict(data), [Points(data["sentences"]), Points(data["notes"])],
            sections_of(folder, spread, data, table), study=source.read_text("utf-8"), files=FILES,
        )  # fmt: skip
        command.finish("tolerated", {"tolerated": source}, study.model_dump(mode="json"), page=page)
    command.report(data, "Tables and figure are")


def _study(source: Path) -> Study:
    return Study.model_validate(read_design(source).study) if source.suffix == ".json" else read_study(source)


def _subject(source: Path, study: Study, progress: Progress) -> TolerancedModule:
    """Return the module to analyse: a design as it is, a study evaluated, or the optimum of one."""
    table = study.table
    notes = []
    if not study.tolerances:
        study = study.model_copy(update={"tolerances": standard_tolerances(table)})
        notes.append("The study gives no tolerances: the standard ones are taken.")
    if source.suffix == ".json":
        design = read_design(source)
        resolved = resolve_design(design)
        return TolerancedModule(
            replace(resolved, study=resolved.study.model_copy(update={"tolerances": study.tolerances})),
            None,
            (f"Module: the design {source}.", *design.rating_notes, *notes),
        )
    if not study.vary:
        return TolerancedModule(resolve_study(study), None, (f"Module: {source}.", *notes))
    progress("searching for the optimum")
    design = _optimum(study, progress)
    module = f"Module: the optimum of {source}{', robust as it asks' if study.robust else ''}."
    notes = [module, *design.rating_notes, *notes]
    return TolerancedModule(resolve_design(design), design, tuple(notes))


def _optimum(study: Study, progress: Progress) -> Design:
    table = study.table
    result = answer(study, progress)
    if not result.found:
        raise InfeasibleError(complaint(result, table))
    return result.design


def _write(
    folder: ResultsFolder, source: Path, subject: TolerancedModule, data: dict[str, Any], spread: Spread, table: Table
) -> None:
    folder.write(f"tolerated{source.suffix}", source.read_bytes())
    if subject.design is not None:
        write_design(subject.design, folder.path / "design.json")
    folder.write_json("tolerances.json", data)
    folder.write("outputs.csv", csv_text(output_rows(spread, table), digits=6))
    folder.write("limits.csv", csv_text(limit_rows(spread, table), digits=6))
    folder.write("contributors.csv", csv_text(contributor_rows(spread, table, subject.resolved.study), digits=6))
