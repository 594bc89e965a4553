"""Modes that a module can have, each with its table."""

from __future__ import annotations

from functools import cache

from tvimdesign.base.errors import InputError
from tvimdesign.device.table.table import Table

MODES = ("shear", "compression")
"""The modes a study may name."""


@cache
def table_for(mode: str) -> Table:
    """Return the table of a mode; raises InputError for a mode that does not exist."""
    if mode == "shear":
        from tvimdesign.device.shear.shear_table import TABLE

        return TABLE
    if mode == "compression":
        from tvimdesign.device.compression.compression_table import TABLE

        return TABLE
    raise InputError(f"mode {mode!r} is not one of: {', '.join(MODES)}")
