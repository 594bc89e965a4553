"""The unknowns of a problem as one vector: inputs, times and currents, and further unknowns that move its limits."""

from collections.abc import Iterator, Mapping

import numpy as np

from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile, ramp_time
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.nlp.problem import UNIT, Problem
from tvimdesign.solve.nlp.problem_parts import FreeCurrent, Parameters, Point
from tvimdesign.solve.nlp.solver_run import Array, Ends

SHORTEST = 0.1  # s; with a slow supply all of a phase may be its ramp, and the pieces after it next to nothing
_UNKNOWN_TIME = 60.0  # s, where a phase has no end


class DecisionVector:
    """Free numbers; for each free current its nodes and the logarithm of its time; the peaks of driven phases."""

    def __init__(self, problem: Problem, model: DeviceFunctions) -> None:
        """Set up. Fixed numbers come from `model`, which differs from the problem's own if records differ."""
        self.problem, self.model = problem, model

    def at(self, inputs: Array, cycle: Mapping[str, float]) -> Array:
        """Return the unknowns at a design: the free numbers, the constant currents, and its times."""
        parts = [np.array([f.to_unknown(inputs[self.model.index[f.name]]) for f in self.problem.free])]
        for current in self.problem.free_currents:
            size = float(np.clip(inputs[self.model.index[current.row]], current.lower, current.upper))
            time = cycle[self.model.phases[current.phase].phase.ends]
            time = time if 0.0 < time < np.inf else _UNKNOWN_TIME
            parts += [np.full(current.nodes, size / current.upper), np.array([np.log(max(time, SHORTEST) / UNIT)])]
        for peak in self.problem.peaks:
            value = cycle.get(peak.row.name, np.inf)
            parts.append(np.array([value / peak.scale if np.isfinite(value) else 1.0]))
        return np.concatenate(parts)

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
            lower[place.stop] = np.log(SHORTEST / UNIT)
        return lower, upper

    def shaken(self, unknowns: Array, within: Mapping[str, Ends], share: float, random: np.random.Generator) -> Array:
        """Return unknowns with the free numbers moved at random, by at most a share of their ranges, within ends."""
        lower, upper = (ends[: len(self.problem.free)] for ends in self.bounds(within))
        moved = unknowns.copy()
        step = share * (upper - lower) * random.uniform(-1.0, 1.0, len(lower))
        moved[: len(lower)] = np.clip(unknowns[: len(lower)] + step, lower, upper)
        return moved

    def places_of_currents(self) -> Iterator[tuple[FreeCurrent, slice]]:
        """Yield the free currents and their places among the unknowns."""
        for i, current in enumerate(self.problem.free_currents):
            yield current, self.problem.nodes_place(i)

    def current_profiles(self, unknowns: Array) -> dict[str, CurrentProfile]:
        """Return the free currents over the time their phase takes."""
        profiles: dict[str, CurrentProfile] = {}
        for i, (current, place) in enumerate(self.places_of_currents()):
            sizes = np.clip(unknowns[place] * current.upper, current.lower, current.upper)
            phase = self.model.table.phase(current.phase)
            ramp = ramp_time(float(sizes[0]), current.slew)
            signed = [float(phase.sign * size) for size in sizes]
            profiles[current.phase] = CurrentProfile.in_pieces(ramp, self.problem.pieces_time(unknowns, i), signed)
        return profiles

    def inputs(self, unknowns: Array) -> Array:
        """Return the inputs with the free numbers within their ranges, and the mean of each current."""
        inputs = self.model.start.copy()
        for i, free in enumerate(self.problem.free):
            inputs[self.model.index[free.name]] = min(max(free.to_value(unknowns[i]), free.lower), free.upper)
        for phase, profile in self.current_profiles(unknowns).items():
            inputs[self.model.index[self.model.table.phase(phase).current_input]] = abs(profile.mean)
        return inputs

    def free_values(self, inputs: Array) -> dict[str, float]:
        """Return the free numbers among the inputs by name; shares of records are not in the table."""
        shares = {name for mixture in self.problem.mixtures for name in mixture.shares}
        names = [free.name for free in self.problem.free if free.name not in shares]
        return {name: float(inputs[self.model.index[name]]) for name in names}


_NONE = np.zeros(0)


class ExtendedProblem:
    """A nonlinear programme: the problem's unknowns, then the further ones."""

    def __init__(
        self, problem: Problem, parameters: Parameters, by_further: Array | None = None, weights: Array = _NONE,
        share: float = 1.0,
    ) -> None:  # fmt: skip
        """Take the problem at its parameters.

        A further unknown (a column of `by_further`) moves the residual of each limit (a row) in proportion, and counts
        by its weight in what is minimised, beside a `share` of the problem's own objective.
        """
        self.problem, self.parameters = problem, parameters
        self._by_further, self._weights, self._share = by_further, weights, share
        self.unknown_count, self.row_count = problem.unknown_count + len(weights), problem.row_count

    def at(self, x: Array) -> Point:
        """Evaluate the problem and its further unknowns at a point."""
        size, first = self.problem.unknown_count, self.problem.equation_count
        point = self.problem.at(x[:size], self.parameters)
        if self._by_further is None:
            return point
        further, limits = x[size:], slice(first, first + len(self._by_further))
        rows, by_further = point.rows.copy(), np.zeros((self.row_count, len(further)))
        rows[limits] += self._by_further @ further
        by_further[limits] = self._by_further
        return point._replace(
            objective=self._share * point.objective + float(self._weights @ further),
            gradient=np.concatenate([self._share * point.gradient, self._weights]),
            rows=rows, jacobian=np.hstack([point.jacobian, by_further]),
        )  # fmt: skip
