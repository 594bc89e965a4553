"""The working cycle by the engine, with derivatives of all it supplies along directions of the inputs."""

from __future__ import annotations

from collections.abc import Collection
from functools import cached_property
from typing import NamedTuple

import numpy as np

from tvimdesign.engine.tape import Array
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_engine import Ended, Grid, PhaseEngine


class Supplied(NamedTuple):
    """Values of what the cycle supplies, in the order of the model's `switch_names`; infinite where something never
    happens. Slopes along each direction, a column each."""

    values: Array
    slopes: Array


class CycleEngine:
    """Steps the working cycle of one model."""

    def __init__(self, model: DeviceFunctions) -> None:
        """Nothing is recorded yet."""
        self.model = model

    @cached_property
    def _phases(self) -> dict[str, PhaseEngine]:
        return {name: PhaseEngine(phase) for name, phase in self.model.phases.items()}

    def run(
        self, inputs: Array, along: Array, wanted: Collection[str] | None = None, grids: dict[str, Grid] | None = None
    ) -> Supplied:
        """Step the phases that are needed for what is wanted, everything unless given.

        `grids` are the steps by phase; a phase that has none adds its own. With the same grids, values are smooth in
        the inputs.
        """
        grids = {} if grids is None else grids
        place = {name: i for i, name in enumerate(self.model.switch_names)}
        values = np.full(len(place), np.inf)
        slopes = np.zeros((len(place), along.shape[1]))
        ended: dict[str, Ended] = {}
        horizon = float(inputs[self.model.index["horizon"]])
        for name, engine in self._phases.items():
            phase = engine.phase
            rows = {row.name for row in (*phase.events, *phase.paths, *phase.steadies)}
            if wanted is not None and not (rows & set(wanted)) and not self._leads(name, wanted):
                continue
            before = ended.get(phase.phase.after) if phase.phase.after else None
            if phase.phase.after and before is None:
                continue
            found, grids[name] = engine.run(inputs, along, before, wanted, horizon, grids.get(name))
            for row, value in found.values.items():
                values[place[row]], slopes[place[row]] = value, found.slopes[row]
            if found.end is not None:
                ended[name] = found.end
        return Supplied(values, slopes)

    def _leads(self, name: str, wanted: Collection[str]) -> bool:
        """Whether a phase that something wanted belongs to starts where this one ends."""
        for other, engine in self._phases.items():
            phase = engine.phase
            if phase.phase.after == name:
                rows = {row.name for row in (*phase.events, *phase.paths, *phase.steadies)}
                if rows & set(wanted) or self._leads(other, wanted):
                    return True
        return False
