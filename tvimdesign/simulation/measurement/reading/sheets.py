"""Rows of cells from a file: text in any encoding, with its separator and decimal sign; TRIOS's JSON; workbooks.

Encodings are recognised by marks and by zeros in every second byte, not by statistics: charset-normalizer reads the
degree sign of a short file in Windows' Latin as Chinese, and takes 60 times as long.
"""

import codecs
import csv
import json
import math
import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from io import BytesIO
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.errors import InputError

_CLOCK = re.compile(
    r"(?:(?P<date>\d{4}-\d{1,2}-\d{1,2}|\d{1,2}[./]\d{1,2}[./]\d{2,4})[T ,]+|(?P<days>\d+) days?,? +)?"
    r"(?P<hours>\d{1,3}):(?P<minutes>\d{2})(?::(?P<seconds>\d{2}(?:[.,]\d+)?))?"
    r"\s*(?P<half>[AaPp])?\.?(?(half)[Mm]\.?)\s*(?:Z|[+-]\d{2}:?\d{2})?"
)
_DATE = re.compile(r"\d{4}-\d{1,2}-\d{1,2}|\d{1,2}[./]\d{1,2}[./]\d{2,4}")
_DAY = 86400.0


def is_clock(cell: str) -> bool:
    """Return whether a cell is a time of day or a duration with colons, with a date before it or without."""
    return ":" in cell and _CLOCK.fullmatch(cell) is not None


def clock_seconds(
    cells: Sequence[str], gaps: Collection[str], lines: Sequence[int], heading: str, file: str
) -> NDArray[np.float64]:
    """Return seconds from the first of the times; a gap is not a number, and times go on past midnight.

    Of 03/04/2026, day or month comes first by whichever order lets time rise over the shorter span. Raises InputError
    for a cell that is no clock time, and for two numbers that may be hours and minutes or minutes and seconds.
    """
    matches = [None if cell.lower() in gaps else _CLOCK.fullmatch(cell) for cell in cells]
    for match, cell, line in zip(matches, cells, lines, strict=True):
        where = f"{file}:{line}: column {heading!r}"
        if match is None and cell.lower() not in gaps:
            raise InputError(f"{where}: {cell[:30]!r} is no clock time, as the other rows have")
        bare = match and not (match["seconds"] or match["date"] or match["half"])
        if bare and not {"mm:ss", "hh:mm"} & {heading.lower()[i : i + 5] for i in range(len(heading))}:
            raise InputError(f"{where}: {cell!r} may be hh:mm or mm:ss; name the column 'time [mm:ss]'")
    tries = [_from_first(matches, day_first=day_first) for day_first in (True, False)]
    times = [each for each in tries if each is not None]
    if not times:
        raise InputError(f"{file}:{lines[0]}: column {heading!r}: a day that is none; write 2026-11-26 14:05:00")
    short = heading.lower().count("mm:ss") and "hh:mm" not in heading.lower()
    seconds = min(times, key=lambda each: (bool(np.any(np.diff(each[np.isfinite(each)]) < 0.0)), np.nanmax(each)))
    return seconds / 60.0 if short and not any(match and match["seconds"] for match in matches) else seconds


def _from_first(matches: Sequence[re.Match[str] | None], *, day_first: bool) -> NDArray[np.float64] | None:
    """Return seconds from the first; None where a date is none in that order."""
    try:
        times = np.array([np.nan if match is None else _seconds(match, day_first) for match in matches])
    except ValueError:
        return None
    there = np.flatnonzero(np.isfinite(times))
    if not any(match and (match["date"] or match["days"]) for match in matches):
        falls = np.diff(times[there], prepend=times[there[0]]) < -0.5 * _DAY
        times[there] += _DAY * np.cumsum(falls)
    return np.asarray(times - times[there[0]])


def _seconds(match: re.Match[str], day_first: bool) -> float:
    hours, minutes = int(match["hours"]), int(match["minutes"])
    if match["half"]:
        hours = hours % 12 + (12 if match["half"] in "pP" else 0)
    clock = 3600.0 * hours + 60.0 * minutes + float((match["seconds"] or "0").replace(",", "."))
    if match["days"]:
        return _DAY * int(match["days"]) + clock
    if not match["date"]:
        return clock
    year, month, day = map(int, re.split(r"[-./]", match["date"]))
    if "-" not in match["date"]:
        day, month, year = (year, month, day) if day_first else (month, year, day)
    return (datetime(year, month, day) - datetime(1970, 1, 1)) / timedelta(seconds=1) + clock


