"""The table of the shear-mode module, put together from the rooms that write the quantities."""

from __future__ import annotations

from tvimdesign.device.shared import BOOKS
from tvimdesign.device.shear import arc_clearances, arc_volumes, keys, layer_heat, layer_impedance, rotor_level
from tvimdesign.device.table.phases import PHASES
from tvimdesign.device.table.quantity_group import gather
from tvimdesign.device.table.table import Table

ROOMS = (rotor_level, layer_impedance, layer_heat, arc_volumes, arc_clearances)
TABLE = Table(gather([*BOOKS, *(room.quantities for room in ROOMS), *keys.groups], "shear"), PHASES)
