"""What making the parts gives back: plain records, without the CAD kernel."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class Check:
    """One thing that was held against the design."""

    name: str
    value: float
    """Relative deviation, or what two parts share [mm^3], or a gap [mm]."""
    limit: float
    ok: bool
    text: str
    """What was checked, for people."""


@dataclass(frozen=True)
class CadReport:
    """The files that were written and the checks that were made."""

    folder: Path
    files: tuple[str, ...]
    """Relative to the folder."""
    checks: tuple[Check, ...]
    seconds: float
    notes: tuple[str, ...] = field(default=())
    """What is missing and why, such as the picture on a machine that cannot render."""

    reused: tuple[str, ...] = field(default=())
    """The parts and checks that were kept from before, because nothing they hang on has changed."""

    @property
    def failed(self) -> tuple[Check, ...]:
        """The checks that did not hold: the parts are there to be looked at, not to be made."""
        return tuple(check for check in self.checks if not check.ok)
