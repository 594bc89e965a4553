"""The sections `tolerances` and `robust`: how far inputs lie from what is drawn, and what must hold anyway."""

import re
from collections.abc import Iterable
from contextlib import suppress
from functools import partial
from typing import Any

from tvimdesign.base.errors import UnitError
from tvimdesign.base.record import own_data
from tvimdesign.base.units import format_quantity, parse_quantity
from tvimdesign.device import Input, Output, Table
from tvimdesign.study.sections.section import NUMBER, NUMBER_VALUE, POINT, Schema, Section, described, mapping, shape
from tvimdesign.study.study import Robust, Study, Tolerance
from tvimdesign.study.text import values
from tvimdesign.study.text.mistakes import RefusedError, one_of, quoted, step
from tvimdesign.study.text.yaml_text import Mapping, Node, Text

STANDARD = "standard"
_SHARE = re.compile(r"(?P<number>[^%]*[0-9.])\s*%")
_KEYS = ["plus_minus", "row", "distribution", "sigma", "adjustable", "adjusted_to"]
_ROBUST_KEYS: Schema = {
    "sigma": {"description": "standard deviations between each limit and the nominal design", **NUMBER_VALUE},
    "yield": {"description": "share of modules that must satisfy all limits", **NUMBER_VALUE},
    "plausible": {
        "description": "beside it: share of the plausible cases that must satisfy each limit",
        **NUMBER_VALUE,
    },
}
_MOST_SIGMAS = 6.0


standard_entries = partial(own_data, __file__, "tolerances.yaml")  # The usual tolerances by input


def standard_tolerances(table: Table) -> dict[str, Tolerance]:
    """Return the usual tolerances of a mode's inputs."""
    return {name: _standard(table, name, entry) for name, entry in standard_entries().items() if name in table.by_name}


def _standard(table: Table, name: str, entry: dict[str, Any]) -> Tolerance:
    unit = values.difference_unit(table.unit(name))
    size: dict[str, Any] = {"row": entry["row"]} if "row" in entry else _size(str(entry["plus_minus"]), unit)
    adjusted = parse_quantity(str(entry["adjusted_to"]), unit) if "adjusted_to" in entry else None
    return Tolerance(
        **size, distribution=entry["distribution"], sigma=entry.get("sigma", 3.0), adjusted_to=adjusted,
        source=entry["source"], status=entry["status"],
    )  # fmt: skip


def _size(written: str, unit: str) -> dict[str, float]:
    share = _SHARE.fullmatch(written)
    if share:
        return {"share": parse_quantity(share["number"], "1") / 100.0}
    return {"plus_minus": parse_quantity(written, unit)}


def tolerance_rows(table: Table) -> list[str]:
    """Return the outputs that give the tolerance of an input."""
    return [row.name for row in table.outputs if row.name.endswith("_tolerance") and not row.per_point]


def _read_tolerances(reading: values.Reading, node: Node | None) -> dict[str, Tolerance]:
    if isinstance(node, Text) and node.value == STANDARD:
        return standard_tolerances(reading.table)
    expected = f"{STANDARD}, or names of inputs, each with a plus-minus value"
    section = values.entries(reading.problems, node, "tolerances", expected)
    tolerances: dict[str, Tolerance] = {}
    for name, (key, value) in sorted(section.items(), key=lambda entry: entry[0] != STANDARD):
        path = step("tolerances", name)
        with suppress(RefusedError):
            if name != STANDARD:
                row = _input(reading, key, path, name)
                tolerances[name] = _tolerance(reading, value, path, row, tolerances.get(name))
            elif values.flag(reading.problems, value, path):
                tolerances = standard_tolerances(reading.table)
    return tolerances


def _input(reading: values.Reading, key: Text, path: str, name: str) -> Input:
    base, _, point = name.partition("@")
    row, refuse = reading.table.by_name.get(base), reading.problems.refuse
    if row is None:
        names = [quantity.name for quantity in reading.table.inputs if not quantity.integer]
        reading.unknown_quantity(key, path, "input", base, names)
        raise RefusedError
    if not isinstance(row, Input):
        what = "is a result" if isinstance(row, Output) else "is a word"
        refuse(key, path, f"{what} and has no tolerance of its own", "an input")
    if point and row.per_point and point not in reading.points:
        reading.problems.unknown(key, path, f"operating point: {quoted(point)}", point, reading.points)
        raise RefusedError
    if row.integer:
        refuse(key, path, "counts whole things and has no tolerance")
    if row.per_point != bool(point):
        expected = f"{base}@<operating point>" if row.per_point else repr(base)
        refuse(key, path, "belongs to an operating point" if row.per_point else "has no points", expected)
    return row


