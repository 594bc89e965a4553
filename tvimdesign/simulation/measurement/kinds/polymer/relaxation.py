"""Stress relaxation of a melt: the modulus over time after a strain that is held.

G(t) follows by `viscoelasticity.relaxation_modulus`, or by `ramped_stress` where the strain took a time to be reached.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.physics.polymers import viscoelasticity
from tvimdesign.physics.polymers.polymer import Modes
from tvimdesign.simulation.measurement.kinds.measurement import Measurement, Settings, required, rows_of
from tvimdesign.simulation.measurement.kinds.polymer.melt_spectrum import measured
from tvimdesign.simulation.measurement.kinds.polymer.melt_test import (
    Curve,
    MeltTest,
    temperature_of,
    thinned,
    title_of,
)
from tvimdesign.simulation.measurement.reading.data_file import Array, Block
from tvimdesign.simulation.working_cycle.casadi_setup import ca


def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit relaxations, together. Raises InputError for what lacks."""
    return measured([test for block in blocks for test in tests_of(block, settings)], settings, profiles=profiles)


def tests_of(block: Block, settings: Settings) -> list[MeltTest]:
    """The relaxation of a table: rows after the rise, with a modulus above zero."""
    time, modulus = _modulus(block, settings)
    rise = settings["rise_time"]
    good = (time > rise) & (modulus > 0.0)
    time, modulus = time[good], modulus[good]
    if len(time) == 0:
        raise InputError(f"{block.file}:{block.lines[0]}: no row has a time after the rise and a modulus above zero")
    used = thinned(time)
    time, modulus = time[used], modulus[used]
    temperature = temperature_of(block, settings)
    where = title_of(block, temperature)

    def predicted(modes: Modes, shift: Any) -> Any:
        reduced = ca.MX(ca.DM(time)) / shift
        if rise == 0.0:
            return viscoelasticity.relaxation_modulus(reduced, modes)
        # `ramped_stress` at a strain of one, after the rise
        return sum(
            viscoelasticity.relaxation_modulus(reduced - rise / shift, [mode])
            * viscoelasticity.start_up_viscosity(rise / shift, [mode]) / (mode[1] * rise / shift)
            for mode in modes
        )  # fmt: skip

    curve = Curve(f"relaxation modulus of {where}", "Pa", modulus, predicted, time, "time", "s")
    return [MeltTest(where, temperature, None, [curve], 1.0 / time, modulus)]


def _modulus(block: Block, settings: Settings) -> tuple[Array, Array]:
    """Time and modulus: the file's, or stress over strain, which may be set."""
    if "relaxation_modulus" in block.columns:
        time, modulus = rows_of(block, ["time", "relaxation_modulus"])
        return time, modulus
    if "strain" in block.columns:
        time, stress, strain = rows_of(block, ["time", "stress", "strain"])
        return time, stress / np.max(np.abs(strain))
    time, stress = rows_of(block, ["time", "stress"])
    return time, stress / required(settings, "strain", f"as {block.file} has a stress and neither strain nor modulus")
