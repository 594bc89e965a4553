"""User's additions to a file's own information: which column is what, units, separator, decimal sign."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import pretty, si_unit
from tvimdesign.simulation.measurement.reading.headings import Heading, conversion, known, plain, unit_of
from tvimdesign.simulation.measurement.reading.sheets import DECIMALS, SEPARATORS

_WORDS: dict[str, Mapping[str, str]] = {"separator": SEPARATORS, "decimal": DECIMALS, "units": {"SI": ""}}
_ENTRY = ("heading", "column", "unit")


@dataclass(frozen=True)
class ColumnMap:
    """Columns by quantity, each `heading`, or `column` from 1, and `unit` where the file has none or a wrong one."""

    columns: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    separator: str = ""
    decimal: str = ""
    units: str = ""
    """`SI`: what has no unit is in SI."""

    def applied(self, headings: list[Heading]) -> list[Heading]:
        """Return the headings with what the map says; a quantity it names is no longer found elsewhere."""
        taken = [heading._replace(quantity="") if heading.quantity in self.columns else heading for heading in headings]
        for quantity, entry in self.columns.items():
            for i, heading in enumerate(taken):
                meant = (
                    plain(heading.text) == plain(str(entry["heading"]))
                    if "heading" in entry
                    else i + 1 == entry["column"]
                )
                if meant:
                    taken[i] = heading._replace(quantity=quantity, unit=str(entry.get("unit", heading.unit)))
        return [_in_si(heading) for heading in taken] if self.units else taken


def _in_si(heading: Heading) -> Heading:
    """Return a heading without a unit with that of SI."""
    return (
        heading
        if heading.unit or not heading.quantity
        else heading._replace(unit=pretty(si_unit(unit_of(heading.quantity))))
    )


def read_column_map(path: Path) -> ColumnMap:
    """Read a column map: YAML such as `{angle: {column: 2, unit: deg}, decimal: comma}`. Raises InputError."""
    try:
        tree = yaml.safe_load(path.read_text(encoding="utf-8-sig"))
    except (OSError, ValueError, yaml.YAMLError) as error:
        raise InputError(f"{path}: cannot be read as a column map in YAML ({str(error)[:80]})") from None
    return column_map(tree, str(path))


def column_map(tree: Any, file: str) -> ColumnMap:
    """Return a column map from plain data. Raises InputError naming the key and what was expected."""
    if not isinstance(tree, Mapping):
        raise InputError(f"{file}: expected quantities with their columns, as in `angle: {{column: 2, unit: deg}}`")
    quantities = known()["quantities"]
    columns = {}
    for key, entry in tree.items():
        if key in _WORDS:
            if not isinstance(entry, str) or entry not in _WORDS[key]:
                raise InputError(f"{file}: {key}: expected {', '.join(_WORDS[key])}")
            continue
        if key not in quantities:
            raise InputError(f"{file}: {str(key)[:40]} is no quantity; there are {', '.join(quantities)}")
        columns[key] = _entry(key, entry, file)
    return ColumnMap(columns, str(tree.get("separator", "")), str(tree.get("decimal", "")), str(tree.get("units", "")))


def _entry(key: str, entry: Any, file: str) -> Mapping[str, Any]:
    if isinstance(entry, str):
        return {"heading": entry}
    if isinstance(entry, int) and not isinstance(entry, bool):
        return {"column": entry}
    if not isinstance(entry, Mapping) or set(entry) - set(_ENTRY) or not {"heading", "column"} & set(entry):
        raise InputError(f"{file}: {key}: expected a heading, the count of the column, or {{column: 2, unit: deg}}")
    if "unit" in entry and conversion(str(entry["unit"]), unit_of(key)) is None:
        raise InputError(f"{file}: {key}: {entry['unit']!r} is no unit of it, such as {unit_of(key)}")
    return entry
