"""Excel and LibreOffice workbooks as rows of cells, by python-calamine."""

from __future__ import annotations

from io import BytesIO
from typing import Any

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.reading.separated import Row, Sheet

ENDINGS = (".xlsx", ".xlsm", ".xlsb", ".xls", ".ods")


def workbook_sheets(data: bytes, file: str) -> list[Sheet]:
    """The sheets of a workbook that have something in them. Raises InputError where it cannot be read."""
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
    """A cell as text: numbers in full, so that none is rounded."""
    if isinstance(value, bool):
        return str(value)
    return repr(float(value)) if isinstance(value, int | float) else str(value).strip()
