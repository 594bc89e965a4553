"""What came out of a case: found values beside expected ones, their distance as a share of the band, a verdict."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from judging.case import Case, CaseError, Quantity

INSIDE, KNOWN, OUTSIDE, OPEN = "inside", "known difference", "OUTSIDE", "open"


@dataclass(frozen=True)
class Row:
    """One expected value beside the one found."""

    label: str
    expected: float
    found: float
    half_band: float

    @property
    def of_band(self) -> float:
        """How far off it is, over half the band; 1 is its edge. Signed."""
        return (self.found - self.expected) / self.half_band


@dataclass(frozen=True)
class Compared:
    """One quantity of a case, all of its rows."""

    quantity: Quantity
    rows: tuple[Row, ...]

    @property
    def worst(self) -> Row:
        """The row nearest to the edge of its band, or furthest beyond."""
        return max(self.rows, key=lambda row: abs(row.of_band))

    @property
    def verdict(self) -> str:
        """Inside its band, outside by a known difference, or outside.

        A difference that is known and no longer there is outside as well: the case has to be corrected.
        """
        if not all(np.isfinite(row.found) for row in self.rows):
            return OUTSIDE
        if not self.quantity.known:
            return INSIDE if abs(self.worst.of_band) <= 1.0 else OUTSIDE
        furthest = max(abs(row.found / row.expected - 1.0) for row in self.rows)
        return KNOWN if abs(self.worst.of_band) > 1.0 and furthest <= self.quantity.known_within else OUTSIDE


@dataclass(frozen=True)
class Outcome:
    """A case and what came out of it; nothing where it is open."""

    case: Case
    quantities: tuple[Compared, ...]
    seconds: float

    @property
    def verdict(self) -> str:
        """The worst of its quantities' verdicts."""
        found = {one.verdict for one in self.quantities}
        return next((verdict for verdict in (OUTSIDE, KNOWN, INSIDE) if verdict in found), OPEN)

    @property
    def worst(self) -> tuple[Compared, Row]:
        """The quantity and the row that stand worst."""
        order = (INSIDE, KNOWN, OUTSIDE)
        worst = max(self.quantities, key=lambda one: (order.index(one.verdict), abs(one.worst.of_band)))
        return worst, worst.worst


def outcome(case: Case) -> Outcome:
    """Compare a case. Raises CaseError where what comes back is not what the case expects."""
    if case.open:
        return Outcome(case, (), 0.0)
    begin = time.perf_counter()
    found = _called("comparisons", case, case.compare)
    expected = _called("references", case, case.reference) if case.reference else {}
    quantities = tuple(_compared(case, quantity, found, expected) for quantity in case.expected)
    return Outcome(case, quantities, time.perf_counter() - begin)


def worst_first(outcomes: Iterable[Outcome]) -> list[Outcome]:
    """Outside first, then known differences, then the rest by how much of their bands they take; open ones last."""
    order = (OUTSIDE, KNOWN, INSIDE, OPEN)

    def rank(one: Outcome) -> tuple[int, float, str]:
        used = abs(one.worst[1].of_band) if one.quantities else 0.0
        return order.index(one.verdict), -used, one.case.name

    return sorted(outcomes, key=rank)


def _called(room: str, case: Case, name: str) -> Mapping[str, Any]:
    """What a function `module:function` of a room says of a case's inputs."""
    module, _, function = name.partition(":")
    try:
        call = getattr(import_module(f"{room}.{module}"), function)
    except (ImportError, AttributeError) as error:
        raise CaseError(f"{case.name}: {room} has no {name}: {error}") from error
    told: Mapping[str, Any] = call(case.inputs)
    return told


def _compared(case: Case, quantity: Quantity, found: Mapping[str, Any], expected: Mapping[str, Any]) -> Compared:
    told = quantity.values or _numbers(expected.get(quantity.name, ()))
    here = _numbers(found.get(quantity.name, ()))
    if not told or len(told) != len(here):
        raise CaseError(f"{case.name}: {quantity.name}: {len(told)} values expected, {len(here)} found")
    labels = _labels(case, quantity, len(told), expected.get("labels", {}).get(quantity.name, ()))
    pairs = zip(labels, told, here, strict=True)
    return Compared(quantity, tuple(Row(label, a, b, quantity.half_band(a)) for label, a, b in pairs))


def _labels(case: Case, quantity: Quantity, count: int, told: Sequence[str]) -> tuple[str, ...]:
    labels = quantity.labels or tuple(told)
    if quantity.at:
        labels = tuple(f"{quantity.at} {value}" for value in case.inputs[quantity.at])
    elif not labels:
        labels = tuple(str(i + 1) for i in range(count)) if count > 1 else ("",)
    if len(labels) != count:
        raise CaseError(f"{case.name}: {quantity.name}: {len(labels)} labels for {count} values")
    return labels


def _numbers(values: Any) -> tuple[float, ...]:
    return tuple(float(value) for value in np.ravel(np.asarray(values, dtype=float)))
