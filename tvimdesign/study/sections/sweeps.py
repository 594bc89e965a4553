"""The section `sweep`: which cells are laid over which axes, and what is done in each.

A sweep as plain data: axes with their values or ranges, and the arrangement of cells.
"""

from dataclasses import dataclass, replace
from typing import Literal

from tvimdesign.device import Choice, Input, Table
from tvimdesign.study.sections.goals import named_output, read_limit
from tvimdesign.study.sections.section import Schema, Section, mapping, output_name, set_schema, settable, shape
from tvimdesign.study.text.mistakes import quoted, step
from tvimdesign.study.text.values import (
    ROUNDING,
    Reading,
    below,
    difference_unit,
    entries,
    in_unit,
    misfit,
    quantity,
    text,
    unknown_keys,
    whole,
    word_of,
)
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
_MOST_SEED = 2**32 - 1
_EXAMPLE = "'over: {pcl_thickness: {from: 0.6 mm, to: 2 mm, count: 20}}'"


def _read(reading: Reading, node: Node | None) -> SweepBlock | None:
    """Return what is swept, None where nothing is; every problem is noted."""
    parts = unknown_keys(
        reading.problems, entries(reading.problems, node, "sweep", _EXAMPLE), "sweep", "key", list(_FIELDS)
    )
    if node is None or not parts:
        return None
    method = word_of(reading.problems, parts.get("method"), "sweep.method", METHODS) or (
        "list" if "cells" in parts else "grid"
    )
    before = len(reading.problems.items)
    if method == "list":
        axes, rows = _listed(reading, parts, node)
    else:
        axes, rows = _axes(reading, parts, node, method), ()
    count = _count(reading, parts, node, method)
    block = SweepBlock(
        method=method, axes=axes, rows=rows, task=word_of(reading.problems, parts.get("task"), "sweep.task", TASKS),
        count=count, seed=_number(reading, parts, "seed", 0, _MOST_SEED) or 0 if "seed" in parts else 1,
        outputs=_outputs(reading, parts.get("outputs")),
    )  # fmt: skip
    most = _number(reading, parts, "most", 1, 10**9)
    if len(reading.problems.items) > before:
        return None
    return block if most is None else replace(block, most=most)


def _number(reading: Reading, parts: dict[str, Node], key: str, least: int, most: int) -> int | None:
    if key not in parts:
        return None
    value = whole(reading.problems, parts[key], step("sweep", key))
    if value is not None and not least <= value <= most:
        reading.problems.add(parts[key], step("sweep", key), f"{value} does not fit here", f"{least} to {most}")
        return None
    return value


def _count(reading: Reading, parts: dict[str, Node], node: Node, method: str) -> int:
    if method in SAMPLED and "count" not in parts:
        reading.problems.add(node, "sweep", f"how many cells are drawn is missing ({method})", "'count: 256', for one")
    elif method not in SAMPLED and "count" in parts:
        message = f"a {method} has as many cells as its axes give"
        reading.problems.add(parts["count"], "sweep.count", message, "'count' at a range of `over`")
    return _number(reading, parts, "count", 1, 10**9) or 0


def _outputs(reading: Reading, node: Node | None) -> tuple[str, ...]:
    if node is None:
        return ()
    if isinstance(node, Text) and node.value == EVERY_OUTPUT:
        return (EVERY_OUTPUT,)
    if not isinstance(node, Sequence):
        misfit(reading.problems, node, "sweep.outputs", f"a list of outputs, or {EVERY_OUTPUT}")
        return ()
    names = []
    for i, item in enumerate(node.items):
        path = f"sweep.outputs[{i}]"
        word = text(reading.problems, item, path, "the name of an output")
        if word and isinstance(item, Text) and named_output(reading, item, path, word):
            names.append(word)
    return tuple(names)


# --- axes ---


def _axes(reading: Reading, parts: dict[str, Node], node: Node, method: str) -> tuple[SweptAxis, ...]:
    if "cells" in parts:
        reading.problems.add(parts["cells"], "sweep.cells", f"a {method} has no list of cells", "'method: list'")
    over = parts.get("over")
    named = entries(reading.problems, over, "sweep.over", _EXAMPLE)
    if not named and (over is None or isinstance(over, Mapping | Text)):
        reading.problems.add(over or node, "sweep.over", "nothing is swept: it has no axis", _EXAMPLE)
    axes = []
    for name, (key, value) in named.items():
        path = step("sweep.over", name)
        axis = _axis(reading, key, path, name)
        if axis is None:
            continue
        if isinstance(value, Mapping):
            spanned = _range(reading, value, path, axis, method)
            axes += [spanned] if spanned else []
        else:
            axes.append(replace(axis, values=_values(reading, value, path)))
    return tuple(axes)


