"""The sections `module`, `operating_points`, `profile`, `currents`, `solver` and `write`: what the study fixes."""

import re
from itertools import pairwise

from tvimdesign.base.units import format_quantity
from tvimdesign.device import Choice, Input, Table
from tvimdesign.device.core.task import GROUP as TASK_GROUP
from tvimdesign.study.sections import section
from tvimdesign.study.study import (
    STANDARD_POINTS,
    ControlOptions,
    DutyOptions,
    GivenCurrent,
    ProfileOptions,
    Range,
    SolverOptions,
    Study,
    WriteOptions,
)
from tvimdesign.study.text import values
from tvimdesign.study.text.mistakes import Mistakes, RefusedError, one_of, quoted, step
from tvimdesign.study.text.yaml_text import Mapping, Node, Sequence, Text

MOST_POINTS = 20
_POINT = re.compile(section.POINT)


def _read_module(reading: values.Reading, node: Node | None) -> dict[str, float | str]:
    expected = "names of the module's inputs, each with a value"
    named = values.entries(reading.problems, node, "module", expected)
    return {
        **values.readable(lambda name, entry: _set(reading, name, *entry), named),
        **reading.section("task")["module"],
    }


def _set(reading: values.Reading, name: str, key: Text, value: Node) -> float | str:
    path, row, refuse = step("module", name), reading.table.by_name.get(name), reading.problems.refuse
    if isinstance(row, Choice) or (isinstance(row, Input) and not row.per_point):
        return values.read_input(reading, value, path, row)
    if isinstance(row, Input):
        refuse(key, path, "belongs to an operating point", "it under `operating_points`, for each point")
    if row is not None:
        refuse(key, path, "is a result and cannot be set", "an input", "limit it under `require`")
    known = [row.name for row in section.settable(reading.table)]
    reading.unknown_quantity(key, path, "input or choice", name, known)
    raise RefusedError


def _read_drawn(reading: values.Reading, node: Node | None) -> dict[str, float]:
    named = values.entries(
        reading.problems, node, "as_drawn", "inputs that the parts were drawn with, each with a value"
    )
    return values.readable(lambda name, entry: _drawn(reading, name, *entry), named)


def _drawn(reading: values.Reading, name: str, key: Text, value: Node) -> float:
    path, known = step("as_drawn", name), reading.table.drawn_with
    if name in known:
        return values.quantity(reading.problems, value, path, known[name])
    if name in reading.table.by_name:
        reading.problems.refuse(key, path, "no part is drawn with it", "a size or a clearance of the parts")
    reading.unknown_quantity(key, path, "input", name, known)
    raise RefusedError


def _read_points(reading: values.Reading, node: Node | None) -> dict[str, dict[str, float]]:
    """Return every operating point in full (SI): the study's values over the standard ones over the defaults."""
    rows = {row.name: row for row in reading.table.inputs if row.per_point}
    all_points = {name: _standard(name, rows) for name in STANDARD_POINTS}
    expected = "operating points, each with its " + ", ".join(rows)
    for name, (key, value) in list(values.entries(reading.problems, node, "operating_points", expected).items()):
        path = step("operating_points", name)
        if not _POINT.fullmatch(name) or "_at_" in name:
            shown = f"{quoted(name)} cannot name an operating point"
            reading.problems.add(key, path, shown, "a short word of lower-case letters, digits and _, without '_at_'")
        elif len(all_points) == MOST_POINTS and name not in all_points:
            reading.problems.add(key, path, f"more than {MOST_POINTS} operating points", "fewer")
            break
        else:
            own = _point(reading, value, path, rows)
            all_points[name] = _standard(name, rows) | own
            given = list(value.entries) if isinstance(value, Mapping) else []
            unset = [row.name for row in rows.values() if row.name not in all_points[name] and row.record is None]
            missing = [row for row in unset if row not in given]
            if missing:
                reading.problems.add(key, path, f"has no {' and no '.join(missing)}", _examples(missing, rows))
    return all_points


def _point(reading: values.Reading, node: Node, path: str, rows: dict[str, Input]) -> dict[str, float]:
    expected = "values such as " + _examples(list(rows), rows)
    given = values.entries(reading.problems, node, path, expected)
    known = values.unknown_keys(reading.problems, given, path, "input of an operating point", list(rows))
    return values.readable(
        lambda name, value: values.quantity(reading.problems, value, step(path, name), rows[name]), known
    )


def _standard(point: str, rows: dict[str, Input]) -> dict[str, float]:
    own = STANDARD_POINTS.get(point, {})
    known = {row.name: own.get(row.name, row.default) for row in rows.values()}
    return {name: value for name, value in known.items() if value is not None}


def _examples(names: list[str], rows: dict[str, Input]) -> str:
    units = {name: "" if rows[name].unit == "1" else f" {rows[name].unit}" for name in names}
    return ", ".join(f"'{name}: 1{units[name]}'" for name in names) or one_of([])


def written_value(table: Table, name: str, value: float | str) -> str:
    """Return the value of an input or a choice as it is written."""
    return value if isinstance(value, str) else values.exactly(value, table.unit(name))


def _write_points(study: Study) -> dict[str, dict[str, str]]:
    return {
        point: {name: written_value(study.table, name, value) for name, value in given.items()}
        for point, given in study.operating_points.items()
    }


def _points_schema(table: Table) -> section.Schema:
    point = section.mapping({row.name: section.set_schema(row) for row in table.inputs if row.per_point})
    return section.mapping({}, {f"^{section.POINT}$": {"description": "one operating point", **point}})


