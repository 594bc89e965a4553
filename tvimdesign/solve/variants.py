"""Variants of a design evaluated beside it: without one of its idealizations, and without cooling by current."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.errors import TvimError
from tvimdesign.device import Choice
from tvimdesign.device.table.quantity import STIFFENING
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, ResolvedModule
from tvimdesign.solve.nlp.constraints import on_cycle

_SAME, _SAME_CYCLE = 1e-6, 2e-3
"""Shares by which two values of an output differ by rounding, and by the integration of a working cycle."""


@dataclass(frozen=True)
class Idealization:
    """A word of the study that leaves out something of the drawn part, and what the module is without it."""

    choice: str
    word: str
    instead: str  # The word that leaves nothing out
    leaves_out: str
    as_drawn: dict[str, float]
    """The outputs (SI) that are other values without it; NaN where the module cannot be evaluated so."""

    @property
    def text(self) -> str:
        """`transmission: unity`."""
        return f"{self.choice}: {self.word}"


def idealizations(
    resolved: ResolvedModule,
    inputs: NDArray[np.float64],
    values: Mapping[str, float],
    current_profiles: Mapping[str, CurrentProfile],
) -> tuple[Idealization, ...]:
    """Return the idealizations of a module, each alone; `values` are with all of them, `inputs` in their order."""
    table = resolved.table
    rows = []
    for row in table.choices:
        word = resolved.values[row.name]
        if isinstance(word, str) and word in row.idealized:
            without = _without(row, resolved, inputs, current_profiles)
            changed = {name: value for name, value in without.items() if not _same(name, value, values[name], resolved)}
            if not without:
                needing = [other.name for other in table.outputs if row.name in table.ancestors(other.name)]
                changed = {name: np.nan for name in values if name.partition("@")[0] in needing}
            rows.append(Idealization(row.name, word, row.default, row.idealized[word], changed))
    return tuple(rows)


def _without(
    row: Choice, resolved: ResolvedModule, inputs: NDArray[np.float64], current_profiles: Mapping[str, CurrentProfile]
) -> dict[str, float]:
    """Return every output of the module without an idealization; empty if there is no such module."""
    study = resolved.study
    given = {**resolved.values, row.name: row.default}
    try:
        model = DeviceFunctions(resolved.table, given, resolved.points, study.solver.cells)
        cycle = Simulator(model).run(inputs, dict(current_profiles))
        return model.values(inputs, cycle.values)
    except TvimError:
        return {}


def _same(name: str, value: float, other: float, resolved: ResolvedModule) -> bool:
    if name not in resolved.table.by_name and name.partition("@")[0] not in resolved.table.by_name:
        return True
    within = _SAME_CYCLE if on_cycle(resolved.table, name) else _SAME
    return bool(np.isclose(value, other, rtol=within, atol=0.0, equal_nan=True))


TIMES = ("stiffening_time", "frozen_time")  # The times of the way back that are compared


@dataclass(frozen=True)
class Cooling:
    """Ability of a module's pads to cool, whether they do, and the time of the way back without cooling [s]."""

    able: bool  # True if the heater has a Seebeck coefficient: a foil heats whichever way its current flows
    used: bool  # True if a current flows through it while the module stiffens
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
    able = bool(inputs[model.index["heater_seebeck"]] > 0.0)
    if not (able and used and math.isfinite(values["response_time"])):
        return Cooling(able, used, {})
    left = inputs.copy()
    left[current] = 0.0
    profiles = {name: profile for name, profile in current_profiles.items() if name != STIFFENING.name}
    alone = Simulator(model).run(left, profiles, {STIFFENING.name}, wanted=TIMES).values
    return Cooling(able, used, {name: alone[name] for name in TIMES})
