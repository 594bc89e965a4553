"""The working cycle simulated, phase after phase, each starting where the one before has ended."""

from collections.abc import Collection, Mapping

import numpy as np
from cvodes_phase import FIRST_STRETCH, PhaseSimulator

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.interrupts import raise_pending
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.trajectory import Array, Cycle, Trajectory

STEPS = 50  # samples of one stretch of time
TOLERANCE = 1e-6  # with these, values are within 2e-4 of what they converge to (test)
SHOWN_STRETCHES = 4  # of a phase that is to be drawn


class CvodesSimulator:
    """Simulates the working cycle of one model; each phase's integrator is built once, when it is first needed."""

    def __init__(self, model: DeviceFunctions, tolerance: float = TOLERANCE, steps: int = STEPS) -> None:
        """Nothing is built yet. `tolerance` is CVODES's, `steps` divides each stretch of time."""
        self.model = model
        self.tolerance, self.steps = tolerance, steps
        self._phases: dict[str, PhaseSimulator] = {}

    def run_to_show(self, inputs: Array, current_profiles: Mapping[str, CurrentProfile] | None = None) -> Cycle:
        """Simulate all phases with samples enough to draw each, however short it is.

        A first simulation finds out how long they take, and seeks nothing else: so the same inputs have the same
        samples, and every value that is told of them is the same, whoever asks.
        """
        found = self.run(inputs, current_profiles, wanted=())
        ends = {name: found.values[phase.phase.ends] for name, phase in self.model.phases.items()}
        lengths = {
            name: ends.get(name, ends.get(phase.phase.like or name, 0.0)) for name, phase in self.model.phases.items()
        }
        stretches = {name: length / SHOWN_STRETCHES for name, length in lengths.items() if 0.0 < length < np.inf}
        return self.run(inputs, current_profiles, stretches=stretches)

    def run(
        self,
        inputs: Array,
        current_profiles: Mapping[str, CurrentProfile] | None = None,
        phases: Collection[str] | None = None,
        stretches: Mapping[str, float] | None = None,
        wanted: Collection[str] | None = None,
        deadline: Deadline = NEVER,
    ) -> Cycle:
        """Simulate the named phases (all unless given) and those they start from; the rest has infinite values.

        `drives` are currents by phase where they are not the constant ones of the inputs; `stretches` the lengths [s]
        of time, by phase, that are sampled at a time at first. Of the phases' quantities only those that are
        `wanted` need be sought (all unless given), as steady states and each event take time of their own. Raises
        KeyboardInterrupt where an interrupt came that CasADi has swallowed, TimeOverError once the deadline has passed.
        """
        raise_pending()
        values = dict.fromkeys(self.model.switch_names, np.inf)
        trajectories: dict[str, Trajectory] = {}
        balances: dict[str, Array] = {}
        for name, phase_functions in self.model.phases.items():
            phase = phase_functions.phase
            if phases is not None and name not in self._with_earlier(phases):
                continue
            before = trajectories.get(phase.after) if phase.after else None
            if phase.after and (before is None or not np.isfinite(values[self.model.phases[phase.after].phase.ends])):
                continue
            profile = (current_profiles or {}).get(phase.like or name) or self.constant_drive(name, inputs)
            simulator = self._phase(name)
            stretch = (stretches or {}).get(name, FIRST_STRETCH)
            state = before.states[:, -1] if before else None
            found, trajectories[name] = simulator.run(inputs, profile, state, stretch, wanted, deadline)
            values |= found
            settles = np.isfinite(found[phase.ends]) and simulator.stays(wanted)
            balance = simulator.balance(inputs, trajectories[name]) if settles else None
            if balance is not None:
                balances[name] = balance
                values |= simulator.steady_values(inputs, balance)
        return Cycle(values, trajectories, balances)

    def trace(self, name: str, inputs: Array, before: Array | None, end: float) -> Trajectory:
        """A phase at its constant current for `end` seconds, on beyond what ends it if that is longer."""
        return self._phase(name).trace(inputs, self.constant_drive(name, inputs), before, end)

    def constant_drive(self, phase: str, inputs: Array) -> CurrentProfile:
        """The constant current the inputs ask for in a phase."""
        row = self.model.phases[phase].phase
        return CurrentProfile.constant(row.sign * float(inputs[self.model.index[row.current_input]]))

    def _with_earlier(self, phases: Collection[str]) -> set[str]:
        wanted = set(phases)
        for name in reversed(self.model.phases):
            after = self.model.phases[name].phase.after
            if name in wanted and after:
                wanted.add(after)
        return wanted

    def _phase(self, name: str) -> PhaseSimulator:
        if name not in self._phases:
            self._phases[name] = PhaseSimulator(self.model, self.model.phases[name], self.tolerance, self.steps)
        return self._phases[name]
