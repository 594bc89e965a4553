"""Source of each number of a design, and how well it is known: from the study, a record, a default or the model."""

from collections.abc import Callable
from typing import NamedTuple

from tvimdesign.base.errors import CatalogError
from tvimdesign.base.record import Record
from tvimdesign.device import Choice, Input, Table
from tvimdesign.study.design import Design

Ends = tuple[float, float]
FindRecord = Callable[[str, str], Record]
"""Gives a record by its category and name; raises CatalogError where there is none."""


class Provenance(NamedTuple):
    """The status of a number, its source in words, and the range (SI) within which it is known; None where unsaid."""

    status: str
    """`study`, `optimized`, `computed`, or as its record or default has it: measured, datasheet, assumed, paper ..."""
    source: str
    low: float | None = None
    high: float | None = None


def provenance(name: str, design: Design, table: Table, find_record: FindRecord) -> Provenance:
    """Return where the number of a full name comes from, in a design."""
    row, base = table.quantity(name), name.partition("@")[0]
    if not isinstance(row, Input):
        return Provenance("computed", "computed", *design.intervals.get(name, (None, None)))
    if base in design.study["vary"]:
        return Provenance("optimized", "found by the optimiser")
    if base in design.study["module"]:
        return Provenance("study", "set by the study")
    if row.per_point:
        return Provenance("study", "an operating point of the study")
    if (record := _record_of(row, design, table)) and not _without(record[0], row, design, table):
        return _of_record(*record, row, design, table, find_record)
    status, _, source = row.source.partition(": ")
    return Provenance(status, source, *(_of_factor(row, design, table, find_record) or (row.low, row.high)))


def _record_of(row: Input, design: Design, table: Table) -> tuple[str, str] | None:
    """Return (choice, field) that an input comes from, if from a record: one bought whole before any other."""
    if row.stock_record is None:
        return row.record
    chosen = table.quantity(row.stock_record[0])
    assert isinstance(chosen, Choice)
    is_whole = design.choices.get(chosen.name, "none") not in chosen.options
    return row.stock_record if is_whole else row.record


def _without(choice: str, row: Input, design: Design, table: Table) -> bool:
    """Return whether an input with a default of its own comes from a choice that stands for no record."""
    chosen = table.quantity(choice)
    assert isinstance(chosen, Choice)
    return row.falls_back and design.choices[choice] in chosen.options


def _of_factor(row: Input, design: Design, table: Table, find_record: FindRecord) -> Ends | None:
    """Return the range of a factor of a chosen record's value, as the record has it."""
    if row.range_of is None:
        return None
    chosen = table.quantity(row.range_of[0])
    assert isinstance(chosen, Choice)
    entry = find_record(chosen.category or "", design.choices[row.range_of[0]]).entries.get(row.range_of[1])
    return entry.share_of_range if entry else None


def _of_record(
    choice: str, field: str, row: Input, design: Design, table: Table, find_record: FindRecord
) -> Provenance:
    """Return the source in the chosen record; that of the row if there is no such record any more."""
    chosen = table.quantity(choice)
    assert isinstance(chosen, Choice)
    if design.choices[choice] in chosen.options:
        return Provenance("chosen", f"{choice} is {design.choices[choice]}; such a module needs none")
    try:
        record = find_record(chosen.category or "", design.choices[choice])
    except CatalogError:
        return Provenance("record", row.source)
    entry = record.entries.get(field)
    if entry is None and row.falls_back:
        status, _, source = row.source.partition(": ")
        return Provenance(status, source)
    if entry is None:
        return Provenance("chosen", f"{record.category}/{record.name} has no {field}; such a module needs none")
    return Provenance(entry.status, f"{record.category}/{record.name}: {entry.source}", entry.low, entry.high)
