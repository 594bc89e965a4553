"""Compare two sets of named values and list what differs."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

Value = float | str | None
Values = Mapping[str, Value]
"""Numbers in SI and words by name; a name is `quantity`, `quantity@point`, or one of these after a `group:`."""


@dataclass(frozen=True)
class Difference:
    """Describe one value that differs, was lost or was added."""

    subject: str
    """The study, file or message."""
    quantity: str
    frozen: str
    now: str
    relative: float = math.nan
    """Relative difference; not a number for words, and for names that were lost or added."""

    def __str__(self) -> str:
        """Format the difference as one line."""
        relative = "-" if math.isnan(self.relative) else f"{self.relative:.2e}"
        return f"{self.subject}  {self.quantity}  {self.frozen}  {self.now}  {relative}"


@dataclass(frozen=True, eq=False)
class Renames:
    """Hold the deliberate changes of names since the values were frozen."""

    renamed: Mapping[str, str] = field(default_factory=dict)
    """New name by frozen name, without group and operating point."""
    removed: frozenset[str] = frozenset()
    """Frozen names that need not exist any more."""
    added: frozenset[str] = frozenset()
    """New names that have no frozen value."""

    @classmethod
    def read(cls, path: Path) -> Renames:
        """Read a file of renames; a file that does not exist holds none.

        Raises
        ------
        ValueError
            If the file has a key other than `renamed`, `removed` and `added`.
        """
        data = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
        if unknown := set(data) - {"renamed", "removed", "added"}:
            raise ValueError(f"{path}: unknown keys {sorted(unknown)}; expected renamed, removed, added")
        return cls(data.get("renamed", {}), frozenset(data.get("removed", ())), frozenset(data.get("added", ())))

    def expected(self, frozen: Values) -> dict[str, Value]:
        """Return the frozen values by the names of today, without those that were removed."""
        remaining = {name: value for name, value in frozen.items() if base_name(name) not in self.removed}
        return {self.name_now(name): value for name, value in remaining.items()}

    def name_now(self, name: str) -> str:
        """Return the name that a frozen one has today."""
        base, (group, colon, suffix) = base_name(name), name.rpartition(":")
        return group + colon + self.renamed[base] + suffix[len(base) :] if base in self.renamed else name


def base_name(name: str) -> str:
    """Return a name without its group, operating point, element and sense: `limit:a@hot >=` gives `a`."""
    return name.rpartition(":")[2].partition(" ")[0].partition("@")[0].partition("[")[0]


def relative_difference(frozen: float, now: float, scale: float = 0.0) -> float:
    """Return the difference of two numbers over the larger one, or over `scale` if that is larger.

    It is 0 if both are the same number, or both are not a number, and infinite if only one of them is finite.
    """
    if frozen == now or (math.isnan(frozen) and math.isnan(now)):
        return 0.0
    if not (math.isfinite(frozen) and math.isfinite(now)):
        return math.inf
    return abs(now - frozen) / max(abs(frozen), abs(now), scale)


def differences(
    subject: str, frozen: Values, now: Values, *, tolerance: float = 0.0, renames: Renames | None = None
) -> Iterator[Difference]:
    """Compare the values of a subject, such as a study, with the frozen ones.

    Parameters
    ----------
    tolerance
        Relative difference up to which two numbers are the same; 0 compares bit for bit. For margins of limits, which
        are shares already, it is an absolute difference.
    renames
        Names that changed deliberately.

    Yields
    ------
    Difference
        A value that differs, in the order of the frozen values; then names that were lost, and names that were added.
    """
    renames = renames or Renames()
    expected = renames.expected(frozen)
    for name, value in expected.items():
        if name in now and (difference := _different(subject, name, value, now[name], tolerance)):
            yield difference
    for name, value in expected.items():
        if name not in now:
            yield Difference(subject, name, shown(value), "lost")
    for name, value in now.items():
        if name not in expected and base_name(name) not in renames.added:
            yield Difference(subject, name, "added", shown(value))


def _different(subject: str, name: str, frozen: Value, now: Value, tolerance: float) -> Difference | None:
    if isinstance(frozen, str) or isinstance(now, str) or frozen is None or now is None:
        return None if frozen == now else Difference(subject, name, shown(frozen), shown(now))
    scale = 1.0 if name.startswith(("limit:", "advice:")) else 0.0
    relative = relative_difference(frozen, now, scale)
    return Difference(subject, name, shown(frozen), shown(now), relative) if relative > tolerance else None


def shown(value: Value) -> str:
    """Format a value with all its digits; a word as it is."""
    return value if isinstance(value, str) else repr(value)
