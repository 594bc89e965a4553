"""What to write in a study so that a warning goes away: data, and which of several lines helps at this design."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cache
from importlib import resources
from typing import Any

from tvimdesign.base.errors import TvimError
from tvimdesign.base.yaml_data import plain_data
from tvimdesign.device import Choice, Table
from tvimdesign.solve.nlp.constraints import advice_of, ratings_of
from tvimdesign.solve.optimizer.verify_optimum import CYCLE_TOLERANCE
from tvimdesign.solve.result import ConstraintCheck, StudyResult
from tvimdesign.study import Study, given

_PLACE = re.compile(r"<(\w+)>")
RULE_TOLERANCE = 1e-9
"""By how much, in SI, a rule may seem broken by rounding."""
VARY = "vary the current or a size, and write "
"""What a study that varies nothing is told first, where a requirement is what mends."""


@cache
def hints() -> dict[str, dict[str, Any]]:
    """What `warnings.yaml` holds: of each advice, and of what else is warned of."""
    file = resources.files("tvimdesign.report.run.first_screen").joinpath("warnings.yaml")
    found: dict[str, dict[str, Any]] = plain_data(file.read_text(encoding="utf-8"))
    return found


def hint(name: str) -> dict[str, Any]:
    """What the file says of a rating or an advice; nothing where it has none."""
    found: dict[str, Any] = (hints()["ratings"] | hints()["advice"]).get(name, {})
    return found


def filled(text: str, places: Mapping[str, str]) -> str:
    """A text with what stands in its places."""
    return _PLACE.sub(lambda found: places.get(found[1], found[0]), text)


def mending(check: ConstraintCheck, answer: StudyResult, table: Table) -> str:
    """The line that mends a broken advice; empty where the file knows none.

    A study that varies nothing is told to vary something where the line is a requirement.
    """
    lines: Sequence[str] = hint(check.output).get("mend", ())
    for line in lines:
        words = plain_data(line).get("module", {})
        if words and _only_words(words, table) and _mends(check, words, answer, table):
            return line
    last = lines[-1] if lines else ""
    return f"{VARY}{last}" if last.startswith("require:") and answer.solution is None else last


def _only_words(words: Mapping[str, Any], table: Table) -> bool:
    return all(isinstance(table.by_name.get(name), Choice) for name in words)


def _mends(check: ConstraintCheck, words: Mapping[str, str], answer: StudyResult, table: Table) -> bool:
    """Whether the advice is followed with other words chosen, the numbers and the working cycle being the same."""
    design = answer.design
    study = Study.model_validate(design.study)
    found = {name: design.choices[name] for name in study.vary if name in design.choices}
    changed = study.model_copy(update={"vary": {}, "profile": {}, "module": {**study.module, **found, **words}})
    try:
        values = given(changed)
        values |= {name: design.values[name] for name in study.vary if name in design.values}
        values |= {row.name: design.values[row.name] for row in table.supplied}
        value = table.evaluate(values, [check.output])[check.output]
        if not _fits(words, values, table):
            return False
    except TvimError:
        return False
    return all(
        limit.residual(value) <= CYCLE_TOLERANCE
        for limit in (*ratings_of(table), *advice_of(table))
        if limit.output == check.output
    )


def _fits(words: Mapping[str, str], values: Mapping[str, Any], table: Table) -> bool:
    """Whether what the words bring into the module keeps the rules of its own rows: a spring must fit its hub."""
    brought = [
        (row.name, rule)
        for row in table.outputs
        if any(feature.choice in words for feature in row.requires)
        for rule in row.rules
    ]
    found = table.evaluate(values, list(dict.fromkeys(name for name, _ in brought)))
    return all((found[name] - rule.value) * (1.0 if rule.sense == ">=" else -1.0) >= -RULE_TOLERANCE
               for name, rule in brought)  # fmt: skip
