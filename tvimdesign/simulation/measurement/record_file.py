"""A record of the catalogue from a measurement: `measured` values with low, high and the files' hashes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from tvimdesign.base.errors import CatalogError, InputError
from tvimdesign.base.units import from_si
from tvimdesign.base.whole_files import write_whole
from tvimdesign.simulation.measurement.measure_files import Measured
from tvimdesign.study import Catalog

BASED_ON = {
    "spring_materials": "music_wire",
    "polymers": "pcl_80k",
    "peltiers": "flexible_1600",
    "heat_paths": "handbook",
}
"""What a record is based on unless told: all that was not measured is that one's."""
_NAME = re.compile(r"[a-z][a-z0-9_]{0,60}")
_DIGITS = 6


def record_text(measured: Measured, name: str, based_on: str) -> str:
    """The record as YAML. Raises InputError where nothing follows for one."""
    found = measured.measurement
    lines = list(_value_lines(measured))
    if not measured.kind.category or not (lines or found.record_tables):
        raise InputError(
            f"{measured.kind.name}: nothing in it is a value of a record"
            + (f"; {' '.join(found.notes)}" if found.notes else "")
        )
    text = [f'title: "{name}: {based_on}, with what was measured"', f"based_on: {based_on}"]
    text += ["values:", *lines] if lines else []
    for table, sheet in found.record_tables.items():
        columns = ", ".join(f'{column}: "{unit}"' for column, unit in sheet.columns.items())
        text += ["tables:", f"  {table}:", f"    columns: {{{columns}}}", "    rows:"]
        units = list(sheet.columns.values())
        text += [
            f"      - [{', '.join(_number(from_si(cell, unit)) for cell, unit in zip(row, units, strict=True))}]"
            for row in sheet.rows
        ]
        text += [f'    source: "{_quoted(measured.source)}"', "    status: measured"]
    return "\n".join(text) + "\n"


def write_record(measured: Measured, folder: Path, name: str, based_on: str = "", *, overwrite: bool = False) -> Path:
    """Write the record into a folder of the user's records, `<folder>/<category>/<name>.yaml`; returns its path.

    Raises InputError where there is one already or the name will not do, and CatalogError where what was measured
    contradicts what the record is based on.
    """
    category = measured.kind.category
    if not _NAME.fullmatch(name):
        raise InputError(f"--record {name[:60]}: a record's name is small letters, digits and underscores")
    text = record_text(measured, name, based_on or BASED_ON.get(category, ""))
    path = folder / category / f"{name}.yaml"
    if path.exists() and not overwrite:
        raise InputError(f"{path}: there is such a record already; --overwrite replaces it")
    earlier = path.read_bytes() if path.exists() else None
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, text.encode())
    try:
        Catalog(folder).record(category, name)
    except CatalogError as error:
        if earlier is None:
            path.unlink()
        else:
            write_whole(path, earlier)
        raise CatalogError(f"what was measured does not go with {based_on or BASED_ON[category]}:\n{error}") from None
    return path


def _value_lines(measured: Measured) -> Iterator[str]:
    found = measured.measurement
    source = _quoted(measured.source)
    for name, one in found.record_values.items():
        if one.low is None or one.high is None:
            continue
        low, value, high = (_number(from_si(end, one.unit)) for end in (one.low, one.value, one.high))
        yield f'  {name}: {{value: {value}, unit: "{one.unit}", low: {low}, high: {high}, status: measured,'
        yield f'    source: "{source}, interval of 95 %"}}'
    for name, (chosen, unit) in found.record_conditions.items():
        yield f'  {name}: {{value: {_number(from_si(chosen, unit))}, unit: "{unit}", status: calibrated,'
        yield f'    source: "chosen, and goes with the values {source}"}}'


def _number(value: float) -> str:
    return f"{value:.{_DIGITS}g}"


def _quoted(text: str) -> str:
    return text.replace("\\", "/").replace('"', "'")
