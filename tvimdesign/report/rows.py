"""Lists the rows of a mode's table, groups first: what a study may set, vary, require and minimise."""

import json
import math
from collections.abc import Sequence
from typing import Any

from rich.console import Console
from rich.padding import Padding
from rich.text import Text

from tvimdesign.base.errors import InputError
from tvimdesign.base.record import Record
from tvimdesign.base.units import pretty
from tvimdesign.catalog.catalog import Catalog
from tvimdesign.device import MODES, Choice, Input, Output, table_for
from tvimdesign.device.table.quantity import Quantity
from tvimdesign.report.output.numbers import in_unit, label
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.terminal import print_grid, wide_console
from tvimdesign.study import words_of
from tvimdesign.study.text.mistakes import did_you_mean, synonyms

_SHOWN = 8  # Names of a group in the list of groups


def print_rows(mode: str, word: str, as_json: bool) -> None:
    """Print the groups, or the rows of a group, or those a word is about. Raises InputError where there is none."""
    rows = named_rows(mode)
    matches = matching(rows, word)
    if not matches:
        names = [row.name for row in rows]
        hint = did_you_mean(word, [*names, *synonyms()]) or "`tvimdesign rows` lists the groups"
        raise InputError(f"no row of {mode} mode has {word!r} in its name or description; {hint}")
    if as_json:
        print(json.dumps([_plain(row) for row in matches], indent=2))
    elif word:
        _print_found(matches, word, mode, wide_console())
    else:
        _print_groups(rows, mode, wide_console())


def named_rows(mode: str) -> list[Quantity]:
    """Return the rows that a study may name, in the table's order. Raises InputError for no such mode."""
    return [row for row in table_for(mode).quantities if not (isinstance(row, Output) and (row.hidden or row.instant))]


def row_names() -> list[str]:
    """Return names of the rows of every mode, each once."""
    return list(dict.fromkeys(row.name for mode in MODES for row in named_rows(mode)))


def setting_names() -> list[str]:
    """Return what `--set` takes: inputs and choices, and outputs after `require.`, each with the `=`."""
    every = [row for mode in MODES for row in named_rows(mode)]
    return list(dict.fromkeys(f"require.{row.name}=" if isinstance(row, Output) else f"{row.name}=" for row in every))


def matching(rows: Sequence[Quantity], word: str) -> list[Quantity]:
    """Return the group of that name and the row so called; else rows with the word, or what engineers mean by it."""
    word = " ".join(word.lower().split())
    named = [row for row in rows if word in (row.group.lower(), row.name)]
    terms = (word, *synonyms().get(word.replace("_", " "), ()))
    in_group = any(row.group.lower() == word for row in named)
    texts = [f"{row.name} {row.name.replace('_', ' ')} {row.description}".lower() for row in rows]
    return named if in_group else [row for row, text in zip(rows, texts, strict=True) if any(map(text.count, terms))]


def _print_groups(rows: Sequence[Quantity], mode: str, console: Console) -> None:
    """Print a line for each group: how many names it has, and those a summary shows or a search may change."""
    groups = list(dict.fromkeys(row.group for row in rows))
    console.print(f"{len(rows)} names of {mode} mode in {len(groups)} groups, with those that are asked for most:\n")
    in_groups = {group: [row for row in rows if row.group == group] for group in groups}
    cells = [(group, str(len(own)), ", ".join(_important(own))) for group, own in in_groups.items()]
    print_grid(grid("", ("group", "", "names"), cells, right=(1,), code=()), console)
    console.print(
        '\nNext: `tvimdesign rows Springs` for a group, `tvimdesign rows weight` for a word, "power supply" for two.',
        markup=False,
    )


def _important(rows: Sequence[Quantity]) -> list[str]:
    """Return variables and headline outputs, then what is better one way; of a group without any, choices."""
    names = [row.name for row in rows if _asked_for(row)]
    names += [row.name for row in rows if getattr(row, "better", None) and row.name not in names]
    return (names or [row.name for row in rows if isinstance(row, Choice)] or [row.name for row in rows])[:_SHOWN]


def _asked_for(row: Quantity) -> bool:
    return row.headline if isinstance(row, Output) else isinstance(row, Input) and row.variable


