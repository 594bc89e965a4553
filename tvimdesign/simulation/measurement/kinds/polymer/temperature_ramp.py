"""Temperature ramps of a melt at one frequency: spectrum and shift from how the moduli change with temperature.

Each row's rate is the frequency times Arrhenius' factor at its own temperature. Rows below the least temperature, where
the polymer may be frozen, are left out: there the moduli are those of the solid fraction, which depends on the history.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.physics.polymers import polymer
from tvimdesign.simulation.measurement.kinds.measurement import LEAST_ROWS, Measurement, Settings
from tvimdesign.simulation.measurement.kinds.polymer.frequency_sweep import oscillation
from tvimdesign.simulation.measurement.kinds.polymer.melt_spectrum import guessed_shift, measured
from tvimdesign.simulation.measurement.kinds.polymer.melt_test import Curve, MeltTest, title_of
from tvimdesign.simulation.measurement.reading.data_file import Block

MELT = 70.0 + polymer.ZERO_CELSIUS
"""Least temperature [K] unless set: polycaprolactone's melting ends at 62 to 70 degC."""


def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit ramps. Raises InputError where no row is of the melt."""
    return measured([test for block in blocks for test in tests_of(block, settings)], settings, profiles=profiles)


def tests_of(block: Block, settings: Settings) -> list[MeltTest]:
    """The ramp of a table, the rows of the melt."""
    least = settings.get("least_temperature", MELT)
    found = oscillation(block)
    molten = found[3] >= least
    if np.sum(molten) < LEAST_ROWS:
        raise InputError(
            f"{block.file}:{block.lines[0]}: {np.sum(molten)} rows of the melt, from "
            f"{least - polymer.ZERO_CELSIUS:.0f} degC on; --set least_temperature=... says otherwise"
        )
    omega, storage, loss, at = (one[molten] for one in found)
    middle = float(np.median(at))

    def predicted(which: int) -> Callable[[polymer.Modes, Any], Any]:
        return lambda modes, shift: polymer.maxwell_moduli(omega * shift, modes)[which]

    where = title_of(block, middle)
    curves = [
        Curve(f"{name} of {where}", "Pa", moduli, predicted(which), at, "temperature", "degC")
        for which, (name, moduli) in enumerate((("storage modulus", storage), ("loss modulus", loss)))
    ]
    seen = omega * guessed_shift(at, middle)
    return [MeltTest(where, middle, at, curves, seen, np.hypot(storage, loss))]
