"""The table of the shear-mode module, put together from the rooms that write the quantities."""

from __future__ import annotations

from tvimdesign.device.shared import SHARED_GROUPS
from tvimdesign.device.shear import (
    arc_clearances,
    arc_laps,
    arc_volumes,
    cold_sides,
    floor_heat,
    keys,
    layer_columns,
    layer_end,
    layer_heat,
    layer_impedance,
    layer_shrinkage,
    liner_rim,
    lip_heat,
    melt_lip,
    melt_retention,
    pad_pockets,
    rotor_level,
    thermistor_seat,
    tile_heat,
    tile_room,
    tiles,
)
from tvimdesign.device.table.phases import PHASES
from tvimdesign.device.table.quantity_group import gather
from tvimdesign.device.table.table import Table

ROOMS = (
    rotor_level, layer_impedance, arc_laps, layer_heat, layer_columns, layer_end, liner_rim, lip_heat, floor_heat,
    arc_volumes, arc_clearances, melt_retention, tile_heat, tile_room,
    cold_sides,
)  # fmt: skip
GROUPS = (
    *tiles.groups, *pad_pockets.groups, *thermistor_seat.groups, *keys.groups, *layer_shrinkage.groups,
    *melt_lip.groups,
)  # fmt: skip
TABLE = Table(gather([*SHARED_GROUPS, *(room.quantities for room in ROOMS), *GROUPS], "shear"), PHASES)
