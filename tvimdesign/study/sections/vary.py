"""The section `vary`: which inputs may change, and between what or among which values."""

import math
from typing import Any

from tvimdesign.base.errors import CatalogError
from tvimdesign.base.units import format_quantity
from tvimdesign.device import Choice, Input, Table
from tvimdesign.study.sections.section import Schema, Section, described, mapping, settable, shape, value_schema
from tvimdesign.study.sections.settings import written_value
from tvimdesign.study.study import Options, Range, Study, Vary
from tvimdesign.study.text import values
from tvimdesign.study.text.mistakes import RefusedError, one_of, quoted, step
from tvimdesign.study.text.yaml_text import Mapping, Node, Sequence, Text

MOST_OPTIONS = 200


def _read(reading: values.Reading, node: Node | None) -> dict[str, Vary]:
    vary, module = _ranges(reading, node), reading.section("module")
    _check_against_module(reading, vary, module)
    if node is not None and reading.has("vary") and not reading.has("minimize"):
        reading.problems.add(node, "vary", "there is nothing to improve: `minimize` is missing", "both or neither")
    return _with_start(vary, module)


def _ranges(reading: values.Reading, node: Node | None) -> dict[str, Vary]:
    rows: dict[str, Input | Choice] = {row.name: row for row in reading.table.inputs if row.variable}
    rows |= {row.name: row for row in reading.table.choices}
    known = {}
    expected = "names of variables, each with a range or list"
    for name, (key, value) in values.entries(reading.problems, node, "vary", expected).items():
        path = step("vary", name)
        if name in rows:
            known[name] = value
        elif name in reading.table.by_name:
            message, hint = _fixed(reading, name)
            reading.problems.add(key, path, message, one_of(list(rows)), hint)
        else:
            reading.unknown_quantity(key, path, "variable", name, rows)
    return values.readable(lambda name, value: _allowed(reading, value, step("vary", name), rows[name]), known)


def _fixed(reading: values.Reading, name: str) -> tuple[str, str]:
    """Say why a row cannot be varied, and what to do instead."""
    row = reading.table.by_name[name]
    if not isinstance(row, Input):
        return "is a result and cannot be varied", "limit it under `require`"
    if row.per_point:
        return "belongs to the operating points and cannot be varied", "give it under `operating_points`"
    return "cannot be varied", "give it under `module`"


def _allowed(reading: values.Reading, node: Node, path: str, row: Input | Choice) -> Vary:
    if isinstance(row, Choice):
        if not isinstance(node, Mapping) or list(node.entries) != ["choose"]:
            values.misfit(reading.problems, node, path, "a list of names {choose: [...]}")
        return _listed(reading, node.entries["choose"][1], path, row)
    if isinstance(node, Sequence):
        return _pair(reading, node, path, row)
    if not isinstance(node, Mapping) or not node.entries:
        values.misfit(reading.problems, node, path, _forms(row))
    kinds = [kind for kind in ("choose", "catalog") if kind in node.entries]
    steps = row.integer or "step" in node.entries
    span = ["from", "to", "step"] if steps else ["from", "to", "start"]
    known = {"choose": ["choose"], "catalog": ["catalog", "from", "to"]}.get(kinds[0] if kinds else "", span)
    parts = values.unknown_keys(
        reading.problems, node.entries, path, f"key beside {kinds[0]!r}" if kinds else "key", known
    )
    if len(parts) < len(node.entries):
        raise RefusedError
    if "choose" in parts:
        return _listed(reading, parts["choose"], path, row)
    if "catalog" in parts:
        return _read_sizes(reading, parts, path, row)
    return _steps(reading, node, parts, path, row) if steps else _span(reading, node, parts, path, row)


def _forms(row: Input) -> str:
    unit = "" if row.unit == "1" else f" {row.unit}"
    if row.integer:
        return "a list of whole numbers {choose: [3, 4, 6]} or {from: 3, to: 6}"
    return (
        f"a range [1{unit}, 2{unit}] or {{from: 1{unit}, to: 2{unit}}}, with a step, a list {{choose: [...]}} or "
        "{catalog: ...}"
    )


def _pair(reading: values.Reading, node: Sequence, path: str, row: Input) -> Range:
    if len(node.items) != 2:
        message = f"a list of {len(node.items)} does not fit here" if node.items else "the list is empty"
        reading.problems.refuse(node, path, message, _forms(row), "write several values as {choose: [...]}")
    ends = _quantities(reading, {f"{path}[{i}]": item for i, item in enumerate(node.items)}, row)
    return _checked(reading, node, path, row, *ends.values())


def _span(reading: values.Reading, node: Mapping, parts: dict[str, Node], path: str, row: Input) -> Range:
    ends = _ends(reading, node, parts, path, row)
    return _checked(reading, parts.get("start", node), path, row, ends["from"], ends["to"], ends.get("start"))


