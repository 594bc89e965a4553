"""Summary of cells as they pass to their files: how they ended, the best of them, what is drawn and listed."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Any

from tvimdesign.sweep.gather import Value, columns
from tvimdesign.sweep.plan import ALWAYS, SweepPlan

MOST_DRAWN = 20_000
"""Cells of a figure; of more, every second, third, ... is drawn."""
MOST_LISTED = 2_000
"""Cells of a page, which a browser draws and sorts; of more, every second, third, ... is there."""
MOST_FAILED = 500
"""Cells without an answer that a page lists; of more, the first."""
PANELS = 3


class CellTable:
    """Looks at every row of a table once."""

    def __init__(self, plan: SweepPlan) -> None:
        """Start with no cells."""
        self._names = [column.name for column in columns(plan)]
        self._units = {column.name: column.unit for column in columns(plan)}
        self._every = -(-plan.count // MOST_DRAWN)
        self.every_listed = -(-plan.count // MOST_LISTED)
        """Each how many-th cell the page has."""
        study = plan.first
        wanted = [*study.minimize, *(limit.output for limit in study.require), *ALWAYS]
        apart = {axis.name for axis in plan.axes}
        self.shown = [name for name in dict.fromkeys(wanted) if name not in apart][:PANELS]
        """Outputs of the figure and of the screen."""
        self.least = [name for name in (study.minimize or self.shown) if name not in apart]
        self._ended: Counter[str] = Counter()
        self.best: dict[str, dict[str, Any]] = {}
        """By minimised output: the feasible cell with the least value."""
        self.drawn: list[dict[str, Value]] = []
        """Rows of the figure."""
        self.listed: list[dict[str, Value]] = []
        """Rows of the page."""
        self.failed: list[dict[str, Value]] = []
        """Rows of the first cells without an answer."""
        self.failures = 0
        """Count of the cells without an answer."""
        self.keeping = 0
        """Count of the feasible cells."""

    @property
    def statuses(self) -> dict[str, int]:
        """Count of cells by status."""
        return dict(sorted(self._ended.items()))

    def seeing(self, rows: Iterable[list[Value]]) -> Iterator[list[Value]]:
        """Hand on every row, once it is seen."""
        for number, values in enumerate(rows):
            row = dict(zip(self._names, values, strict=True))
            self._ended[str(row["status"])] += 1
            for name in self.least:
                self._compare(name, row)
            if number % self._every == 0:
                self.drawn.append(row)
            if number % self.every_listed == 0:
                self.listed.append(row)
            self._note_end(row)
            yield values

    def _note_end(self, row: dict[str, Value]) -> None:
        """Count a cell by whether it has an answer, and whether it is feasible."""
        self.keeping += row["broken"] == 0
        if row["broken"] is not None:
            return
        self.failures += 1
        if len(self.failed) < MOST_FAILED:
            self.failed.append(row)

    def _compare(self, name: str, row: dict[str, Value]) -> None:
        value = row[name]
        if row["broken"] != 0 or not isinstance(value, float) or not math.isfinite(value):
            return
        if name not in self.best or value < self.best[name]["value"]:
            self.best[name] = {"cell": row["cell"], "value": value, "unit": self._units[name]}
