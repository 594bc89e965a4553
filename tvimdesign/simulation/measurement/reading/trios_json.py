"""TA Instruments' TRIOS exports in JSON as rows of cells: a sheet for each data set that has columns and values."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.reading.separated import Row, Sheet


def json_sheets(text: str, file: str) -> list[Sheet]:
    """Every object with `columns` (name, unit) and rows of `values`, in the file's order. Raises InputError.

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
        yield _sheet(columns, values, title, file)
        return
    for item in tree.values():
        yield from _sheets(item, title, file)


def _sheet(columns: list[Any], values: list[Any], title: str, file: str) -> Sheet:
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
    return Sheet(tuple(rows), "sheet", "point", title)
