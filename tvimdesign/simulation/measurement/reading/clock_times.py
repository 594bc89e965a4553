"""Clock times of loggers and spreadsheets as seconds from the first row."""

import re
from collections.abc import Collection, Sequence
from datetime import datetime, timedelta

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


def is_date(cell: str) -> bool:
    """Return whether a cell is a date alone."""
    return _DATE.fullmatch(cell) is not None


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
