"""The section `sweep`: which cells are laid over which axes, and what is done in each."""

from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Literal

from tvimdesign.device import Choice, Input, Table
from tvimdesign.study.sections.goals import named_output, read_limit, read_output
from tvimdesign.study.sections.section import Schema, Section, mapping, output_name, set_schema, settable, shape
from tvimdesign.study.text import values
from tvimdesign.study.text.mistakes import RefusedError, quoted, step
from tvimdesign.study.text.yaml_text import Mapping, Node, Sequence, Text

Sense = Literal["<=", ">=", ""]
METHODS = ("grid", "list", "latin_hypercube", "sobol")
SAMPLED = ("latin_hypercube", "sobol")
TASKS = ("evaluate", "optimize")
EVERY_OUTPUT = "all"
MOST_CELLS = 100_000  # Cells of a sweep unless it says `most`: a typing error is not to become a month of work


@dataclass(frozen=True)
class SweptRange:
    """Numbers between two ends: `count` of them in a grid; drawn where a sweep is sampled."""

    lower: float  # SI
    upper: float
    count: int = 0
    logarithmic: bool = False


@dataclass(frozen=True)
class SweptAxis:
    """One thing that is swept: its name as `--set` takes it, and its values as they are written, or a range."""

    name: str
    unit: str  # Of its numbers; empty for words and for settings
    whole: bool  # True if it counts things
    number: bool  # True for a size of the module or a condition, which a search from a neighbour can follow
    sense: Sense = ""  # Of a limit
    values: tuple[Text, ...] = ()
    range: SweptRange | None = None


@dataclass(frozen=True)
class SweepBlock:
    """A `sweep:` section."""

    method: str
    axes: tuple[SweptAxis, ...]
    rows: tuple[tuple[Text, ...], ...] = ()  # The cells of a list, a value for each axis
    task: str = ""  # `evaluate` or `optimize`; what the study asks for where it is empty
    count: int = 0  # Cells of a sample
    seed: int = 1
    outputs: tuple[str, ...] = ()  # Outputs that are kept beside those the study asks about
    most: int = MOST_CELLS


_SWEPT_SECTIONS = ("require", "operating_points", "profile", "solver", "minimize", "robust")
"""Sections in which what stands at a path can be swept."""
_RANGE_KEYS = ["from", "to", "count", "step", "spacing"]
_SPACINGS = ("linear", "logarithmic")
_COUNT: Schema = {"type": "integer", "minimum": 1}
_FIELDS: Schema = {
    "method": {"enum": list(METHODS), "description": "arrangement of the cells; default: a grid"},
    "over": {"description": "axes: lists of values, or ranges"},
    "cells": {"type": "array", "minItems": 1, "description": "the cells of a list, one by one"},
    "task": {"enum": list(TASKS), "description": "task in each cell; default: what the study asks"},
    "count": {**_COUNT, "description": f"cells of a sample ({', '.join(SAMPLED)})"},
    "seed": {"type": "integer", "minimum": 0, "description": "seed of a sample; default 1"},
    "outputs": {"description": "further outputs in the tables"},
    "most": {**_COUNT, "description": f"largest number of cells; default {MOST_CELLS}"},
}
"""The keys; those that depend on the mode are completed by `_schema`."""
_WHOLE_NUMBERS = {"count": (1, 10**9), "seed": (0, 2**32 - 1), "most": (1, 10**9)}  # Keys, with their ends
_EXAMPLE = "'over: {pcl_thickness: {from: 0.6 mm, to: 2 mm, count: 20}}'"


def _read(reading: values.Reading, node: Node | None) -> SweepBlock | None:
    problems = reading.problems
    parts = values.unknown_keys(
        problems, values.entries(problems, node, "sweep", _EXAMPLE), "sweep", "key", list(_FIELDS)
    )
    if node is None or not parts:
        return None
    usual = "list" if "cells" in parts else "grid"
    method = values.word_of(problems, parts.get("method"), "sweep.method", METHODS) or usual
    before = len(problems.items)
    axes, rows = _listed(reading, parts, node) if method == "list" else (_axes(reading, parts, node, method), ())
    counts = _counts(reading, parts, node, method)
    block = SweepBlock(
        method=method, axes=axes, rows=rows, task=values.word_of(problems, parts.get("task"), "sweep.task", TASKS),
        outputs=_outputs(reading, parts.get("outputs")), **counts,
    )  # fmt: skip
    return None if len(problems.items) > before else block


