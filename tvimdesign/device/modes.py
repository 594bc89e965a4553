"""Modes that a module can have, each with its table."""

from __future__ import annotations

from functools import cache

from tvimdesign.base.errors import InputError
from tvimdesign.device.table.quantity import PHASES
from tvimdesign.device.table.quantity_group import gather
from tvimdesign.device.table.table import Table

MODES = ("shear", "compression")
"""The modes a study may name."""


@cache
def table_for(mode: str) -> Table:
    """Return the table of a mode; raises InputError for a mode that does not exist."""
    if mode not in MODES:
        raise InputError(f"mode {mode!r} is not one of: {', '.join(MODES)}")
    from tvimdesign.device.mode_files import FILES_OF_MODE, SHARED_FILES

    return Table(gather((*SHARED_FILES, *FILES_OF_MODE[mode]), mode), PHASES)
