"""The designs that switch in a given time: for each value of a second parameter, the layer's thickness that does.

One response time does not tell a design: thickness, contacts, current and the place of the sensor trade off. The set of
those that give the same time is a line for each place of the sensor; its points are roots, not read off a grid.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions

Array = NDArray[np.float64]
PLACES = ("near_face_time", "mean_time", "far_face_time", "softening_time")
CLOSE = 1e-4  # of the time wanted, within which a root is found


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
