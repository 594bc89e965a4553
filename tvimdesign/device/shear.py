"""The shear-mode module: its table, put together from the rooms that write the rows."""

from __future__ import annotations

from tvimdesign.device import bodies, gaps, impedance, layout, materials, softening, springs, stiffening, thermal
from tvimdesign.device.rows import Table
from tvimdesign.device.stages import STAGES

ROOMS = (materials, layout, springs, impedance, thermal, softening, stiffening, bodies, gaps)
TABLE = Table(tuple(row for room in ROOMS for row in room.book.rows), STAGES)
