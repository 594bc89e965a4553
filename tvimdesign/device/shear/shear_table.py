"""The table of the shear-mode module, put together from the rooms that write the rows."""

from __future__ import annotations

from tvimdesign.device.shared import BOOKS
from tvimdesign.device.shear import arc_clearances, arc_volumes, keys, layer_heat, layer_impedance, rotor_level
from tvimdesign.device.table.phases import STAGES
from tvimdesign.device.table.quantity import Table
from tvimdesign.device.table.quantity_group import gather

ROOMS = (rotor_level, layer_impedance, layer_heat, arc_volumes, arc_clearances)
TABLE = Table(gather([*BOOKS, *(room.book for room in ROOMS), *keys.books], "shear"), STAGES)
