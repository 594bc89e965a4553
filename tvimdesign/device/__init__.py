"""The module itself: parametric geometry, the modes, and the one table of variables and outputs."""

from tvimdesign.device.modes import MODES, table_for
from tvimdesign.device.table import Scalar
from tvimdesign.device.table.quantity import (
    Choice,
    Event,
    Input,
    Output,
    Path,
    Phase,
    Rule,
    Simulated,
    Steady,
    Supplied,
)
from tvimdesign.device.table.table import Table

__all__ = [
    "MODES", "Choice", "Event", "Input", "Output", "Path", "Phase", "Rule", "Scalar", "Simulated", "Steady",
    "Supplied", "Table", "table_for",
]  # fmt: skip
