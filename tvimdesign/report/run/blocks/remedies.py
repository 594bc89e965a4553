"""Remedies of warnings: lines of the study, each tried as far as arithmetic can before it is advised.

A part or a material is tried in the design, at its numbers and working cycle. In an optimised study, requirements and
parts are then tried together with the remedies of graver warnings: the limits that depend on no working cycle must
allow all of them, with the margins that the study asks for. What depends on a switch is not tried.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import TvimError
from tvimdesign.base.record import plain_data
from tvimdesign.base.units import parse_quantity
from tvimdesign.device import Choice, Input, Table, table_for
from tvimdesign.report.output.numbers import in_labels, label, with_unit
from tvimdesign.solve.nlp.constraints import advice_of, on_cycle, ratings_of
from tvimdesign.solve.optimizer.verify_optimum import CYCLE_TOLERANCE
from tvimdesign.solve.result import StudyResult
from tvimdesign.solve.uncertainty.robust import Extreme, least_with_margins
from tvimdesign.study import Study, given, read_study_text
from tvimdesign.study.written_studies import started_at

_NAMED = 2  # Limits that are named, of those that allow no more
RULE_TOLERANCE = 1e-9  # By how much, in SI, a rule may seem violated by rounding


@dataclass(frozen=True)
class Remedy:
    """A line of the study that cures a warning, or in words why there is none."""

    line: str
    tried: bool = False
    failed: bool = False  # True if the line does not cure at the numbers of the design
    words: str = ""


class Remedies:
    """Remedies of one result, the gravest warning's first: each is tried beside those before it."""

    def __init__(self, answer: StudyResult, deadline: Deadline) -> None:
        """Start with a study that has no remedy yet; nothing is tried once the deadline has passed."""
        self._answer, self._deadline = answer, deadline
        self._table = table_for(answer.design.mode)
        self._study = Study.model_validate(answer.design.study)

    def of(self, output: str, lines: Sequence[str], *, cheap: bool = False) -> Remedy:
        """Return the first line that cures; else the last one, or why it does not cure; empty without lines.

        `output` has the advice or rating that the design does not follow. A `cheap` remedy needs no search.
        """
        refusal: str | None = ""
        failed: set[str] = set()
        for line in lines:
            entry = plain_data(line)
            if changes := _changes(entry, self._table):
                if _cures(output, changes, self._answer, self._table):
                    changed = self._study.model_copy(update={"module": {**self._study.module, **changes}})
                    if self._answer.solution is None or cheap or self._least(changed, "module_mass") is not None:
                        self._study = changed
                        return Remedy(line, tried=True)
                failed.add(line)
            elif "require" in entry and not (cheap or self._answer.solution is None or self._deadline.passed):
                if on_cycle(self._table, output):
                    continue
                refusal = self._misses(line)
                if refusal is None:
                    return Remedy(line, tried=True)
        if refusal or not lines:
            return Remedy("", words=refusal or "")
        return Remedy(lines[-1], failed=lines[-1] in failed)

    def _misses(self, line: str) -> str | None:
        """Return what is possible instead of a requirement; None, and the requirement is adopted, if it is possible.

        Empty if the search for it does not end.
        """
        added = read_study_text(f"mode: {self._study.mode}\n{line}\n").require
        for limit in added:
            sign = -1.0 if limit.sense == ">=" else 1.0
            for margins in (False, True) if self._study.robust else (False,):
                most = self._least(self._study, limit.output, sign, margins=margins)
                if most is None:
                    return ""
                if sign * (most.value - limit.limit) > RULE_TOLERANCE:
                    value = with_unit(most.value, self._table.unit(limit.output), 3)
                    end = "most" if sign < 0.0 else "least"
                    return f"{held_by(most)} limit the {label(limit.output)} to at {end} {value}"
        self._study = self._study.model_copy(update={"require": (*self._study.require, *added)})
        return None

    def _least(self, study: Study, output: str, weight: float = 1.0, *, margins: bool = False) -> Extreme | None:
        """Return the least value of an output that arithmetic allows; None if that is not known."""
        started = started_at(study, self._answer.design.values, self._answer.design.choices)
        try:
            return least_with_margins(started, output, weight, margins=margins)
        except TvimError:
            return None


def held_by(extreme: Extreme) -> str:
    """Return the limits and ranges that allow no more, the costliest, in words."""
    texts = [text.removesuffix(" >= 0 mm") for text in extreme.held_by[:_NAMED]]
    return in_labels(" and ".join(texts)) or "the study's limits"


def _changes(entry: Mapping[str, Any], table: Table) -> dict[str, Any]:
    """Return the records, options and numbers that a line sets in the module; empty if it sets anything else."""
    changes = dict(entry.get("module", {}))
    if not all(isinstance(table.by_name.get(name), Choice | Input) for name in changes):
        return {}
    for name, value in changes.items():
        row = table.quantity(name)
        if isinstance(row, Input) and isinstance(value, str):
            changes[name] = parse_quantity(value, row.unit)
    return changes


def _cures(output: str, changes: Mapping[str, Any], answer: StudyResult, table: Table) -> bool:
    """Return whether the advice is followed with a part or number changed, the working cycle being the same."""
    design = answer.design
    study = Study.model_validate(design.study)
    chosen = {name: design.choices[name] for name in study.vary if name in design.choices}
    changed = study.model_copy(update={"vary": {}, "profile": {}, "module": {**study.module, **chosen, **changes}})
    try:
        values = given(changed)
        values |= {name: design.values[name] for name in study.vary if name in design.values}
        values |= {row.name: design.values[row.name] for row in table.supplied}
        value = table.evaluate(values, [output])[output]
        if not _fits(changes, values, table):
            return False
    except TvimError:
        return False
    limits = [limit for limit in (*ratings_of(table), *advice_of(table)) if limit.output == output]
    return all(limit.residual(value) <= CYCLE_TOLERANCE for limit in limits)


def _fits(changes: Mapping[str, Any], values: Mapping[str, Any], table: Table) -> bool:
    """Return whether what the changes bring into the module meets its own rules: a spring must fit its hub."""
    brought = [
        (row.name, rule)
        for row in table.outputs
        if any(feature.choice in changes for feature in row.requires)
        for rule in row.rules
    ]
    fit_values = table.evaluate(values, list(dict.fromkeys(name for name, _ in brought)))
    return all((fit_values[name] - rule.value) * (1.0 if rule.sense == ">=" else -1.0) >= -RULE_TOLERANCE
               for name, rule in brought)  # fmt: skip
