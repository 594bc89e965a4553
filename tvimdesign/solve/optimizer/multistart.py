"""Starts of searches: the study's own, and seeded points between the bounds whose switch ends."""

from collections.abc import Iterator
from functools import cached_property
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.deadline import Deadline
from tvimdesign.base.errors import SimulationError
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.nlp.constraints import impossible, on_cycle
from tvimdesign.solve.nlp.mixture import MixedDevice
from tvimdesign.solve.nlp.problem import Problem
from tvimdesign.solve.nlp.solver_run import Array, Progress
from tvimdesign.study import SolverOptions

MAX_DRAWS = 100


class Multistart:
    """Points to begin at, each tried by simulating its switch as far as the problem needs it."""

    def __init__(
        self, problem: Problem, model: DeviceFunctions, options: SolverOptions, progress: Progress,
        deadline: Deadline | None = None,
    ) -> None:  # fmt: skip
        """Simulate the study's own start, which is in `model`, as far as the problem needs it.

        Where that is no module that can be simulated, a point that can takes its place in the model. Raises
        SimulationError where none is found, TimeOverError where the time of the whole command is over first.
        """
        self.deadline = deadline or Deadline()
        self.problem, self.model = problem, model
        self.options, self.progress = options, progress
        self.passed_over = {"switch never ends": 0, "no such module": 0}
        """Points at which no search began, by the reason."""
        self.cycle = dict.fromkeys(model.switch_names, np.inf)  # What the switch of the study's own start supplies
        try:
            self.cycle = problem.simulated(model.start)
        except SimulationError as error:
            self._move_start(error)

    def _move_start(self, error: SimulationError) -> None:
        """Put a point whose switch ends in the place of a start that cannot be simulated. Raises SimulationError."""
        self.progress("looking for a start: the study's own cannot be simulated")
        points = unit_points(1, len(self.problem.free), self.options.seed + 1) if self.problem.free else iter(())
        for point in islice(points, MAX_DRAWS):
            inputs = self._inputs_at(point)
            cycle = self.trial(inputs) if self._exists(inputs) else None
            if cycle is not None:
                self.model.start, self.cycle = inputs, cycle
                return
            self.deadline.check("a module was found that can be simulated")
        raise SimulationError(
            f"{error}; neither can {MAX_DRAWS} points between the bounds: set `module` to a design that can"
        ) from error

    def points(self) -> Iterator[Array]:
        """Inputs to start from: the study's own, then others spread between the bounds, seeded.

        From a point whose switch never ends, or takes no time, the solver mostly gets stuck there, so such points are
        passed over; the study's own is replaced by the first other one.
        """
        points = unit_points(self.options.starts, len(self.problem.free), self.options.seed)
        if self.trial(self.model.start) is not None:
            yield self.model.start
        else:
            self.progress("looking for a start: the switch of the study's own never ends, or takes no time")
            self.passed_over["switch never ends"] += 1
            yield self._ending_point(points)
        for _ in range(self.options.starts - 1):
            yield self._ending_point(points)

    def _ending_point(self, points: Iterator[Array]) -> Array:
        for _ in range(MAX_DRAWS):
            if self.deadline.passed:
                break
            point = self._point_among(points)
            if self.trial(point) is not None:
                return point
            self.passed_over["switch never ends"] += 1
        return self.model.start

    def _point_among(self, points: Iterator[Array]) -> Array:
        """Inputs at the next of some points of the unit cube, of the logarithm of a free number that is positive.

        Points at which there is no such module, as with a leg that cannot reach its pin or a core wider than the
        layer's inner edge, are passed over.
        """
        for _ in range(MAX_DRAWS):
            point = self._inputs_at(next(points))
            if self._exists(point):
                return point
            self.passed_over["no such module"] += 1
        return self.model.start

    def _inputs_at(self, shares: Array) -> Array:
        point = self.model.start.copy()
        for free, share in zip(self.problem.free, shares, strict=True):
            low, high = free.to_unknown(free.lower), free.to_unknown(free.upper)
            point[self.model.index[free.name]] = free.to_value(low + share * (high - low))
        return self.model.mixed(point) if isinstance(self.model, MixedDevice) else point

    def _exists(self, point: Array) -> bool:
        values = self.model.values(point, self.cycle)
        numbers = [value for name, value in values.items() if not on_cycle(self.model.table, name)]
        return (
            not np.any(np.isnan(numbers))
            and not impossible(values, self.model.table)
            and self._bodies(point)
            # A link that corrects another one may be below zero, as at the start; any other would cost seconds.
            and bool(np.all((self._links(point) > 0.0) | self._corrects))
        )

    def heats(self, inputs: Array) -> bool:
        """Return whether every heated body of the problem's phases exists and no link is below zero."""
        return self._bodies(inputs) and bool(np.all(self._links(inputs) > 0.0))

    @cached_property
    def _corrects(self) -> NDArray[np.bool_]:
        """Which links are below zero at the study's start."""
        return self._links(self.model.start) <= 0.0

    def _bodies(self, inputs: Array) -> bool:
        return all(np.all(bodies > 0.0) for bodies, _ in self._networks(inputs))

    def _links(self, inputs: Array) -> Array:
        return np.concatenate([np.zeros(0), *(links for _, links in self._networks(inputs))])

    def _networks(self, inputs: Array) -> list[list[Array]]:
        return [self.model.engines[name].network.values(inputs) for name in self.problem.phases]

    def trial(self, inputs: Array) -> dict[str, float] | None:
        """Return the outputs of the switch at a point; None if it does not end, or is over before it starts.
        In the second case it shows nothing.
        """
        try:
            cycle = self.cycle if inputs is self.model.start else self.problem.simulated(inputs)
        except SimulationError:
            return None
        return cycle if all(0.0 < cycle[event] < np.inf for event in self.problem.events) else None


FEW = 16
"""Starts up to which points are simply drawn: for as few a sequence that fills the cube evenly has no merit yet."""


def unit_points(starts: int, size: int, seed: int) -> Iterator[NDArray[np.float64]]:
    """Endless points between 0 and 1 for a search with so many starts; the same ones for the same seed.

    Many starts follow a scrambled Sobol sequence (Owen's scrambling, scipy), which leaves no part of the ranges out.
    """
    if starts <= FEW:
        random = np.random.default_rng(seed)
        while True:
            yield random.random(size)
    from scipy.stats import qmc  # half a second of import that few starts do without

    sequence = qmc.Sobol(size, rng=np.random.default_rng(seed))
    batch = 1 << (starts - 1).bit_length()  # a power of two, as the sequence is even over those
    while True:
        yield from sequence.random(batch)
