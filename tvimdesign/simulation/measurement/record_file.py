"""A record of the catalogue from a measurement: `measured` values with low, high and the files' hashes."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from tvimdesign.base.atomic_files import atomic_write
from tvimdesign.base.errors import CatalogError, InputError
from tvimdesign.base.units import from_si
from tvimdesign.catalog import Catalog
from tvimdesign.simulation.measurement.fitting.fit import Estimate
from tvimdesign.simulation.measurement.measure_files import Measured

BASED_ON = {
    "spring_materials": "music_wire",
    "polymers": "pcl_80k",
    "heaters": "flexible_1600",
    "heat_paths": "handbook",
}
"""Default record to base a new one on: all that was not measured is that one's. A joint's is based on none."""
CHOICES = {
    "spring_materials": "spring_material", "polymers": "pcl_grade", "heaters": "heater_module",
    "heat_paths": "heat_paths", "joints": "joint",
}  # fmt: skip
"""What a study names a record of each category by."""
_NAME = re.compile(r"[a-z][a-z0-9_]{0,60}")
_DIGITS = 6


ACCURACY, WARMER = 0.02, 0.5
"""Share of a value, and kelvins of a temperature, by which scale and drift of the instrument may be off: no fit sees
that."""


class NoRecordError(InputError):
    """A fit from which no record follows; the fit itself is of use."""


def record_text(measured: Measured, name: str, based_on: str) -> str:
    """Return the kind's own record as YAML. Raises InputError where nothing follows for one."""
    measurement = measured.measurement
    lines = list(_value_lines(measured, measurement.record_values))
    if not measured.kind.category or not (lines or measurement.record_tables):
        raise NoRecordError(_nothing(measured))
    source = _quoted(measured.source)
    for condition, (chosen, unit) in measurement.record_conditions.items():
        lines.append(f'  {condition}: {{value: {_number(from_si(chosen, unit))}, unit: "{unit}", status: calibrated,')
        lines.append(f'    source: "chosen, and goes with the values {source}"}}')
    text = [*_head(name, based_on), *(["values:", *lines] if lines else [])]
    for table, sheet in measurement.record_tables.items():
        columns = ", ".join(f'{column}: "{unit}"' for column, unit in sheet.columns.items())
        text += ["tables:", f"  {table}:", f"    columns: {{{columns}}}", "    rows:"]
        units = list(sheet.columns.values())
        text += [
            f"      - [{', '.join(_number(from_si(cell, unit)) for cell, unit in zip(row, units, strict=True))}]"
            for row in sheet.rows
        ]
        text += [f'    source: "{source}"', "    status: measured"]
    return "\n".join(text) + "\n"


def write_records(
    measured: Measured, folder: Path, name: str, based_on: str = "", *, overwrite: bool = False
) -> dict[str, Path]:
    """Write what was measured into a folder of the user's records, `<folder>/<category>/<name>.yaml`.

    Returns the files by what a study names each by. One for the kind's own category, and one of the same name for each
    other category that the data give a value of; `based_on` is of the first. Raises InputError where there is one
    already or the name will not do, and CatalogError where what was measured contradicts what a record is based on:
    then none of them stays.
    """
    if not _NAME.fullmatch(name):
        raise InputError(f"--record {name[:60]}: a record's name is small letters, digits and underscores")
    written: dict[str, Path] = {}
    earlier: dict[Path, bytes | None] = {}
    for category, choice, base, text in _records(measured, name, based_on):
        path = folder / category / f"{name}.yaml"
        if path.exists() and not overwrite:
            _put_back(earlier)
            raise InputError(f"{path}: there is such a record already; --overwrite replaces it")
        earlier[path] = path.read_bytes() if path.exists() else None
        path.parent.mkdir(parents=True, exist_ok=True)
        atomic_write(path, text.encode())
        try:
            Catalog(folder).record(category, name)
        except CatalogError as error:
            _put_back(earlier)
            raise CatalogError(
                f"what was measured does not go with {base}, which has all that was not measured: {error}\n"
                "--based-on names another record, such as a shipped one; leave out what contradicts it"
            ) from None
        written[choice] = path
    return written


def write_record(measured: Measured, folder: Path, name: str, based_on: str = "", *, overwrite: bool = False) -> Path:
    """Write the records and return the first of the files."""
    return next(iter(write_records(measured, folder, name, based_on, overwrite=overwrite).values()))


def _records(measured: Measured, name: str, based_on: str) -> list[tuple[str, str, str, str]]:
    """Return category, choice, base and text of every record that follows. Raises InputError where none does."""
    if measured.measurement.fit.misfit:
        raise NoRecordError(f"{measured.kind.name}: {measured.measurement.fit.misfit}")
    category, records = measured.kind.category, []
    base = based_on or BASED_ON.get(category, "")
    others = [record for record in measured.measurement.more_records if any(_value_lines(measured, record.values))]
    if not others or any(_value_lines(measured, measured.measurement.record_values)):
        records.append((category, CHOICES.get(category, ""), base, record_text(measured, name, base)))
    for other in others:
        text = "\n".join([*_head(name, other.based_on), "values:", *_value_lines(measured, other.values)]) + "\n"
        records.append((other.category, other.choice, other.based_on, text))
    return records


def _put_back(earlier: Mapping[Path, bytes | None]) -> None:
    """Leave the files as they were before any was written."""
    for path, text in earlier.items():
        if text is None:
            path.unlink(missing_ok=True)
        else:
            atomic_write(path, text)


def _nothing(measured: Measured) -> str:
    notes = " ".join(measured.measurement.notes)
    return f"{measured.kind.name}: nothing in it is a value of a record" + (f"; {notes}" if notes else "")


def _head(name: str, based_on: str) -> list[str]:
    if not based_on:
        return [f'title: "{name}: what was measured"']
    return [f'title: "{name}: {based_on}, with what was measured"', f"based_on: {based_on}"]


def _value_lines(measured: Measured, values: Mapping[str, Estimate]) -> Iterator[str]:
    source = _quoted(measured.source)
    for name, entry in values.items():
        if entry.low is None or entry.high is None:
            continue
        wide = as_recorded(entry)
        low, value, high = (_number(from_si(end or 0.0, entry.unit)) for end in (wide.low, wide.value, wide.high))
        yield f'  {name}: {{value: {value}, unit: "{entry.unit}", low: {low}, high: {high}, status: measured,'
        yield f'    source: "{source}, interval of 95 %"}}'


def as_recorded(estimate: Estimate) -> Estimate:
    """Return an estimate with the interval that a record has.

    It is wider by the drift that may have gone unseen, and by the instrument's own error, in squares.
    """
    if estimate.low is None or estimate.high is None:
        return estimate
    value, ends = estimate.value, (estimate.low, estimate.high)
    if estimate.unit != "degC" and estimate.low > 0.0:
        moved = np.log1p(estimate.drift / value)
        below, above = (np.hypot(abs(np.log(end / value)) + moved, ACCURACY) for end in ends)
        low, high = value * np.exp(-below), value * np.exp(above)
    else:
        own = WARMER if estimate.unit == "degC" else ACCURACY * abs(value)
        below, above = (np.hypot(abs(end - value) + estimate.drift, own) for end in ends)
        low, high = max(value - below, 0.0) if estimate.low >= 0.0 else value - below, value + above
    return replace(estimate, low=float(low), high=float(high))


def _number(value: float) -> str:
    return f"{value:.{_DIGITS}g}"


def _quoted(text: str) -> str:
    return text.replace("\\", "/").replace('"', "'")
