"""One phase of the working cycle by the engine, with derivatives along directions of the inputs.

A direction says how the inputs move: a column of `along`, a row an input. The phase is recorded once for a structure;
`phase_run` steps it.
"""

from collections.abc import Collection, Sequence
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.engine.integrator import Motion
from tvimdesign.engine.interpreter import Array
from tvimdesign.engine.lanes import evaluate, lanes_of
from tvimdesign.engine.tape import Tape
from tvimdesign.physics.heat_flow import heat
from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions
from tvimdesign.simulation.working_cycle.phase_instants import Drive, Grid, Instant, PhaseOutputs
from tvimdesign.simulation.working_cycle.phase_results import PhaseResults
from tvimdesign.simulation.working_cycle.phase_run import PhaseRun
from tvimdesign.simulation.working_cycle.recordings import Recordings
from tvimdesign.simulation.working_cycle.symbols import ca, symbols

_NONE = np.zeros(0)
MANY = 5000  # Nodes of an expression from which on it is recorded apart from what has fewer


class Watch(NamedTuple):
    """Quantities at an instant, recorded."""

    given: Tape  # Constants of a run, from the inputs alone
    at: Tape  # The quantities, one below the other, of state, current and these constants


class PhaseEngine:
    """One phase, recorded when it is first asked for; `inputs` is a vector in the order of the model's names."""

    def __init__(self, phase: PhaseFunctions, recordings: Recordings) -> None:
        self.phase, self._recordings = phase, recordings
        self.integrals = [row.name for row in phase.paths if row.reduce == "integral"]
        numbers, self._heavy = recordings.arrays("sizes", self._sizes)
        self.size, self.lip, *self.bodies = numbers.tolist()
        """Count of the state's entries; of temperatures of the lip, which has no heat capacity: unknowns beside the
        state; of bodies beside the plate, core and link last, of those around the pads, the housing last; of sinks."""
        self._watches: dict[tuple[str, ...], Watch] = {}
        self._lanes: dict[tuple[str, ...], Array] = {}
        place = phase.input_names.index(phase.phase.current_input)
        self._current_place = place

    def _sizes(self) -> list[NDArray[Any]]:
        """Return counts, and which of the phase's quantities take most of the work."""
        stack = self.phase._stack
        bodies = len(stack.beside), len(stack.around), 1 if stack.sink else 0
        counts = self.phase.state_size, 2 if stack.lip else 0, *bodies
        heavy = [ca.n_nodes(ca.SX(self.phase._instant[name])) > MANY for name in self._rows]
        return [np.array(counts), np.array(heavy, dtype=bool)]

    @property
    def _rows(self) -> list[str]:
        return [row.name for row in (*self.phase.events, *self.phase.paths, *self.phase.steadies)]

    @cached_property
    def network(self) -> Tape:
        """Record conductances and capacities of the bodies, and conductances of the links between them."""
        return self._recordings.tapes("network", 1, lambda: [Tape.of([self.phase._inputs], self.phase.network)])[0]

    @cached_property
    def recorded(self) -> tuple[Motion, Tape]:
        """The equation of motion, and what it takes from the inputs: constants, unit of time, first state."""
        arrays = self._recordings.arrays(
            "motion", lambda: [*(array for part in self._motion() for array in part.arrays())]
        )
        return Motion.of_arrays(arrays), Tape.of_arrays(arrays)

    def _motion(self) -> tuple[Motion, Tape]:
        phase, lip = self.phase, ca.SX.sym("lip", self.lip)
        stack = phase._stack
        if self.lip:
            kelvin = ZERO_CELSIUS + heat.TEMPERATURE_SCALE * symbols(lip)
            stack = stack._replace(lip_temperatures=(kelvin[0], kelvin[1]))
        state_rates, now, *integrands = phase._instant_with(
            ["state_rates", "stack_profile", *self.integrals], stack_now=stack
        )
        of_lip = [residual / heat.TEMPERATURE_SCALE for residual in now.lip.residuals] if self.lip else []
        value, constants, k = phase._parted(ca.vertcat(state_rates, *of_lip, *integrands))
        y = ca.vertcat(phase._state, lip, ca.SX.sym("integrals", len(self.integrals)))
        mass = np.ones(y.numel())
        mass[self.size : self.size + self.lip] = 0.0
        motion = Motion.of(y, phase._drive, k, value, ca.jacobian(value, y), mass)
        current = phase.phase.sign * symbols(phase._inputs)[self._current_place]
        first = phase._initial(phase._stack._replace(freezing=None))
        given = Tape.of([phase._inputs], [constants, _heating_time(phase._stack, current), ca.vertcat(first)])
        return motion, given

    @cached_property
    def start(self) -> Tape:
        """Record the state that a phase goes on from."""
        return self._recordings.tapes("start", 1, self._started)[0]

    def _started(self) -> list[Tape]:
        before = ca.SX.sym("before", len(self.phase._initial(self.phase._stack._replace(freezing=None))))
        return [Tape.of([before, self.phase._inputs], [self.phase.begin(before, self.phase._inputs)])]

    def watch(self, *names: str) -> Watch:
        """Record what quantities are at an instant."""
        if names not in self._watches:
            self._watches[names] = Watch(
                *self._recordings.tapes(f"watch {' '.join(names)}", 2, partial(self._watched, names))
            )
        return self._watches[names]

    def _watched(self, names: Sequence[str]) -> tuple[Tape, Tape]:
        values = ca.densify(ca.vertcat(*(ca.SX(self.phase._instant[name]) for name in names)))
        return Tape.parted(self.phase._arguments, [values])

    def at_instants(self, names: Sequence[str], inputs: Array, states: Array, currents: Array) -> Array:
        """Return quantities, one below the other, at instants of one device, a column each."""
        (constants,) = self.watch(*names).given.values(inputs)
        return self.evaluated(tuple(names), constants, np.vstack([states[: self.size], currents]))

    def evaluated(self, names: tuple[str, ...], constants: Array, given: Array) -> Array:
        """Return quantities at instants whose state and current are `given`, with the constants of a run."""
        tape, w, first = self.watch(*names).at, self.lanes(names), len(given)
        w[first : tape.arguments[-1]] = constants[:, None]
        values = np.empty((len(tape.results[0]), given.shape[1]))
        evaluate(tape.code, w, np.arange(first), given, tape.results[0], values, 0, given.shape[1])
        return values

    def lanes(self, names: tuple[str, ...]) -> Array:
        """Return registers in which these quantities are evaluated at many instants."""
        if names not in self._lanes:
            self._lanes[names] = lanes_of(self.watch(*names).at)
        return self._lanes[names]

    @cached_property
    def together(self) -> dict[str, tuple[tuple[str, ...], int]]:
        """The quantities that each is recorded with, and its place among them.

        What needs the moduli of the layer's slices shares them; all else is a small part of the work.
        """
        rows = list(zip(self._rows, self._heavy.tolist(), strict=True))
        groups = (tuple(name for name, heavy in rows if heavy == of) for of in (False, True))
        return {name: (group, place) for group in groups for place, name in enumerate(group)}

    def run(
        self,
        inputs: Array,
        along: Array,
        before: Instant | None,
        wanted: Collection[str] | None,
        horizon: float,
        tolerance: float,
        grid: Grid | None,
        drive: Drive | None = None,
    ) -> tuple[PhaseOutputs, Grid]:
        """Step until every wanted event has happened, and evaluate all that is wanted.

        Steps are those of a `grid`, or as long as their errors are within the `tolerance`. With a `drive`, whose length
        is given, the phase ends there, whatever the event that ends it still waits for. Returns the grid, too. Raises
        SimulationError where not even the first step can be taken.
        """
        run, start, pace, dpace = self._begin(inputs, along, before)
        ends = self.phase.phase.ends
        sought = [row.name for row in self.phase.events if wanted is None or row.name in wanted or row.name == ends]
        outputs, results = PhaseOutputs(), PhaseResults(run)
        if drive is not None:
            outputs.end = run.driven(start, drive.with_length())
            if outputs.end is not None:
                outputs.add(ends, outputs.end.time, outputs.end.of_time)
                outputs.short, outputs.of_short = run.slopes(ends, outputs.end)
                results.add_samples(outputs, wanted)
        else:
            grid = grid or run.first(start, pace, sought, horizon, tolerance)
            events = [name for name in sought if name in grid.events]
            moments = run.search(start, pace, dpace, events, grid)
            for name, moment in moments.items():
                outputs.add(name, moment.time, moment.of_time)
            outputs.end = moments.get(ends)
        if outputs.end is not None:
            results.add_paths(outputs, wanted)
            results.add_steadies(outputs, wanted)
        return outputs.without_length(), grid or Grid()

    def _begin(self, inputs: Array, along: Array, before: Instant | None) -> tuple[PhaseRun, Instant, float, Array]:
        """Return a run with its constants in place, where it starts, and the unit of its steps with its slopes."""
        motion, given = self.recorded
        along = np.column_stack([along, np.zeros(len(along))])  # the length of a phase's last step
        (k, dk), (pace, dpace), (y, s) = given.tangents([inputs], [along])
        if before is not None:
            size = self.start.arguments[1]
            of_state = np.column_stack([before.of_state[:size], np.zeros(size)])
            ((y, s),) = self.start.tangents((before.state[:size], inputs), (of_state, along))
        extra = self.lip + len(self.integrals)
        y, s = np.append(y, np.zeros(extra)), np.concatenate([s, np.zeros((extra, along.shape[1]))])
        sign = self.phase.phase.sign
        current, of_current = sign * float(inputs[self._current_place]), sign * along[self._current_place]
        start = Instant(0.0, np.zeros(along.shape[1]), y, s, current, of_current)
        return PhaseRun(self, motion, motion.registers(k, dk), inputs, along), start, float(pace[0]), dpace[0]

    def simulate(
        self, inputs: Array, profile: CurrentProfile, before: Array | None, sought: list[str], horizon: float,
        tolerance: float, deadline: Deadline = NEVER, *, throughout: bool = False, going_on: bool = False,
    ) -> tuple[PhaseRun, dict[str, Instant], bool]:  # fmt: skip
        """Step with a current that may follow a profile, without derivatives, until all that is sought has happened, or
        `throughout` the horizon. What starts `going_on` has the history of the state before, too.

        Returns the run, the instants of the events, and whether nothing will change any more. Raises SimulationError.
        """
        state = None if before is None else Instant(0.0, _NONE, before, np.zeros((len(before), 0)), 0.0, _NONE)
        run, start, pace, _ = self._begin(inputs, np.zeros((len(inputs), 0)), state)
        if going_on and before is not None:
            start.state[: self.size] = before
        return run, *run.simulate(start, pace, sought, horizon, profile, tolerance, deadline, throughout=throughout)


def _heating_time(stack: heat.Stack, current: Any) -> Any:
    """Estimate the time [s] in which the pads at their power would heat the layer: the unit of the steps."""
    melting = stack.melting
    heated = melting.latent_heat + melting.specific_heat_melt * (melting.end - stack.ambient)
    power = current * stack.peltier.seebeck * 330.0 + 0.5 * current**2 * stack.peltier.resistance
    return ca.vertcat(stack.density * stack.area * stack.thickness * heated / np.sqrt(power**2 + 0.01))
