"""Values that a record leaves out and that follow from others it has: by a power law, or from a table's sums."""

from __future__ import annotations

from collections.abc import Mapping
from math import prod

from tvimdesign.base.record import Entry, RecordTable
from tvimdesign.catalog.category import Category, PowerLaw


def following(category: Category, entries: Mapping[str, Entry], tables: Mapping[str, RecordTable]) -> dict[str, Entry]:
    """Return the entries that follow from others of a record, by name, without those it has itself."""
    found = {}
    for table, values in category.instead.items():
        for name, columns in values.items() if table in tables else ():
            if name not in entries:
                found[name] = _sum(tables[table], columns, category.units[name])
    for name, law in category.follows.items():
        if name not in entries and name not in found and {*law.names} <= entries.keys():
            found[name] = _power(law, entries, category.units[name])
    return found


def _sum(table: RecordTable, columns: tuple[str, ...], unit: str) -> Entry:
    rows = [dict(zip(table.columns, row, strict=True)) for row in table.rows]
    total = sum(prod(row[column] for column in columns) for row in rows)
    return Entry(total, unit, table.source, table.status, None, None)


def _power(law: PowerLaw, entries: Mapping[str, Entry], unit: str) -> Entry:
    """value = reference (size/reference size)^exponent; the range is that of reference and exponent together."""
    reference, size, known, exponent = (entries[name] for name in law.names)
    ratio = size.value / known.value

    def ends(entry: Entry) -> tuple[float, float]:
        low, high = (entry.value if end is None else end for end in (entry.low, entry.high))
        return low, high

    powers = [ratio**end for end in ends(exponent)]
    low, high = (end * power for end, power in zip(ends(reference), (min(powers), max(powers)), strict=True))
    source = f"{exponent.status}: follows from {law.size}: {reference.source}; {exponent.source}"
    return Entry(reference.value * ratio**exponent.value, unit, source, exponent.status, low, high)
