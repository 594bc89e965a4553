"""The table of the shear-mode module, put together from the rooms that write the rows."""

from __future__ import annotations

from tvimdesign.device.book import gather
from tvimdesign.device.rows import Table
from tvimdesign.device.shared import BOOKS
from tvimdesign.device.shear import bodies, gaps, impedance, keys, layout, thermal
from tvimdesign.device.stages import STAGES

ROOMS = (layout, impedance, thermal, bodies, gaps)
TABLE = Table(gather([*BOOKS, *(room.book for room in ROOMS), *keys.books], "shear"), STAGES)
