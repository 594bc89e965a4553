"""Answers for a page, quick while something is dragged and exact afterwards: limits, variables and values."""

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal, TypeAlias

import numpy as np

from tvimdesign.base.errors import TvimError
from tvimdesign.base.units import from_si
from tvimdesign.device import Table
from tvimdesign.explore.quick_model import Evaluated, QuickModel
from tvimdesign.explore.state import State, set_values, text_of, tree_of
from tvimdesign.report.output.numbers import all_finite, in_labels, label, with_unit
from tvimdesign.report.output.tables import NOTHING, margin_text
from tvimdesign.report.run.answered_study import AnsweredStudy, answer_study, note_uncertainty
from tvimdesign.report.run.first_screen import verdict_of
from tvimdesign.report.run.reasons import complaint
from tvimdesign.report.run.uncertainty_data import uncertainty_data
from tvimdesign.solve.anchored_search import NearOptimum, optimum_near
from tvimdesign.solve.nlp import constraints
from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.nlp.solver_run import OPTIMAL
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.optimizer.refinements import put_at_bounds
from tvimdesign.solve.optimizer.verify_optimum import exceeded, is_met, verify_optimum
from tvimdesign.solve.result import ConstraintCheck
from tvimdesign.solve.search import Keep, optimize
from tvimdesign.study import Options, Range, Study, StudyTree, given, read_tree

_ROUNDING = 1e-6  # Margin that is what a solver leaves of zero
Shown = dict[str, Any]  # Plain data, as JSON has it


def shown_design(
    study: Study, free: Study, known: Mapping[str, Any], values: Mapping[str, float], active: Collection[str] = (),
    ends: Mapping[str, str] | None = None,
) -> Shown:  # fmt: skip
    """Return a module's values (SI, by full name) for the page; `free` is the study with its variables.

    `known` is what the study gives, `active` are the active limits, `ends` variables at an end of their range.
    """
    table = study.table
    return {
        "values": [_finite(from_si(values[name], table.unit(name))) for name in value_names(free)],
        "limits": limits_shown(study, known, values, active),
        "warnings": ratings_shown(study, values),
        "variables": {
            name: {"value": _finite(from_si(values[name], table.unit(name))), "end": (ends or {}).get(name, "")}
            for name in free.vary if name in values
        },
    }  # fmt: skip


def value_names(study: Study) -> list[str]:
    """Return the outputs whose values are shown, in the table's order."""
    seen = {row.name for row in study.table.first_oscillations}
    return [name for name in study.table.names(study.operating_points) if name.partition("@")[0] not in seen]


def limits_shown(
    study: Study, known: Mapping[str, Any], values: Mapping[str, float], active: Collection[str]
) -> list[Shown]:
    """Return every requirement and the active or violated rules, violated ones first.

    Of the limits that one requirement puts on several outputs, and that are met, the closest is shown.
    """
    stand = [
        (limit, _stands(limit, values[limit.output], study.table, limit.name in active))
        for limit in constraints.constraints_of(study, study.table, known)
    ]
    order = ("violated", "active", "met")
    stand.sort(key=lambda pair: (order.index(pair[1]), -float(pair[0].residual(values[pair[0].output]))))
    limits = [
        _limit(limit, values[limit.output], study.table, stands) for limit, stands in stand
        if limit.origin == "require" or stands != "met"
    ]  # fmt: skip
    first = {(row["of"], row["sense"]): row for row in reversed(limits)}
    return [row for row in limits if row["stands"] != "met" or first[row["of"], row["sense"]] is row]


def _stands(limit: constraints.Constraint, value: float, table: Table, presses: bool) -> str:
    if not is_met(limit, value, table):
        return "violated"
    return "active" if presses or -float(limit.residual(value)) <= NOTHING else "met"


