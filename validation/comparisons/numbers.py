"""Numbers out of a case's inputs: quantities with units, and lists of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.units import to_si

Array = NDArray[np.float64]


def si(value: Any) -> float:
    """Convert a quantity such as "0.072 in" to SI; return a bare number unchanged."""
    if isinstance(value, str):
        number, _, unit = value.strip().partition(" ")
        return to_si(float(number), unit or "1")
    return float(value)


def array(values: Sequence[Any]) -> Array:
    """Convert a list of quantities to an array in SI."""
    return np.array([si(value) for value in values])
