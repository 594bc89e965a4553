"""A validation case as its folder holds it: case.yaml, read and checked before anything is compared."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

CASES = Path(__file__).resolve().parents[1] / "cases"
KINDS = {
    "springs": "Springs",
    "parts": "Fits, screws and friction",
    "heat": "Heat",
    "heater": "Peltier modules",
    "freezing": "Freezing and melting",
    "rheology": "Rheology",
    "layers": "Layers and blocks",
    "motion": "Motion of the link",
    "structure": "Structure",
    "devices": "Published devices",
}
"""Kinds of case, in the order of the page, with their headings."""
_CASE = {"title", "kind", "source", "compare", "inputs", "expected", "reference", "open", "note"}
_QUANTITY = {"unit", "value", "values", "low", "high", "relative", "absolute", "at", "labels", "known", "known_within"}


DATED = re.compile(
    r"10\.\d{4,9}/\S"  # a DOI
    r"|\((?:[^()]*\D)?(?:18|19|20)\d\d\b|\w[:-](?:19|20)\d\d\b|, (?:19|20)\d\d\b"  # (1959), ISO 273:1979, ASME ...-1994
    r"|\d(?:st|nd|rd|th) ed\.|its edition\)"
    r"|own calculation of 20\d\d-\d\d|read (?:on )?20\d\d-\d\d|commit [0-9a-f]{7}"
    r"|without year or DOI|neither DOI nor edition"
)
"""What says which edition of a source is meant, by DOI, year, edition or day; or that there is none of them."""


class CaseError(Exception):
    """A case that cannot be read; names file, entry and what is wrong."""


@dataclass(frozen=True)
class Quantity:
    """Expected values of a quantity or curve of a case."""

    name: str
    unit: str
    values: tuple[float, ...]
    """Empty where the case's reference gives them."""
    relative: float
    """Limit, as a share of the expected value."""
    absolute: float
    """Limit, in `unit`; the wider of the two holds."""
    at: str
    """The input that the values go over; empty for one value or labelled ones."""
    labels: tuple[str, ...]
    known: str
    """Reason of a known difference."""
    known_within: float
    """How far it may be off then, as a share."""

    def limit(self, expected: float) -> float:
        """Return the limit around an expected value."""
        return max(self.absolute, self.relative * abs(expected))


@dataclass(frozen=True)
class Case:
    """A case that is compared, or open: then `open` says what is missing."""

    name: str
    folder: Path
    title: str
    kind: str
    source: str
    compare: str
    """`module:function` of comparisons/."""
    reference: str
    """`module:function` of references/, where the expected values are computed."""
    inputs: Mapping[str, Any]
    expected: tuple[Quantity, ...]
    open: str
    note: str


def read_cases(folder: Path = CASES) -> list[Case]:
    """Read all cases of a folder, by name; raise CaseError."""
    return [read_case(path) for path in sorted(folder.glob("*/case.yaml"))]


def read_case(path: Path) -> Case:
    """Read one case; raise CaseError for what is missing, unknown or not finite."""
    given = yaml.safe_load(path.read_text(encoding="utf-8"))
    if not isinstance(given, dict):
        raise CaseError(f"{path}: a case is a mapping of {', '.join(sorted(_CASE))}")
    _only(given, _CASE, str(path))
    for name in ("title", "kind", "source"):
        if not given.get(name):
            raise CaseError(f"{path}: {name}: missing")
    if not DATED.search(" ".join(str(given["source"]).split())):
        raise CaseError(f"{path}: source: give its DOI, edition or year, or the day a page was read: {given['source']}")
    if given["kind"] not in KINDS:
        raise CaseError(f"{path}: kind: {given['kind']!r} is none of {', '.join(KINDS)}")
    if bool(given.get("open")) == bool(given.get("compare")):
        raise CaseError(f"{path}: either `compare` names a function, or `open` says what is missing")
    inputs = given.get("inputs", {})
    expected = [
        _quantity(f"{path}: expected.{name}", name, entry, inputs, bool(given.get("reference")))
        for name, entry in given.get("expected", {}).items()
    ]
    if given.get("compare") and not expected:
        raise CaseError(f"{path}: expected: missing")
    words = {name: " ".join(str(given.get(name, "")).split()) for name in ("title", "source", "open", "note")}
    return Case(
        name=path.parent.name, folder=path.parent, kind=given["kind"], compare=given.get("compare", ""),
        reference=given.get("reference", ""), inputs=inputs, expected=tuple(expected), **words,
    )  # fmt: skip


def _quantity(where: str, name: str, entry: Any, inputs: Mapping[str, Any], computed: bool) -> Quantity:
    if not isinstance(entry, dict):
        raise CaseError(f"{where}: expected a mapping of {', '.join(sorted(_QUANTITY))}")
    _only(entry, _QUANTITY, where)
    values, absolute = _values(where, entry)
    if bool(values) == computed:
        raise CaseError(f"{where}: give value, values or low and high, or name a `reference`, not both")
    relative = float(entry.get("relative", 0.0))
    if not relative + absolute > 0.0:
        raise CaseError(f"{where}: relative or absolute: a limit is needed, such as relative: 0.01")
    if entry.get("at") and entry["at"] not in inputs:
        raise CaseError(f"{where}: at: {entry['at']!r} is no input of the case")
    if bool(entry.get("known")) != ("known_within" in entry):
        raise CaseError(f"{where}: a known difference needs `known`, its reason, and `known_within`, its size")
    return Quantity(
        name=name, unit=str(entry.get("unit", "1")), values=values, relative=relative, absolute=absolute,
        at=entry.get("at", ""), labels=tuple(map(str, entry.get("labels", ()))),
        known=" ".join(str(entry.get("known", "")).split()), known_within=float(entry.get("known_within", 0.0)),
    )  # fmt: skip


def _values(where: str, entry: Mapping[str, Any]) -> tuple[tuple[float, ...], float]:
    """Return expected values and their absolute limit: of a published range, half the range."""
    if "low" in entry or "high" in entry:
        low, high = float(entry["low"]), float(entry["high"])
        if not low < high:
            raise CaseError(f"{where}: low has to be below high")
        return (0.5 * (low + high),), 0.5 * (high - low)
    given = entry["values"] if "values" in entry else [entry["value"]] if "value" in entry else []
    values = tuple(float(value) for value in given)
    if not all(math.isfinite(value) for value in values):
        raise CaseError(f"{where}: not a finite number among {given}")
    return values, float(entry.get("absolute", 0.0))


def _only(given: Mapping[str, Any], known: set[str], where: str) -> None:
    unknown = sorted(set(given) - known)
    if unknown:
        raise CaseError(f"{where}: {', '.join(unknown)}: unknown; it may have {', '.join(sorted(known))}")
