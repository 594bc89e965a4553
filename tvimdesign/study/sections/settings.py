"""Reads the sections `module` and `operating_points`: what the study fixes."""

from __future__ import annotations

import re

from tvimdesign.device import Choice, Input
from tvimdesign.study.study import STANDARD_POINTS
from tvimdesign.study.text.mistakes import one_of, quoted, step
from tvimdesign.study.text.values import Reading, choice, entries, quantity
from tvimdesign.study.text.yaml_text import Node

MOST_POINTS = 20
_POINT = re.compile(r"[a-z][a-z0-9_]{0,31}")


def read_module(reading: Reading, node: Node | None) -> dict[str, float | str]:
    """Return the inputs (SI) and choices the study sets; every problem is noted."""
    found: dict[str, float | str] = {}
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
            names = [row.name for row in reading.table.quantities if isinstance(row, Choice) or _fixed(row)]
            reading.unknown_quantity(key, path, "input or choice", name, names)
        if read is not None:
            found[name] = read
    return found


def read_points(reading: Reading, node: Node | None) -> dict[str, dict[str, float]]:
    """Return every operating point in full (SI): the study's values over the standard ones over the defaults."""
    rows = {row.name: row for row in reading.table.inputs if row.per_point}
    found = {name: _standard(name, rows) for name in STANDARD_POINTS}
    expected = "operating points, each with its " + ", ".join(rows)
    for name, (key, value) in list(entries(reading.problems, node, "operating_points", expected).items()):
        path = step("operating_points", name)
        if not _POINT.fullmatch(name) or "_at_" in name:
            shown = f"{quoted(name)} cannot name an operating point"
            reading.problems.add(key, path, shown, "a short word of lower-case letters, digits and _, without '_at_'")
        elif len(found) == MOST_POINTS and name not in found:
            reading.problems.add(key, path, f"more than {MOST_POINTS} operating points", "fewer")
            break
        else:
            own = _point(reading, value, path, rows)
            found[name] = _standard(name, rows) | own
            given = value_names(value)
            missing = [row.name for row in rows.values() if _unset(row, found[name]) and row.name not in given]
            if missing:
                reading.problems.add(key, path, f"has no {' and no '.join(missing)}", _examples(missing, rows))
    return found


def value_names(node: Node) -> list[str]:
    """The keys of a mapping, none of anything else."""
    return list(getattr(node, "entries", {}))


def _point(reading: Reading, node: Node, path: str, rows: dict[str, Input]) -> dict[str, float]:
    found: dict[str, float] = {}
    expected = "values such as " + _examples(list(rows), rows)
    for name, (key, value) in entries(reading.problems, node, path, expected).items():
        where = step(path, name)
        if name not in rows:
            reading.problems.unknown(key, where, "input of an operating point", name, rows)
            continue
        read = quantity(reading.problems, value, where, rows[name])
        if read is not None:
            found[name] = read
    return found


def _standard(point: str, rows: dict[str, Input]) -> dict[str, float]:
    own = STANDARD_POINTS.get(point, {})
    values = {row.name: own.get(row.name, row.default) for row in rows.values()}
    return {name: value for name, value in values.items() if value is not None}


def _unset(row: Input, values: dict[str, float]) -> bool:
    return row.name not in values and row.record is None


def _examples(names: list[str], rows: dict[str, Input]) -> str:
    units = {name: "" if rows[name].unit == "1" else f" {rows[name].unit}" for name in names}
    return ", ".join(f"'{name}: 1{units[name]}'" for name in names) or one_of([])


def _fixed(row: object) -> bool:
    return isinstance(row, Input) and not row.per_point
