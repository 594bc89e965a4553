"""Points spread over the unit cube, seeded: where a search begins besides the study's own start."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

FEW = 16
"""Starts up to which points are simply drawn: for as few a sequence that fills the cube evenly has no merit yet."""


def unit_points(starts: int, size: int, seed: int) -> Iterator[NDArray[np.float64]]:
    """Endless points between 0 and 1 for a search with so many starts; the same ones for the same seed.

    Many starts follow a scrambled Sobol sequence (Owen's scrambling, scipy), which leaves no part of the ranges out.
    """
    if starts <= FEW:
        random = np.random.default_rng(seed)
        while True:
            yield random.random(size)
    from scipy.stats import qmc  # half a second of import that few starts do without

    sequence = qmc.Sobol(size, rng=np.random.default_rng(seed))
    batch = 1 << (starts - 1).bit_length()  # a power of two, as the sequence is even over those
    while True:
        yield from sequence.random(batch)
