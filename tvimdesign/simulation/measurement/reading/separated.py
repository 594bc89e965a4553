"""Text as rows of cells: which sign separates them, and which stands before the decimals."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice

from tvimdesign.base.errors import InputError

SEPARATORS = {"tab": "\t", "semicolon": ";", "bar": "|", "comma": ",", "blanks": ""}
"""By the names a column map uses; in the order in which they are preferred where several would do."""
DECIMALS = {"point": ".", "comma": ","}
_POINT = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,4})?")
_COMMA = re.compile(r"[+-]?(?:[0-9]+(?:,[0-9]*)?|,[0-9]+)(?:[eE][+-]?[0-9]{1,4})?")
_THOUSANDS = re.compile(r"[+-]?[1-9][0-9]{0,2}(?:,[0-9]{3})+")
_BAD = re.compile(r"(?=.*[0-9])[0-9.,;|+\-eE\s]+")
_LOOKED_AT = 3000
_LIKELY = 0.8
"""Share of the best score from which a way to cut the lines may be right: what cuts least wrongly is taken then."""


@dataclass(frozen=True)
class Row:
    """The cells of a line; `line` counts from 1."""

    line: int
    cells: tuple[str, ...]

    @property
    def empty(self) -> bool:
        """Whether nothing stands in it."""
        return not any(self.cells)

    @property
    def filled(self) -> int:
        """Cells in which something stands."""
        return sum(map(bool, self.cells))


@dataclass(frozen=True)
class Sheet:
    """The rows of a text or of a sheet of a workbook, and how its numbers are written."""

    rows: tuple[Row, ...]
    separator: str
    """By its name in `SEPARATORS`; `sheet` in a workbook."""
    decimal: str
    title: str = ""

    def number(self, cell: str) -> float | None:
        """The number in a cell; None where it has none."""
        return number(cell, self.decimal)

    def numbers(self, row: Row) -> int:
        """Cells of a row that are numbers."""
        return sum(self.number(cell) is not None for cell in row.cells)


def number(cell: str, decimal: str) -> float | None:
    """The number in a cell, with a decimal `point` or `comma`; None where the cell is not a number, or a greater one
    than a computer has.
    """
    form, text = (_COMMA, cell.replace(",", ".")) if decimal == "comma" else (_POINT, cell)
    value = float(text) if form.fullmatch(cell) else math.inf
    return value if math.isfinite(value) else None


def separated(text: str, file: str, separator: str = "", decimal: str = "") -> Sheet:
    """Split a text into rows of cells; separator and decimal sign are guessed where they are not given.

    Raises InputError where no row has two numbers, and where 1,234 may be a thousand or a little more than one.
    """
    lines = text.splitlines()
    begin = list(islice((line for line in lines if line.strip()), _LOOKED_AT))
    choices = [
        (one, sign)
        for one in ([separator] if separator else SEPARATORS)
        for sign in ([decimal] if decimal else DECIMALS)
        if not (one == "comma" and sign == "comma")
    ]
    counts = [_counts(begin, one, sign) for one, sign in choices]
    scores = [good - 3 * bad for good, bad in counts]
    if not scores or max(scores) <= 0:
        raise InputError(f"{file}: no line has two numbers side by side; expected columns of numbers under headings")
    likely = [i for i, score in enumerate(scores) if score >= _LIKELY * max(scores)]
    found, sign = choices[min(likely, key=lambda i: counts[i][1])]
    if sign == "comma" and not decimal:
        _refuse_thousands(begin, found, file)
    rows = (Row(i, cells_of(line, found)) for i, line in enumerate(lines, start=1))
    return Sheet(tuple(rows), found, sign)


def cells_of(line: str, separator: str) -> tuple[str, ...]:
    """The cells of a line, without blanks and quotation marks around them."""
    sign = SEPARATORS[separator]
    if not sign:
        by_tab = [cell.strip() for cell in line.split("\t")]
        headings = len(by_tab) > 1 and all(number(cell, "point") is None for cell in line.split())
        return tuple(by_tab if headings else line.split())
    if sign == "\t" or '"' not in line:  # a tab needs no quotation marks, and G" has one of its own
        return tuple(cell.strip().strip('"') if cell.count('"') == 2 else cell.strip() for cell in line.split(sign))
    return tuple(cell.strip() for cell in next(csv.reader([line], delimiter=sign)))


def _counts(lines: Sequence[str], separator: str, decimal: str) -> tuple[int, int]:
    """Numbers that stand beside others, and cells of digits that are none: cut in the wrong place."""
    together, wrong = 0, 0
    for line in lines:
        cells = [cell for cell in cells_of(line, separator) if cell]
        good = sum(number(cell, decimal) is not None for cell in cells)
        together += good if good >= 2 else 0
        wrong += sum(number(cell, decimal) is None and _BAD.fullmatch(cell) is not None for cell in cells)
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
