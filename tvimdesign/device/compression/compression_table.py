"""The table of the compression-mode module, of the files that define its quantities."""

from __future__ import annotations

from tvimdesign.device.compression import (
    block_heat,
    block_impedance,
    block_volumes,
    ring_heat,
    thermistor_place,
    vane_clearances,
    vane_heat,
    vane_layout,
    vane_stiffness,
    vane_tiles,
)
from tvimdesign.device.shared import SHARED_FILES
from tvimdesign.device.table.quantity import PHASES
from tvimdesign.device.table.quantity_group import gather
from tvimdesign.device.table.table import Table

FILES = (
    vane_layout, block_impedance, vane_stiffness, block_heat, ring_heat, vane_heat, block_volumes, vane_clearances,
    vane_tiles, thermistor_place,
)  # fmt: skip
TABLE = Table(gather((*SHARED_FILES, *FILES), "compression"), PHASES)