def _forms(row: Input) -> str:
    unit = values.difference_unit(row.unit)
    share = "" if row.unit == "degC" else " or '5 %'"
    return f"a plus-minus value such as '0.1{'' if unit == '1' else ' ' + unit}'{share}, or {{plus_minus: ...}}"


def _tolerance(reading: values.Reading, node: Node, path: str, row: Input, standard: Tolerance | None) -> Tolerance:
    if isinstance(node, Text):
        return Tolerance(**_read_size(reading, node, path, row), source="the study", status="stated")
    if not isinstance(node, Mapping) or not node.entries:
        values.misfit(reading.problems, node, path, _forms(row))
    before = len(reading.problems.items)
    parts = values.unknown_keys(reading.problems, node.entries, path, "key", _KEYS)
    read = values.readable(lambda key, part: _part(reading, part, f"{path}.{key}", key, row), parts)
    given = [key for key in ("plus_minus", "row") if key in parts]
    if len(given) == 2 or (not given and standard is None):
        problem = "both 'plus_minus' and 'row'" if given else "'plus_minus' missing"
        reading.problems.add(node, path, problem, _forms(row))
    if len(reading.problems.items) > before or len(read) < len(parts):
        raise RefusedError
    fields = {} if standard is None else standard.model_dump()
    if given:
        fields |= {"plus_minus": None, "share": None, "row": None, "source": "the study", "status": "stated"}
    for part in read.values():
        fields |= part
    return Tolerance(**fields)


def _part(reading: values.Reading, node: Node, path: str, key: str, row: Input) -> dict[str, Any]:
    """Return the fields that a study states under a key."""
    match key:
        case "plus_minus":
            return _read_size(reading, node, path, row)
        case "row":
            return {"row": _read_row(reading, node, path, row)}
        case "distribution":
            return {"distribution": values.word_of(reading.problems, node, path, ["normal", "uniform"])}
        case "sigma":
            return {"sigma": _sigmas(reading, node, path)}
        case "adjustable":
            return {"adjustable": values.flag(reading.problems, node, path)}
    left = _read_size(reading, node, path, row)
    if "share" in left:
        reading.problems.refuse(node, path, "is a share", f"a value in {row.unit}")
    return {"adjusted_to": left["plus_minus"]}


def _read_size(reading: values.Reading, node: Node, path: str, row: Input) -> dict[str, float]:
    """Return a plus-minus value in SI, or a share of the value if it is written in percent."""
    word, refuse = values.text(reading.problems, node, path, _forms(row)), reading.problems.refuse
    share = _SHARE.fullmatch(word)
    unit = "1" if share else values.difference_unit(row.unit)
    value = values.si_value(reading.problems, node, path, share["number"] if share else word, unit)
    if value < 0.0 or (share and value >= 100.0):
        limit = "0 to 100 %" if share else "0 or more: it counts to either side"
        refuse(node, path, f"{quoted(word)} cannot be a tolerance", limit)
    if share and row.unit == "degC":
        refuse(node, path, f"{quoted(word)}: a temperature has no share", _forms(row))
    if not share and row.upper - row.lower < value:
        span = f"{format_quantity(row.lower, row.unit)} to {format_quantity(row.upper, row.unit)}"
        refuse(node, path, f"{quoted(word)} is wider than all that {row.name} may be", span)
    return {"share": value / 100.0} if share else {"plus_minus": value}


def _read_row(reading: values.Reading, node: Node, path: str, row: Input) -> str:
    rows = tolerance_rows(reading.table)
    word = values.text(reading.problems, node, path, one_of(rows))
    if word not in rows:
        reading.problems.unknown(node, path, f"row that gives a tolerance: {quoted(word)}", word, rows)
        raise RefusedError
    try:
        parse_quantity(f"1 {reading.table.unit(word)}", values.difference_unit(row.unit))
    except UnitError:
        reading.problems.refuse(node, path, f"{word} is in {reading.table.unit(word)}", f"a row in {row.unit}")
    return word


def _sigmas(reading: values.Reading, node: Node, path: str) -> float:
    expected = f"a count of standard deviations, above 0 and at most {_MOST_SIGMAS:g}"
    value = values.number(reading.problems, node, path, expected)
    if not 0.0 < value <= _MOST_SIGMAS:
        reading.problems.refuse(node, path, f"{value:g} is out of range", expected)
    return value


