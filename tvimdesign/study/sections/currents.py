"""The section `currents`: how the current of a phase is given over time, instead of searched or constant."""

from __future__ import annotations

from itertools import pairwise

from tvimdesign.base.units import format_quantity
from tvimdesign.study.sections.fields import changed, field_schemas, unit_of
from tvimdesign.study.sections.section import Section, mapping, shape
from tvimdesign.study.study import GivenCurrent, ProfileOptions
from tvimdesign.study.text.mistakes import step
from tvimdesign.study.text.values import Reading, entries, in_unit, misfit, unknown_keys
from tvimdesign.study.text.yaml_text import Node, Sequence, Text

MOST_MOMENTS = 1000
_SERIES = {name: unit_of(field) for name, field in GivenCurrent.model_fields.items()}
_EXPECTED = "moments: [0 s, 0.4 s, 8 s] and currents: [0 A, 4 A, 3.8 A], for one"


def _read(reading: Reading, node: Node | None) -> dict[str, GivenCurrent]:
    """Return the current given for each phase; every problem is noted. A study that searches has none."""
    problems = reading.problems
    phases = list(ProfileOptions.model_fields)
    expected = f"phases, each with its moments and currents: {', '.join(phases)}"
    phases_given = entries(problems, node, "currents", expected)
    if reading.has("vary") and phases_given and node is not None:
        hint = "a search finds them: `profile`, or the inputs of constant currents under `vary`"
        problems.add(node, "currents", "given currents belong to a module that is evaluated", "no `vary` beside", hint)
    currents = {}
    for phase, value in unknown_keys(problems, phases_given, "currents", "phase", phases).items():
        given = _given(reading, value, step("currents", phase))
        if given is not None:
            currents[phase] = given
    return currents


def _given(reading: Reading, node: Node, path: str) -> GivenCurrent | None:
    problems = reading.problems
    parts = entries(problems, node, path, _EXPECTED)
    known = unknown_keys(problems, parts, path, "series", list(_SERIES))
    if isinstance(node, Text) and node.empty:
        misfit(problems, node, path, _EXPECTED)
    missing = [name for name in _SERIES if name not in parts]
    if parts and missing:
        problems.add(node, path, f"has no {' and no '.join(missing)}", _EXPECTED)
    series = {name: _series(reading, known[name], step(path, name), unit)
              for name, unit in _SERIES.items() if name in known}  # fmt: skip
    moments, currents = series.get("moments"), series.get("currents")
    if moments is None or currents is None:
        return None
    before = len(problems.items)
    if len(moments) != len(currents):
        problems.add(node, path, f"{len(moments)} moments and {len(currents)} currents", "a current for each moment")
    if moments[0] != 0.0:
        problems.add(node, path, f"begins at {format_quantity(moments[0], 's')}", "0 s, the phase's start, at first")
    if any(later <= earlier for earlier, later in pairwise(moments)):
        problems.add(node, path, "the moments do not rise", "each moment later than the one before")
    return None if len(problems.items) > before else GivenCurrent(moments=moments, currents=currents)


def _series(reading: Reading, node: Node, path: str, unit: str) -> tuple[float, ...] | None:
    """Return the values of one series in SI, or None with a problem noted."""
    problems = reading.problems
    if not isinstance(node, Sequence):
        misfit(problems, node, path, f"a list of quantities in {unit}")
        return None
    if not 2 <= len(node.items) <= MOST_MOMENTS:
        problems.add(node, path, f"{len(node.items)} values", f"2 to {MOST_MOMENTS}")
        return None
    read = [in_unit(problems, item, step(path, str(place)), unit, f"a quantity in {unit}")
            for place, item in enumerate(node.items)]  # fmt: skip
    values = tuple(value for value in read if value is not None)
    return values if len(values) == len(read) else None


CURRENTS = Section(
    "currents", "currents of an evaluated module over time, by phase: moments from its start, and a current at each",
    _read, mapping(dict.fromkeys(ProfileOptions.model_fields, shape(field_schemas(GivenCurrent), list(_SERIES)))),
    lambda study: {phase: changed(current) for phase, current in study.currents.items()},
)  # fmt: skip
