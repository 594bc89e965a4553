"""The working cycle simulated, phase after phase, each starting where the one before has ended."""

from collections.abc import Collection, Mapping

import numpy as np

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.interrupts import raise_pending
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_instants import Found, Instant
from tvimdesign.simulation.working_cycle.phase_results import PhaseResults
from tvimdesign.simulation.working_cycle.trajectory import Array, Cycle, Trajectory

TOLERANCE = 1e-4
"""Largest error of a step in the scaled state: values are within 2e-4 of what they converge to (test)."""
SAMPLES = 200
"""Samples of a phase at least."""


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
        time of their own. Raises KeyboardInterrupt where an interrupt came that CasADi has swallowed, SimulationError
        where a phase cannot be stepped, TimeOverError once the deadline has passed.
        """
        raise_pending()
        values = dict.fromkeys(self.model.switch_names, np.inf)
        trajectories: dict[str, Trajectory] = {}
        balances: dict[str, Array] = {}
        horizon = float(inputs[self.model.index["horizon"]])
        for name, phase_functions in self.model.phases.items():
            phase = phase_functions.phase
            if phases is not None and name not in self._with_earlier(phases):
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
            found = Found(end=moments.get(phase.ends))
            results = PhaseResults(run)
            results.add_paths(found, None)
            values |= {event: moment.time for event, moment in moments.items()} | found.values
            trajectories[name] = self._trajectory(results, found.end)
            stays = [row.name for row in phase_functions.steadies if wanted is None or row.name in wanted]
            standing = results.standing(found.end) if stays and found.end is not None else None
            if standing is not None:
                state = standing.state[: engine.size]
                balances[name] = np.append(state, standing.current)
                values |= {one: run.value(one, state, standing.current) for one in stays}
        return Cycle(values, trajectories, balances)

    def run_to_show(self, inputs: Array, current_profiles: Mapping[str, CurrentProfile] | None = None) -> Cycle:
        """Simulate all phases; the same inputs have the same values and samples, whoever asks."""
        return self.run(inputs, current_profiles)

    def _trajectory(self, results: PhaseResults, end: Instant | None) -> Trajectory:
        times, states, currents = results.sampled(end or results.run.instants[-1], self.samples)
        return Trajectory(times=times, states=states, currents=currents)

    def trace(self, name: str, inputs: Array, before: Array | None, end: float) -> Trajectory:
        """Simulate a phase at its constant current for `end` seconds, on beyond what ends it if that is longer."""
        profile = self.constant_drive(name, inputs)
        engine = self.model.engines[name]
        run, _, _ = engine.simulate(inputs, profile, before, [], end, self.tolerance, throughout=True)
        return self._trajectory(PhaseResults(run), None)

    def constant_drive(self, phase: str, inputs: Array) -> CurrentProfile:
        """Return the constant current the inputs ask for in a phase."""
        row = self.model.phases[phase].phase
        return CurrentProfile.constant(row.sign * float(inputs[self.model.index[row.current_input]]))

    def _with_earlier(self, phases: Collection[str]) -> set[str]:
        wanted = set(phases)
        for name in reversed(self.model.phases):
            after = self.model.phases[name].phase.after
            if name in wanted and after:
                wanted.add(after)
        return wanted
