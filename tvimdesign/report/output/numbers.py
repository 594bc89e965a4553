"""Numbers for people and for files: digits, units, ranges, labels, and the entries of JSON files.

One unit system in files: every bare number is in SI. A number that people read in another unit stands under `value`,
`low` and `high` with its `unit`, and under `si` once more in SI. What never happens is null.
"""

import csv
import io
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from typing import Any

from tvimdesign.base.record import own_data
from tvimdesign.base.units import from_si, pretty, si_unit

_CAPITALS = {"pcl": "PCL", "youngs": "Young's"}
_NAME = re.compile(r"\b[a-z][a-z0-9]*(?:_[a-z0-9]+)+(?:@\w+)?|\b[a-z_0-9]+@\w+|^[a-z]+(?= [<>]=)")


_labels = partial(own_data, __file__, "labels.yaml")  # Labels of quantities whose names do not read as words


def name_in_words(name: str, words: str | None = None) -> str:
    """Return a quantity's full name in words, or with other words for all but its point."""
    quantity, _, point = name.partition("@")
    words = words or " ".join(_CAPITALS.get(word, word) for word in quantity.split("_"))
    return f"{words}, {point.replace('_', ' ')}" if point else words


def label(name: str) -> str:
    """Return the label of a quantity: a few words for people; its name in words if it has none of its own."""
    return name_in_words(name, _labels().get(name.partition("@")[0]))


def in_labels(text: str) -> str:
    """Return a text with each name of a quantity replaced by its label."""
    return _NAME.sub(lambda match: label(match[0]), text)


_NAMED = 2  # Limits that are named, of those that allow no more
_NO_MARGIN = re.compile(r" >= 0( [^\s,]+)?(?=$|,)")


def at_its_minimum(text: str) -> str:
    """Return a limit in labels: `wall of the posts at its minimum` for a margin that must not be negative."""
    return in_labels(_NO_MARGIN.sub(" at its minimum", text))


def held_by(limits: Sequence[str]) -> str:
    """Return the first limits and ranges that allow no more, in words."""
    texts = [text.removesuffix(" >= 0 mm") for text in limits[:_NAMED]]
    return in_labels(" and ".join(texts)) or "the study's limits"


def axis_label(name: str, unit: str) -> str:
    """Return what stands at an axis: the quantity in words, and its unit; a dash for a number without one."""
    words = name_in_words(name)
    shown = pretty(unit)
    return f"{words[0].upper()}{words[1:]} ({shown if shown and shown != '1' else '–'})"


FORMAT = 1
"""Version of results.json, compare.json, findings.json and tolerances.json; a change that breaks a reader raises it."""


def head() -> dict[str, Any]:
    """Return the first entries of a JSON file of results."""
    return {"format": FORMAT, "units": "SI"}


Ends = tuple[float | None, float | None]


def number_entry(value: float, unit: str, ends: Ends | None = None) -> dict[str, Any]:
    """Return a number (SI) of a quantity people read in `unit`, with its range (SI) if that is known."""
    low, high = ends or (None, None)
    return {
        "value": finite_in(value, unit),
        "low": finite_in(low, unit),
        "high": finite_in(high, unit),
        "unit": pretty(unit),
        "si": {"value": finite(value), "low": finite(low), "high": finite(high), "unit": pretty(si_unit(unit))},
    }


def listed(words: Sequence[str]) -> str:
    """Return `a, b and c`."""
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def all_finite(data: Any) -> Any:
    """Return plain data with null for what is not finite."""
    if isinstance(data, Mapping):
        return {key: all_finite(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [all_finite(value) for value in data]
    return finite(data) if isinstance(data, float) else data


def finite(value: float | None) -> float | None:
    """Return a number, or None for what never happens: JSON has no infinity."""
    return value if value is not None and math.isfinite(value) else None


def finite_in(value: float | None, unit: str) -> float | None:
    """Return a number (SI) in a unit, or None for what never happens."""
    return None if value is None else finite(from_si(value, unit))


def number(value: float | None, digits: int = 4) -> str:
    """Return a number for people: `digits` significant figures, no needless zeros, `never` for what does not happen."""
    if value is None or math.isinf(value):
        return "never"
    text = f"{value:.{digits}g}"
    return f"{value:.0f}" if "e+" in text and abs(value) < 1e7 else text


_FINEST, _LEAST_DIGITS, _ROUNDING = {"mm": 0.01}, 2, 1e-9
"""What one measures to in a workshop, by unit; of a smaller number the first digits show where it comes from."""


def in_unit(value: float, unit: str, digits: int = 4) -> str:
    """Return a number (SI) for people, in a unit: no finer than a workshop measures, but to two digits."""
    shown = from_si(value, unit)
    if unit in _FINEST and shown and math.isfinite(shown):
        measured = 1 + math.floor(math.log10(abs(shown)) + _ROUNDING) - round(math.log10(_FINEST[unit]))
        digits = min(digits, max(measured, _LEAST_DIGITS))
    return number(shown, digits)


def with_unit(value: float, unit: str, digits: int = 4) -> str:
    """Return a number (SI) for people with its unit; `never` has none."""
    return number(value) if math.isinf(value) else f"{in_unit(value, unit, digits)} {pretty(unit)}".rstrip()


def percent(share: float, digits: int = 3) -> str:
    """Return a share for people: `95.8 %`."""
    return f"{100.0 * share:.{digits}g} %"


def ends_text(low: float | None, high: float | None, digits: int = 3) -> str:
    """Return an interval for people, `38 to 104`; what never happens has no end."""
    return " to ".join(number(end, digits) for end in (low, high))


def range_text(interval: Mapping[str, Any] | None) -> str:
    """Return the range of a value, `38 to 104`; empty if its ends are the value itself in three digits."""
    if interval is None:
        return ""
    text = ends_text(interval["low"], interval["high"])
    value = ends_text(interval["value"], interval["value"])
    return "" if text == value else text


def csv_text(rows: Iterable[Mapping[str, Any]], columns: Sequence[str] = (), digits: int = 0) -> str:
    """Return rows as CSV; what a row lacks, or has as None, is empty.

    Columns are those of the first row, and floats have all their digits, unless given.
    """
    listed, stream = list(rows), io.StringIO()
    heads = columns or (list(listed[0]) if listed else [])
    writer = csv.DictWriter(stream, heads, lineterminator="\n", extrasaction="ignore")
    writer.writeheader()
    for row in listed:
        shown = (
            (name, f"{cell:.{digits}g}" if digits and isinstance(cell, float) else cell) for name, cell in row.items()
        )
        writer.writerow(dict(shown))
    return stream.getvalue()


def curves_csv(curves: Mapping[str, Sequence[float]], units: Mapping[str, str], other: str) -> str:
    """Return columns of equal length as CSV, headed by name and unit; `other` is the unit of what is not in `units`."""
    heads = [f"{name} [{pretty(units.get(name, other)) or 1}]" for name in curves]
    rows = zip(*(map(float, values) for values in curves.values()), strict=True)
    return csv_text((dict(zip(heads, row, strict=True)) for row in rows), heads, 8)
