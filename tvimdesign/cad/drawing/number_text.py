"""Lengths, angles and azimuths as drawings write them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

_LISTED = 4
"""Azimuths that are listed; of more that are evenly apart the ends are told."""


def figure(value: float) -> str:
    """A length or an angle with at most two decimals."""
    return f"{value:.2f}".rstrip("0").rstrip(".") if abs(value) >= 5e-3 else "0"


def around(azimuths: Sequence[float]) -> str:
    """Azimuths [deg] in ascending order: all around evenly, or the first few and how often they come again."""
    steps = [later - earlier for earlier, later in pairwise([*azimuths, azimuths[0] + 360.0])]
    if _even(steps):
        return f"from {figure(azimuths[0])}°"
    few = next(
        few
        for few in range(1, len(steps) + 1)
        if len(steps) % few == 0 and all(_even(steps[start::few]) for start in range(few))
    )
    # The pattern begins behind the widest step.
    start = (max(range(few), key=lambda one: steps[one]) + 1) % few
    first = azimuths[start : start + few] if start + few <= len(azimuths) else azimuths
    again = f", {len(steps) // few} times around" if few < len(steps) else ""
    if few > _LISTED and _even([later - earlier for earlier, later in pairwise(first)]):
        apart = figure(first[1] - first[0])
        return f"from {figure(first[0])}° every {apart}° to {figure(first[-1])}°{again}"
    return f"at {', '.join(f'{figure(azimuth)}°' for azimuth in first)}{again}"


def _even(steps: Sequence[float]) -> bool:
    return max(steps) - min(steps) < 0.01
