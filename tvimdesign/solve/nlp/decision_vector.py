"""The unknowns of a problem as one vector: put together from a switch, and read again as inputs, times and currents."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from tvimdesign.device import Path
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile, ramp_time
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions
from tvimdesign.simulation.working_cycle.trajectory import Cycle, Trajectory
from tvimdesign.solve.nlp.problem import FreeCurrent, Problem
from tvimdesign.solve.nlp.solver_run import Array, Ends
from tvimdesign.solve.nlp.transcription import guess

SHORTEST = 0.1  # s; with a slow supply all of a phase may be its ramp, and the pieces after it next to nothing


class DecisionVector:
    """Free numbers; a block of states and the logarithm of a time for each phase; currents; steady states; peaks."""

    def __init__(self, problem: Problem, model: DeviceFunctions) -> None:
        """What is not free is as in `model`, which differs from the problem's own where records do."""
        self.problem, self.model = problem, model

    def at(self, inputs: Array, cycle: Cycle) -> Array:
        """The unknowns at a point: the free numbers of the inputs, and a switch (as far as it goes where it stalls)."""
        currents = self.problem.free_currents
        parts = [np.array([f.to_unknown(inputs[self.model.index[f.name]]) for f in self.problem.free])]
        sizes = {c.phase: float(np.clip(inputs[self.model.index[c.row]], c.lower, c.upper)) for c in currents}
        slew = float(inputs[self.model.index["current_slew"]])
        ramps = {c.phase: (c.ramp_elements, ramp_time(sizes[c.phase], slew)) for c in currents}
        for block in self.problem.blocks:
            trajectory = cycle.trajectories.get(block.phase.phase.name)
            if trajectory is None:  # a phase that does not begin: as it would stand after the first
                trajectory = self._standing(block.phase, cycle)
            end = cycle.values[block.event]
            end = end if np.isfinite(end) else trajectory.times[-1]
            name = block.phase.phase.name
            grid = (self.problem.elements(name), ramps.get(name, (0, 0.0)), self.problem.order)
            parts += [guess(trajectory, *grid).ravel(order="F"), np.array([np.log(max(end, 1e-3))])]
        parts += [np.full(current.nodes, sizes[current.phase] / current.upper) for current in currents]
        for balance in self.problem.balances:
            begin = cycle.balances.get(balance.phase)
            last = cycle.trajectories[balance.phase]
            parts.append(np.append(last.states[:, -1], last.currents[-1]) if begin is None else begin)
        for name in self.problem.peaks:
            row = self.model.table.quantity(name)
            assert isinstance(row, Path)
            value = cycle.values[name]
            parts.append(np.array([(value if np.isfinite(value) else 1.0) / self.problem.peak_scale(row)]))
        return np.concatenate(parts)

    def _standing(self, phase: PhaseFunctions, cycle: Cycle) -> Trajectory:
        last = cycle.trajectory
        state = np.asarray(phase.begin(last.states[:, -1], self.model.start)).ravel()
        return Trajectory(np.array([0.0, 60.0]), np.column_stack([state, state]), np.zeros(2))

    def bounds(self, within: Mapping[str, Ends]) -> tuple[Array, Array]:
        """Least and largest unknowns, with some free numbers and first nodes of currents kept within ends of their own.

        A current is named by the input it is constant by.
        """
        lower = np.full(self.problem.unknown_count, -np.inf)
        upper = np.full(self.problem.unknown_count, np.inf)
        for i, free in enumerate(self.problem.free):
            low, high = within.get(free.name, (free.lower, free.upper))
            lower[i], upper[i] = free.to_unknown(low), free.to_unknown(high)
        for current, place in self.places_of_currents():
            lower[place], upper[place] = current.lower / current.upper, 1.0
            low, high = within.get(current.row, (current.lower, current.upper))
            lower[place.start], upper[place.start] = low / current.upper, high / current.upper
        driven = {current.phase for current in self.problem.free_currents}
        last = len(self.problem.free)
        for block in self.problem.blocks:
            last += block.unknowns.numel()
            if block.phase.phase.name in driven:
                lower[last - 1] = np.log(SHORTEST)
        return lower, upper

    def places_of_currents(self) -> Iterator[tuple[FreeCurrent, slice]]:
        """Where the free currents stand among the unknowns."""
        first = len(self.problem.free) + sum(block.unknowns.numel() for block in self.problem.blocks)
        for current in self.problem.free_currents:
            yield current, slice(first, first + current.nodes)
            first += current.nodes

    def times(self, unknowns: Array) -> dict[str, float]:
        """Time [s] to each event, after its phase's ramp."""
        first, times = len(self.problem.free), {}
        for block in self.problem.blocks:
            first += block.unknowns.numel()
            times[block.event] = float(np.exp(unknowns[first - 1]))
        return times

    def current_profiles(self, unknowns: Array) -> dict[str, CurrentProfile]:
        """The free currents over the time their phase takes."""
        times = self.times(unknowns)
        sizes = {
            current.phase: np.clip(unknowns[place] * current.upper, current.lower, current.upper)
            for current, place in self.places_of_currents()
        }
        slew = float(self.model.start[self.model.index["current_slew"]])
        current_profiles: dict[str, CurrentProfile] = {}
        for name, nodes in sizes.items():
            phase = self.model.table.phase(name)
            signed = [float(phase.sign * size) for size in nodes]
            current_profiles[name] = CurrentProfile.in_pieces(
                ramp_time(float(nodes[0]), slew), times[phase.ends], signed
            )
        return current_profiles

    def inputs(self, unknowns: Array) -> Array:
        """The inputs with the free numbers within their ranges, and the mean of each current."""
        inputs = self.model.start.copy()
        for i, free in enumerate(self.problem.free):
            inputs[self.model.index[free.name]] = min(max(free.to_value(unknowns[i]), free.lower), free.upper)
        for phase, profile in self.current_profiles(unknowns).items():
            inputs[self.model.index[self.model.table.phase(phase).current_input]] = abs(profile.mean)
        return inputs

    def free_values(self, inputs: Array) -> dict[str, float]:
        """The free numbers among the inputs, by name; shares of records are none of the table's."""
        shares = {name for mixture in self.problem.mixtures for name in mixture.shares}
        names = [free.name for free in self.problem.free if free.name not in shares]
        return {name: float(inputs[self.model.index[name]]) for name in names}
