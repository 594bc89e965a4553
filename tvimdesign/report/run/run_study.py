"""The commands `run` and `cad`, from a file to a finished folder: the order of things, and what the terminal says.

Backup of a run that is interrupted before it is written: a study that goes on from the best design so far.

Checks a study without answering it: its text, limits that cannot hold together, records with doubtful values.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from tvimdesign.base import errors
from tvimdesign.base.deadline import Deadline
from tvimdesign.base.environment import how_to_install
from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.base.units import format_quantity
from tvimdesign.cad.make import BackgroundPartsJob
from tvimdesign.report.output.command import Command, done_in_part, noting
from tvimdesign.report.output.terminal import Progress, print_lines, progress_output, wide_console
from tvimdesign.report.page.blocks import Section, Words
from tvimdesign.report.run.parts_of_design import in_short
from tvimdesign.solve.result import StudyResult
from tvimdesign.solve.search import SearchInterrupted
from tvimdesign.study import Study, read_design, read_tree, record_checks, tree_of_file, write_design
from tvimdesign.study.written_studies import started_at, study_text
from tvimdesign.sweep.plan import swept_cells

if TYPE_CHECKING:
    from rich.console import Console

    from tvimdesign.report.run.answered_study import AnsweredStudy


def run_study(
    path: Path, out: Path, *, overwrite: bool, cad: bool, plots: bool, as_json: bool,
    resume: bool = False, prove: bool = False, full: bool = False, settings: Sequence[str] = (), gives_up: bool = False,
) -> None:  # fmt: skip
    """Answer a study and write its folder. Raises InputError, InfeasibleError, and TvimError for what is not done.

    A study that `check` refuses ends there, before the folder is touched. One that misses its yield ends before it is
    reported if it `gives_up`, with BelowYieldError.
    """
    began = time.perf_counter()
    tree = tree_of_file(path, settings)
    study = read_tree(tree)
    deadline = Deadline(study.solver.time_limit)
    _check(study, deadline, as_json=as_json)
    cad = cad and study.write.cad
    without = how_to_install("cad") if cad else ""
    with Command(out, overwrite=overwrite, resume=resume, as_json=as_json) as command, ExitStack() as stack:
        folder, progress = command.folder, command.progress
        # Started before what solves and reports is loaded here: both take their time to load as much.
        making = stack.enter_context(BackgroundPartsJob(study.mode)) if cad and not without else None
        if plots and study.write.plots:
            command.start_plotter(gives_way=True)
        from tvimdesign.report.run.answered_study import answer_study, drawings
        from tvimdesign.report.run.first_screen import print_everything, print_first_screen, verdict_of, write_summary
        from tvimdesign.report.run.run_page import finish, summary_sheet, write_answer, write_failure, write_results
        from tvimdesign.solve.search import optimize

        best = stack.enter_context(keeping_best(folder))
        with write_failure(folder, tree, study, progress, as_json=as_json):
            answered = answer_study(
                tree,
                progress,
                prove=prove,
                folder=folder,
                search=partial(optimize, deadline=deadline, checked=True, eases=not gives_up),
                early=best.note,
                designed=(lambda design, _: making.begin_with(design, folder.path / "cad"))
                if making
                else lambda *_: None,
                deadline=deadline,
            )
        result, command.failures = answered.result, answered.failures
        if gives_up and isinstance(missed := _ending(answered), errors.BelowYieldError):
            raise missed
        if result.has_design:
            vector = bool(making) or study.write.vector
            command.begin_plots(drawings(answered), study.name, vector=vector, folder="plots")
            command.missing = [f"parts: {without}"] if without else []
        write_answer(folder, answered)  # nothing that follows can lose it
        _add_uncertainty(answered, progress)
        answered.reported["verdict"] = verdict_of(answered).text
        progress("")
        if not as_json:
            print_result = print_everything if full else print_first_screen
            print_result(answered, wide_console(), time.perf_counter() - began)
        write_results(folder, answered)
        write_summary(answered, folder)
        parts = ""
        if making and result.has_design:
            parts = _add_parts(making, answered, command)
        elif making:
            making.stop()
        command.add_plot(lambda: summary_sheet(folder, answered), study.name, "pdf")
        folder.look_up_versions()
        command.finish_plots("drawing the plots")
        finish(folder, answered)

    show = partial(_print_last, command, parts)
    command.report(answered.reported, "", show, lambda failures: _ending(answered) or done_in_part(failures))
    if ending := _ending(answered):
        raise ending


def _check(study: Study, deadline: Deadline | None = None, *, as_json: bool = False) -> None:
    """Refuse a study that cannot be answered; with `as_json`, print the JSON of one whose limits conflict."""
    from tvimdesign.solve.infeasibility.early_checks import refuse_what_cannot_be

    try:
        with progress_output() as progress:
            progress("checking whether the requirements conflict")
            refuse_what_cannot_be(study, deadline=deadline)
    except errors.InfeasibleError as error:
        if as_json:
            from tvimdesign.report.run.run_page import refused_run

            print(json.dumps(refused_run(study, error), indent=2))
        raise


_STEP = "yield and intervals"


def _add_uncertainty(answered: AnsweredStudy, progress: Progress) -> None:
    from tvimdesign.report.run.answered_study import note_left_out, note_uncertainty
    from tvimdesign.report.run.uncertainty_data import uncertainty_of

    progress(f"computing {_STEP} over the assumed values")
    try:
        answered.deadline.check(_STEP)
        note_uncertainty(answered, uncertainty_of(answered.result, answered.study, answered.deadline))
    except errors.TimeOverError:
        answered.deadline.leave_out(_STEP)
        note_left_out(answered)
    except errors.TvimError as error:
        how = "run the study again, or `tvimdesign tolerate` with the results folder for the yield alone"
        message = f"the uncertainty of the design could not be computed: {error}; {how}"
        answered.failures.append(errors.TvimError(message))
        answered.no_uncertainty = message


def _add_parts(making: BackgroundPartsJob, answered: AnsweredStudy, command: Command) -> str:
    """Wait for the parts, report their checks, and return those in short; a failure is noted."""
    checked = ""
    with noting(command.failures):
        report = making.finish(command.progress)
        answered.reported["cad"], checked = report.plain(), in_short(report.checks)
        report.refuse_failed()
    return checked


def _print_last(command: Command, parts: str, console: Console) -> None:
    """Print what is not installed, where to look first, and what the `parts` passed."""
    from tvimdesign.report.run.first_screen import look_first

    for text in command.missing:
        console.print(f"No {text}", markup=False, soft_wrap=True)
    print_lines(look_first(str(command.out), console.width, parts), console)


def _ending(answered: AnsweredStudy) -> errors.TvimError | None:
    """Return what a run that is written ends with, where its design is no plain success."""
    from tvimdesign.report.run.reasons import above_rating, complaint
    from tvimdesign.report.run.uncertainty_data import below_yield

    result = answered.result
    if not result.has_design:
        return errors.InfeasibleError(complaint(result))
    if refused := above_rating(result):
        return errors.AboveRatingError(refused)
    return errors.BelowYieldError(missed) if (missed := below_yield(result)) else None


def make_parts(source: Path, out: Path, *, overwrite: bool, as_json: bool) -> None:
    """Make the parts of a design.json, or of a study, which is answered first."""
    if source.suffix != ".json":
        run_study(source, out, overwrite=overwrite, cad=True, plots=False, as_json=as_json)
        return
    design, data = read_design(source), None
    with Command(out, overwrite=overwrite, as_json=as_json) as command:
        written = write_design(design, command.folder.path / DESIGN)
        with noting(command.failures), BackgroundPartsJob(design.mode, gives_way=False) as making:
            making.begin(written, command.folder.path)
            report = making.finish(command.progress)
            data = report.plain()
            command.shown = [Section("parts", "", [Words([f"Parts: {in_short(report.checks)}"])])]
            report.refuse_failed()
        status = "parts failed" if command.failures else design.status
        command.folder.finish(status, {"design": source}, design.study)
    command.report(data, "Parts are")


DESIGN = "design.json"
BEST = "best_so_far.yaml"
_TITLE = "The run was interrupted: this study begins at the best design so far, which was not checked any further"


class Best:
    """The answer of a run, once there is one."""

    study: Study | None = None  # The study started at it

    def note(self, result: StudyResult) -> None:
        """Note an answer where it is a design that was searched."""
        if result.has_design and result.solution:
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
            with suppress(errors.OutputError, OSError):  # no room, or nobody to tell: the interrupt is what counts
                path = folder.where_if_stopped(BEST)
                folder.write_at_the_end(BEST, study_text(study, _TITLE, path.parent))
                sys.stderr.write(f"{path} starts at the best design so far; go on from there: tvimdesign run {path}\n")
        raise


def check_study(path: Path, settings: Sequence[str] = (), *, as_json: bool) -> None:
    """Print what a study asks. Raises StudyError with every mistake, and what `refuse_what_cannot_be` raises."""
    tree = tree_of_file(path, settings)
    study = read_tree(tree)
    _check(study)
    cells = swept_cells(tree)
    print(study.model_dump_json(indent=2) if as_json else describe(study))
    if cells and not as_json:
        print(f"Its sweep has {cells} cells.")


def describe(study: Study) -> str:
    """Return one line on what a valid study asks, then one for each of its records that contradicts itself."""
    what = f"optimises {len(study.vary)} variables" if study.task == "optimize" else "evaluates one module"
    summary = f"{study.name}: valid; {what}, {len(study.require)} requirements ({study.mode} mode)."
    return "\n".join([summary, *record_checks(study), *foreseen_ratings(study)])


def foreseen_ratings(study: Study) -> list[str]:
    """Return ratings that the module the study starts from is beyond and the study neither accepts nor excludes."""
    from tvimdesign.solve.optimizer.verify_optimum import exceeded_at_start

    try:
        exceeded = exceeded_at_start(study)
    except errors.SimulationError:
        return []
    module, then = ("The module", "") if not study.vary else ("The module it starts from", " An optimum may be, too.")
    return [
        f"{module} is beyond a rating: {name} is {format_quantity(value, study.table.unit(name))}.{then} Accept it, "
        f'`accept: [{name}]`, or exclude it, `require: {{{name}: ">= 0 {study.table.unit(name)}"}}`.'
        for name, value in exceeded.items()
    ]
