"""Outcome of a case: found values beside expected ones, their deviation as a share of the limit, a verdict."""

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
    """An expected value beside the found one."""

    label: str
    expected: float
    computed: float
    limit: float

    @property
    def of_limit(self) -> float:
        """Return the signed deviation over the limit."""
        return (self.computed - self.expected) / self.limit


@dataclass(frozen=True)
class Compared:
    """A quantity of a case, with all rows."""

    quantity: Quantity
    rows: tuple[Row, ...]

    @property
    def worst(self) -> Row:
        """Return the row nearest its limit, or furthest beyond."""
        return max(self.rows, key=lambda row: abs(row.of_limit))

    @property
    def verdict(self) -> str:
        """Return the verdict: inside its limit, outside by a known difference, or outside.

        A difference that is known and no longer there is outside as well: the case has to be corrected.
        """
        if not all(np.isfinite(row.computed) for row in self.rows):
            return OUTSIDE
        if not self.quantity.known:
            return INSIDE if abs(self.worst.of_limit) <= 1.0 else OUTSIDE
        furthest = max(abs(row.computed / row.expected - 1.0) for row in self.rows)
        return KNOWN if abs(self.worst.of_limit) > 1.0 and furthest <= self.quantity.known_within else OUTSIDE


@dataclass(frozen=True)
class Outcome:
    """A case and its compared quantities, none if it is open."""

    case: Case
    quantities: tuple[Compared, ...]
    seconds: float

    @property
    def verdict(self) -> str:
        """Return the worst of its quantities' verdicts."""
        verdicts = {each.verdict for each in self.quantities}
        return next((verdict for verdict in (OUTSIDE, KNOWN, INSIDE) if verdict in verdicts), OPEN)

    @property
    def worst(self) -> tuple[Compared, Row]:
        """Return the worst quantity and row."""
        order = (INSIDE, KNOWN, OUTSIDE)
        worst = max(self.quantities, key=lambda each: (order.index(each.verdict), abs(each.worst.of_limit)))
        return worst, worst.worst


def outcome(case: Case) -> Outcome:
    """Compare a case; raise CaseError if the values returned are not those expected."""
    if case.open:
        return Outcome(case, (), 0.0)
    begin = time.perf_counter()
    results = _called("comparisons", case, case.compare)
    expected = _called("references", case, case.reference) if case.reference else {}
    quantities = tuple(_compared(case, quantity, results, expected) for quantity in case.expected)
    return Outcome(case, quantities, time.perf_counter() - begin)


def worst_first(outcomes: Iterable[Outcome]) -> list[Outcome]:
    """Sort: outside, known differences, the others by their share of the limit, open cases last."""
    order = (OUTSIDE, KNOWN, INSIDE, OPEN)

    def rank(each: Outcome) -> tuple[int, float, str]:
        used = abs(each.worst[1].of_limit) if each.quantities else 0.0
        return order.index(each.verdict), -used, each.case.name

    return sorted(outcomes, key=rank)


def _called(folder: str, case: Case, name: str) -> Mapping[str, Any]:
    """Call a function `module:function` of a folder with a case's inputs."""
    module, _, function = name.partition(":")
    try:
        call = getattr(import_module(f"{folder}.{module}"), function)
    except (ImportError, AttributeError) as error:
        raise CaseError(f"{case.name}: {folder} has no {name}: {error}") from error
    values: Mapping[str, Any] = call(case.inputs)
    return values


def _compared(case: Case, quantity: Quantity, results: Mapping[str, Any], expected: Mapping[str, Any]) -> Compared:
    values = quantity.values or _numbers(expected.get(quantity.name, ()))
    here = _numbers(results.get(quantity.name, ()))
    if not values or len(values) != len(here):
        raise CaseError(f"{case.name}: {quantity.name}: {len(values)} values expected, {len(here)} found")
    labels = _labels(case, quantity, len(values), expected.get("labels", {}).get(quantity.name, ()))
    pairs = zip(labels, values, here, strict=True)
    return Compared(quantity, tuple(Row(label, a, b, quantity.limit(a)) for label, a, b in pairs))


def _labels(case: Case, quantity: Quantity, count: int, given: Sequence[str]) -> tuple[str, ...]:
    labels = quantity.labels or tuple(given)
    if quantity.at:
        labels = tuple(f"{quantity.at} {value}" for value in case.inputs[quantity.at])
    elif not labels:
        labels = tuple(str(i + 1) for i in range(count)) if count > 1 else ("",)
    if len(labels) != count:
        raise CaseError(f"{case.name}: {quantity.name}: {len(labels)} labels for {count} values")
    return labels


def _numbers(values: Any) -> tuple[float, ...]:
    return tuple(float(value) for value in np.ravel(np.asarray(values, dtype=float)))
