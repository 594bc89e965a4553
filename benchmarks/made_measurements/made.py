"""A table of made data, as a file would give it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from tvimdesign.simulation.measurement.reading.data_file import Block, Column

Array = NDArray[np.float64]
Made = tuple[list[Block], Mapping[str, str], Mapping[str, float]]
"""Blocks of data, settings as a user writes them, and what the data were made with [SI]."""


def block(**columns: Any) -> Block:
    """Return a table in SI, as a file would give it."""
    table = {name: Column(name, name, "SI", np.asarray(values, float)) for name, values in columns.items()}
    return Block("made.csv", "", (2, 1 + len(next(iter(table.values())).values)), table, (), {})


def numbers(expression: Any) -> Array:
    """Return the values of an expression without symbols."""
    return np.asarray(ca.evalf(ca.MX(expression))).ravel()