def _print_found(rows: Sequence[Quantity], word: str, mode: str, console: Console) -> None:
    """Print those asked for most, then the others by group: a name with its facts, below it its description."""
    also = synonyms().get(word.lower().replace("_", " "))
    if also:
        console.print(f"{word}: rows with {', '.join(also)}\n", style="dim", markup=False)
    heading = ""
    for row in sorted(rows, key=lambda row: not _asked_for(row)):
        group = f"{row.group}: asked for most" if _asked_for(row) else row.group
        if group != heading:
            heading = group
            console.print(Text(heading, style="bold underline"))
        plain = _plain(row)
        console.print(Text.assemble((plain["name"], "bold"), "  ", (_facts(plain), "dim")), no_wrap=True, crop=False)
        allowed = f" [{plain['allowed']}]" if plain["allowed"] else ""
        console.print(Padding(Text(plain["description"] + allowed), (0, 0, 0, 4)))
        if isinstance(row, Input) and len(rows) == 1 and row.record:
            console.print(Padding(Text(_by_record(row, mode)), (0, 0, 0, 4)))
        if isinstance(row, Choice) and len(rows) == 1 and row.category:
            cells = [(name, _what(Catalog().record(row.category, name))) for name in Catalog().names(row.category)]
            print_grid(grid("", ("record", "what it is"), cells, code=(0,)), console)


def _by_record(row: Input, mode: str) -> str:
    """Return an input's value, with its range, by each record that it may come from."""
    choice = table_for(mode).by_name[row.record[0]] if row.record else None
    if row.record is None or not isinstance(choice, Choice) or not choice.category:
        return ""
    catalog, values = Catalog(), []
    for name in catalog.names(choice.category):
        record = catalog.record(choice.category, name)
        if record.has(row.record[1]):
            entry = record.entry(row.record[1])
            ends = [in_unit(end, row.unit) for end in (entry.low, entry.high) if end is not None]
            values.append(f"{name} {in_unit(entry.value, row.unit)}" + (f" ({' to '.join(ends)})" if ends else ""))
    return ", ".join(values)


def _what(record: Record) -> str:
    """Return a record's title, with the ends of the columns of its types."""
    types = record.tables.get("types")
    columns = types.columns.items() if types else ()
    ends = [
        f"{label(name)} {in_unit(min(values), unit)} to {in_unit(max(values), unit)} {pretty(unit)}"
        for (name, unit), values in zip(columns, zip(*types.rows, strict=True) if types else (), strict=True)
        if unit != "1"
    ]
    return "; ".join([record.title, *ends])


def _facts(plain: dict[str, Any]) -> str:
    """Return what a row is, in a few words: `variable, 2.413 mm` or `input in GPa, from spring_material`."""
    kind, default, unit = plain["kind"], plain["default"], plain["unit"]
    if not default or default.startswith("from "):
        return ", ".join(filter(None, (f"{kind} in {unit}" if unit else kind, default)))
    known = f" (known within {plain['range']})" if plain["range"] else ""
    return f"{kind}, {default} {unit}".rstrip() + known


def _plain(row: Quantity) -> dict[str, Any]:
    """Return a row as plain data; an input or a choice says without which feature it has no effect."""
    kind, default, allowed = _value(row)
    idle = () if isinstance(row, Output) else row.requires
    without = "".join(f"; of no effect while {feature.choice} is {feature.without}" for feature in idle)
    return {
        "name": row.name if isinstance(row, Choice) or not row.per_point else f"{row.name}@point",
        "kind": kind,
        "unit": "" if isinstance(row, Choice) else pretty(row.unit),
        "default": default,
        "allowed": allowed,
        "group": row.group,
        "description": row.description + without,
        "source": row.source if isinstance(row, Input) else "",
        "range": _range(row) if isinstance(row, Input) else "",
    }


def _value(row: Quantity) -> tuple[str, str, str]:
    """Return what kind of row it is, its default, and what its value may be."""
    if isinstance(row, Choice):
        return "choice", f"from {row.record[0]}" if row.record else row.default, ", ".join(words_of(row))
    if isinstance(row, Output):
        return "output", "", "; ".join(f"{rule.sense} {in_unit(rule.value, row.unit)}" for rule in row.rules)
    kind = "variable" if row.variable else "input"
    default = "" if row.default is None else in_unit(row.default, row.unit)
    if row.record and not (row.falls_back and math.isfinite(row.upper)):
        default = f"from {row.record[0]}"
    ends = [in_unit(end, row.unit) if math.isfinite(end) else "any" for end in (row.lower, row.upper)]
    return kind, default, "" if row.record and not math.isfinite(row.upper) else " to ".join(ends)


def _range(row: Input) -> str:
    """Return how well the table's own unmeasured default is known."""
    if row.range_of is not None:
        return f"the range of {row.range_of[1]} of {row.range_of[0]}"
    if row.low is None or row.high is None:
        return ""
    return " to ".join(in_unit(end, row.unit) for end in (row.low, row.high))
