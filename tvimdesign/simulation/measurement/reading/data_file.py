"""A file of measured data: blocks of named columns in SI, with the place of everything in the file."""

import hashlib
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import pretty
from tvimdesign.simulation.measurement.reading.headings import (
    ColumnMap,
    Heading,
    conversion,
    known,
    plain,
    rank,
    unit_of,
)
from tvimdesign.simulation.measurement.reading.sheets import (
    DECIMALS,
    Row,
    Sheet,
    clock_seconds,
    file_bytes,
    is_clock,
    read_sheets,
)
from tvimdesign.simulation.measurement.reading.table_blocks import RawBlock, blocks_of

Array = NDArray[np.float64]
_COLDEST = 1.0  # K; nothing that is measured here is as cold
_LOWEST = 150.0  # K; a sample in a rheometer or a calorimeter for polymers is not as cold
_TINY = 1e-200
_NOTHING = {"", "-", "--", "---", "n/a", "na", "nan", "none", "nd", "no value", "#n/a", "#nv", "#value!", "#wert!",
            "#div/0!", "ol", "open", "****"}  # fmt: skip
"""Cells without a value, as instruments, loggers (OL, OPEN: no thermocouple) and spreadsheets write them."""


@dataclass(frozen=True)
class Column:
    """A column that is understood: its quantity, how the file calls it, its unit there, and its values in SI."""

    quantity: str
    heading: str
    unit: str
    values: Array  # Not a number where the cell is empty
    step: float = 0.0  # Step of the last digit, in SI: the middle one of those of all cells
    share: float = 0.0  # Step over the size of the value, the middle one


@dataclass(frozen=True)
class Block:
    """A table of a file; every column is as long as it has rows."""

    file: str
    title: str
    lines: tuple[int, int]
    columns: Mapping[str, Column]
    unused: tuple[str, ...]
    settings: Mapping[str, str]
    skipped: tuple[int, ...] = ()  # Lines among the rows that hold no number
    problems: Mapping[str, str] = field(default_factory=dict)
    """Why a column of a known name could not be read, by its quantity: with line and column."""
    flagged: str = ""  # How many rows the instrument itself flags, and how; they are left out

    @property
    def place(self) -> str:
        """File and first line, for messages."""
        return f"{self.file}:{self.lines[0]}"

    def values(self, quantity: str) -> Array:
        """Return the values of a column in SI. Raises KeyError where the block lacks it."""
        return self.columns[quantity].values

    def step(self, *quantities: str) -> float:
        """Return the largest step of the last digit of columns [SI]."""
        return max(self.columns[quantity].step for quantity in quantities)

    def share(self, *quantities: str) -> float:
        """Return the largest step of columns over the size of their values."""
        return max(self.columns[quantity].share for quantity in quantities)

    def complete(self, quantities: Sequence[str]) -> int:
        """Count rows in which all these stand; 0 where a column lacks. Raises InputError for an unreadable one."""
        for quantity in quantities:
            if quantity in self.problems:
                raise InputError(self.problems[quantity])
        if any(quantity not in self.columns for quantity in quantities):
            return 0
        return int(np.sum(np.all([np.isfinite(self.values(name)) for name in quantities], axis=0)))

    def number(self, setting: str) -> float | None:
        """Return a setting said before the table, in SI; None where it is not there or no number."""
        words = self.settings.get(setting, "").replace(",", ".").split()
        entry = known()["settings"][setting]
        try:
            value = float(words[0])
        except (IndexError, ValueError):
            return None
        converted = conversion(words[1] if len(words) > 1 else entry["unit"], entry["unit"])
        return None if converted is None else converted[0] + converted[1] * value

    def shown(self, uses: Sequence[str] = ()) -> list[str]:
        """Return lines on its columns with their units and ranges: those of `uses`, or all, and what is unused then."""
        rows = max((len(column.values) for column in self.columns.values()), default=0)
        title = f" {self.title!r}" if self.title else ""
        lines = [f"  lines {self.lines[0]} to {self.lines[1]}{title}: {rows} rows"]
        lines += [f"    {name}: {_range(column)}" for name, column in self.columns.items() if not uses or name in uses]
        lines += [f"    {name}: not read ({why})" for name, why in self.problems.items() if not uses or name in uses]
        if self.unused:
            lines.append(f"    not used: {', '.join(self.unused)}")
        if self.skipped:
            lines.append(f"    without a number: line {', '.join(map(str, self.skipped))}")
        if self.flagged:
            lines.append(f"    left out: {self.flagged}")
        return lines


