"""Records to choose from as shares of a mixture: the hull of their numbers, and a device in which they are unknowns.

Each record has a share between 0 and 1, and the shares add up to one. A number of the device is the sum of the records'
numbers times their shares, and so is an output that reads a record's table. Where one share is one, the device is that
of the record; no combination of records lies outside the hull, so what is best in it bounds them all.
"""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.device import Input, Table
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, built_once
from tvimdesign.study import Options, Study

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Mixture:
    """Records of one or a few choices that share numbers; a design has one of them."""

    records: tuple[dict[str, str], ...]  # Records chosen by each of them, by the choices' names
    numbers: Mapping[str, tuple[float, ...]]  # The inputs (SI) that differ among them, one value a record
    words: tuple[Mapping[str, Any], ...]  # Their records and options as the table reads them
    read_by: tuple[str, ...]  # The outputs that read these

    @property
    def name(self) -> str:
        """The choices, which stand for all of their records."""
        return ", ".join(self.records[0])

    @cached_property
    def shares(self) -> tuple[str, ...]:
        """The names of the shares among the device's inputs."""
        return tuple(f"share of {', '.join(record.values())}" for record in self.records)

    def in_order(self, order: Sequence[int]) -> "Mixture":
        """Return the records in another order."""
        return Mixture(
            tuple(self.records[i] for i in order),
            {name: tuple(values[i] for i in order) for name, values in self.numbers.items()},
            tuple(self.words[i] for i in order),
            self.read_by,
        )


class MixedDevice(DeviceFunctions):
    """A device whose records are mixed: their shares are inputs. It starts with the first record of each mixture."""

    def __init__(
        self, table: Table, given: Mapping[str, Any], points: Sequence[str], cells: int, mixtures: Sequence[Mixture]
    ) -> None:
        self.mixtures = tuple(mixtures)
        shares = {name: float(place == 0) for mixture in mixtures for place, name in enumerate(mixture.shares)}
        super().__init__(table, {**given, **shares}, points, cells)
        self.start = self.mixed(self.start)

    def mixed(self, inputs: Array) -> Array:
        """Inputs with shares that add up to one, and the numbers that follow from these."""
        mixed_inputs = inputs.copy()
        for mixture in self.mixtures:
            places = [self.index[name] for name in mixture.shares]
            mixed_inputs[places] = shared(mixed_inputs[places])
            for name, values in mixture.numbers.items():
                mixed_inputs[self.index[name]] = mixed_inputs[places] @ np.array(values)
        return mixed_inputs

    @property
    def _apart(self) -> tuple[Any, ...]:
        return self.mixtures

    @built_once
    def _symbols(self) -> tuple[Any, Any, dict[str, Any]]:
        inputs, cycle, known = super()._symbols
        for mixture in self.mixtures:
            for name, values in mixture.numbers.items():
                known[name] = _sum(mixture, known, values)
        for reader, mixture in sorted(self._readers(), key=lambda pair: len(self.table.ancestors(pair[0]))):
            read = [self.table.resolve({**known, **words}, [reader])[reader] for words in mixture.words]
            known[reader] = _sum(mixture, known, read)
        return inputs, cycle, known

    def _readers(self) -> list[tuple[str, Mixture]]:
        return [(reader, mixture) for mixture in self.mixtures for reader in mixture.read_by]


def shared(shares: Array) -> Array:
    """Numbers that are not negative as shares of their sum; alike where all are nothing."""
    whole = np.sum(shares)
    return shares / whole if whole > 0.0 else np.full(len(shares), 1.0 / len(shares))


def _sum(mixture: Mixture, known: Mapping[str, Any], values: Sequence[Any]) -> Any:
    """Values weighted by the records' shares."""
    return sum(known[share] * value for share, value in zip(mixture.shares, values, strict=True))


def listed_records(study: Study, table: Table) -> dict[str, list[str]]:
    """Return the records and options a study lists, by the choice's name."""
    return {
        name: [str(value) for value in vary.values]
        for name, vary in study.vary.items()
        if isinstance(vary, Options) and not isinstance(table.quantity(name), Input)
    }


def discrete_records(study: Study, table: Table) -> list[dict[str, str]]:
    """Return every combination of listed records and options; one empty combination if none is listed."""
    listed = listed_records(study, table)
    return [dict(zip(listed, combination, strict=True)) for combination in itertools.product(*listed.values())]


def with_records(study: Study, records: Mapping[str, str]) -> Study:
    """Return the study with some records chosen."""
    if not records:
        return study
    vary = {name: value for name, value in study.vary.items() if name not in records}
    return study.model_copy(update={"module": {**study.module, **records}, "vary": vary})