LARGEST_FILE = 64_000_000
WORKBOOKS = (".xlsx", ".xlsm", ".xlsb", ".xls", ".ods")
_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_BYTES_LOOKED_AT, _LINES_LOOKED_AT = 4000, 3000
SEPARATORS = {"tab": "\t", "semicolon": ";", "bar": "|", "comma": ",", "blanks": ""}
"""By the names a column map uses; in the order in which they are preferred where several would do."""
DECIMALS = {"point": ".", "comma": ","}
_POINT = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,4})?")
_COMMA = re.compile(r"[+-]?(?:[0-9]+(?:,[0-9]*)?|,[0-9]+)(?:[eE][+-]?[0-9]{1,4})?")
_THOUSANDS = re.compile(r"[+-]?[1-9][0-9]{0,2}(?:,[0-9]{3})+")
_BAD = re.compile(r"(?=.*[0-9])[0-9.,;|+\-eE\s]+")
_LIKELY = 0.8
"""Share of the best score from which a way to cut the lines may be right: what cuts least wrongly is taken then."""


@dataclass(frozen=True)
class Row:
    """The cells of a line; `line` counts from 1."""

    line: int
    cells: tuple[str, ...]

    @property
    def empty(self) -> bool:
        """True where nothing stands in it."""
        return not any(self.cells)

    @property
    def filled(self) -> int:
        """Cells in which something stands."""
        return sum(map(bool, self.cells))


@dataclass(frozen=True)
class Sheet:
    """The rows of a text or of a sheet of a workbook, and how its numbers are written."""

    rows: tuple[Row, ...]
    separator: str  # By its name in `SEPARATORS`; `sheet` in a workbook
    decimal: str
    title: str = ""

    def number(self, cell: str) -> float | None:
        """Return the number in a cell; None where it has none."""
        return number(cell, self.decimal)

    def numbers(self, row: Row) -> int:
        """Return cells of a row that are numbers or clock times."""
        return sum(self.number(cell) is not None or is_clock(cell) for cell in row.cells)


def file_bytes(path: Path) -> bytes:
    """Return the bytes of a file. Raises InputError where there is none, or more than `LARGEST_FILE` bytes."""
    try:
        if not path.is_file():
            raise InputError(f"{path}: there is no such file")
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise InputError(f"{path}: {size / 1e6:.0f} MB; files of data are read up to {LARGEST_FILE / 1e6:.0f} MB")
        return path.read_bytes()
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read ({type(error).__name__})") from None


def decoded(data: bytes, file: str) -> tuple[str, str]:
    """Return the text, and the encoding it was in. Raises InputError where it is no text."""
    encoding = _encoding(data)
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError:
        encoding = "cp1252"
        text = data.decode(encoding, errors="replace")
    if "\0" in text:
        raise InputError(f"{file}: this is no text; export the data as text, CSV or Excel (.xlsx)")
    return text, encoding


def _encoding(data: bytes) -> str:
    for mark, name in _MARKS:
        if data.startswith(mark):
            return name
    begin = data[:_BYTES_LOOKED_AT]
    # Western text in UTF-16 has a zero in every second byte.
    even, odd = begin[0::2].count(0), begin[1::2].count(0)
    if odd > 0.4 * len(begin) / 2 and even == 0:
        return "utf-16-le"
    if even > 0.4 * len(begin) / 2 and odd == 0:
        return "utf-16-be"
    return "utf-8"


def read_sheets(path: Path, data: bytes, separator: str = "", decimal: str = "") -> tuple[list[Sheet], str]:
    """Return the sheets of a file, and how it was read: encoding, separator and decimal sign. Raises InputError."""
    if path.suffix.lower() in WORKBOOKS:
        return workbook_sheets(data, str(path)), "workbook"
    text, encoding = decoded(data, str(path))
    if text.lstrip()[:1] in {"{", "["} and path.suffix.lower() == ".json":
        return json_sheets(text, str(path)), "JSON"
    sheet = separated(text, str(path), separator, decimal)
    return [sheet], f"{encoding}, separated by {sheet.separator}, decimal {sheet.decimal}"


def number(cell: str, decimal: str) -> float | None:
    """Return the number in a cell, with a decimal `point` or `comma`; None where it is none, or too large."""
    form, text = (_COMMA, cell.replace(",", ".")) if decimal == "comma" else (_POINT, cell)
    value = float(text) if form.fullmatch(cell) else math.inf
    return value if math.isfinite(value) else None


def separated(text: str, file: str, separator: str = "", decimal: str = "") -> Sheet:
    """Split a text into rows of cells; separator and decimal sign are guessed where they are not given.

    Raises InputError where no row has two numbers, and where 1,234 may be a thousand or a little more than one.
    """
    lines = text.splitlines()
    begin = list(islice((line for line in lines if line.strip()), _LINES_LOOKED_AT))
    choices = [
        (mark, sign)
        for mark in ([separator] if separator else SEPARATORS)
        for sign in ([decimal] if decimal else DECIMALS)
        if not (mark == "comma" and sign == "comma")
    ]
    counts = [_counts(begin, mark, sign) for mark, sign in choices]
    scores = [good - 3 * bad for good, bad in counts]
    if not scores or max(scores) <= 0:
        raise InputError(f"{file}: no line has two numbers side by side; expected columns of numbers under headings")
    likely = [i for i, score in enumerate(scores) if score >= _LIKELY * max(scores)]
    chosen, sign = choices[min(likely, key=lambda i: counts[i][1])]
    if sign == "comma" and not decimal:
        _refuse_thousands(begin, chosen, file)
    rows = (Row(i, cells_of(line, chosen)) for i, line in enumerate(lines, start=1))
    return Sheet(tuple(rows), chosen, sign)


