"""Lists the rows of a mode's table: what a study may set, vary, require and minimise."""

from __future__ import annotations

import json
import math
from typing import Any

from rich.table import Table as Grid

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import from_si, pretty
from tvimdesign.catalog import Catalog
from tvimdesign.device import Choice, Input, Output, table_for
from tvimdesign.device.table.quantity import Quantity
from tvimdesign.report.output.progress import wide_console
from tvimdesign.report.output.tables import number


def print_rows(mode: str, match: str, as_json: bool) -> None:
    """Print the rows whose name or description has `match` in it. Raises InputError where none has."""
    rows = [row for row in table_for(mode).quantities if not _internal(row)]
    found = [row for row in rows if match.lower() in f"{row.name} {row.description}".lower()]
    if not found:
        raise InputError(f"no row of {mode} mode has {match!r} in its name or description")
    if as_json:
        print(json.dumps([_plain(row) for row in found], indent=2))
        return
    console = wide_console()
    grid = Grid(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim")
    for column in ("name", "kind", "unit", "default", "allowed", "meaning"):
        grid.add_column(column, overflow="fold")
    group = ""
    for row in found:
        if row.group != group:
            grid.add_section()
            grid.add_row(f"[bold]{row.group}[/bold]", "", "", "", "", "")
            group = row.group
        plain = _plain(row)
        grid.add_row(
            plain["name"], plain["kind"], plain["unit"], plain["default"], plain["allowed"], plain["description"]
        )
    console.print(grid)


def _internal(row: Quantity) -> bool:
    return isinstance(row, Output) and (row.hidden or row.instant)


def _plain(row: Quantity) -> dict[str, Any]:
    if isinstance(row, Choice):
        allowed = ", ".join([*row.options, *(Catalog().names(row.category) if row.category else [])])
        return _entry(row, "choice", "", f"from {row.record[0]}" if row.record else row.default, allowed)
    name = f"{row.name}@point" if row.per_point else row.name
    if isinstance(row, Input):
        kind = "variable" if row.variable else "input"
        ends = (row.lower, row.upper)
        if row.record and not math.isfinite(row.upper):
            return _entry(row, kind, row.unit, f"from {row.record[0]}", "", name)
        default = "" if row.default is None else number(from_si(row.default, row.unit))
        if row.record:
            default = f"from {row.record[0]}"
        allowed = " to ".join(number(from_si(end, row.unit)) if math.isfinite(end) else "any" for end in ends)
        return _entry(row, kind, row.unit, default, allowed, name)
    rules = "; ".join(f"{r.sense} {number(from_si(r.value, row.unit))}" for r in row.rules)
    return _entry(row, "output", row.unit, "", rules, name)


def _only_with(row: Quantity) -> str:
    """What an input or a choice counts for nothing without; an output's description says what it is then."""
    idle = () if isinstance(row, Output) else row.requires
    return "".join(f"; of no effect while {feature.choice} is {feature.without}" for feature in idle)


def _entry(row: Quantity, kind: str, unit: str, default: str, allowed: str, name: str = "") -> dict[str, Any]:
    return {
        "name": name or row.name,
        "kind": kind,
        "unit": pretty(unit),
        "default": default,
        "allowed": allowed,
        "group": row.group,
        "description": row.description + _only_with(row),
        "source": row.source if isinstance(row, Input) else "",
    }
