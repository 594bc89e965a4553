"""A study answered: every way to show, write or print an answer starts from it."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import TvimError
from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.engine.integrator import is_compiled
from tvimdesign.report.output.plot_process import Drawing
from tvimdesign.report.output.tables import control_entry, duty_entry, results
from tvimdesign.report.output.terminal import Progress, duration
from tvimdesign.report.run.blocks.warnings import RunWarning, warnings_of
from tvimdesign.report.run.front_report import FrontOfRun
from tvimdesign.report.run.reasons import conflicts_reported, starts_reported, why
from tvimdesign.solve.result import Designed, StudyResult, answer
from tvimdesign.solve.search import Search, optimize
from tvimdesign.study import Study, StudyTree, drawn, read_tree, record_checks


@dataclass
class AnsweredStudy:
    """A study, what it came to, and what could not be done."""

    tree: StudyTree
    study: Study
    result: StudyResult
    front: FrontOfRun
    reported: dict[str, Any]  # Everything a script wants to know: the content of results.json
    failures: list[TvimError] = field(default_factory=list)
    uncertainty: Mapping[str, Any] = field(default_factory=dict)
    """What `Uncertainty.data` returns; empty if it was not computed."""
    no_uncertainty: str = ""  # Why it could not be computed
    deadline: Deadline = field(default_factory=Deadline)  # Until when it is answered, with what is left out for it

    @property
    def warnings(self) -> list[RunWarning]:
        """The warnings on the design, first what was not done; terminal, summary.txt and page ask for the same."""
        return [*self._not_done(), *self._of_design]

    @cached_property
    def _of_design(self) -> list[RunWarning]:
        return warnings_of(self.result, self.reported["doubts"], self.deadline)

    def _not_done(self) -> Iterator[RunWarning]:
        """Report a missing uncertainty, and the steps that the time limit left out."""
        if self.no_uncertainty:
            yield RunWarning(self.no_uncertainty, level="serious")
        if self.deadline.left_out:
            limit, steps = duration(self.deadline.seconds), "; ".join(self.deadline.left_out)
            left_out = f"the time limit of {limit} ended before these were done: {steps}"
            yield RunWarning(f"{left_out}. Raise --time-limit to get them", level="serious")


def answer_study(
    tree: StudyTree,
    progress: Progress,
    *,
    prove: bool = False,
    drawn_only: bool = False,
    folder: ResultsFolder | None = None,
    search: Search | None = None,
    early: Callable[[StudyResult], None] = lambda _: None,
    designed: Designed = lambda *_: None,
    deadline: Deadline | None = None,
) -> AnsweredStudy:
    """Read and answer a study: evaluate or optimise it, and seek its front, which a `folder` lets go on later.

    With `drawn_only` nothing is optimised: what may change stands at its start. `early` gets the answer before the
    front is sought, `designed` a design that is found before that. All of it ends at the `deadline`: the study's time
    limit from now on unless given; a `search` in place of the usual one has its own.

    Raises InputError, InfeasibleError for what no search can mend, and TimeOverError where the time is over before the
    search; a search that finds no design is a result.
    """
    first = "" if is_compiled() else ": the first run after an installation compiles them, for about a minute"
    progress(f"preparing the equations{first}")
    study = read_tree(tree)
    if prove:  # every combination of listed choices is solved
        study = study.model_copy(update={"solver": study.solver.model_copy(update={"prove": True})})
    study = drawn(study) if drawn_only else study
    deadline = deadline or Deadline(study.solver.time_limit)
    front, search = FrontOfRun(study, folder), search or partial(optimize, deadline=deadline, eases=True)
    result = answer(study, progress, keep=front.search.keep, objectives=front.outputs, search=search, designed=designed)
    early(result)
    answered = AnsweredStudy(tree, study, result, front, _reported(result), deadline=deadline)
    answered.reported["doubts"] = record_checks(study)
    front.seek(result, progress, answered.reported, answered.failures)
    note_left_out(answered)
    progress("")
    return answered


def _reported(result: StudyResult) -> dict[str, Any]:
    reported = results(result)
    if result.duty:
        reported["duty"] = duty_entry(result.duty, result.design.table)
    if result.control:
        reported["control"] = control_entry(result.control)
    reported["why"] = why(result)
    if result.solution:
        reported["starts"] = starts_reported(result)
        reported["conflict_set"] = conflicts_reported(result.solution.conflict_set)
    return reported


def note_uncertainty(answered: AnsweredStudy, data: Mapping[str, Any]) -> None:
    """Add to what is reported how sure the design is; results.json has it without what only the screen needs."""
    answered.uncertainty = data
    if data:
        answered.reported["uncertainty"] = {name: value for name, value in data.items() if name != "needs"}


def note_left_out(answered: AnsweredStudy) -> None:
    """Add to what is reported which steps the time limit left out."""
    if answered.deadline.left_out:
        answered.reported["left_out"] = list(answered.deadline.left_out)


def drawings(answered: AnsweredStudy) -> list[Drawing]:
    """Return every figure of an answer, with what it is drawn from; none where there is no design."""
    from tvimdesign.report.run import run_page

    if not answered.result.has_design:
        return []
    return run_page.drawings(answered.result) + answered.front.drawings()
