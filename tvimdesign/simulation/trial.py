"""Result of a virtual test as plain data: tables of curves, panels that draw them, and the numbers read off them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.units import from_si

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Column:
    """One quantity, sampled: SI values, and the unit people read it in."""

    name: str
    unit: str
    values: Array

    @property
    def shown(self) -> list[float]:
        """The values in that unit."""
        return [from_si(float(value), self.unit) for value in self.values]


@dataclass(frozen=True)
class CurveTable:
    """Columns of one length; becomes one CSV file."""

    name: str
    columns: tuple[Column, ...]

    def column(self, name: str) -> Column:
        """Return the column of that name; raises KeyError where there is none."""
        return next(column for column in self.columns if column.name == name)


@dataclass(frozen=True)
class PlottedLine:
    """One line of a panel: two columns of a sheet. `band` names two columns between which the panel is shaded.

    Lines whose labels are the same up to a comma have one colour.
    """

    sheet: str
    x: str
    y: str
    label: str
    band: tuple[str, str] | None = None
    dashed: bool = False


@dataclass(frozen=True)
class Panel:
    """One pair of axes."""

    title: str
    x_label: str
    y_label: str
    lines: tuple[PlottedLine, ...]
    log_x: bool = False
    log_y: bool = False


@dataclass(frozen=True)
class Finding:
    """One number read off a test; `low` and `high` where the layer's history leaves an interval, else None."""

    name: str
    value: float
    unit: str
    meaning: str
    low: float | None = None
    high: float | None = None

    @property
    def parts(self) -> dict[str, float | None]:
        """The numbers by what they are; if history decides there is no one value, only the nominal one."""
        if self.low is None and self.high is None:
            return {"value": self.value}
        return {"nominal": self.value, "low": self.low, "high": self.high}


@dataclass(frozen=True)
class Trial:
    """One virtual test, done."""

    test: str
    title: str
    sheets: tuple[CurveTable, ...]
    panels: tuple[Panel, ...]
    findings: tuple[Finding, ...]
    notes: tuple[str, ...] = ()  # Hints for reading the curves, one sentence each
