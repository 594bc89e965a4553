"""Answers for a page: quick ones while something is dragged, exact ones when it is let go."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Literal, TypeAlias

import numpy as np

from tvimdesign.base.errors import TvimError
from tvimdesign.base.units import from_si
from tvimdesign.explore.answers.quick_model import Evaluated, QuickModel
from tvimdesign.explore.answers.shown import Shown, finite_data, shown_design
from tvimdesign.explore.states.state import State, set_values, text_of, tree_of
from tvimdesign.report.run.answered_study import AnsweredStudy, answer_study
from tvimdesign.report.run.infeasible_report import complaint
from tvimdesign.solve.nlp.constraints import refuse_impossible
from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.optimizer.at_bounds import put_at_bounds
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.optimizer.parametric_optimizer import Moved, ParametricOptimizer
from tvimdesign.solve.optimizer.statuses import OPTIMAL
from tvimdesign.solve.optimizer.verify_optimum import verify_optimum
from tvimdesign.solve.search import Keep, optimize
from tvimdesign.study import Options, Study, read_tree
from tvimdesign.study.tree import StudyTree

Stage: TypeAlias = Literal["quick", "exact", "confirmed", "report"]
"""While something is dragged; when it is let go; from every start, as `run` does; what was exact last, once more."""
Progress: TypeAlias = Callable[[str], None]
_MODELS = 3
"""Modules of different records that are kept compiled."""
WAITS = "follows when you let go: its current follows a profile"


@dataclass(frozen=True)
class Answer:
    """What is sent to the page, and what a report is written from."""

    shown: Shown
    answered: AnsweredStudy | None = None


class Engine:
    """One study and what was compiled of it."""

    def __init__(self, base: StudyTree, *, compiled: bool = True) -> None:
        """Nothing is built yet."""
        self._base, self._compiled = base, compiled
        self._study = read_tree(base)
        self._models: list[QuickModel] = []
        self._problem: ParametricOptimizer | None = None
        self._last: Moved | None = None
        self._told: Answer | None = None

    def answer(self, state: State, stage: Stage, progress: Progress = lambda _: None) -> Answer:
        """The module of a state. Raises InputError and InfeasibleError in the study's own words."""
        if stage == "report" and self._told is not None:
            return self._told
        began = perf_counter()
        found = self._quick(state) if stage == "quick" else self._exact(state, stage, progress)
        if found.answered is not None:
            self._told = found
        found.shown.update(stage=stage, way=state.way, milliseconds=round(1e3 * (perf_counter() - began), 1))
        return found

    # --- while something is dragged ---

    def _quick(self, state: State) -> Answer:
        free = self._read(tree_of(self._base, state, "optimize"))
        if state.way == "evaluate":
            study = self._read(tree_of(self._base, state))
            values = self._evaluated(study, {})
            return Answer({"status": "", **shown_design(study, free, values.values),
                           "curves": finite_data(values.curves)})  # fmt: skip
        study = self._read(set_values(tree_of(self._base, state), _listed(free, state)))
        if study.profile.pieces():
            return Answer({"status": WAITS})
        study = study.model_copy(update={"robust": None}) if study.robust and study.robust.share else study
        moved = self._optimum(study)
        if not moved.converged:
            return Answer({"status": "no optimum near the last one; the search from every start follows"})
        self._last = moved
        found = {name: float(moved.run.inputs[self._problem_index(name)]) for name in study.vary}
        evaluated = self._evaluated(study, found)
        shown = shown_design(study, free, evaluated.values, moved.binding, moved.ends)
        shown["at"] = {**state.at, **{name: _rounded(study, name, value) for name, value in found.items()}}
        shown["curves"], shown["iterations"] = finite_data(evaluated.curves), moved.run.start.iterations
        return Answer({"status": "", **shown})

    def _problem_index(self, name: str) -> int:
        assert self._problem is not None
        return int(self._problem.optimizer.model.index[name])

    def _optimum(self, study: Study) -> Moved:
        if self._problem is None or not self._problem.fits(study):
            self._problem, self._last = ParametricOptimizer(study), None
        last = self._last.run if self._last else None
        return self._problem.solve(study, last, self._reference(study, self._problem))

    def _reference(self, study: Study, problem: ParametricOptimizer) -> dict[str, float]:
        """What is minimised at the study's own start, where that is another than the one that was built."""
        model, built = self._model(study), problem.optimizer
        start = model.inputs(study)
        if np.array_equal(start, built.model.start):
            return {}
        values = model.evaluate(start).values
        horizon = values["horizon"]
        found = {name: values[name] if np.isfinite(values[name]) else horizon for name in study.minimize}
        return {name: value or 1.0 for name, value in found.items()}

    def _evaluated(self, study: Study, found: Mapping[str, float]) -> Evaluated:
        """Raises InputError in the study's words where there is no such module."""
        model = self._model(study)
        evaluated = model.evaluate(model.inputs(study, found))
        if any(np.isnan(value) for value in evaluated.values.values()):
            with np.errstate(invalid="ignore"):
                refuse_impossible(study)
        return evaluated

    def _model(self, study: Study) -> QuickModel:
        for model in self._models:
            if model.fits(study):
                return model
        self._models = [QuickModel(study, compiled=self._compiled), *self._models[: _MODELS - 1]]
        return self._models[0]

    def wait(self) -> None:
        """Wait until what is being compiled is there."""
        for model in self._models:
            model.wait()

    # --- when it is let go ---

    def _exact(self, state: State, stage: Stage, progress: Progress) -> Answer:
        tree = tree_of(self._base, state)
        free = self._read(tree_of(self._base, state, "optimize"))
        if stage == "exact" and state.way == "optimize":
            tree = set_values(tree, _listed(free, state))
        tree = set_values(tree, {"front": None}) if tree.section("front") is not None else tree
        answered = answer_study(tree, progress, search=self._near if stage == "exact" else optimize)
        found, table = answered.result, answered.study.table
        design = found.design
        shown = shown_design(answered.study, free, design.values)
        shown["status"] = "" if found.found else complaint(found, table)
        shown["found"] = found.found
        shown["at"] = {
            name: text_of(free, name, design.choices.get(name, design.values.get(name, 0.0))) for name in free.vary
        }
        return Answer(shown, answered)

    def _near(
        self,
        study: Study,
        progress: Progress,
        reference: dict[str, float] | None,
        keep: Keep,
        objectives: Sequence[str],
    ) -> Solution:
        """The optimum from where the last one is; every start where that is none."""
        if self._last is not None and not study.robust:
            optimizer = Optimizer(study, reference, progress, objectives=objectives)
            begin = optimizer.model.start.copy()
            for name, value in self._last.run.start.end.items():
                if name in study.vary:
                    begin[optimizer.model.index[name]] = value
            run = put_at_bounds(optimizer, optimizer.solve(begin=begin))
            if run.start.converged:
                solution = verify_optimum(optimizer, run, (run.start,), optimizer.seconds)
                if solution.status == OPTIMAL:
                    keep(optimizer, [run])
                    return solution
        return optimize(study, progress, reference, keep, objectives)

    # --- what both need ---

    def _read(self, tree: StudyTree) -> Study:
        return read_tree(tree, lambda _: self._study.table, lambda _: self._study.catalog)


def _listed(study: Study, state: State) -> dict[str, str]:
    """What is chosen from lists, as the hand has it."""
    return {name: state.at[name] for name, one in study.vary.items() if isinstance(one, Options) and name in state.at}


def _rounded(study: Study, name: str, value: float) -> str:
    """A number of an optimum that is passed through, in as many digits as it is shown."""
    unit = study.table.unit(name)
    return f"{from_si(value, unit):.7g} {unit}".removesuffix(" 1")


def refused(error: TvimError) -> Shown:
    """What is sent where a state has no answer."""
    return {"status": str(error), "found": False}