def _quantities(reading: values.Reading, nodes: dict[str, Node], row: Input) -> dict[str, float]:
    """Return values of an input by their paths; raises RefusedError, once all are read, if any is refused."""
    return values.all_readable(lambda path, node: values.quantity(reading.problems, node, path, row), nodes)


def _ends(reading: values.Reading, node: Mapping, parts: dict[str, Node], path: str, row: Input) -> dict[str, float]:
    """Return the values of `from`, `to` and the keys beside them. Raises RefusedError, with a problem noted."""
    missing = [key for key in ("from", "to") if key not in parts]
    if missing:
        reading.problems.add(node, path, f"{' and '.join(map(repr, missing))} missing", _forms(row))
    read = _quantities(reading, {f"{path}.{key}": value for key, value in parts.items()}, row)
    if missing:
        raise RefusedError
    return dict(zip(parts, read.values(), strict=True))


def _steps(reading: values.Reading, node: Mapping, parts: dict[str, Node], path: str, row: Input) -> Options:
    """Return sizes evenly spaced between two ends, such as quarters of a coil; whole things by default one by one."""
    place, refuse = parts.get("step", node), reading.problems.refuse
    width = 1.0
    if "step" in parts:
        width = values.in_unit(reading.problems, place, f"{path}.step", row.unit, values.expected_for(row))
        if width <= 0.0:
            refuse(place, f"{path}.step", "a step of that size leads nowhere", "a step above zero")
        if row.integer and not width.is_integer():
            refuse(place, f"{path}.step", "counts whole things", "a whole step")
    ends = _ends(reading, node, {key: parts[key] for key in ("from", "to") if key in parts}, path, row)
    lower, upper = ends["from"], ends["to"]
    if values.below(upper, lower):
        refuse(node, path, "the range is upside down", "from < to", "swap the two")
    count = int((upper - lower) / width * (1.0 + values.ROUNDING) + values.ROUNDING) + 1
    if count > MOST_OPTIONS:
        refuse(place, path, f"{count} sizes from end to end", f"1 to {MOST_OPTIONS}", "a longer step")
    return Options(values=tuple(lower + i * width for i in range(count)))


def _checked(
    reading: values.Reading, node: Node, path: str, row: Input, lower: float, upper: float, start: float | None = None
) -> Range:
    low, high = format_quantity(lower, row.unit), format_quantity(upper, row.unit)
    if row.integer:
        reading.problems.refuse(node, path, "counts whole things, which a range cannot hold", _forms(row))
    if not values.below(lower, upper):
        message = (
            f"the range ends where it begins, at {low}" if math.isclose(lower, upper, rel_tol=values.ROUNDING) else ""
        )
        hint = "to fix it, set it under `module`" if message else "swap the two"
        message = message or f"the range is upside down: from {low} to {high}"
        reading.problems.refuse(node, path, message, "from < to", hint)
    if start is not None and (values.below(start, lower) or values.below(upper, start)):
        shown = format_quantity(start, row.unit)
        reading.problems.refuse(node, f"{path}.start", f"{shown} lies outside the range", f"{low} to {high}")
    return Range(lower=lower, upper=upper, start=start)


def _listed(reading: values.Reading, node: Node, path: str, row: Input | Choice) -> Options:
    path = f"{path}.choose"
    if not isinstance(node, Sequence):
        values.misfit(reading.problems, node, path, "a list [..., ...]")
    if not 1 <= len(node.items) <= MOST_OPTIONS:
        message = f"the list has {len(node.items)} values" if node.items else "the list is empty"
        reading.problems.refuse(node, path, message, f"1 to {MOST_OPTIONS} values")
    options: list[float | str] = []

    def read(where: str, item: Node) -> None:
        value = values.read_input(reading, item, where, row)
        if _has(options, value):
            reading.problems.refuse(item, where, f"{_shown(item)} stands twice in the list", "each value once")
        options.append(value)

    values.all_readable(read, {f"{path}[{index}]": item for index, item in enumerate(node.items)})
    return Options(values=tuple(options))


def _check_against_module(reading: values.Reading, vary: dict[str, Vary], module: dict[str, float | str]) -> None:
    """Note each value under `module` that lies outside what `vary` allows for the same row."""
    node = reading.nodes.get("module")
    written = node.entries if isinstance(node, Mapping) else {}
    for name in [name for name in vary if name in module and name in written]:
        allowed, value, place, row = vary[name], module[name], written[name][1], reading.table.by_name[name]
        if isinstance(allowed, Options) and isinstance(value, str) and value not in allowed.values:
            span = " or ".join(str(option) for option in allowed.values)
        elif isinstance(value, float) and isinstance(row, Input):
            sizes = (allowed.lower, allowed.upper) if isinstance(allowed, Range) else tuple(map(float, allowed.values))
            low, high = min(sizes), max(sizes)
            if not values.below(value, low) and not values.below(high, value):
                continue
            span = f"{format_quantity(low, row.unit)} to {format_quantity(high, row.unit)}"
        else:
            continue
        message = f"{_shown(place)} lies outside what `vary` allows, where it would be the start"
        reading.problems.add(place, step("module", name), message, span, "widen the range or change the value")


