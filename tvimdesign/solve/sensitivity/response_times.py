"""Response times of modules: what keeps them equal, and what changes their ratio.

The designs that switch in a given time: for each value of a second parameter, the layer's thickness that does.

One response time does not tell a design: thickness, contacts, current and the place of the sensor trade off. The set of
those that give the same time is a line for each place of the sensor; its points are roots, not read off a grid.

Sensitivity of two modules' response times, and of their ratio, to an input of both or one of them.

Their derivatives are those of the engine's steps; tests compare them with finer steps, and those with CVODES.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.cycle_engine import CycleEngine
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_instants import Grid

Array = NDArray[np.float64]
PLACES = ("near_face_time", "mean_time", "far_face_time", "softening_time")
CLOSE = 1e-4  # of the time wanted, within which a root is found
FINENESS = 2.0  # of the engine's steps for derivatives: with a search's own, that by a melting temperature is 0.8 % off


@dataclass(frozen=True)
class LevelSet:
    """Response times over a grid of thickness and one parameter, and the line on which they are the time wanted."""

    parameter: str
    values: Array
    """Of the parameter, SI, one a row of `times`."""
    thicknesses: Array
    """[m], one a column of `times`."""
    times: dict[str, Array]
    """By place of the sensor [s]; infinite where it is never reached."""
    line: dict[str, Array]
    """By place: the thickness [m] that takes the time wanted, one a value; nan where none in the range does."""


def level_set(
    model: DeviceFunctions,
    parameter: str,
    values: Sequence[float],
    thicknesses: Sequence[float],
    wanted: float,
    say: Callable[[str], None] = lambda _: None,
) -> LevelSet:
    """Simulate the grid, and find the thickness that takes `wanted` seconds for each value and place of the sensor.

    Everything else is as the model starts. The line is looked for between neighbours of the grid, from the thinnest.
    """
    simulator = Simulator(model)

    def simulate(value: float, thickness: float) -> dict[str, float]:
        inputs = model.start.copy()
        inputs[model.index[parameter]], inputs[model.index["pcl_thickness"]] = value, thickness
        return simulator.run(inputs).values

    times: dict[str, list[list[float]]] = {place: [] for place in PLACES}
    line: dict[str, list[float]] = {place: [] for place in PLACES}
    for i, value in enumerate(values):
        say(f"the set of designs that take {wanted:g} s: {parameter}, {i + 1} of {len(values)}")
        row = [simulate(value, thickness) for thickness in thicknesses]
        for place in PLACES:
            sampled = [seen[place] for seen in row]

            def late(thickness: float, value: float = value, place: str = place) -> float:
                return simulate(value, thickness)[place] - wanted

            times[place].append(sampled)
            line[place].append(_first_root(late, thicknesses, [time - wanted for time in sampled], CLOSE * wanted))
    return LevelSet(
        parameter,
        np.asarray(values, float),
        np.asarray(thicknesses, float),
        {place: np.array(sampled) for place, sampled in times.items()},
        {place: np.array(times) for place, times in line.items()},
    )


def _first_root(function: Callable[[float], float], at: Sequence[float], known: Sequence[float], close: float) -> float:
    """Return the first zero of a function with known values at some points; nan if there is none."""
    for i in range(len(at) - 1):
        if known[i] <= 0.0 < known[i + 1]:
            return _root(function, (at[i], known[i]), (at[i + 1], known[i + 1]), close)
    return math.nan


def _root(
    function: Callable[[float], float], low: tuple[float, float], high: tuple[float, float], close: float
) -> float:
    """Return the zero of a function between two points (x, value), to `close` in its value, by the Illinois method.

    Halves the interval while the value at its upper end is infinite.
    """
    (x, below), (end, above) = low, high
    while end - x > 1e-12 * end:
        share = 0.5 if math.isinf(above) else below / (below - above)
        middle = x + share * (end - x)
        value = function(middle)
        if abs(value) <= close:
            return middle
        if value < 0.0:
            x, below, above = middle, value, 0.5 * above
        else:
            end, above, below = middle, value, 0.5 * below
    return 0.5 * (x + end)


@dataclass(frozen=True)
class Span:
    """The plausible range of one input, SI."""

    name: str
    low: float
    high: float


@dataclass(frozen=True)
class Influence:
    """Effect of one input while all others stay: times [s] of the first and the second module."""

    span: Span
    value: float
    """Of the input, SI."""
    at_low: Array
    at_high: Array

    @property
    def ratios(self) -> tuple[float, float]:
        """Second time over first, at the low and at the high end of the range."""
        return ratio(self.at_low), ratio(self.at_high)

    @property
    def reach(self) -> float:
        """Return the factor between the two ratios, at least one."""
        low, high = sorted(self.ratios)
        return high / low


def ratio(times: Sequence[float] | Array) -> float:
    """Second time over first."""
    return float(times[1] / times[0])


class Pair:
    """Two modules whose inputs of one name move together."""

    def __init__(self, first: DeviceFunctions, second: DeviceFunctions) -> None:
        """Start with nothing simulated."""
        self.models = (first, second)
        self._simulators = tuple(Simulator(model) for model in self.models)
        self._grids = defaultdict[tuple[int, str], dict[str, Grid]](dict)
        """Steps of the phases by module and event: those of the first run, so that all times have the same errors."""
        self._times: dict[tuple[int, str, tuple[tuple[str, float], ...]], float] = {}
        self._slopes: dict[tuple[int, str], dict[str, float]] = {}

    def value(self, name: str) -> float:
        """Value of an input [SI]. Raises InputError where the two differ in it or neither has it."""
        values = {float(model.start[model.index[name]]) for model in self.models if name in model.index}
        if len(values) != 1:
            listed = " and ".join(f"{value:g}" for value in sorted(values)) or "no value at all"
            raise InputError(f"{name} has {listed} in the two modules; it can move only where both start from the same")
        return values.pop()

    def switches(self, changes: Mapping[str, float] | None = None) -> tuple[dict[str, float], dict[str, float]]:
        """Return every value of the heating of both modules, with some inputs changed."""
        first, second = (self._switch(i, changes or {}) for i in range(2))
        return first, second

    def times(self, event: str, changes: Mapping[str, float] | None = None) -> Array:
        """Return the times of one event in both modules [s], infinite where it never happens."""
        return np.array([self._time(i, event, changes or {}) for i in range(2)])

    def _time(self, which: int, event: str, changes: Mapping[str, float]) -> float:
        """Return the time of one event in one module, whose own inputs among the changes alone count."""
        model = self.models[which]
        own = tuple((name, value) for name, value in changes.items() if name in model.index)
        if (which, event, own) not in self._times:
            inputs = model.start.copy()
            for name, value in own:
                inputs[model.index[name]] = value
            engine, still = CycleEngine(model), np.zeros((len(inputs), 0))
            times = engine.run(inputs, still, [event], self._grids[which, event]).values
            self._times[which, event, own] = float(times[model.switch_names.index(event)])
        return self._times[which, event, own]

    def influence(self, event: str, span: Span) -> Influence:
        """Times at both ends of an input's range."""
        at_low, at_high = (self.times(event, {span.name: end}) for end in (span.low, span.high))
        return Influence(span, self.value(span.name), at_low, at_high)

    def output_sensitivities(self, event: str, name: str) -> Array:
        """Relative change of both times with a relative change of an input, d ln t/d ln x; temperatures in kelvin.

        The ratio's is the second less the first.
        """
        self.value(name)
        return np.array([self._elasticities(i, event).get(name, 0.0) for i in range(2)])

    def _elasticities(self, which: int, event: str) -> dict[str, float]:
        """d ln t/d ln x of one module by each of its inputs."""
        if (which, event) not in self._slopes:
            model = self.models[which]
            row = model.switch_names.index(event)
            engine = CycleEngine(model, FINENESS)
            times, slopes, _ = engine.run(model.start, np.diag(model.start), [event])
            self._slopes[which, event] = dict(zip(model.names, slopes[row] / times[row], strict=True))
        return self._slopes[which, event]

    def _switch(self, which: int, changes: Mapping[str, float]) -> dict[str, float]:
        model = self.models[which]
        inputs = model.start.copy()
        for name, value in changes.items():
            if name in model.index:
                inputs[model.index[name]] = value
        return self._simulators[which].run(inputs, phases=[next(iter(model.phases))]).values