def _counts(reading: values.Reading, parts: dict[str, Node], node: Node, method: str) -> dict[str, int]:
    """Return the whole numbers that are given."""
    if method in SAMPLED and "count" not in parts:
        reading.problems.add(node, "sweep", f"how many cells are drawn is missing ({method})", "'count: 256', for one")
    elif method not in SAMPLED and "count" in parts:
        message = f"a {method} has as many cells as its axes give"
        reading.problems.add(parts["count"], "sweep.count", message, "'count' at a range of `over`")

    def read(key: str, part: Node) -> int:
        (least, most), path = _WHOLE_NUMBERS[key], step("sweep", key)
        value = values.whole(reading.problems, part, path)
        if not least <= value <= most:
            reading.problems.refuse(part, path, f"{value} does not fit here", f"{least} to {most}")
        return value

    return values.readable(read, {key: parts[key] for key in _WHOLE_NUMBERS if key in parts})


def _outputs(reading: values.Reading, node: Node | None) -> tuple[str, ...]:
    if node is None:
        return ()
    if isinstance(node, Text) and node.value == EVERY_OUTPUT:
        return (EVERY_OUTPUT,)
    if isinstance(node, Sequence):
        listed = dict(enumerate(node.items))
        return tuple(
            values.readable(lambda i, item: read_output(reading, item, f"sweep.outputs[{i}]"), listed).values()
        )
    with suppress(RefusedError):
        values.misfit(reading.problems, node, "sweep.outputs", f"a list of outputs, or {EVERY_OUTPUT}")
    return ()


def _axes(reading: values.Reading, parts: dict[str, Node], node: Node, method: str) -> tuple[SweptAxis, ...]:
    if "cells" in parts:
        reading.problems.add(parts["cells"], "sweep.cells", f"a {method} has no list of cells", "'method: list'")
    over = parts.get("over")
    named = values.entries(reading.problems, over, "sweep.over", _EXAMPLE)
    if not named and (over is None or isinstance(over, Mapping | Text)):
        reading.problems.add(over or node, "sweep.over", "nothing is swept: it has no axis", _EXAMPLE)
    return tuple(values.readable(lambda name, entry: _swept(reading, name, *entry, method), named).values())


def _swept(reading: values.Reading, name: str, key: Text, node: Node, method: str) -> SweptAxis:
    path = step("sweep.over", name)
    axis = _axis(reading, key, path, name)
    if isinstance(node, Mapping):
        return _range(reading, node, path, axis, method)
    if not isinstance(node, Sequence) or not node.items:
        message = "is an empty list" if isinstance(node, Sequence) else "is no list of values"
        reading.problems.refuse(node, path, message, "[a, b, c], or {from: ..., to: ..., count: ...}")
    listed = dict(enumerate(node.items))
    return replace(
        axis, values=tuple(values.readable(lambda i, item: _single(reading, item, f"{path}[{i}]"), listed).values())
    )


def _single(reading: values.Reading, node: Node, path: str) -> Text:
    if not isinstance(node, Text) or node.empty:
        values.misfit(reading.problems, node, path, "one value")
    return node


