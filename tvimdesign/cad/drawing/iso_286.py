"""Limit deviations of a tolerance class by ISO 286-1, from its table in `iso_286.yaml`."""

import re
from collections.abc import Sequence
from functools import partial
from itertools import pairwise
from typing import NamedTuple

from tvimdesign.base.errors import GeometryError
from tvimdesign.base.yaml_data import own_data

_DATA = "iso_286.yaml"
standard_data = partial(own_data, __file__, _DATA)
_MICRON = 1e-3
_HAIR = 1e-5
"""What [mm] a size may be off the end of a range for rounding."""


class Limits(NamedTuple):
    """Lower and upper limit deviation [mm]."""

    lower: float
    upper: float


def limit_deviations(fit: str, size: float) -> Limits:
    """Limit deviations [mm] of a tolerance class such as H7 or js5 at a nominal size [mm]; ISO 286-1.

    Raises GeometryError for a class or a size that is not in the table.
    """
    known = re.fullmatch(r"(H|JS|G|h|js|g|k)(\d)", fit)
    if not known or (known[1] == "k" and known[2] not in "567"):
        raise GeometryError(f"tolerance class {fit!r} is not in {_DATA}: H, JS, G, h, js, g, or k in 5 to 7")
    letter, width = known[1], standard_tolerance(int(known[2]), size)
    if letter in ("JS", "js"):
        return Limits(-0.5 * width, 0.5 * width)
    if letter in ("H", "h"):
        return Limits(0.0, width) if letter == "H" else Limits(-width, 0.0)
    off = _MICRON * _at(standard_data()["deviations"][letter.lower()], size)
    if letter == "k":
        return Limits(off, off + width)
    return Limits(off - width, off) if letter == "g" else Limits(-off, -off + width)


def standard_tolerance(grade: int, size: float) -> float:
    """Return standard tolerance [mm] of a grade at a size [mm]."""
    grades = standard_data()["grades"]
    if grade not in grades:
        raise GeometryError(f"tolerance grade IT{grade} is not in {_DATA}: it has {', '.join(map(str, grades))}")
    return _MICRON * _at(grades[grade], size)


def _at(row: Sequence[int], size: float) -> int:
    """Return the value of a row of the table at a size [mm]."""
    ends = (0.0, *standard_data()["up_to"])
    # What is a hair off a range's end for rounding belongs to the range.
    for value, (over, up_to) in zip(row, pairwise(ends), strict=True):
        if over < size <= up_to + _HAIR:
            return value
    raise GeometryError(f"{size:g} mm is outside the sizes of {_DATA}: above 0 up to {ends[-1]:g} mm")
