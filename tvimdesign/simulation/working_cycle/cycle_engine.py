"""The working cycle by the engine, with derivatives of all it supplies along directions of the inputs."""

from collections.abc import Collection, Mapping
from typing import NamedTuple

import numpy as np

from tvimdesign.engine.interpreter import Array
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_instants import Drive, Found, Grid, Instant
from tvimdesign.simulation.working_cycle.phase_run import TOLERANCE


class Supplied(NamedTuple):
    """Values of what the cycle supplies, in the order of the model's `switch_names`; infinite where something never
    happens. Slopes along each direction, a column each."""

    values: Array
    slopes: Array
    driven: dict[str, Found]
    """All of each driven phase."""


class CycleEngine:
    """Steps the working cycle of one model."""

    def __init__(self, model: DeviceFunctions, fineness: float = 1.0) -> None:
        """Take what the model's phases have recorded; with twice the `fineness`, errors in time are an eighth."""
        self.model, self._tolerance = model, TOLERANCE / fineness**3
        self._place = {name: i for i, name in enumerate(model.switch_names)}

    def run(
        self,
        inputs: Array,
        along: Array,
        wanted: Collection[str] | None = None,
        grids: dict[str, Grid] | None = None,
        drives: Mapping[str, Drive] | None = None,
    ) -> Supplied:
        """Step the phases that are needed for what is wanted, everything unless given.

        `grids` are the steps by phase; a phase that has none adds its own. With the same grids, values are smooth in
        the inputs. `drives` are currents by phase where they follow a profile. Raises SimulationError.
        """
        grids, drives = {} if grids is None else grids, drives or {}
        values = np.full(len(self._place), np.inf)
        slopes = np.zeros((len(self._place), along.shape[1]))
        ended: dict[str, Instant] = {}
        driven: dict[str, Found] = {}
        horizon = float(inputs[self.model.index["horizon"]])
        for name, engine in self.model.engines.items():
            after = engine.phase.phase.after
            if not self._needed(name, wanted) or (after and after not in ended):
                continue
            before = ended[after] if after else None
            found, grid = engine.run(
                inputs, along, before, wanted, horizon, self._tolerance, grids.get(name), drives.get(name)
            )
            if name not in drives:
                grids[name] = grid
            for row, value in found.values.items():
                values[self._place[row]], slopes[self._place[row]] = value, found.slopes[row]
            if found.end is not None:
                ended[name] = found.end
                if name in drives:
                    driven[name] = found
        return Supplied(values, slopes, driven)

    def _needed(self, name: str, wanted: Collection[str] | None) -> bool:
        """Return whether something wanted belongs to a phase, or to one that starts where it ends."""
        if wanted is None:
            return True
        phase = self.model.phases[name]
        mine = any(row.name in wanted for row in (*phase.events, *phase.paths, *phase.steadies))
        after = (other for other, one in self.model.phases.items() if one.phase.after == name)
        return mine or any(self._needed(other, wanted) for other in after)
