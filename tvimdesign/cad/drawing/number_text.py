"""Lengths, angles and azimuths as drawings write them."""

from __future__ import annotations

from collections.abc import Sequence
from decimal import ROUND_HALF_UP, Decimal
from itertools import pairwise

_HUNDREDTH = Decimal("0.01")
_LISTED = 4
"""Azimuths that are listed; of more that are evenly apart the ends are told."""


def figure(value: float) -> str:
    """A length or an angle with at most two decimals, a half rounded up: every text of a drawing rounds here.

    A micrometre is settled first: 23.155 read off two faces is 23.16 in both places.
    """
    settled = Decimal(f"{value:.4f}").quantize(_HUNDREDTH, ROUND_HALF_UP)
    return f"{settled:f}".rstrip("0").rstrip(".") if settled else "0"


def around(azimuths: Sequence[float]) -> str:
    """Azimuths [deg] in ascending order: all around evenly, or the first few and how often they come again."""
    if len(azimuths) == 1:
        return f"at {figure(azimuths[0])}°"
    steps = [later - earlier for earlier, later in pairwise([*azimuths, azimuths[0] + 360.0])]
    if _even(steps):
        return f"every {figure(360.0 / len(azimuths))}° from {figure(azimuths[0])}°"
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