@dataclass(frozen=True)
class DataFile:
    """A file as it was understood."""

    path: Path
    sha256: str
    how: str  # Encoding, separator and decimal sign, in words
    blocks: tuple[Block, ...]

    def shown(self) -> list[str]:
        """Return lines on each block with its columns, their units and ranges, and what is unused."""
        lines = [f"{self.path}: {self.how}, {len(self.blocks)} {'table' if len(self.blocks) == 1 else 'tables'}"]
        return [*lines, *(line for block in self.blocks for line in block.shown())]


def read_data_file(path: Path, columns: ColumnMap | None = None) -> DataFile:
    """Read a file of measured data: text, CSV, Excel, TRIOS's JSON, RepTate's .tts, .osc and .gt.

    Raises InputError with the line where rows and headings do not go together. A column in which a cell is no number,
    or whose unit lacks or is of another kind, is among the block's `problems`: it stops who needs it.
    """
    columns = columns or ColumnMap()
    data = file_bytes(path)
    sheets, how = read_sheets(path, data, columns.separator, columns.decimal)
    by_place = any("column" in entry for entry in columns.columns.values())
    raw = [
        (sheet, block)
        for sheet in sheets
        for block in blocks_of(sheet, _place(path, sheet), path.suffix, by_place=by_place)
    ]
    if not raw:
        raise InputError(f"{path}: no table of numbers under headings was found")
    blocks = tuple(_block(block, sheet, _place(path, sheet), columns) for sheet, block in raw)
    return DataFile(path, hashlib.sha256(data).hexdigest(), how, blocks)


def _place(path: Path, sheet: Sheet) -> str:
    return f"{path} ({sheet.title})" if sheet.separator == "sheet" and sheet.title else str(path)


def _block(raw: RawBlock, sheet: Sheet, file: str, columns: ColumnMap) -> Block:
    lines = raw.rows[0].line, raw.rows[-1].line
    good, flagged = _not_flagged(raw)
    columns_by_name: dict[str, Column] = {}
    problems: dict[str, str] = {}
    if not good:
        why = f"{file}:{lines[0]}: {flagged}: no row is left; measure where the instrument can"
        problems = {heading.quantity: why for heading in raw.headings if heading.quantity}
    raw = replace(raw, rows=good or raw.rows)
    unused = []
    headings = columns.applied(raw.headings)
    first = {
        heading.quantity: rank(heading)
        for heading in sorted((each for each in headings if each.quantity), key=rank, reverse=True)
    }
    for i, heading in enumerate(headings):
        if (
            not heading.quantity
            or rank(heading) > first[heading.quantity]
            or not good
            or (heading.quantity in columns_by_name)
        ):
            unused += [heading.text] if heading.text and not heading.text.startswith("column ") else []
            continue
        try:
            column = _column(i, heading, raw, sheet, file)
        except InputError as error:
            problems.setdefault(heading.quantity, str(error))
            continue
        if column is not None:
            columns_by_name[heading.quantity] = column
    unread = {quantity: why for quantity, why in problems.items() if quantity not in columns_by_name}
    return Block(
        file, raw.title, lines, columns_by_name, tuple(unused), raw.settings, tuple(raw.skipped), unread, flagged
    )


def _is_flag(cell: str) -> bool:
    """Return whether a verdict, in small letters, says that its row does not count."""
    verdicts, words = known()["verdicts"], re.split(r"[\s,;/|]+", cell.replace("no error", ""))
    return not {*verdicts["words"]}.isdisjoint(words) or any(part in cell for part in verdicts["parts"])


def _not_flagged(raw: RawBlock) -> tuple[list[Row], str]:
    """Return the rows that the instrument does not flag in a column of verdicts, and a count of the others in words."""
    columns = [i for i, heading in enumerate(raw.headings) if plain(heading.text) in known()["verdicts"]["names"]]
    good, counts = [], Counter[str]()
    for row in raw.rows:
        cells = [plain(row.cells[i]) for i in columns if i < len(row.cells)]
        bad = [cell for cell in cells if _is_flag(cell)]
        if bad:
            counts[row.cells[columns[cells.index(bad[0])]].strip()] += 1
        else:
            good.append(row)
    named = ", ".join(f"{word} {count}" for word, count in counts.items())
    return good, f"{counts.total()} of {len(raw.rows)} rows are flagged by the instrument ({named})" if counts else ""