def _listed(
    reading: values.Reading, parts: dict[str, Node], node: Node
) -> tuple[tuple[SweptAxis, ...], tuple[tuple[Text, ...], ...]]:
    """Read the axes and rows of `cells: [{pcl_thickness: 1 mm, current: 1 A}, ...]`."""
    expected, add = "a list such as [{pcl_thickness: 1 mm, current: 1 A}, ...]", reading.problems.add
    cells = parts.get("cells")
    if "over" in parts:
        add(parts["over"], "sweep.over", "a list of cells has no axes of its own", "'cells', or a grid")
    if not isinstance(cells, Sequence) or not cells.items:
        add(cells or node, "sweep.cells", "there is no list of cells", expected)
        return (), ()
    axes: dict[str, SweptAxis] = {}
    rows = []
    for i, item in enumerate(cells.items):
        path = f"sweep.cells[{i}]"
        named = values.entries(reading.problems, item, path, expected)
        for name, (key, _) in named.items():
            with suppress(RefusedError):
                axis = axes.get(name) or _axis(reading, key, step(path, name), name)
                if i and name not in axes:
                    add(key, step(path, name), "is not in the first cell", "the same names in each cell")
                else:
                    axes[name] = axis
        texts = values.readable(
            lambda where, value: _single(reading, value, where),
            {step(path, name): value for name, (_, value) in named.items()},
        )
        if missing := [name for name in axes if name not in named]:
            add(item, path, f"has no {' and no '.join(missing)}", "the same names in each cell")
        else:
            rows.append(tuple(texts[step(path, name)] for name in axes if step(path, name) in texts))
    return tuple(axes.values()), tuple(rows)


def _axis(reading: values.Reading, key: Text, path: str, name: str) -> SweptAxis:
    """Return the axis that a name under `over` means, still without values. Raises RefusedError."""
    section, _, path_in_section = name.partition(".")
    if not path_in_section:
        return _of_module(reading, key, path, name)
    if section not in _SWEPT_SECTIONS:
        reading.problems.unknown(key, path, f"section to sweep in: {quoted(section)}", section, _SWEPT_SECTIONS)
        raise RefusedError
    if section == "require":
        row = named_output(reading, key, path, path_in_section)
        return SweptAxis(name, row.unit, whole=False, number=False)
    point = path_in_section.partition(".")[2] if section == "operating_points" else ""
    value = reading.table.by_name.get(point)
    if isinstance(value, Input) and value.per_point:
        return SweptAxis(name, value.unit, whole=value.integer, number=not value.integer)
    return SweptAxis(name, "", whole=False, number=False)


def _of_module(reading: values.Reading, key: Text, path: str, name: str) -> SweptAxis:
    row, refuse = reading.table.by_name.get(name), reading.problems.refuse
    if isinstance(row, Choice):
        return SweptAxis(name, "", whole=False, number=False)
    if isinstance(row, Input) and not row.per_point:
        return SweptAxis(name, row.unit, whole=row.integer, number=not row.integer)
    if isinstance(row, Input):
        refuse(key, path, "belongs to an operating point", f"'operating_points.hot.{name}', for one")
    if row is not None:
        refuse(key, path, "is a result and cannot be set", f"'require.{name}' to sweep a limit on it")
    names = [quantity.name for quantity in reading.table.quantities if isinstance(quantity, Choice | Input)]
    reading.unknown_quantity(key, path, "input or choice", name, names)
    raise RefusedError


def _range(reading: values.Reading, node: Mapping, path: str, axis: SweptAxis, method: str) -> SweptAxis:
    problems = reading.problems
    parts = values.unknown_keys(problems, node.entries, path, "key", _RANGE_KEYS)
    if not axis.unit:
        problems.refuse(node, path, "has no numbers between two ends", "a list of values [..., ...]")
    ends = {key: parts[key] for key in ("from", "to") if key in parts}
    if missing := [key for key in ("from", "to") if key not in ends]:
        problems.refuse(node, path, f"{' and '.join(map(repr, missing))} missing", "{from: ..., to: ...}")
    read = values.all_readable(lambda key, end: _end(reading, end, f"{path}.{key}", axis), ends)
    (lower, sense), (upper, other) = read["from"], read["to"]
    logarithmic = values.word_of(problems, parts.get("spacing"), f"{path}.spacing", _SPACINGS) == "logarithmic"
    if sense != other:
        problems.refuse(node, path, f"begins with {sense} and ends with {other}", "the same sense at both ends")
    if not values.below(lower, upper):
        problems.refuse(node, path, "the range is upside down or has no length", "from < to", "swap the two")
    if logarithmic and lower <= 0.0:
        problems.refuse(parts["from"], f"{path}.from", "a logarithmic range begins above 0", "a value above 0")
    count = _steps(reading, node, parts, path, axis, (lower, upper), method)
    return replace(axis, sense=sense, range=SweptRange(lower, upper, count, logarithmic))


