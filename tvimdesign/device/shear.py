"""The shear-mode module: its table, put together from the rooms that write the rows."""

from __future__ import annotations

from tvimdesign.device import bodies, gaps, impedance, layout, materials, springs, switching
from tvimdesign.device.rows import Table

ROOMS = (materials, layout, springs, impedance, switching, bodies, gaps)
TABLE = Table(tuple(row for room in ROOMS for row in room.book.rows))