def _check_profile(reading: values.Reading) -> None:
    """Note each profile of a current that has no range in which it could change."""
    if not reading.mode:
        return
    vary, vary_node = reading.section("vary"), reading.nodes.get("vary")
    for phase, (_, node) in values.entries(Mistakes(""), reading.nodes.get("profile"), "profile", "").items():
        if phase not in ProfileOptions.model_fields:
            continue  # it has been noted
        row = reading.table.phase(phase).current_input
        if row not in vary and isinstance(vary_node, Mapping) and row in vary_node.entries:
            continue  # what is wrong with that range has been noted
        if not isinstance(vary.get(row), Range) and not (isinstance(node, Text) and node.value.strip() == "0"):
            message = f"the current of this phase has no range: `vary.{row}` is missing"
            reading.problems.add(node, step("profile", phase), message, f"{row}: [0.1 A, 3 A] under `vary`, for one")


MODULE = section.Section(
    "module", "inputs and choices of the module", _read_module,
    lambda table: section.mapping({row.name: section.set_schema(row) for row in section.settable(table)}),
    lambda study: {
        name: written_value(study.table, name, value)
        for name, value in study.module.items()
        if study.table.quantity(name).group != TASK_GROUP
    },
)  # fmt: skip
AS_DRAWN = section.Section(
    "as_drawn", "inputs that the parts were drawn with, where `module` has what was measured of them since",
    _read_drawn,
    lambda table: section.mapping({name: section.set_schema(row) for name, row in table.drawn_with.items()}),
    lambda study: {name: written_value(study.table, name, value) for name, value in study.as_drawn.items()},
)  # fmt: skip
POINTS = section.Section(
    "operating_points", "temperatures and frequencies for stiffness and damping; `cold` and `hot` always exist",
    _read_points, _points_schema, _write_points,
)  # fmt: skip
PROFILE = section.settings(
    "profile",
    "straight pieces in which the current of a phase changes with time; 0 keeps it constant",
    ProfileOptions,
    _check_profile,
)
SOLVER = section.settings("solver", "effort of the search and fineness of the heat model", SolverOptions)
DUTY = section.settings("duty", "repeated switching, whose periodic state and highest rate are reported", DutyOptions)
CONTROL = section.settings("control", "the heater's controller, and modules drawn under it", ControlOptions)
WRITE = section.settings("write", "files in the results folder besides the numbers", WriteOptions)


MOST_MOMENTS = 1000
_SERIES = {name: section.unit_of(field) for name, field in GivenCurrent.model_fields.items()}
_EXPECTED = "moments: [0 s, 0.4 s, 8 s] and currents: [0 A, 4 A, 3.8 A], for one"


def _read(reading: values.Reading, node: Node | None) -> dict[str, GivenCurrent]:
    """Return the current given for each phase; every problem is noted. A study that searches has none."""
    problems = reading.problems
    phases = list(ProfileOptions.model_fields)
    expected = f"phases, each with its moments and currents: {', '.join(phases)}"
    phases_given = values.entries(problems, node, "currents", expected)
    if reading.has("vary") and phases_given and node is not None:
        hint = "a search finds them: `profile`, or the inputs of constant currents under `vary`"
        problems.add(node, "currents", "given currents belong to a module that is evaluated", "no `vary` beside", hint)
    known = values.unknown_keys(problems, phases_given, "currents", "phase", phases)
    return values.readable(lambda phase, value: _given(reading, value, step("currents", phase)), known)


def _given(reading: values.Reading, node: Node, path: str) -> GivenCurrent:
    problems = reading.problems
    parts = values.entries(problems, node, path, _EXPECTED)
    known = values.unknown_keys(problems, parts, path, "series", list(_SERIES))
    if isinstance(node, Text) and node.empty:
        values.misfit(problems, node, path, _EXPECTED)
    missing = [name for name in _SERIES if name not in parts]
    if parts and missing:
        problems.add(node, path, f"has no {' and no '.join(missing)}", _EXPECTED)
    units = {name: unit for name, unit in _SERIES.items() if name in known}
    series = values.readable(lambda name, unit: _series(reading, known[name], step(path, name), unit), units)
    if len(series) < len(_SERIES):
        raise RefusedError
    moments, currents = series["moments"], series["currents"]
    before = len(problems.items)
    if len(moments) != len(currents):
        problems.add(node, path, f"{len(moments)} moments and {len(currents)} currents", "a current for each moment")
    if moments[0] != 0.0:
        problems.add(node, path, f"begins at {format_quantity(moments[0], 's')}", "0 s, the phase's start, at first")
    if any(later <= earlier for earlier, later in pairwise(moments)):
        problems.add(node, path, "the moments do not rise", "each moment later than the one before")
    if len(problems.items) > before:
        raise RefusedError
    return GivenCurrent(moments=moments, currents=currents)


def _series(reading: values.Reading, node: Node, path: str, unit: str) -> tuple[float, ...]:
    """Return the values of one series in SI. Raises RefusedError, with a problem noted."""
    problems = reading.problems
    if not isinstance(node, Sequence):
        values.misfit(problems, node, path, f"a list of quantities in {unit}")
    if not 2 <= len(node.items) <= MOST_MOMENTS:
        problems.refuse(node, path, f"{len(node.items)} values", f"2 to {MOST_MOMENTS}")
    return values.quantities(problems, node, path, unit)


CURRENTS = section.Section(
    "currents", "currents of an evaluated module over time, by phase: moments from its start, and a current at each",
    _read,
    section.mapping(
        dict.fromkeys(ProfileOptions.model_fields, section.shape(section.field_schemas(GivenCurrent), list(_SERIES)))
    ),
    lambda study: {phase: section.changed(current) for phase, current in study.currents.items()},
)  # fmt: skip
