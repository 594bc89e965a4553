"""Scrambled Sobol points, kept from one run to the next: to load scipy's takes 0.4 s, to draw some thousand 10 ms."""

from __future__ import annotations

from importlib.metadata import version

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.user_cache import find_code, keep_code


def sobol_points(dimensions: int, count: int, seed: int) -> NDArray[np.float64]:
    """Return the first points of a sequence in the unit cube, one a row; `count` is a power of two."""
    key = (f"scipy {version('scipy')}, numpy {version('numpy')}", f"Sobol {dimensions} {count} {seed}")
    cached = find_code(*key)
    if cached is not None:
        return np.frombuffer(cached).reshape(count, dimensions)
    from scipy.stats import qmc

    points: NDArray[np.float64] = qmc.Sobol(dimensions, rng=np.random.default_rng(seed)).random(count)
    keep_code(points.tobytes(), *key)
    return points
