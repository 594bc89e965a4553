"""Frequency sweeps of a melt: storage and loss modulus over frequency, at one temperature or several.

G', G'' follow by `polymer.maxwell_moduli`; what is fitted stands in `melt_spectrum`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tvimdesign.physics.polymers import polymer
from tvimdesign.simulation.measurement.kinds.measurement import Measurement, Settings, rows_of
from tvimdesign.simulation.measurement.kinds.polymer.melt_spectrum import measured
from tvimdesign.simulation.measurement.kinds.polymer.melt_test import Curve, MeltTest, temperature_of, title_of
from tvimdesign.simulation.measurement.reading.data_file import Array, Block

_APART = 1.5
"""Rows within so many kelvin of the first are of one sweep, where a table holds sweeps at several temperatures."""


def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit sweeps at one temperature or several. Raises InputError for what lacks."""
    return measured([test for block in blocks for test in tests_of(block, settings)], settings, profiles=profiles)


def tests_of(block: Block, settings: Settings) -> list[MeltTest]:
    """The sweeps of a table: one for each temperature that it holds."""
    frequency, storage, loss, *at = oscillation(block)
    if not at:
        return [_test(block, temperature_of(block, settings), frequency, storage, loss)]
    changes = np.flatnonzero(np.abs(np.diff(at[0])) > _APART) + 1
    return [
        _test(block, float(np.mean(at[0][part])), frequency[part], storage[part], loss[part])
        for part in np.split(np.arange(len(frequency)), changes)
    ]


def oscillation(block: Block) -> list[Array]:
    """Angular frequency [rad/s], G', G'' [Pa] and, where there is one, temperature [K]; rows above zero."""
    which = "angular_frequency" if "angular_frequency" in block.columns else "frequency"
    extra = ["temperature"] if block.complete(["temperature"]) else []
    frequency, storage, loss, *rest = rows_of(block, [which, "storage_modulus", "loss_modulus", *extra])
    good = (frequency > 0.0) & (storage > 0.0) & (loss > 0.0)
    omega = frequency * (1.0 if which == "angular_frequency" else 2.0 * np.pi)
    return [one[good] for one in (omega, storage, loss, *rest)]


def _test(block: Block, temperature: float, omega: Array, storage: Array, loss: Array) -> MeltTest:
    def predicted(which: int) -> Callable[[polymer.Modes, Any], Any]:
        return lambda modes, shift: polymer.maxwell_moduli(omega * shift, modes)[which]

    where = title_of(block, temperature)
    curves = [
        Curve(f"{name} of {where}", "Pa", moduli, predicted(which), omega, "angular frequency", "rad/s")
        for which, (name, moduli) in enumerate((("storage modulus", storage), ("loss modulus", loss)))
    ]
    return MeltTest(where, temperature, None, curves, omega, np.hypot(storage, loss))
