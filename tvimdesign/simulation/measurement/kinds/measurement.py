"""What a kind of measurement comes to: the fit, notes, and what follows for a record of the catalogue."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.fitting.fit import Estimate, Fit
from tvimdesign.simulation.measurement.reading.data_file import Array, Block

Settings = Mapping[str, Any]
"""By name: numbers in SI, texts as they are."""
LEAST_ROWS = 3


@dataclass(frozen=True)
class RecordTableFound:
    """A table of a record: columns with their units, rows in SI."""

    columns: Mapping[str, str]
    rows: Sequence[Sequence[float]]


@dataclass(frozen=True)
class RecordFound:
    """Values of a record of another category than the kind's, which the same data tell."""

    category: str
    based_on: str
    choice: str
    """What a study names it by."""
    values: Mapping[str, Estimate]


@dataclass(frozen=True)
class Measurement:
    """What data of a kind come to."""

    fit: Fit
    notes: tuple[str, ...] = ()
    """What a reader has to know: what was taken for what, what was left out."""
    record_values: Mapping[str, Estimate] = field(default_factory=dict)
    """Values of a record, by their names there."""
    record_tables: Mapping[str, RecordTableFound] = field(default_factory=dict)
    record_conditions: Mapping[str, tuple[float, str]] = field(default_factory=dict)
    """Values of a record that were chosen, not measured, and go with the others: in SI, with the unit to write."""
    more_records: Sequence[RecordFound] = ()

    def with_note(self, note: str) -> Measurement:
        """The same with one more note, first."""
        return replace(self, notes=(note, *self.notes))


def required(settings: Settings, name: str, why: str) -> Any:
    """A setting that must be there. Raises InputError."""
    if name not in settings:
        raise InputError(f"--set {name}=...: needed, {why}")
    return settings[name]


def rows_of(block: Block, quantities: Sequence[str]) -> list[Array]:
    """These columns of a block, the rows in which all of them stand. Raises InputError where there are too few."""
    count = block.complete(quantities)
    if count < LEAST_ROWS:
        raise InputError(
            f"{block.file}:{block.lines[0]}: {count} rows have {', '.join(quantities)} all at once; "
            f"at least {LEAST_ROWS} are needed"
        )
    import numpy as np

    values = [block.values(quantity) for quantity in quantities]
    whole = np.all([np.isfinite(one) for one in values], axis=0)
    return [one[whole] for one in values]


def series_of(block: Block, quantities: Sequence[str], most: int = 0) -> list[Array]:
    """The same of a series in time, which stands first; of more than `most` rows every second, third, ... one.

    Raises InputError where time does not rise.
    """
    import numpy as np

    every = rows_of(block, quantities)
    step = -(-len(every[0]) // most) if most else 1
    taken = [one[::step] for one in every]
    if np.any(np.diff(taken[0]) <= 0.0):
        raise InputError(f"{block.file}:{block.lines[0]}: {quantities[0]} does not rise from row to row")
    return taken
