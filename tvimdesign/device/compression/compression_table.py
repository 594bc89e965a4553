"""The table of the compression-mode module, put together from the rooms that write the quantities."""

from __future__ import annotations

from tvimdesign.device.compression import (
    block_heat,
    block_impedance,
    block_shrinkage,
    block_volumes,
    plate_above,
    ring_heat,
    thermistor_place,
    tile_heat,
    tile_load,
    vane_clearances,
    vane_heat,
    vane_layout,
    vane_liners,
    vane_stiffness,
    vane_tiles,
)
from tvimdesign.device.shared import SHARED_GROUPS
from tvimdesign.device.table.phases import PHASES
from tvimdesign.device.table.quantity_group import gather
from tvimdesign.device.table.table import Table

ROOMS = (
    vane_layout,
    block_impedance,
    vane_stiffness,
    block_heat,
    ring_heat,
    plate_above,
    block_volumes,
    vane_clearances,
    vane_heat,
    tile_heat,
    tile_load,
)
GROUPS = (*vane_tiles.groups, *vane_liners.groups, *block_shrinkage.groups, *thermistor_place.groups)
TABLE = Table(gather([*SHARED_GROUPS, *(room.quantities for room in ROOMS), *GROUPS], "compression"), PHASES)
