"""From a design in SI to the dimensions the parts are drawn with: millimetres, radians and plain counts."""

import math
from collections.abc import Iterable, Mapping
from typing import Any

from tvimdesign.base.errors import GeometryError
from tvimdesign.device import Input, Output, table_for
from tvimdesign.device.table.table import AS_DRAWN
from tvimdesign.study import Design

_SCALE = {"mm": 1e3, "rad": 1.0, "deg": 1.0, "1": 1.0}
"""From SI to what CAD uses, by the unit a row is written in; rows in other units are no dimensions."""


HOLES = "_hole_circles"  # End of the name of a row that lists all round holes of a part, to be drawn as they are
_OF_A_CIRCLE = {"count": 1.0, "radius": 1e3, "circle_radius": 1e3, "azimuth": 1.0}
"""What such a row says of each circle of holes (a `HoleCircle`), and its scale from SI."""

_MOST = 64  # Parts of one kind beyond which a design is a mistake


class Dimensions:
    """The design's lengths [mm], angles [rad] and counts by the names of the table: `dims.wire_diameter`."""

    def __init__(self, mode: str, values: Mapping[str, float]) -> None:
        """`values` are in mm, rad and plain numbers by row name."""
        self.mode = mode
        self._values = values

    @property
    def by_name(self) -> Mapping[str, float]:
        """All of them by row name."""
        return self._values

    def __getattr__(self, name: str) -> float:
        """Return the value of a row; raises GeometryError where the design has none that can be drawn."""
        if name.startswith("_"):
            raise AttributeError(name)
        if name not in self._values:
            raise GeometryError(f"the design has no dimension {name!r}; write it anew with `tvimdesign run`")
        value = self._values[name]
        if not math.isfinite(value):
            raise GeometryError(f"{name} is {value}: no part can be drawn to that; see which rules the design violates")
        return value

    def of(self, thing: str, row: str) -> float:
        """Return the value of a row that several things have alike: `screw_pilot` of `link` is `link_screw_pilot`."""
        value: float = getattr(self, f"{thing}_{row}")
        return value

    def count(self, name: str) -> int:
        """Return value of a row that counts something; raises GeometryError where it is no whole number above zero."""
        value: float = getattr(self, name)
        if not 1 <= value <= _MOST or value != round(value):
            raise GeometryError(f"{name} is {value:g}; it must be a whole number from 1 to {_MOST}")
        return round(value)

    def azimuths(self, name: str) -> list[float]:
        """Return azimuths [rad] of the things that row counts, evenly spread, the first at zero; none of no things."""
        count = self.count(name) if getattr(self, name) else 0
        return [2.0 * math.pi * index / count for index in range(count)]

    def holes(self, name: str) -> list[tuple[float, list[tuple[float, float]]]]:
        """Return round holes that a row of the table lists: of each circle of them that is not empty, radius and
        places."""
        circles = []
        for index in range(round(self._values.get(f"{name}.length", 0.0))):
            count, radius, circle, azimuth = (getattr(self, f"{name}.{index}.{of}") for of in _OF_A_CIRCLE)
            if count and radius:
                pitch = 2.0 * math.pi / count
                places = [azimuth + pitch * each for each in range(round(count))]
                circles.append((radius, [(circle * math.cos(at), circle * math.sin(at)) for at in places]))
        return circles


def dimensions(design: Design) -> Dimensions:
    """Convert a design's values to the units of CAD; dimensions that only other rows use are worked out first."""
    return dimensions_of(design.mode, {**design.values, **design.study.get(AS_DRAWN, {})}, design.choices)


def dimensions_of(mode: str, given: Mapping[str, float], choices: Mapping[str, str]) -> Dimensions:
    """Return the same of values [SI] and chosen words by name."""
    table = table_for(mode)
    rows: list[Input | Output] = [*table.inputs, *table.outputs]
    units = {row.name: row.unit for row in rows if row.unit in _SCALE}
    known = {**given, **choices}
    values = {**given, **table.evaluate(known, [row.name for row in table.outputs if row.hidden and row.unit == "mm"])}
    lengths = {name: value * _SCALE[units[name]] for name, value in values.items() if name in units}
    for row in table.outputs:
        if row.name.endswith(HOLES):
            lengths |= _circles(row.name, table.evaluate(known, [row.name])[row.name])
    return Dimensions(mode, lengths)


def _circles(name: str, circles: Iterable[Any]) -> dict[str, float]:
    """Return the numbers of circles of holes as plain dimensions, so that a part is known by those it reads."""
    numbers: dict[str, float] = {}
    for index, circle in enumerate(circles):
        numbers[f"{name}.length"] = index + 1
        numbers |= {f"{name}.{index}.{of}": scale * getattr(circle, of) for of, scale in _OF_A_CIRCLE.items()}
    return numbers