def _limit(limit: constraints.Constraint, value: float, table: Table, stands: str) -> Shown:
    margin = -float(limit.residual(value))
    check = ConstraintCheck(
        text=constraints.in_words(limit, table), output=limit.output, value=value, margin=margin, scale=limit.scale,
        absolute=limit.absolute, met=stands != "violated", worst=margin, origin=limit.origin, part_of=limit.part_of,
    )  # fmt: skip
    unit = table.unit(limit.output)
    got = value if abs(margin) > _ROUNDING else limit.limit
    return {"name": limit.name, "label": label(limit.part_of or limit.output), "of": limit.part_of or limit.output,
            "sense": limit.sense, "text": in_labels(check.text),
            "got": with_unit(got, unit),
            "margin": margin_text(check, table), "stands": stands, "origin": limit.origin}  # fmt: skip


def ratings_shown(study: Study, values: Mapping[str, float]) -> list[Shown]:
    """Ratings that the module is beyond."""
    return [
        {"text": in_labels(constraints.in_words(limit, study.table)), "label": label(limit.output),
         "accepted": limit.output in study.accept}
        for limit in exceeded(values, study.table)
    ]  # fmt: skip


def _finite(value: float) -> float | None:
    """Return a number for JSON; None for infinity, the time of what never happens."""
    return float(f"{value:.7g}") if math.isfinite(value) else None


Stage: TypeAlias = Literal["quick", "exact", "confirmed", "report"]
"""While something is dragged; when it is let go; from every start, as `run` does; what was exact last, once more."""
Progress: TypeAlias = Callable[[str], None]
_MODELS = 3  # Modules of different records that are kept compiled
WAITS = "follows when you let go: its current follows a profile"


@dataclass(frozen=True)
class Answer:
    """An answer for the page, with what a report is written from."""

    shown: Shown
    answered: AnsweredStudy | None = None
    module: Mapping[str, Any] | None = None
    """What it is drafted from: `mode`, `choices`, and `values` in SI, none where one is not finite."""


