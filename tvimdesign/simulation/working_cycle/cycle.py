"""The working cycle phase after phase: `Simulator` with any current, `CycleEngine` with derivatives."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.interrupts import raise_pending
from tvimdesign.engine.interpreter import Array
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_instants import Drive, Grid, Instant, PhaseOutputs
from tvimdesign.simulation.working_cycle.phase_results import PhaseResults
from tvimdesign.simulation.working_cycle.phase_run import TOLERANCE as ENGINE_TOLERANCE


@dataclass(frozen=True)
class Trajectory:
    """A phase over time, sampled: `times` [s], `states` one column a time, `currents` [A]."""

    times: Array
    states: Array
    currents: Array

    def at(self, fractions: Array) -> Array:
        """Interpolate states at fractions of the last time, linearly between the samples."""
        wanted = fractions * self.times[-1]
        return np.array([np.interp(wanted, self.times, row) for row in self.states])


@dataclass(frozen=True)
class Cycle:
    """Result of a cycle: event, path and steady values by name (infinite where something never happens)."""

    values: dict[str, float]
    trajectories: dict[str, Trajectory]
    """By phase, each from its start to the event that ends it, or as far as it goes if that never happens."""
    balances: dict[str, Array]
    """By phase, state and current that stay where the phase ended; none where there is no such state."""


TOLERANCE = 5e-5  # Largest error of a step in the scaled state: values are within 1e-4 of what they converge to (test)
SAMPLES = 200  # Samples of a phase at least


class Simulator:
    """Simulates the working cycle of one model, with any current over time; values have no derivatives here."""

    def __init__(self, model: DeviceFunctions, tolerance: float = TOLERANCE, samples: int = SAMPLES) -> None:
        """Take what the model's phases have recorded; `samples` is how many a trajectory has at least."""
        self.model = model
        self.tolerance, self.samples = tolerance, samples

    def run(
        self,
        inputs: Array,
        current_profiles: Mapping[str, CurrentProfile] | None = None,
        phases: Collection[str] | None = None,
        wanted: Collection[str] | None = None,
        deadline: Deadline = NEVER,
    ) -> Cycle:
        """Simulate the named phases (all unless given) and those they start from; the rest has infinite values.

        `current_profiles` are currents by phase where they are not the constant ones of the inputs. Of the phases'
        quantities only those that are `wanted` need be sought (all unless given), as steady states and each event take
        time of their own. The same inputs have the same values and samples, whoever asks. Raises KeyboardInterrupt
        where an interrupt came that CasADi has swallowed, SimulationError where a phase cannot be stepped,
        TimeOverError once the deadline has passed.
        """
        raise_pending()
        values = dict.fromkeys(self.model.switch_names, np.inf)
        trajectories: dict[str, Trajectory] = {}
        balances: dict[str, Array] = {}
        horizon = float(inputs[self.model.index["horizon"]])
        needed = set(self.model.phases if phases is None else phases)
        for phase_functions in reversed(self.model.phases.values()):
            if phase_functions.phase.name in needed and phase_functions.phase.after:
                needed.add(phase_functions.phase.after)
        for name, phase_functions in self.model.phases.items():
            phase = phase_functions.phase
            if name not in needed:
                continue
            before = trajectories.get(phase.after) if phase.after else None
            if phase.after and (before is None or not np.isfinite(values[self.model.phases[phase.after].phase.ends])):
                continue
            profile = (current_profiles or {}).get(phase.like or name) or self.constant_drive(name, inputs)
            state = before.states[:, -1] if before else None
            events = [row.name for row in phase_functions.events]
            sought = [event for event in events if wanted is None or event in wanted or event == phase.ends]
            engine = self.model.engines[name]
            run, moments, _ = engine.simulate(inputs, profile, state, sought, horizon, self.tolerance, deadline)
            outputs = PhaseOutputs(end=moments.get(phase.ends))
            results = PhaseResults(run)
            results.add_paths(outputs, None)
            values |= {event: moment.time for event, moment in moments.items()} | outputs.values
            trajectories[name] = Trajectory(*results.sampled(outputs.end or run.instants[-1], self.samples))
            stays = [row.name for row in phase_functions.steadies if wanted is None or row.name in wanted]
            standing = results.standing(outputs.end) if stays and outputs.end is not None else None
            if standing is not None:
                state = standing.state[: engine.size]
                balances[name] = np.append(state, standing.current)
                values |= {quantity: run.value(quantity, state, standing.current) for quantity in stays}
        return Cycle(values, trajectories, balances)

    def constant_drive(self, phase: str, inputs: Array) -> CurrentProfile:
        """Return the constant current the inputs ask for in a phase."""
        row = self.model.phases[phase].phase
        return CurrentProfile.constant(row.sign * float(inputs[self.model.index[row.current_input]]))


class Supplied(NamedTuple):
    """Values of what the cycle supplies, in the order of the model's `switch_names`; infinite where something never
    happens. Slopes along each direction, a column each."""

    values: Array
    slopes: Array
    driven: dict[str, PhaseOutputs]  # All of each driven phase


class CycleEngine:
    """Steps the working cycle of one model."""

    def __init__(self, model: DeviceFunctions, fineness: float = 1.0) -> None:
        """Take what the model's phases have recorded; with twice the `fineness`, errors in time are an eighth."""
        self.model, self._tolerance = model, ENGINE_TOLERANCE / fineness**3
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
        driven: dict[str, PhaseOutputs] = {}
        horizon = float(inputs[self.model.index["horizon"]])
        for name, engine in self.model.engines.items():
            after = engine.phase.phase.after
            if not self._needed(name, wanted) or (after and after not in ended):
                continue
            before = ended[after] if after else None
            outputs, grid = engine.run(
                inputs, along, before, wanted, horizon, self._tolerance, grids.get(name), drives.get(name)
            )
            if name not in drives:
                grids[name] = grid
            for row, value in outputs.values.items():
                values[self._place[row]], slopes[self._place[row]] = value, outputs.slopes[row]
            if outputs.end is not None:
                ended[name] = outputs.end
                if name in drives:
                    driven[name] = outputs
        return Supplied(values, slopes, driven)

    def _needed(self, name: str, wanted: Collection[str] | None) -> bool:
        """Return whether something wanted belongs to a phase, or to one that starts where it ends."""
        if wanted is None:
            return True
        phase = self.model.phases[name]
        mine = any(row.name in wanted for row in (*phase.events, *phase.paths, *phase.steadies))
        after = (other for other, later in self.model.phases.items() if later.phase.after == name)
        return mine or any(self._needed(other, wanted) for other in after)
