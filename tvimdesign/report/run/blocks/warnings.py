"""Warnings of a run, the gravest first, each with the line of the study that cures it."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib import resources
from typing import Any, NamedTuple

from tvimdesign.base.errors import TvimError
from tvimdesign.base.units import format_quantity
from tvimdesign.base.yaml_data import plain_data
from tvimdesign.device import Choice, Table, table_for
from tvimdesign.report.output.numbers import label
from tvimdesign.report.output.terminal import duration
from tvimdesign.report.run.reasons import endings
from tvimdesign.solve.nlp.constraints import advice_of, ratings_of
from tvimdesign.solve.optimizer.verify_optimum import CYCLE_TOLERANCE
from tvimdesign.solve.result import ConstraintCheck, StudyResult
from tvimdesign.study import Study, given

LOOSE = 0.05
"""Share of the first swing without contact from which on small motions say little of the joint."""
_PLACE = re.compile(r"<(\w+)>")
RULE_TOLERANCE = 1e-9
"""By how much, in SI, a rule may seem violated by rounding."""
_LEVELS = ("grave", "serious", "")
VARY = "vary the current or a size, and write "
"""What a study that varies nothing is advised first, if a requirement is the cure."""


class RunWarning(NamedTuple):
    """A warning: its text, the line to write in the study, and its level, `grave`, `serious` or none."""

    text: str
    cure: str = ""
    level: str = ""

    @property
    def grave(self) -> bool:
        """True if nobody should build the module as it is."""
        return self.level == "grave"


def warnings_of(answer: StudyResult, doubts: Sequence[str]) -> list[RunWarning]:
    """Return the warnings of a result, the gravest first; `doubts` are contradictions within chosen records."""
    from_records = [_other("doubt", line=doubt) for doubt in doubts]
    if not answer.found:
        return from_records
    warnings = [*_of_the_switch(answer), *_of_advice(answer), *_of_points(answer), *_of_the_search(answer)]
    return sorted([*warnings, *from_records], key=lambda warning: _LEVELS.index(warning.level))


@cache
def hints() -> dict[str, dict[str, Any]]:
    """Return what `warnings.yaml` has on each advice and rating, and on what else is warned of."""
    file = resources.files("tvimdesign.report.run.blocks").joinpath("warnings.yaml")
    return dict(plain_data(file.read_text(encoding="utf-8")))


def _hint(name: str) -> dict[str, Any]:
    """Return the entry of a rating or an advice; empty if it has none."""
    return dict((hints()["ratings"] | hints()["advice"]).get(name, {}))


def filled(text: str, places: Mapping[str, str]) -> str:
    """Return a text with its places filled in."""
    return _PLACE.sub(lambda match: places.get(match[1], match[0]), text)


def _other(kind: str, **places: str) -> RunWarning:
    entry = hints()["others"][kind]
    return RunWarning(filled(entry["say"], places).rstrip("."), filled(entry["mend"], places), entry.get("level", ""))


def _of_the_switch(answer: StudyResult) -> Iterator[RunWarning]:
    if math.isinf(answer.design.value("response_time")):
        yield _other("never_soft")
    elif math.isinf(answer.design.value("stiffening_time")):
        yield _other("never_stiff")


def _of_advice(answer: StudyResult) -> Iterator[RunWarning]:
    table = table_for(answer.design.mode)
    for check in answer.warnings:
        hint = _hint(check.output)
        value = format_quantity(check.value, table.unit(check.output), 3)
        cure, above_rating = mending(check, answer, table), check.output in answer.design.above_rating
        if above_rating:
            accept = f"accept: [{check.output}]"
            cure = f"{cure} or {accept}" if cure else accept
        text = f"{label(check.output)} is {value}: {hint.get('say', check.origin)}"
        if "text" in hint:
            text = filled(hint["text"], {"size": value.lstrip("-")})
        yield RunWarning(text, cure, "grave" if above_rating else hint.get("level", ""))


def _of_points(answer: StudyResult) -> Iterator[RunWarning]:
    points = answer.design.study["operating_points"]
    melting = [point for point in points if f"solid_fraction@{point}" in answer.intervals]
    for point in melting:
        yield _other("melting_range", point=point)
    for check in answer.undecided:
        yield _other("undecided", limit=check.text, point=next(iter(melting), "hot"))
    for point in points:
        lost = answer.design.values.get(f"contact_lost@{point}", 0.0)
        if lost > LOOSE:
            yield _other("contact_lost", point=point, share=f"{100.0 * lost:.2g} %")


def _of_the_search(answer: StudyResult) -> Iterator[RunWarning]:
    solution = answer.solution
    if solution is None:
        return
    if solution.out_of_time is not None:
        yield _other("out_of_time", seconds=duration(solution.out_of_time))
    distinct = solution.distinct_optima()  # none if only a search from elsewhere ended in an optimum
    best, others = distinct[:1], distinct[1:]
    if others:
        count = sum(solution.reached(start) for start in others)
        yield _other(
            "another_optimum", count=str(count), all=str(len(solution.free_starts)),
            objective=f"{others[0].objective:.5g}", best=f"{best[0].objective:.5g}",
        )  # fmt: skip
    for line in endings(solution.free_starts):
        yield _other("not_converged", line=line)


def mending(check: ConstraintCheck, answer: StudyResult, table: Table) -> str:
    """Return the line that cures a neglected advice; empty if the file knows none.

    A study that varies nothing is advised to vary something if the line is a requirement.
    """
    lines: Sequence[str] = _hint(check.output).get("mend", ())
    for line in lines:
        words = plain_data(line).get("module", {})
        only_words = bool(words) and all(isinstance(table.by_name.get(name), Choice) for name in words)
        if only_words and _cures(check, words, answer, table):
            return line
    last = lines[-1] if lines else ""
    return f"{VARY}{last}" if last.startswith("require:") and answer.solution is None else last


def _cures(check: ConstraintCheck, words: Mapping[str, str], answer: StudyResult, table: Table) -> bool:
    """Return whether the advice is followed with other words chosen, numbers and working cycle being the same."""
    design = answer.design
    study = Study.model_validate(design.study)
    chosen = {name: design.choices[name] for name in study.vary if name in design.choices}
    changed = study.model_copy(update={"vary": {}, "profile": {}, "module": {**study.module, **chosen, **words}})
    try:
        values = given(changed)
        values |= {name: design.values[name] for name in study.vary if name in design.values}
        values |= {row.name: design.values[row.name] for row in table.supplied}
        value = table.evaluate(values, [check.output])[check.output]
        if not _fits(words, values, table):
            return False
    except TvimError:
        return False
    limits = [limit for limit in (*ratings_of(table), *advice_of(table)) if limit.output == check.output]
    return all(limit.residual(value) <= CYCLE_TOLERANCE for limit in limits)


def _fits(words: Mapping[str, str], values: Mapping[str, Any], table: Table) -> bool:
    """Return whether what the words bring into the module meets its own rules: a spring must fit its hub."""
    brought = [
        (row.name, rule)
        for row in table.outputs
        if any(feature.choice in words for feature in row.requires)
        for rule in row.rules
    ]
    fit_values = table.evaluate(values, list(dict.fromkeys(name for name, _ in brought)))
    return all((fit_values[name] - rule.value) * (1.0 if rule.sense == ">=" else -1.0) >= -RULE_TOLERANCE
               for name, rule in brought)  # fmt: skip