def _listed(
    reading: Reading, parts: dict[str, Node], node: Node
) -> tuple[tuple[SweptAxis, ...], tuple[tuple[Text, ...], ...]]:
    """Read the axes and rows of `cells: [{pcl_thickness: 1 mm, current: 1 A}, ...]`."""
    expected = "a list such as [{pcl_thickness: 1 mm, current: 1 A}, ...]"
    cells = parts.get("cells")
    if "over" in parts:
        reading.problems.add(
            parts["over"], "sweep.over", "a list of cells has no axes of its own", "'cells', or a grid"
        )
    if not isinstance(cells, Sequence) or not cells.items:
        reading.problems.add(cells or node, "sweep.cells", "there is no list of cells", expected)
        return (), ()
    axes: dict[str, SweptAxis] = {}
    rows = []
    for i, item in enumerate(cells.items):
        path = f"sweep.cells[{i}]"
        named = entries(reading.problems, item, path, expected)
        for name, (key, value) in named.items():
            axis = axes.get(name) or _axis(reading, key, step(path, name), name)
            if i and axis and name not in axes:
                reading.problems.add(key, step(path, name), "is not in the first cell", "the same names in each cell")
            elif axis:
                axes[name] = axis
            if not isinstance(value, Text) or value.empty:
                misfit(reading.problems, value, step(path, name), "one value")
        if missing := [name for name in axes if name not in named]:
            reading.problems.add(item, path, f"has no {' and no '.join(missing)}", "the same names in each cell")
        else:
            rows.append(tuple(cell_text for name in axes if isinstance(cell_text := named[name][1], Text)))
    return tuple(axes.values()), tuple(rows)


def _axis(reading: Reading, key: Text, path: str, name: str) -> SweptAxis | None:
    """Return the axis that a name under `over` means, still without values."""
    section, _, path_in_section = name.partition(".")
    if not path_in_section:
        return _of_module(reading, key, path, name)
    if section not in _SWEPT_SECTIONS:
        reading.problems.unknown(key, path, f"section to sweep in: {quoted(section)}", section, _SWEPT_SECTIONS)
        return None
    if section == "require":
        row = named_output(reading, key, path, path_in_section)
        return SweptAxis(name, row.unit, whole=False, number=False) if row else None
    point = path_in_section.partition(".")[2] if section == "operating_points" else ""
    value = reading.table.by_name.get(point)
    if isinstance(value, Input) and value.per_point:
        return SweptAxis(name, value.unit, whole=value.integer, number=not value.integer)
    return SweptAxis(name, "", whole=False, number=False)


def _of_module(reading: Reading, key: Text, path: str, name: str) -> SweptAxis | None:
    row = reading.table.by_name.get(name)
    if isinstance(row, Choice):
        return SweptAxis(name, "", whole=False, number=False)
    if isinstance(row, Input) and not row.per_point:
        return SweptAxis(name, row.unit, whole=row.integer, number=not row.integer)
    if isinstance(row, Input):
        reading.problems.add(key, path, "belongs to an operating point", f"'operating_points.hot.{name}', for one")
    elif row is not None:
        reading.problems.add(key, path, "is a result and cannot be set", f"'require.{name}' to sweep a limit on it")
    else:
        names = [quantity.name for quantity in reading.table.quantities if isinstance(quantity, Choice | Input)]
        reading.unknown_quantity(key, path, "input or choice", name, names)
    return None


def _values(reading: Reading, node: Node, path: str) -> tuple[Text, ...]:
    if not isinstance(node, Sequence) or not node.items:
        empty = isinstance(node, Sequence)
        message = "is an empty list" if empty else "is no list of values"
        reading.problems.add(node, path, message, "[a, b, c], or {from: ..., to: ..., count: ...}")
        return ()
    for i, item in enumerate(node.items):
        if not isinstance(item, Text) or item.empty:
            misfit(reading.problems, item, f"{path}[{i}]", "one value")
    return tuple(item for item in node.items if isinstance(item, Text))


# --- ranges ---


