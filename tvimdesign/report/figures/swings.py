"""Oscillations on a logarithmic axis of time: the first swings as a line, what follows as the band they fill."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SWINGS_DRAWN = 6
"""Swings drawn one by one; on a logarithmic axis later ones stand closer than a line is wide."""
_ROUNDING = 2e-3
"""Share of a curve's range by which it must turn back for a swing."""


class Drawn(NamedTuple):
    """A curve as it is drawn: lines, and a band between two lines over `band_x`, empty where all is drawn as a line."""

    lines: tuple[tuple[Array, Array], ...]
    band_x: Array
    low: Array
    high: Array


def drawn(x: Array, y: Array) -> Drawn:
    """Split a curve into the line of its first swings, the band of those after, and the line once it is at rest."""
    turns = _turns(y)
    empty: Array = np.array([])
    if len(turns) <= 4 * SWINGS_DRAWN:
        return Drawn(((x, y),), empty, empty, empty)
    later = turns[2 * SWINGS_DRAWN :]
    first, last = later[0], later[-1]
    sides = [np.interp(x[later], x[side], y[side]) for side in (later[::2], later[1::2])]
    lines = [(x[: first + 1], y[: first + 1])]
    if x[-1] - x[last] > x[last] - x[later[-3]]:  # longer than a swing: it has come to rest
        lines.append((x[last:], y[last:]))
    return Drawn(tuple(lines), x[later], np.minimum(*sides), np.maximum(*sides))


def _turns(y: Array) -> NDArray[np.int64]:
    """Samples at which a curve turns back by more than rounding, alternately highs and lows."""
    least = _ROUNDING * (float(np.max(y)) - float(np.min(y)))
    steps = np.diff(y)
    candidates = np.flatnonzero(steps[:-1] * steps[1:] < 0.0) + 1
    kept = [0]
    for at in candidates:
        step = y[at] - y[kept[-1]]
        if len(kept) > 1 and step * (y[kept[-1]] - y[kept[-2]]) > 0.0:
            kept[-1] = int(at)  # higher still, or lower still, after a ripple
        elif abs(step) > least:
            kept.append(int(at))
    return np.array(kept[1:], dtype=np.int64)
