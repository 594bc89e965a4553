"""Benefit of cooling by current: the same module left to the air on its way back, like one with a foil heater."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.device.table.quantity import STIFFENING
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions

TIMES = ("stiffening_time", "frozen_time")
"""The times of the way back that are compared."""


@dataclass(frozen=True)
class Cooling:
    """Ability of a module's pads to cool, whether they do, and the time of the way back without cooling [s]."""

    able: bool
    """Whether the heater has a Seebeck coefficient: a foil heats whichever way its current flows."""
    used: bool
    """Whether a current flows through it while the module stiffens."""
    unpowered: Mapping[str, float]
    """`TIMES` with the pads unpowered, where they cool and the module gets soft; infinite where it never happens."""


def cooling(
    model: DeviceFunctions,
    inputs: NDArray[np.float64],
    values: Mapping[str, float],
    current_profiles: Mapping[str, CurrentProfile],
) -> Cooling:
    """Simulate the way back of a module once more, without current. Raises SimulationError."""
    current = model.index[STIFFENING.current_input]
    used = bool(inputs[current] > 0.0) or STIFFENING.name in current_profiles
    able = bool(inputs[model.index["peltier_seebeck"]] > 0.0)
    if not (able and used and math.isfinite(values["response_time"])):
        return Cooling(able, used, {})
    left = inputs.copy()
    left[current] = 0.0
    profiles = {name: profile for name, profile in current_profiles.items() if name != STIFFENING.name}
    alone = Simulator(model).run(left, profiles, {STIFFENING.name}, wanted=TIMES).values
    return Cooling(able, used, {name: alone[name] for name in TIMES})
