"""What a virtual test is done on: a study's module with its numbers, at the temperatures that are tested."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tvimdesign.catalog import Catalog
from tvimdesign.device import Table, table_for
from tvimdesign.study import Study, given
from tvimdesign.study.model import STANDARD_POINTS

MELTING_POINT = {"temperature": 333.15, "frequency": 1.0}
"""The paper's third temperature, 60 degC, which joins cold and hot where a study names no points of its own."""


@dataclass(frozen=True)
class Rig:
    """A module on the bench. `given` holds every input and record by full name, as `Table.evaluate` wants them."""

    study: Study
    catalog: Catalog
    table: Table
    given: dict[str, Any]
    points: tuple[str, ...]

    def rows(self, names: Iterable[str], **changes: Any) -> dict[str, Any]:
        """Return the rows of those full names in SI, with other values of some rows where `changes` says so."""
        return self.table.evaluate({**self.given, **changes}, names)

    def value(self, name: str) -> Any:
        """Return one row in SI."""
        return self.rows([name])[name]


def rig_of(study: Study, catalog: Catalog | None = None, design: dict[str, float] | None = None) -> Rig:
    """Put a study's module on the bench: at its start, or at the inputs of a `design`, by full name in SI.

    A study that names no operating points is tested at the paper's three temperatures.
    """
    points = dict(study.operating_points)
    if points == STANDARD_POINTS:
        points = {"cold": points["cold"], "melting": MELTING_POINT, "hot": points["hot"]}
    study = study.model_copy(update={"operating_points": points})
    catalog, table = catalog or _catalog(study), table_for(study.mode)
    values = {**given(study, catalog, table), **(design or {})}
    return Rig(study, catalog, table, values, tuple(points))


def _catalog(study: Study) -> Catalog:
    return Catalog(Path(study.catalog_folder) if study.catalog_folder else None)