def _column(at: int, heading: Heading, raw: RawBlock, sheet: Sheet, file: str) -> Column | None:
    """Return a column in SI; None where all its cells are empty. Raises InputError."""
    cells = [row.cells[at] if at < len(row.cells) else "" for row in raw.rows]
    if all(cell.lower() in _NOTHING for cell in cells):
        return None
    wanted = unit_of(heading.quantity)
    where = f"{file}:{raw.rows[0].line}: column {at + 1}, {heading.text!r}"
    if wanted == "s" and any(map(is_clock, cells)):
        lines = [row.line for row in raw.rows]
        return Column(heading.quantity, heading.text, "s", clock_seconds(cells, _NOTHING, lines, heading.text, file))
    if not heading.unit and known()["quantities"][heading.quantity].get("counted"):
        heading = heading._replace(unit="1")
    if not heading.unit and heading.quantity == "temperature" and _no_kelvins(cells, sheet):
        heading = heading._replace(unit="degC")
    if not heading.unit:
        raise InputError(
            f"{where}, has no unit; write it into the heading, as in '{heading.text} [{wanted}]', or into a column map"
        )
    converted = conversion(heading.unit, wanted)
    if converted is None:
        raise InputError(f"{where}: {heading.unit!r} is no unit of {heading.quantity}, such as {wanted}")
    numbers = [_number(cell, row.line, at, sheet, file) for cell, row in zip(cells, raw.rows, strict=True)]
    with np.errstate(over="ignore"):
        values = converted[0] + converted[1] * np.array(numbers, dtype=float)
    if np.any(np.isinf(values)) or np.all(np.isnan(values)):
        raise InputError(f"{where}: a value is too large, or none is a number")
    if heading.quantity.endswith("temperature") and np.nanmin(values) < _COLDEST:
        raise InputError(f"{where}: {np.nanmin(values):g} K is at absolute zero, or below; look at the column's unit")
    steps = converted[1] * _steps(cells, sheet.decimal)
    share = float(np.nanmedian(steps / np.maximum(np.abs(values), _TINY)))
    return Column(heading.quantity, heading.text, heading.unit, values, float(np.median(steps)), share)


def _steps(cells: Sequence[str], decimal: str) -> Array:
    """Return the step of the last digit of each cell; cells without an exponent have that of the longest of them."""
    parts = [cell.lower().replace(DECIMALS[decimal], ".").partition("e") for cell in cells]
    decimals = [len(mantissa.partition(".")[2]) for mantissa, _, _ in parts]
    longest = max((count for count, (_, sign, _) in zip(decimals, parts, strict=True) if not sign), default=0)
    powers = [
        int(power) - count if sign and power.lstrip("+-").isdigit() else -longest
        for count, (_, sign, power) in zip(decimals, parts, strict=True)
    ]
    return np.asarray(10.0 ** np.clip(np.array(powers, float), -300.0, 300.0))


def _no_kelvins(cells: Sequence[str], sheet: Sheet) -> bool:
    """Return whether temperatures without a unit are so low that they cannot be kelvins, but degrees Celsius."""
    return min((value for cell in cells if (value := sheet.number(cell)) is not None), default=_LOWEST) < _LOWEST


def _number(cell: str, line: int, at: int, sheet: Sheet, file: str) -> float:
    value = sheet.number(cell)
    if value is None:
        if cell.lower() in _NOTHING:
            return float("nan")
        raise InputError(
            f"{file}:{line}: column {at + 1}: {cell[:30]!r} is no number; correct it, or leave the cell empty"
        )
    return value


def _range(column: Column) -> str:
    """Describe a column, as in `'G'' [Pa], 120 to 4.1e5`, in the file's own unit."""
    converted = conversion(column.unit, unit_of(column.quantity))
    assert converted is not None
    finite = column.values[np.isfinite(column.values)]
    low, high = ((end - converted[0]) / converted[1] for end in (finite.min(), finite.max()))
    unit = pretty(column.unit) or "plain number"
    gaps = len(column.values) - len(finite)
    counted = f", {gaps} {'gap' if gaps == 1 else 'gaps'}" if gaps else ""
    return f"{column.heading!r} in {unit}, {low:.4g} to {high:.4g}{counted}"