def _end(reading: values.Reading, node: Node, path: str, axis: SweptAxis) -> tuple[float, Sense]:
    """Return an end of a range in SI, with its sense if it is a limit."""
    section, _, output = axis.name.partition(".")
    if section == "require":
        limit = read_limit(reading, node, path, output, reading.table.output(output.partition("@")[0]))
        return limit.limit, limit.sense
    row = reading.table.quantity(axis.name.rpartition(".")[2])
    assert isinstance(row, Input)  # what has a unit and is no limit
    return values.quantity(reading.problems, node, path, row), ""


def _steps(
    reading: values.Reading, node: Mapping, parts: dict[str, Node], path: str, axis: SweptAxis,
    ends: tuple[float, float], method: str,
) -> int:  # fmt: skip
    """Return the number of values of a range in a grid; 0 in a sample."""
    given, problems = [key for key in ("count", "step") if key in parts], reading.problems
    if method in SAMPLED:
        for key in given:
            problems.add(parts[key], f"{path}.{key}", f"a sample ({method}) draws between the ends", "no steps")
        return 0
    if len(given) != 1 and (given or not axis.whole):
        problems.refuse(node, path, "needs 'count' or 'step', one of the two", "{from: ..., to: ..., count: 20}")
    if "count" in parts:
        count = values.whole(problems, parts["count"], f"{path}.count")
        if count < 2:
            problems.refuse(parts["count"], f"{path}.count", f"{count} values between two ends", "2 or more")
        return count
    if "spacing" in parts:
        problems.add(parts["spacing"], f"{path}.spacing", "steps are even", "'count' with a spacing")
    width = 1.0
    if "step" in parts:
        unit, steps = values.difference_unit(axis.unit), {f"{path}.step": parts["step"]}
        read = values.readable(
            lambda where, node: values.in_unit(problems, node, where, unit, f"a step in {unit}"), steps
        )
        width = sum(read.values())
        if width <= 0.0:
            problems.refuse(parts["step"], f"{path}.step", "leads nowhere", "a step above zero")
    return int((ends[1] - ends[0]) / width * (1.0 + values.ROUNDING) + values.ROUNDING) + 1


def _schema(table: Table) -> Schema:
    settings = {row.name: set_schema(row) for row in settable(table)}
    words = {row.name for row in settable(table) if isinstance(row, Choice)}
    quantity: Schema = {"type": ["string", "number"]}
    paths = rf"^({'|'.join(_SWEPT_SECTIONS)})\."
    over = shape({name: _axis_schema(value, ranged=name not in words) for name, value in settings.items()}, [])
    del over["required"]
    over |= {"minProperties": 1, "patternProperties": {paths: _axis_schema(quantity, ranged=True)}}
    cell = {
        "type": "object", "additionalProperties": False, "properties": settings, "patternProperties": {paths: quantity},
    }  # fmt: skip
    outputs = [{"const": EVERY_OUTPUT}, {"type": "array", "items": output_name(table)}]
    by_mode: Schema = {"over": over, "cells": {"items": cell}, "outputs": {"anyOf": outputs}}
    return mapping({name: {**field, **by_mode.get(name, {})} for name, field in _FIELDS.items()})


def _axis_schema(value: Schema, *, ranged: bool) -> Schema:
    listed: Schema = {"type": "array", "minItems": 1, "items": value}
    if not ranged:
        return listed
    steps: Schema = {"count": {"type": "integer", "minimum": 2}, "step": value, "spacing": {"enum": list(_SPACINGS)}}
    return {"anyOf": [listed, shape({"from": value, "to": value, **steps}, ["from", "to"])]}


SWEEP = Section("sweep", "many cells of the study, which `tvimdesign sweep` answers", _read, _schema)
