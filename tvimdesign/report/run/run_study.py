"""The commands `run` and `cad`, from a file to a finished folder: the order of things, and what the terminal says.

Backup of a run that is interrupted before it is written: a study that goes on from the best design so far.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from rich.markup import escape

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.environment import how_to_install
from tvimdesign.base.errors import (
    AboveRatingError,
    BelowYieldError,
    InfeasibleError,
    OutputError,
    TimeOverError,
    TvimError,
)
from tvimdesign.report.output.command import done_in_part, noting
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.output.terminal import Progress, progress_output, wide_console
from tvimdesign.report.run.check_study import refuse_what_cannot_be
from tvimdesign.solve.best_so_far import SearchInterrupted
from tvimdesign.solve.result import StudyResult
from tvimdesign.study import Study, read_tree
from tvimdesign.study.design import read_design, write_design
from tvimdesign.study.tree import tree_of_file
from tvimdesign.study.written_studies import started_at, study_text

if TYPE_CHECKING:
    from tvimdesign.report.output.plot_process import PlotProcess
    from tvimdesign.report.output.results_format import Parts
    from tvimdesign.report.run.answered_study import AnsweredStudy
    from tvimdesign.report.run.parts_of_design import BackgroundPartsJob
    from tvimdesign.report.run.uncertainty_process import UncertaintyProcess
    from tvimdesign.solve.nlp.solution import Solution
    from tvimdesign.solve.result import Designed
    from tvimdesign.study.design import Design

_CHECKS = 15
"""Checks that are printed; checks.json has all."""


def run_study(
    path: Path, out: Path, *, overwrite: bool, cad: bool, plots: bool, as_json: bool, sensitivities: bool = False,
    resume: bool = False, prove: bool = False, full: bool = False, settings: Sequence[str] = (),
) -> None:  # fmt: skip
    """Answer a study and write its folder. Raises InputError, InfeasibleError, and TvimError for what is not done.

    A study that `check` refuses ends there, before the folder is touched.
    """
    began = time.perf_counter()
    tree = tree_of_file(path, settings)
    study = read_tree(tree)
    deadline = Deadline(study.solver.time_limit)
    _check(study, deadline, as_json=as_json)
    without = how_to_install("cad") if cad and study.write.cad else ""
    with ExitStack() as stack:
        folder = stack.enter_context(ResultsFolder(out, overwrite, resume))
        # Begun before what solves and reports is loaded here: both take their time to load as much.
        making = stack.enter_context(_parts_ahead(study.mode)) if cad and study.write.cad and not without else None
        drawing = stack.enter_context(_plots_ahead()) if plots and study.write.plots else None
        from tvimdesign.report.run.answered_study import answer_study, drawings
        from tvimdesign.report.run.first_screen import print_result, write_summary
        from tvimdesign.report.run.run_page import (
            finish,
            summary_sheet,
            write_answer,
            write_failure,
            write_results,
            write_run_page,
        )
        from tvimdesign.report.run.uncertainty_process import uncertainty_process
        from tvimdesign.solve.search import optimize

        best = stack.enter_context(keeping_best(folder))
        progress = stack.enter_context(progress_output())
        uncertainty = stack.enter_context(uncertainty_process(study))
        with write_failure(folder, tree, study, progress, as_json=as_json):
            answered = answer_study(
                tree,
                progress,
                prove=prove,
                sensitivities=sensitivities,
                folder=folder,
                search=partial(optimize, deadline=deadline, checked=True),
                early=best.note,
                designed=_asked_of_design(making, folder, uncertainty),
                deadline=deadline,
            )
        result, failures = answered.result, answered.failures
        if drawing and result.found:
            vector = bool(making) or study.write.vector
            drawing.begin(folder.path / "plots", drawings(answered), study.name, vector=vector)
        write_answer(folder, answered)  # before this run waits for other processes
        _wait_for_uncertainty(answered, uncertainty, progress)
        write_results(folder, answered)
        write_summary(answered, folder)
        progress("")
        if not as_json:
            after = 2 if making and result.found else 1
            print_result(answered, wide_console(), time.perf_counter() - began, after, full=full)
        if making and result.found:
            with noting(failures):
                answered.reported["cad"] = _parts(making, progress, as_json, in_full=full)
        elif making:
            making.stop()
        if drawing and result.found:
            progress("drawing the plots")
            folder.look_up_versions()
            drawing.add(folder.path, summary_sheet(folder, answered), study.name, "pdf")
            with noting(failures):
                drawing.finish()
        write_run_page(folder, answered)
        finish(folder, answered)
    _say_last(answered, folder.out, failures, without if result.found else "", as_json=as_json)
    _end_as(answered)


def _check(study: Study, deadline: Deadline, *, as_json: bool) -> None:
    """Raise what `check` raises; print the JSON of a study whose limits conflict."""
    try:
        with progress_output() as progress:
            progress("checking whether the requirements conflict")
            refuse_what_cannot_be(study, deadline=deadline)
    except InfeasibleError as error:
        if as_json:
            from tvimdesign.report.run.run_page import refused_run

            print(json.dumps(refused_run(study, error), indent=2))
        raise


def _parts_ahead(mode: str) -> BackgroundPartsJob:
    from tvimdesign.report.run.parts_of_design import BackgroundPartsJob

    return BackgroundPartsJob(mode)


def _plots_ahead() -> PlotProcess:
    from tvimdesign.report.output.plot_process import PlotProcess

    return PlotProcess(gives_way=True)


def _asked_of_design(
    making: BackgroundPartsJob | None, folder: ResultsFolder, uncertainty: UncertaintyProcess | None
) -> Designed:  # fmt: skip
    """Return a function that begins the parts and the uncertainty of a design as soon as it is there."""

    def asked(design: Design, solution: Solution | None) -> None:
        if making:
            making.begin(design, folder.path / "cad")
        if uncertainty:
            uncertainty.begin(design, yield_known=solution is not None and solution.yield_reached is not None)

    return asked


def _wait_for_uncertainty(
    answered: AnsweredStudy, process: UncertaintyProcess | None, progress: Progress
) -> None:  # fmt: skip
    from tvimdesign.report.run.answered_study import note_left_out, note_no_uncertainty, note_uncertainty
    from tvimdesign.report.run.uncertainty_process import STEP
    from tvimdesign.solve.nlp.spread import yield_of

    if process is None or not process.begun:
        return
    progress(f"computing {STEP} over the assumed values")
    try:
        data, solution = process.finish(answered.deadline), answered.result.solution
        if solution and (reached := solution.yield_reached):
            data |= {"parts_yield": asdict(yield_of(reached.together, reached.modules)), "modules": reached.modules}
        note_uncertainty(answered, data)
    except TimeOverError:
        answered.deadline.leave_out(STEP)
        note_left_out(answered)
    except TvimError as error:
        note_no_uncertainty(answered, error)


def _end_as(answered: AnsweredStudy) -> None:
    """Raise what a run that is written ends with, where it is no plain success."""
    from tvimdesign.report.run.infeasible_report import above_rating, complaint
    from tvimdesign.report.run.uncertainty_data import below_yield

    result, table = answered.result, answered.study.table
    if not result.found:
        raise InfeasibleError(complaint(result, table))
    if refused := above_rating(result, table):
        raise AboveRatingError(refused)
    if missed := below_yield(result):
        raise BelowYieldError(missed)
    if answered.failures:
        raise done_in_part(answered.failures)


def _say_last(
    answered: AnsweredStudy, folder: Path, failures: Sequence[TvimError], without: str, *, as_json: bool
) -> None:  # fmt: skip
    """Print the JSON, or where to look first; `without` says what is not installed, if anything is not."""
    from tvimdesign.report.output.terminal import print_lines
    from tvimdesign.report.run.first_screen import look_first

    if as_json:
        not_done = [*([f"parts: {without}"] if without else []), *(str(failure) for failure in failures)]
        more = {"folder": str(folder), "not_done": not_done}
        print(json.dumps({**answered.reported, **more}, indent=2, allow_nan=False))
        return
    console = wide_console()
    if without:
        console.print(f"No parts: {without}", markup=False, soft_wrap=True)
    print_lines(look_first(str(folder), console.width), console)


def make_parts(source: Path, out: Path, *, overwrite: bool, as_json: bool) -> None:
    """Make the parts of a design.json, or of a study, which is answered first."""
    from tvimdesign.report.run.parts_of_design import BackgroundPartsJob

    if source.suffix != ".json":
        run_study(source, out, overwrite=overwrite, cad=True, plots=False, as_json=as_json)
        return
    design = read_design(source)
    failures: list[TvimError] = []
    with ResultsFolder(out, overwrite) as folder:
        written = write_design(design, folder.path / "design.json")
        alone = BackgroundPartsJob(design.mode, gives_way=False)
        with progress_output() as progress, noting(failures), alone as making:
            making.begin_with(written, folder.path)
            report = _parts(making, progress, as_json, in_full=True)
            if as_json:
                print(json.dumps(report, indent=2))
            else:
                wide_console().print(f"Parts are in [bold]{escape(str(out))}[/bold]", soft_wrap=True)
        folder.finish("parts failed" if failures else design.status, {"design": source}, design.study)
    if failures:
        raise done_in_part(failures)


def _parts(making: BackgroundPartsJob, progress: Progress, as_json: bool, *, in_full: bool) -> Parts:
    """Wait for the parts and print what was found. Raises GeometryError where a check fails."""
    from tvimdesign.report.output.terminal import print_grid, print_lines, wrapped
    from tvimdesign.report.run.parts_of_design import in_short, plain_report, refuse_failed, worst_first
    from tvimdesign.report.run.parts_sections import checks_grid

    report = making.finish(progress)
    console = wide_console()
    if not as_json and in_full:
        failed = [check.plain() for check in worst_first(report.checks)]
        print_grid(checks_grid("Checks on the solids that did not pass", failed[:_CHECKS]), console)
    if not as_json:
        print_lines(wrapped(f"Parts: {in_short(report.checks)}", console.width, indent="  "), console)
    refuse_failed(report)
    return plain_report(report)


DESIGN = "design.json"
BEST = "best_so_far.yaml"
_TITLE = "The run was interrupted: this study begins at the best design so far, which was not checked any further"


class Best:
    """The answer of a run, once there is one."""

    study: Study | None = None
    """The study started at it."""

    def note(self, result: StudyResult) -> None:
        """Note an answer where it is a design that was searched."""
        if result.found and result.solution:
            design = result.design
            self.study = started_at(Study.model_validate(design.study), design.values, design.choices)


@contextmanager
def keeping_best(folder: ResultsFolder) -> Iterator[Best]:
    """Write that study, and say where, where a run is interrupted before its design is written."""
    best = Best()
    try:
        yield best
    except KeyboardInterrupt as interrupt:
        study = interrupt.best if isinstance(interrupt, SearchInterrupted) else best.study
        if study is not None and not (folder.path / DESIGN).exists():
            with suppress(OutputError, OSError):  # no room, or nobody to tell: the interrupt is what counts
                path = folder.where_if_stopped(BEST)
                folder.write_at_the_end(BEST, study_text(study, _TITLE, path.parent))
                sys.stderr.write(f"the best design so far is where {path} begins\n")
        raise
