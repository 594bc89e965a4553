"""How a number that was found on a part becomes a check: against which limit, and what falling short of it means."""

from __future__ import annotations

from tvimdesign.cad.cad_report import Level, SolidCheck
from tvimdesign.cad.export.mesh import Array


def at_least(value: float, limit: float, failing: float | None = None) -> Level:
    """Level of a value that must not be less than a limit; a failure below `failing`, which is the limit itself."""
    if value >= limit:
        return "pass"
    return "failure" if failing is None or not value >= failing else "warning"


def at_most(value: float, limit: float) -> Level:
    """Level of a value that must not be more than a limit, a failure where it is."""
    return "pass" if value <= limit else "failure"


def finding(
    part: str, what: str, value: float, limit: float, unit: str, level: Level, text: str,
    *, place: Array | None = None, resolution: float = 0.0,
) -> SolidCheck:  # fmt: skip
    """Return a check of one part, its value in `unit`, found at `place` by samples `resolution` [mm] apart."""
    return SolidCheck(
        name=f"{part}: {what}", value=float(value), limit=float(limit), ok=level != "failure", text=f"{part}: {text}",
        warned=level == "warning", part=part, place=None if place is None else tuple(round(float(x), 3) for x in place),
        unit=unit, resolution=resolution,
    )  # fmt: skip
