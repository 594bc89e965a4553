"""Where a solid stands, as numbers."""

from __future__ import annotations

import cadquery as cq
import numpy as np
from numpy.typing import NDArray


def placement(location: cq.Location) -> NDArray[np.float64]:
    """4 x 4 matrix of a location."""
    place_of = location.wrapped.Transformation()
    rows = [[place_of.Value(row, column) for column in range(1, 5)] for row in range(1, 4)]
    return np.array([*rows, [0.0, 0.0, 0.0, 1.0]])
