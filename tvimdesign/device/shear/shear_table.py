"""The table of the shear-mode module, of the files that define its quantities."""

from __future__ import annotations

from tvimdesign.device.shared import SHARED_FILES
from tvimdesign.device.shear import (
    arc_clearances,
    arc_laps,
    arc_volumes,
    floor_heat,
    keys,
    layer_columns,
    layer_end,
    layer_heat,
    layer_impedance,
    layer_shrinkage,
    leads,
    lip_heat,
    melt_lip,
    pad_heat,
    pad_pockets,
    thermistor_seat,
    tiles,
)
from tvimdesign.device.table.quantity import PHASES
from tvimdesign.device.table.quantity_group import gather
from tvimdesign.device.table.table import Table

FILES = (
    pad_pockets, layer_impedance, arc_laps, layer_heat, layer_columns, layer_end, lip_heat, floor_heat, arc_volumes,
    arc_clearances, pad_heat, tiles, leads, thermistor_seat, keys, layer_shrinkage, melt_lip,
)  # fmt: skip
TABLE = Table(gather((*SHARED_FILES, *FILES), "shear"), PHASES)