class Engine:
    """One study and what was compiled of it."""

    def __init__(self, base: StudyTree, *, compiled: bool = True) -> None:
        """Read the study; models are built when they are needed."""
        self._base, self._compiled = base, compiled
        self._study = read_tree(base)
        self._models: list[QuickModel] = []
        self._last: NearOptimum | None = None
        self._free: tuple[Mapping[str, Any], Study] | None = None
        self._last_answer: Answer | None = None

    def answer(self, state: State, stage: Stage, progress: Progress = lambda _: None) -> Answer:
        """Answer a state. Raises InputError and InfeasibleError in the study's own words."""
        if stage == "report" and self._last_answer is not None:
            return self._last_answer
        reply = self._quick(state) if stage == "quick" else self._exact(state, stage, progress)
        if reply.answered is not None:
            self._last_answer = reply
        reply.shown.update(stage=stage, way=state.way)
        return reply

    # --- while something is dragged ---

    def _quick(self, state: State) -> Answer:
        free = self._freed(state)
        if state.way == "evaluate":
            study = self._read(tree_of(self._base, state))
            return Answer({"status": WAITS}) if study.currents else self._drawn(study, free, {})
        listed = _listed(free, state)
        study = self._read(set_values(tree_of(self._base, state), listed)) if listed else free
        if study.profile.pieces():
            return Answer({"status": WAITS})
        study = study.model_copy(update={"robust": None}) if study.robust and study.robust.share else study
        moved = self._optimum(study, state)
        if not moved.converged:
            return Answer({"status": "no optimum near the last one; the search from every start follows"})
        self._last = moved
        optimum = moved.run.start.end
        reply = self._drawn(study, free, optimum, moved.active, moved.ends)
        reply.shown["at"] = {**state.at, **{name: _rounded(study, name, value) for name, value in optimum.items()}}
        return reply

    def _drawn(self, study: Study, free: Study, optimum: Mapping[str, float], *stand: Any) -> Answer:
        """Return a module's values and curves; `stand` is what `shown_design` takes of an optimum."""
        known = given(study)
        evaluated = self._evaluated(study, known, optimum)
        shown = shown_design(study, free, known, evaluated.values, *stand)
        shown |= {"status": "", "curves": all_finite(evaluated.curves)}
        return Answer(shown, None, _module(study, evaluated.values, evaluated.words))

    def _optimum(self, study: Study, state: State) -> NearOptimum:
        """Return the optimum near the last one, or near the controls' values, such as a result's design."""
        optimizer = Optimizer(study)
        if self._last and self._last.run.start.end.keys() == {free.name for free in optimizer.free}:
            return optimum_near(optimizer, self._last.run.start.end)
        hand = given(self._read(tree_of(self._base, state, "evaluate")))
        at = {name: float(hand[name]) for name, allowed in study.vary.items() if isinstance(allowed, Range)}
        return optimum_near(optimizer, at, or_start=True)

    def _evaluated(self, study: Study, known: Mapping[str, Any], optimum: Mapping[str, float]) -> Evaluated:
        """Raises InputError in the study's words where there is no such module; `known` is what the study gives."""
        model = self._model(study, known)
        evaluated = model.evaluate(model.inputs({**known, **optimum}))
        with np.errstate(invalid="ignore"):
            if constraints.impossible(evaluated.values, study.table):
                constraints.refuse_impossible(study)
            constraints.refuse_contradictory(study, known)
        return evaluated

    def _model(self, study: Study, known: Mapping[str, Any]) -> QuickModel:
        """Return the compiled module; `known` holds the study's values."""
        for model in self._models:
            if model.fits(study, known):
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
        free = self._freed(state)
        if stage == "exact" and state.way == "optimize":
            tree = set_values(tree, _listed(free, state))
        tree = set_values(tree, {"front": None}) if tree.section("front") is not None else tree
        answered = answer_study(
            tree, progress, search=self._near if stage == "exact" else partial(optimize, eases=True)
        )
        result, design = answered.result, answered.result.design
        known = given(answered.study)
        shown = shown_design(answered.study, free, known, design.values)
        shown["status"] = "" if result.has_design else complaint(result)
        if result.has_design and state.way == "optimize" and answered.study.robust:
            progress("computing yield and intervals over the assumed values")
            with suppress(TvimError):
                note_uncertainty(answered, uncertainty_data(answered.study, design))
        says = verdict_of(answered)
        shown["verdict"], shown["tone"] = says.text, says.tone
        shown["found"] = result.has_design
        with suppress(TvimError):
            at = {name: design.values[name] for name in free.vary if name in design.values}
            evaluated = self._evaluated(answered.study, known, at)
            if not design.current_profiles:  # these curves are of constant currents
                shown["curves"] = all_finite(evaluated.curves)
        shown["at"] = {
            name: text_of(free, name, design.choices.get(name, design.values.get(name, 0.0))) for name in free.vary
        }
        return Answer(shown, answered, _module(answered.study, design.values, design.choices))

    def _near(
        self,
        study: Study,
        progress: Progress,
        reference: dict[str, float] | None,
        keep: Keep,
        objectives: Sequence[str],
    ) -> Solution:
        """Search from the last optimum, or from every start if that fails."""
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

    def _freed(self, state: State) -> Study:
        """Return the study of a state with free variables; it is read again only after a change."""
        if self._free is None or self._free[0] != state.changes:
            self._free = dict(state.changes), self._read(tree_of(self._base, state, "optimize"))
        return self._free[1]

    def _read(self, tree: StudyTree) -> Study:
        return read_tree(tree, lambda _: self._study.table, lambda _: self._study.catalog)


def _module(study: Study, values: Mapping[str, float], words: Mapping[str, str]) -> dict[str, Any]:
    return {"mode": study.mode, "choices": dict(words), "values": all_finite({**values, **study.as_drawn})}


def _listed(study: Study, state: State) -> dict[str, str]:
    return {
        name: state.at[name]
        for name, allowed in study.vary.items()
        if isinstance(allowed, Options) and name in state.at
    }


def _rounded(study: Study, name: str, value: float) -> str:
    """Write a number of an intermediate optimum with the digits that are shown."""
    unit = study.table.unit(name)
    return f"{from_si(value, unit):.7g} {unit}".removesuffix(" 1")


def refused(error: TvimError) -> Shown:
    """Return the answer to a state that has no design."""
    return {"status": str(error), "found": False}
