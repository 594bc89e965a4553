"""The commands `run` and `cad`, from a file to a finished folder: the order of things, and what the terminal says."""

from __future__ import annotations

import json
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from rich.markup import escape

from tvimdesign.base.errors import AboveRatingError, BelowYieldError, InfeasibleError, TvimError
from tvimdesign.base.extras import how_to_install
from tvimdesign.report.output.progress import Progress, progress_output, wide_console
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.study import read_tree
from tvimdesign.study.design import read_design, write_design
from tvimdesign.study.tree import tree_of_file

if TYPE_CHECKING:
    from tvimdesign.report.output.results_format import Parts
    from tvimdesign.report.run.answered_study import AnsweredStudy


def run_study(
    path: Path, out: Path, *, overwrite: bool, cad: bool, plots: bool, as_json: bool, sensitivities: bool = False,
    resume: bool = False, prove: bool = False, full: bool = False, settings: Sequence[str] = (),
) -> None:  # fmt: skip
    """Answer a study and write its folder. Raises InputError, InfeasibleError, and TvimError for what is not done."""
    from tvimdesign.report.figures.plot_process import PlotProcess
    from tvimdesign.report.run.answered_study import (
        answer_study,
        done_in_part,
        drawings,
        note_uncertainty,
        noting,
    )
    from tvimdesign.report.run.first_screen.run_screen import RunScreen
    from tvimdesign.report.run.infeasible_report import above_rating, complaint
    from tvimdesign.report.run.keep_best import keeping_best
    from tvimdesign.report.run.refusal import leaving_the_reason
    from tvimdesign.report.run.run_page.run_page import write_run_page
    from tvimdesign.report.run.write_answer import finish, write_answer
    from tvimdesign.report.run.yield_words import below_yield

    tree = tree_of_file(path, settings)
    study = read_tree(tree)
    with ExitStack() as stack:
        folder = stack.enter_context(ResultsFolder(out, overwrite, resume))
        best = stack.enter_context(keeping_best(folder))
        progress = stack.enter_context(progress_output())
        screen = stack.enter_context(RunScreen(study))
        drawing = stack.enter_context(PlotProcess()) if plots and study.write.plots else None
        with leaving_the_reason(folder, tree, study, progress, as_json=as_json):
            answered = answer_study(
                tree, progress, prove=prove, sensitivities=sensitivities, folder=folder, early=best.then(screen.ask)
            )
        found, failures = answered.result, answered.failures
        parts = cad and study.write.cad and found.found
        without = how_to_install("cad") if parts else ""
        parts = parts and not without
        if drawing and found.found:
            vector = parts or study.write.vector
            drawing.begin(folder.path / "plots", drawings(answered), study.name, vector=vector)
        note_uncertainty(answered, screen.uncertainty())
        design = write_answer(folder, answered)
        progress("")
        screen.tell(answered, folder, None if as_json else wide_console(), full=full)
        if parts:
            with noting(failures):
                answered.reported["cad"] = _parts(design, folder.path / "cad", progress, as_json, in_full=full)
        if drawing and found.found:
            progress("drawing the plots")
            folder.look_up_versions()
            with noting(failures):
                drawing.finish()
        write_run_page(folder, answered, screen.told(answered, timed=False))
        finish(folder, answered)
    _say_last(answered, folder.path, failures, without, as_json=as_json)
    if not found.found:
        raise InfeasibleError(complaint(found, answered.study.table))
    if refused := above_rating(found, answered.study.table):
        raise AboveRatingError(refused)
    if missed := below_yield(found):
        raise BelowYieldError(missed)
    if failures:
        raise done_in_part(failures)


def _say_last(
    answered: AnsweredStudy, folder: Path, failures: Sequence[TvimError], without: str, *, as_json: bool
) -> None:  # fmt: skip
    """What was told as JSON, or where to look first; `without` says what is not installed, if anything is not."""
    from tvimdesign.report.run.first_screen.run_screen import look_first, show

    if as_json:
        not_done = [*([f"parts: {without}"] if without else []), *(str(failure) for failure in failures)]
        more = {"folder": str(folder), "not_done": not_done}
        print(json.dumps({**answered.reported, **more}, indent=2, allow_nan=False))
        return
    console = wide_console()
    if without:
        console.print(f"No parts: {without}", markup=False, soft_wrap=True)
    show(look_first(str(folder), console.width), console)


def make_parts(source: Path, out: Path, *, overwrite: bool, as_json: bool) -> None:
    """Make the parts of a design.json, or of a study, which is answered first."""
    from tvimdesign.report.run.answered_study import done_in_part, noting

    if source.suffix != ".json":
        run_study(source, out, overwrite=overwrite, cad=True, plots=False, as_json=as_json)
        return
    design = read_design(source)
    failures: list[TvimError] = []
    with ResultsFolder(out, overwrite) as folder:
        kept = write_design(design, folder.path / "design.json")
        with progress_output() as progress, noting(failures):
            report = _parts(kept, folder.path, progress, as_json, in_full=True)
            if as_json:
                print(json.dumps(report, indent=2))
            else:
                wide_console().print(f"Parts are in [bold]{escape(str(out))}[/bold]", soft_wrap=True)
        folder.finish("parts failed" if failures else design.status, {"design": source}, design.study)
    if failures:
        raise done_in_part(failures)


def _parts(design: Path, out: Path, progress: Progress, as_json: bool, *, in_full: bool) -> Parts:
    """Make the parts and print what was found. Raises GeometryError where a check fails."""
    from tvimdesign.report.run.first_screen.layout import block
    from tvimdesign.report.run.first_screen.run_screen import show
    from tvimdesign.report.run.parts_of_design import make_parts_of, plain_report, refuse_failed
    from tvimdesign.report.run.solid_checks import in_short, print_solid_checks

    report = make_parts_of(design, out, progress)
    console = wide_console()
    if not as_json and in_full:
        print_solid_checks(report.checks, console)
    elif not as_json:
        show(block("Parts", in_short(report.checks), console.width), console)
    refuse_failed(report, out)
    return plain_report(report)
