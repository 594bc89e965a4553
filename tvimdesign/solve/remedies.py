"""Remedies of warnings: lines of the study, each tried as far as arithmetic can before it is advised.

A part or a material is tried in the design, at its numbers and working cycle. In an optimised study, requirements and
parts are then tried together with the remedies of graver warnings: the limits that depend on no working cycle must
allow all of them, with the margins that the study asks for. What depends on a switch is not tried.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import TvimError
from tvimdesign.base.record import plain_data
from tvimdesign.base.units import parse_quantity
from tvimdesign.device import Choice, Input, Table, table_for
from tvimdesign.solve.nlp.constraints import advice_of, on_cycle, ratings_of
from tvimdesign.solve.optimizer.verify_optimum import CYCLE_TOLERANCE
from tvimdesign.solve.result import StudyResult
from tvimdesign.solve.uncertainty.robust import Extreme, least_with_margins
from tvimdesign.study import Study, given, read_study_text
from tvimdesign.study.written_studies import started_at

RULE_TOLERANCE = 1e-9  # By how much, in SI, a rule may seem violated by rounding


class Bound(NamedTuple):
    """The most, or least, of an output (SI) that limits allow, where a remedy would need more, or less."""

    output: str
    is_most: bool
    extreme: Extreme


@dataclass(frozen=True)
class Remedy:
    """A line of the study that cures a warning, or why there is none."""

    line: str
    tried: bool = False
    failed: bool = False  # True if the line does not cure at the numbers of the design
    bound: Bound | None = None


class Remedies:
    """Remedies of one result, the gravest warning's first: each is tried beside those before it."""

    def __init__(self, answer: StudyResult, deadline: Deadline) -> None:
        """Start with a study that has no remedy yet; nothing is tried once the deadline has passed."""
        self._answer, self._deadline = answer, deadline
        self._table = table_for(answer.design.mode)
        self._study = Study.model_validate(answer.design.study)

    def of(self, output: str, lines: Sequence[str], *, cheap: bool = False) -> Remedy:
        """Return the first line that cures; else the last one, or why it does not cure; no line without lines.

        `output` has the advice or rating that the design does not follow. A `cheap` remedy needs no search.
        """
        bound: Bound | None = None
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
                possible, bound = self._adopted(line)
                if possible:
                    return Remedy(line, tried=True)
        if bound or not lines:
            return Remedy("", bound=bound)
        return Remedy(lines[-1], failed=lines[-1] in failed)

    def _adopted(self, line: str) -> tuple[bool, Bound | None]:
        """Return whether a requirement is possible, which is adopted then, else what is possible, if that is known."""
        added = read_study_text(f"mode: {self._study.mode}\n{line}\n").require
        for limit in added:
            sign = -1.0 if limit.sense == ">=" else 1.0
            for margins in (False, True) if self._study.robust else (False,):
                most = self._least(self._study, limit.output, sign, margins=margins)
                if most is None:
                    return False, None
                if sign * (most.value - limit.limit) > RULE_TOLERANCE:
                    return False, Bound(limit.output, sign < 0.0, most)
        self._study = self._study.model_copy(update={"require": (*self._study.require, *added)})
        return True, None

    def _least(self, study: Study, output: str, weight: float = 1.0, *, margins: bool = False) -> Extreme | None:
        """Return the least value of an output that arithmetic allows; None if that is not known."""
        started = started_at(study, self._answer.design.values, self._answer.design.choices)
        try:
            return least_with_margins(started, output, weight, margins=margins)
        except TvimError:
            return None


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
