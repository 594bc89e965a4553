"""Any tests of one melt together: sweeps, ramps, creep and relaxation, of which each sees a part of one spectrum."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.kind_sheet import kind_sheets
from tvimdesign.simulation.measurement.kinds.measurement import Measurement, Settings
from tvimdesign.simulation.measurement.kinds.polymer.melt_spectrum import measured
from tvimdesign.simulation.measurement.reading.data_file import Block

PARTS = ("frequency_sweep", "temperature_ramp", "creep", "relaxation")


def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit every table as the kind whose columns it has. Raises InputError for a table of none of them."""
    tests, told = [], []
    for block in blocks:
        kind = next((name for name in PARTS if kind_sheets()[name].fits(block)), None)
        if kind is None:
            raise InputError(f"{block.file}:{block.lines[0]}: this table is none of {', '.join(PARTS)}")
        room = import_module(f"{__package__}.{kind}")
        tests += room.tests_of(block, {**kind_sheets()[kind].values({}), **settings})
        told.append(f"{block.title or block.file} as {kind}")
    found = measured(tests, settings, profiles=profiles)
    return found.with_note(f"Fitted together: {'; '.join(told)}.")