def _with_start(vary: dict[str, Vary], module: dict[str, float | str]) -> dict[str, Vary]:
    """Give each range without a start of its own the value under `module`."""
    started = dict(vary)
    for name, allowed in vary.items():
        value = module.get(name)
        if isinstance(allowed, Range) and allowed.start is None and isinstance(value, float):
            inside = min(max(value, allowed.lower), allowed.upper)
            started[name] = allowed.model_copy(update={"start": inside})
    return started


def _has(options: list[float | str], value: float | str) -> bool:
    if isinstance(value, str):
        return value in options
    return any(isinstance(other, float) and math.isclose(other, value, rel_tol=values.ROUNDING) for other in options)


def _shown(node: Node) -> str:
    return quoted(node.value) if isinstance(node, Text) else "the value"


def _read_sizes(reading: values.Reading, parts: dict[str, Node], path: str, row: Input) -> Options:
    """Return the sizes a catalogue record lists for an input, within `from` and `to` where they are given."""
    node = parts["catalog"]
    ends = {key: parts[key] for key in ("from", "to") if key in parts}
    read = values.readable(lambda key, end: values.quantity(reading.problems, end, f"{path}.{key}", row), ends)
    name = values.text(
        reading.problems, node, f"{path}.catalog", f"the name of a record in the category {row.sizes_in[0]}"
    )
    sizes = _sizes(reading, node, f"{path}.catalog", name, row)
    if len(read) < len(ends):
        raise RefusedError
    low, high = read.get("from", row.lower), read.get("to", row.upper)
    if values.below(high, low):
        place = parts.get("from", node)
        reading.problems.refuse(place, path, "the range is upside down", "from < to", "swap the two")
    within = tuple(size for size in sizes if not values.below(size, low) and not values.below(high, size))
    if not within:
        first, last = format_quantity(sizes[0], row.unit), format_quantity(sizes[-1], row.unit)
        message = f"{name} has no size from {format_quantity(low, row.unit)} to {format_quantity(high, row.unit)}"
        reading.problems.refuse(node, path, message, f"part of {first} to {last}")
    return Options(values=within, source=name)


def _sizes(reading: values.Reading, node: Node, path: str, name: str, row: Input) -> list[float]:
    """Return every size the record lists, smallest first. Raises RefusedError where it lists none."""
    category, of, column = row.sizes_in
    try:
        table = values.record(reading, node, path, category, name).table(of)
    except CatalogError as error:
        reading.problems.refuse(node, path, str(error))
    sizes = sorted({float(line[column]) for line in table if column in line})
    if not sizes:
        columns = ", ".join(sorted({listed for line in table for listed in line}))
        message = f"{name} lists no {column}, only {columns or 'nothing'}"
        reading.problems.refuse(node, path, message, "a record that lists it")
    return sizes


def _schema(table: Table) -> Schema:
    rows = [row for row in settable(table) if isinstance(row, Choice) or row.variable]
    return mapping({row.name: {"description": described(row), "anyOf": _schemas(row)} for row in rows})


def _schemas(row: Input | Choice) -> list[Schema]:
    value = value_schema(row)
    forms = [shape({"choose": {"type": "array", "minItems": 1, "items": value}}, ["choose"])]
    if isinstance(row, Choice):
        return forms
    about = f"a record of the category {row.sizes_in[0]} that lists the sizes one can buy"
    ends = {"from": value, "to": value}
    forms.append(shape({"catalog": {"type": "string", "description": about}, **ends}, ["catalog"]))
    forms.append(shape({**ends, "step": value}, ["from", "to", *([] if row.integer else ["step"])]))
    if not row.integer:
        forms.append({"type": "array", "minItems": 2, "maxItems": 2, "items": value})
        forms.append(shape({**ends, "start": value}, ["from", "to"]))
    return forms


def _write(study: Study) -> dict[str, Any]:
    return {name: _written(study.table, name, allowed) for name, allowed in study.vary.items()}


def _written(table: Table, name: str, allowed: Vary) -> dict[str, Any]:
    if isinstance(allowed, Options):
        options = [written_value(table, name, value) for value in allowed.values]
        if allowed.source is None:
            return {"choose": options}
        return {"catalog": allowed.source, "from": options[0], "to": options[-1]}
    ends = {"from": allowed.lower, "to": allowed.upper, "start": allowed.start}
    return {key: written_value(table, name, end) for key, end in ends.items() if end is not None}


VARY = Section(
    "vary",
    "variables of the search, each with a range, a list or the sizes of a catalogue record",
    _read,
    _schema,
    _write,
)
