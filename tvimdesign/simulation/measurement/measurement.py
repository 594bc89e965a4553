"""Result of a kind of measurement: the fit, notes, and what follows for a record of the catalogue."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.fitting.fit import Estimate, Fit
from tvimdesign.simulation.measurement.reading.data_file import Array, Block

if TYPE_CHECKING:
    from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule

Settings = Mapping[str, Any]  # By name: numbers in SI, texts as they are
LEAST_ROWS = 3


@dataclass(frozen=True)
class RecordTable:
    """A table of a record: columns with their units, rows in SI."""

    columns: Mapping[str, str]
    rows: Sequence[Sequence[float]]


@dataclass(frozen=True)
class OtherRecord:
    """Values of a record of another category than the kind's, which the same data tell."""

    category: str
    based_on: str
    choice: str  # Name in a study
    values: Mapping[str, Estimate]


@dataclass(frozen=True)
class Measurement:
    """The result of fitting a kind of measurement."""

    fit: Fit
    notes: tuple[str, ...] = ()  # Assumptions, and data that was left out
    record_values: Mapping[str, Estimate] = field(default_factory=dict)  # Values of a record, by their names there
    record_tables: Mapping[str, RecordTable] = field(default_factory=dict)
    record_conditions: Mapping[str, tuple[float, str]] = field(default_factory=dict)
    """Values of a record that were chosen, not measured, and go with the others: in SI, with the unit to write."""
    more_records: Sequence[OtherRecord] = ()

    def with_note(self, note: str) -> Measurement:
        """Return a copy with one more note, first."""
        return replace(self, notes=(note, *self.notes))


def required(settings: Settings, name: str, why: str) -> Any:
    """Return a setting that must be there. Raises InputError."""
    if name not in settings:
        raise InputError(f"--set {name}=...: needed, {why}")
    return settings[name]


def endings(blocks: Sequence[Block]) -> list[str]:
    """Return what the names of parameters of each table end with: nothing where there is one table."""
    return [""] if len(blocks) == 1 else [f"_{i}" for i in range(1, len(blocks) + 1)]


def resolve_measured(source: Path) -> ResolvedModule:
    """Return the module of a study, or of a result's design.json."""
    from tvimdesign.simulation.working_cycle.device_functions import resolve_design, resolve_study
    from tvimdesign.study import read_design, read_study

    return resolve_design(read_design(source)) if source.suffix == ".json" else resolve_study(read_study(source))


def rows_of(block: Block, quantities: Sequence[str]) -> list[Array]:
    """Return columns of a block, the rows in which all of them stand. Raises InputError where there are too few."""
    count = block.complete(quantities)
    if count < LEAST_ROWS:
        raise InputError(
            f"{block.place}: {count} rows have {', '.join(quantities)} all at once; at least {LEAST_ROWS} are needed"
        )
    values = [block.values(quantity) for quantity in quantities]
    whole = np.all([np.isfinite(column) for column in values], axis=0)
    return [value[whole] for value in values]


def series_of(block: Block, quantities: Sequence[str], most: int = 0) -> list[Array]:
    """Return columns as `rows_of`, time first; of more than `most` rows every second, third, ... one.

    Raises InputError where time does not rise.
    """
    every = rows_of(block, quantities)
    step = -(-len(every[0]) // most) if most else 1
    taken = [column[::step] for column in every]
    if np.any(np.diff(taken[0]) <= 0.0):
        raise InputError(f"{block.place}: {quantities[0]} does not rise from row to row")
    return taken