def _read_robust(reading: values.Reading, node: Node | None) -> Robust | None:
    """Return how far within its limits a design must stay, or how many modules must keep all."""
    expected = "{sigma: 3} or {yield: 99 %}"
    given = values.entries(reading.problems, node, "robust", expected)
    parts = values.unknown_keys(reading.problems, given, "robust", "key", list(_ROBUST_KEYS))
    if node is None or not parts:
        return None
    if len(parts) > 1 and "sigma" in parts:
        other = next(key for key in parts if key != "sigma")
        reading.problems.refuse(node, "robust", f"both 'sigma' and '{other}'", expected)
    if "yield" not in parts and "sigma" not in parts:
        reading.problems.refuse(node, "robust", "'plausible' without 'yield'", "{yield: 95 %, plausible: 80 %}")
    if not reading.section("tolerances"):
        message = "there is nothing to be robust against: `tolerances` is missing"
        reading.problems.add(node, "robust", message, "`tolerances: standard`, for one")
    if "sigma" in parts:
        return Robust(sigma=_sigmas(reading, parts["sigma"], "robust.sigma"))
    shares = values.all_readable(lambda key, value: _share(reading, value, f"robust.{key}"), parts)
    return Robust(share=shares["yield"], plausible=shares.get("plausible"))


def _share(reading: values.Reading, node: Node, path: str) -> float:
    share = values.number(reading.problems, node, path, "a share such as 99 %")
    if not 0.5 < share < 1.0 - 1e-9:
        reading.problems.refuse(node, path, f"{share:g} is out of range", "above 50 % and below 100 %")
    return share


def tolerance_schema(tables: Iterable[Table]) -> Schema:
    """Return the schema of one tolerance of any input."""
    size = {"anyOf": [{"type": "number"}, {"type": "string", "pattern": rf"^\s*{NUMBER}"}]}
    rows = sorted({name for table in tables for name in tolerance_rows(table)})
    full = {
        "plus_minus": size, "row": {"enum": rows}, "distribution": {"enum": ["normal", "uniform"]},
        "sigma": NUMBER_VALUE, "adjustable": {"type": "boolean"}, "adjusted_to": size,
    }  # fmt: skip
    return {"anyOf": [size, shape(full, [])]}


def _tolerances_schema(table: Table) -> Schema:
    reference: Schema = {"allOf": [{"$ref": "#/definitions/tolerance"}]}
    rows = [row for row in table.inputs if not row.integer]
    points = {f"^{row.name}@{POINT}$": {"description": described(row), **reference} for row in rows if row.per_point}
    named = {row.name: {"description": described(row), **reference} for row in rows if not row.per_point}
    return {"anyOf": [mapping({STANDARD: {"type": "boolean"}, **named}, points), {"const": STANDARD}]}


def _write_tolerances(study: Study) -> dict[str, Any]:
    """Return each tolerance; if all the usual ones are there, only that they are and what differs from them."""
    table, tolerances, usual = study.table, study.tolerances, standard_tolerances(study.table)
    usual = usual if usual.keys() <= tolerances.keys() else {}
    entries_written: dict[str, Any] = {STANDARD: "true"} if usual else {}
    for name, tolerance in tolerances.items():
        if tolerance != usual.get(name):
            entries_written[name] = _written(table, name, tolerance, usual.get(name))
    return entries_written


def _written(table: Table, name: str, tolerance: Tolerance, usual: Tolerance | None) -> dict[str, Any]:
    row = table.by_name[name.partition("@")[0]]
    unit = values.difference_unit(row.unit if isinstance(row, Input) else "1")
    size: dict[str, Any] = {"row": tolerance.row} if tolerance.row else {"plus_minus": _written_size(tolerance, unit)}
    size = {} if usual and tolerance.source == usual.source else size
    left = {} if tolerance.adjusted_to is None else {"adjusted_to": values.exactly(tolerance.adjusted_to, unit)}
    return {
        **size,
        "distribution": tolerance.distribution,
        "sigma": tolerance.sigma,
        "adjustable": tolerance.adjustable,
        **left,
    }


def _written_size(tolerance: Tolerance, unit: str) -> str | None:
    if tolerance.share is not None:
        return values.exactly(tolerance.share, "percent").replace(" percent", " %")
    return None if tolerance.plus_minus is None else values.exactly(tolerance.plus_minus, unit)


def _write_robust(study: Study) -> dict[str, float | str]:
    if study.robust is None:
        return {}
    if study.robust.sigma is not None:
        return {"sigma": study.robust.sigma}
    shares = {"yield": study.robust.share, "plausible": study.robust.plausible}
    return {key: values.exactly(share, "%") for key, share in shares.items() if share is not None}


TOLERANCES = Section(
    "tolerances", "deviations of inputs from their nominal values; `standard` takes the usual ones",
    _read_tolerances, _tolerances_schema, _write_tolerances,
)  # fmt: skip
ROBUST = Section(
    "robust", "distance from each limit in standard deviations, or the share of modules that must satisfy all limits",
    _read_robust,
    mapping(_ROBUST_KEYS) | {"dependencies": {"plausible": ["yield"]}, "not": {"required": ["sigma", "yield"]}},
    _write_robust,
)  # fmt: skip
