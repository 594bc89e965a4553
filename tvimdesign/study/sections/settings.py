"""The sections `module`, `operating_points`, `profile`, `solver` and `write`: what the study fixes."""

from __future__ import annotations

import re

from tvimdesign.device import Choice, Input, Table
from tvimdesign.study.sections.fields import settings
from tvimdesign.study.sections.section import POINT, Schema, Section, mapping, set_schema, settable
from tvimdesign.study.study import STANDARD_POINTS, ProfileOptions, Range, SolverOptions, Study, WriteOptions
from tvimdesign.study.text.mistakes import Mistakes, one_of, quoted, step
from tvimdesign.study.text.values import Reading, choice, entries, exactly, quantity
from tvimdesign.study.text.yaml_text import Mapping, Node, Text

MOST_POINTS = 20
_POINT = re.compile(POINT)


def _read_module(reading: Reading, node: Node | None) -> dict[str, float | str]:
    """Return the inputs (SI) and choices the study sets; every problem is noted."""
    module: dict[str, float | str] = {}
    for name, (key, value) in entries(
        reading.problems, node, "module", "names of the module's inputs, each with a value"
    ).items():
        path, row = step("module", name), reading.table.by_name.get(name)
        read: float | str | None = None
        if isinstance(row, Choice):
            read = choice(reading, value, path, row)
        elif isinstance(row, Input) and not row.per_point:
            read = quantity(reading.problems, value, path, row)
        elif isinstance(row, Input):
            reading.problems.add(
                key, path, "belongs to an operating point", "it under `operating_points`, for each point"
            )
        elif row is not None:
            reading.problems.add(key, path, "is a result and cannot be set", "an input", "limit it under `require`")
        else:
            reading.unknown_quantity(key, path, "input or choice", name, [row.name for row in settable(reading.table)])
        if read is not None:
            module[name] = read
    return module


def _read_points(reading: Reading, node: Node | None) -> dict[str, dict[str, float]]:
    """Return every operating point in full (SI): the study's values over the standard ones over the defaults."""
    rows = {row.name: row for row in reading.table.inputs if row.per_point}
    all_points = {name: _standard(name, rows) for name in STANDARD_POINTS}
    expected = "operating points, each with its " + ", ".join(rows)
    for name, (key, value) in list(entries(reading.problems, node, "operating_points", expected).items()):
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
            missing = [row.name for row in rows.values() if _unset(row, all_points[name]) and row.name not in given]
            if missing:
                reading.problems.add(key, path, f"has no {' and no '.join(missing)}", _examples(missing, rows))
    return all_points


def _point(reading: Reading, node: Node, path: str, rows: dict[str, Input]) -> dict[str, float]:
    values: dict[str, float] = {}
    expected = "values such as " + _examples(list(rows), rows)
    for name, (key, value) in entries(reading.problems, node, path, expected).items():
        where = step(path, name)
        if name not in rows:
            reading.problems.unknown(key, where, "input of an operating point", name, rows)
            continue
        read = quantity(reading.problems, value, where, rows[name])
        if read is not None:
            values[name] = read
    return values


def _standard(point: str, rows: dict[str, Input]) -> dict[str, float]:
    own = STANDARD_POINTS.get(point, {})
    values = {row.name: own.get(row.name, row.default) for row in rows.values()}
    return {name: value for name, value in values.items() if value is not None}


def _unset(row: Input, values: dict[str, float]) -> bool:
    return row.name not in values and row.record is None


def _examples(names: list[str], rows: dict[str, Input]) -> str:
    units = {name: "" if rows[name].unit == "1" else f" {rows[name].unit}" for name in names}
    return ", ".join(f"'{name}: 1{units[name]}'" for name in names) or one_of([])


def written_value(table: Table, name: str, value: float | str) -> str:
    """Return the value of an input or a choice as it is written."""
    return value if isinstance(value, str) else exactly(value, table.unit(name))


def _write_points(study: Study) -> dict[str, dict[str, str]]:
    return {
        point: {name: written_value(study.table, name, value) for name, value in values.items()}
        for point, values in study.operating_points.items()
    }


def _points_schema(table: Table) -> Schema:
    point = mapping({row.name: set_schema(row) for row in table.inputs if row.per_point})
    return mapping({}, {f"^{POINT}$": {"description": "one operating point", **point}})


def _check_profile(reading: Reading) -> None:
    """Note each profile of a current that has no range in which it could change."""
    if not reading.mode:
        return
    vary, vary_node = reading.section("vary"), reading.nodes.get("vary")
    for phase, (_, node) in entries(Mistakes(""), reading.nodes.get("profile"), "profile", "").items():
        if phase not in ProfileOptions.model_fields:
            continue  # it has been noted
        row = reading.table.phase(phase).current_input
        if row not in vary and isinstance(vary_node, Mapping) and row in vary_node.entries:
            continue  # what is wrong with that range has been noted
        if not isinstance(vary.get(row), Range) and not (isinstance(node, Text) and node.value.strip() == "0"):
            message = f"the current of this phase has no range: `vary.{row}` is missing"
            reading.problems.add(node, step("profile", phase), message, f"{row}: [0.1 A, 3 A] under `vary`, for one")


MODULE = Section(
    "module", "inputs and choices of the module", _read_module,
    lambda table: mapping({row.name: set_schema(row) for row in settable(table)}),
    lambda study: {name: written_value(study.table, name, value) for name, value in study.module.items()},
)  # fmt: skip
POINTS = Section(
    "operating_points", "temperatures and frequencies for stiffness and damping; `cold` and `hot` always exist",
    _read_points, _points_schema, _write_points,
)  # fmt: skip
PROFILE = settings(
    "profile",
    "straight pieces in which the current of a phase changes with time; 0 keeps it constant",
    ProfileOptions,
    _check_profile,
)
SOLVER = settings("solver", "effort of the search and fineness of the heat model", SolverOptions)
WRITE = settings("write", "files in the results folder besides the numbers", WriteOptions)
