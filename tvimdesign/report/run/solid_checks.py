"""What the checks on the solids found, for the terminal: failures, then warnings, then how many passed."""

from __future__ import annotations

from collections.abc import Sequence

from rich import box
from rich.console import Console
from rich.table import Table

from tvimdesign.base.units import pretty
from tvimdesign.cad.cad_report import SolidCheck

_COLOURS = {"failure": "red", "warning": "yellow"}
_SHOWN = 15


def print_solid_checks(checks: Sequence[SolidCheck], console: Console) -> None:
    """Print what did not pass, worst first, and count the rest."""
    found = worst_first(checks)
    if found:
        grid = Table(box=box.SIMPLE_HEAD, title="Checks on the solids", title_justify="left", show_edge=False)
        for column in ("", "what was found", "value", "limit", "at x, y, z in mm"):
            grid.add_column(column, justify="right" if column in {"value", "limit"} else "left")
        for check in found[:_SHOWN]:
            unit = pretty(check.unit)
            place = ", ".join(f"{x:.1f}" for x in check.place) if check.place else ""
            level = f"[{_COLOURS[check.level]}]{check.level}[/]"
            grid.add_row(level, check.text, f"{check.value:.4g} {unit}", f"{check.limit:.4g} {unit}", place)
        console.print(grid)
    console.print(_count(checks, max(0, len(found) - _SHOWN)), soft_wrap=True)


def in_short(checks: Sequence[SolidCheck]) -> str:
    """How many checks passed, how many did not, and the worst failure."""
    found = worst_first(checks)
    counts = (f"{sum(check.level == level for check in found)} {level}s" for level in _COLOURS)
    said = [f"{sum(check.level == 'pass' for check in checks)} of {len(checks)} checks on the solids passed"]
    said += [count for count in counts if not count.startswith("0 ")]
    said += [f"the worst: {check.text}" for check in found[:1] if check.level == "failure"]
    return "; ".join([*said, "cad/checks.json"] if found else said)


def worst_first(checks: Sequence[SolidCheck]) -> list[SolidCheck]:
    """Failures, then warnings, those that miss their limit by the most first."""
    rank = {"failure": 0, "warning": 1}
    reported = [check for check in checks if check.level in rank]
    return sorted(reported, key=lambda check: (rank[check.level], -_missed(check), check.name))


def _missed(check: SolidCheck) -> float:
    """By what share of it a value misses its limit."""
    return abs(check.value - check.limit) / max(abs(check.limit), 1e-9)


def _count(checks: Sequence[SolidCheck], hidden: int) -> str:
    passed = sum(check.level == "pass" for check in checks)
    sampled = sum(check.resolution > 0.0 for check in checks)
    more = f"; {hidden} more that did not are in checks.json" if hidden else ""
    return f"{passed} of {len(checks)} checks on the solids passed, {sampled} of them all by samples{more}."