def cells_of(line: str, separator: str) -> tuple[str, ...]:
    """Return the cells of a line, without blanks and quotation marks around them."""
    sign = SEPARATORS[separator]
    if not sign:
        by_tab = [cell.strip() for cell in line.split("\t")]
        headings = len(by_tab) > 1 and all(number(cell, "point") is None for cell in line.split())
        return tuple(by_tab if headings else line.split())
    if sign == "\t" or '"' not in line:  # a tab needs no quotation marks, and G" has one of its own
        return tuple(cell.strip().strip('"') if cell.count('"') == 2 else cell.strip() for cell in line.split(sign))
    return tuple(cell.strip() for cell in next(csv.reader([line], delimiter=sign)))


def _counts(lines: Sequence[str], separator: str, decimal: str) -> tuple[int, int]:
    """Return numbers that stand beside others, and cells of digits that are none: cut in the wrong place."""
    together, wrong = 0, 0
    for line in lines:
        cells = [cell for cell in cells_of(line, separator) if cell]
        good = sum(number(cell, decimal) is not None or is_clock(cell) for cell in cells)
        together += good if good >= 2 else 0
        bad = [cell for cell in cells if number(cell, decimal) is None and not _DATE.fullmatch(cell)]
        wrong += sum(_BAD.fullmatch(cell) is not None for cell in bad)
    return together, wrong


def _refuse_thousands(lines: Sequence[str], separator: str, file: str) -> None:
    with_comma = [
        cell for line in lines for cell in cells_of(line, separator) if "," in cell and _COMMA.fullmatch(cell)
    ]
    if with_comma and all(_THOUSANDS.fullmatch(cell) for cell in with_comma):
        raise InputError(
            f"{file}: {with_comma[0]!r} may be a decimal comma or a separator of thousands; say `decimal: comma` in "
            "the column map (--columns), or write the numbers without separators"
        )


def json_sheets(text: str, file: str) -> list[Sheet]:
    """Return every object with `columns` (name, unit) and rows of `values`, in the file's order. Raises InputError.

    Lines count in the rows of the data set: 1 is the headings, 2 the units.
    """
    try:
        tree = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{file}: this is no JSON ({str(error)[:80]})") from None
    sheets = list(_sheets(tree, "", file))
    if not sheets:
        raise InputError(f"{file}: no data set in it has `columns` and `values`, as TRIOS writes them")
    return sheets


def _sheets(tree: Any, title: str, file: str) -> Iterator[Sheet]:
    if isinstance(tree, list):
        for item in tree:
            yield from _sheets(item, title, file)
    if not isinstance(tree, dict):
        return
    properties = tree.get("Properties")
    if isinstance(properties, dict):
        title = str(properties.get("Name", title))
    columns, values = tree.get("columns"), tree.get("values")
    if isinstance(columns, list) and isinstance(values, list):
        if not all(isinstance(column, dict) and "name" in column for column in columns):
            raise InputError(f"{file}: {title}: a column without a `name`")
        rows = [
            Row(1, tuple(str(column["name"]) for column in columns)),
            Row(2, tuple(str(column.get("unit") or "[1]") for column in columns)),
        ]
        for line, cells in enumerate(values, start=3):
            if not isinstance(cells, list) or len(cells) != len(columns):
                raise InputError(f"{file}: {title}: row {line - 2} of the values has not {len(columns)} cells")
            rows.append(Row(line, tuple("" if cell is None else str(cell) for cell in cells)))
        yield Sheet(tuple(rows), "sheet", "point", title)
        return
    for item in tree.values():
        yield from _sheets(item, title, file)


def workbook_sheets(data: bytes, file: str) -> list[Sheet]:
    """Return the sheets of a workbook that have something in them. Raises InputError where it cannot be read."""
    from python_calamine import CalamineError, CalamineWorkbook

    try:
        book = CalamineWorkbook.from_filelike(BytesIO(data))
        grids = [(name, book.get_sheet_by_name(name).to_python(skip_empty_area=False)) for name in book.sheet_names]
    except (CalamineError, ValueError, OSError) as error:
        raise InputError(f"{file}: this is no workbook that can be read ({str(error)[:80]})") from None
    sheets = []
    for name, grid in grids:
        rows = tuple(Row(i, tuple(map(_cell, cells))) for i, cells in enumerate(grid, start=1))
        if any(not row.empty for row in rows):
            sheets.append(Sheet(rows, "sheet", "point", name))
    return sheets


def _cell(value: Any) -> str:
    """Return a cell as text: numbers in full, so that none is rounded."""
    if isinstance(value, bool):
        return str(value)
    return repr(float(value)) if isinstance(value, int | float) else str(value).strip()
