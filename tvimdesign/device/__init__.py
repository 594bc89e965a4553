"""The module itself: parametric geometry, the modes, and the one table of variables and outputs."""

from tvimdesign.device.modes import MODES, table_for
from tvimdesign.device.table.quantity import (
    Choice,
    Event,
    Input,
    Output,
    Path,
    Rule,
    Scalar,
    Stage,
    Steady,
    Supplied,
    Swing,
    Table,
)  # fmt: skip

__all__ = [
    "MODES", "Choice", "Event", "Input", "Output", "Path", "Rule", "Scalar", "Stage", "Steady", "Supplied", "Swing",
    "Table", "table_for",
]  # fmt: skip