def _range(reading: Reading, node: Mapping, path: str, axis: SweptAxis, method: str) -> SweptAxis | None:
    parts = unknown_keys(reading.problems, node.entries, path, "key", _RANGE_KEYS)
    ends = _ends(reading, node, parts, path, axis)
    if ends is None:
        return None
    (lower, sense), (upper, other) = ends
    logarithmic = word_of(reading.problems, parts.get("spacing"), f"{path}.spacing", _SPACINGS) == "logarithmic"
    if sense != other:
        reading.problems.add(node, path, f"begins with {sense} and ends with {other}", "the same sense at both ends")
    elif not below(lower, upper):
        reading.problems.add(node, path, "the range is upside down or has no length", "from < to", "swap the two")
    elif logarithmic and lower <= 0.0:
        reading.problems.add(parts["from"], f"{path}.from", "a logarithmic range begins above 0", "a value above 0")
    else:
        count = _steps(reading, node, parts, path, axis, (lower, upper), method)
        return replace(axis, sense=sense, range=SweptRange(lower, upper, count, logarithmic))
    return None


def _ends(
    reading: Reading, node: Mapping, parts: dict[str, Node], path: str, axis: SweptAxis
) -> tuple[tuple[float, Sense], tuple[float, Sense]] | None:
    """Both ends of a range; None (and a problem) where one is missing or wrong."""
    if not axis.unit:
        reading.problems.add(node, path, "has no numbers between two ends", "a list of values [..., ...]")
        return None
    if missing := [key for key in ("from", "to") if key not in parts]:
        reading.problems.add(node, path, f"{' and '.join(map(repr, missing))} missing", "{from: ..., to: ...}")
        return None
    first, last = (_end(reading, parts[key], f"{path}.{key}", axis) for key in ("from", "to"))
    return None if first is None or last is None else (first, last)


def _end(reading: Reading, node: Node, path: str, axis: SweptAxis) -> tuple[float, Sense] | None:
    """Return an end of a range in SI, with its sense if it is a limit."""
    section, _, output = axis.name.partition(".")
    if section == "require":
        limit = read_limit(reading, node, path, output, reading.table.output(output.partition("@")[0]))
        return (limit.limit, limit.sense) if limit else None
    row = reading.table.quantity(axis.name.rpartition(".")[2])
    assert isinstance(row, Input)  # what has a unit and is no limit
    value = quantity(reading.problems, node, path, row)
    return None if value is None else (value, "")


def _steps(
    reading: Reading, node: Mapping, parts: dict[str, Node], path: str, axis: SweptAxis, ends: tuple[float, float],
    method: str,
) -> int:  # fmt: skip
    """Return the number of values of a range in a grid; 0 in a sample."""
    given = [key for key in ("count", "step") if key in parts]
    if method in SAMPLED:
        for key in given:
            reading.problems.add(parts[key], f"{path}.{key}", f"a sample ({method}) draws between the ends", "no steps")
        return 0
    whole_steps = axis.whole and not given
    if len(given) != 1 and not whole_steps:
        reading.problems.add(node, path, "needs 'count' or 'step', one of the two", "{from: ..., to: ..., count: 20}")
        return 0
    if "count" in parts:
        count = whole(reading.problems, parts["count"], f"{path}.count")
        if count is not None and count < 2:
            reading.problems.add(parts["count"], f"{path}.count", f"{count} values between two ends", "2 or more")
        return count or 0
    if "spacing" in parts:
        reading.problems.add(parts["spacing"], f"{path}.spacing", "steps are even", "'count' with a spacing")
    width: float | None = 1.0
    if "step" in parts:
        unit = difference_unit(axis.unit)
        width = in_unit(reading.problems, parts["step"], f"{path}.step", unit, f"a step in {unit}")
    if width is None or width <= 0.0:
        reading.problems.add(parts["step"], f"{path}.step", "leads nowhere", "a step above zero")
        return 0
    return int((ends[1] - ends[0]) / width * (1.0 + ROUNDING) + ROUNDING) + 1


# --- schema ---


def _schema(table: Table) -> Schema:
    values = {row.name: set_schema(row) for row in settable(table)}
    words = {row.name for row in settable(table) if isinstance(row, Choice)}
    quantity: Schema = {"type": ["string", "number"]}
    paths = rf"^({'|'.join(_SWEPT_SECTIONS)})\."
    over = shape({name: _axis_schema(value, ranged=name not in words) for name, value in values.items()}, [])
    del over["required"]
    over |= {"minProperties": 1, "patternProperties": {paths: _axis_schema(quantity, ranged=True)}}
    cell = {
        "type": "object", "additionalProperties": False, "properties": values, "patternProperties": {paths: quantity},
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
