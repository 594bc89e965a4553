"""One phase as equations: direct collocation of the heat equation over an unknown final time.

Radau points on each of a few equal elements over an unknown time, five unless asked for otherwise; the last point of an
element is the start of the next, so the states need no continuity equations. States have no bounds. The current is
straight between evenly spaced nodes; a ramp to the first of them, as long as the supply's slew makes it, has elements
of its own before the others.
Source: Biegler, Nonlinear Programming (2010), ch. 10.
"""

from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from per_phase import per_phase

from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions
from tvimdesign.simulation.working_cycle.trajectory import Trajectory

ORDER = 5
"""Points of an element. Three of five are as exact as eight of three, with three eighths fewer unknowns."""
Array = NDArray[np.float64]


@cache
def radau(order: int = ORDER) -> tuple[Array, Array, Array]:
    """Collocation points on (0, 1], derivative matrix [start and points, points], quadrature weights."""
    points = ca.collocation_points(order, "radau")
    derivative, _, weights = ca.collocation_coeff(points)
    return np.array(points), np.asarray(derivative), np.asarray(weights).ravel()


@dataclass(frozen=True)
class Block:
    """The unknowns and equations of one phase that ends at one event."""

    event: str
    phase: PhaseFunctions
    states: Any
    """MX, one column a collocation point."""
    log_time: Any
    """MX, the logarithm of the time in seconds that the equal elements take."""
    ramp: Any
    """MX or 0, the length [s] of the ramp before them."""
    equations: Any
    """MX, zero on a solution: the heat equation at every point, and the event at the last."""
    every: Any
    """MX, the states at the start and at every point, one column each."""
    currents: Any
    """MX, the current at the start and at every point, one row."""
    weights: Any
    """MX, quadrature weights [s] of the points; the start has none."""

    @property
    def pieces_time(self) -> Any:
        """Time [s] after the ramp."""
        return ca.exp(self.log_time)

    @property
    def final_time(self) -> Any:
        """[s]"""
        return self.ramp + self.pieces_time

    @cached_property
    def unknowns(self) -> Any:
        """MX, states column by column, then the log time."""
        return ca.vertcat(ca.vec(self.states), self.log_time)


def moments(elements: int, duration: float, ramp: tuple[int, float] = (0, 0.0), order: int = ORDER) -> Array:
    """The collocation points [s] of equal elements over a duration, after those of a ramp: its elements and seconds."""
    count, before = ramp
    rising = _evenly(count, order) * before if count else np.zeros(0)
    return np.concatenate([rising, before + _evenly(elements, order) * duration])


def _evenly(elements: int, order: int) -> Array:
    """The points of equal elements as fractions of their time."""
    return np.concatenate([(element + radau(order)[0]) / elements for element in range(elements)])


def between_nodes(elements: int, nodes: int, ramp_elements: int, order: int = ORDER) -> Array:
    """Matrix that takes currents at evenly spaced nodes to the start and every collocation point [nodes, points].

    With a ramp, the start is at zero current and the ramp's elements lead to the first node.
    """
    places = np.linspace(0.0, 1.0, nodes)
    found = np.array([np.interp(_evenly(elements, order), places, row) for row in np.eye(nodes)])
    rising = np.append(0.0, _evenly(ramp_elements, order)) if ramp_elements else np.ones(1)
    return np.hstack([np.eye(nodes)[:, :1] * rising, found])


def phase_block(
    phase: PhaseFunctions,
    event: str,
    elements: int,
    inputs: Any,
    start: Any,
    nodes: Any,
    ramp: tuple[int, Any] = (0, 0.0),
    order: int = ORDER,
) -> Block:
    """Write the equations of a phase for symbolic inputs, starting state and currents at the nodes (MX).

    A current that is not there from the start rises from zero to its first node over a `ramp`: elements and seconds.
    """
    weights = radau(order)[2]
    log_time = ca.MX.sym(f"log_time_{event}")
    ramp_elements, ramp_time = ramp
    lengths = [ramp_time / ramp_elements] * ramp_elements if ramp_elements else []
    lengths += [ca.exp(log_time) / elements] * elements
    states = ca.MX.sym(f"states_{event}", phase.state_size, len(lengths) * order)
    currents = ca.mtimes(nodes.T, between_nodes(elements, nodes.numel(), ramp_elements, order))
    every = ca.horzcat(start, states)
    slopes = ca.mtimes(every, _differences(len(lengths), order))
    rates = at_each(phase, phase.rates, states, currents[:, 1:], inputs)
    steps = ca.horzcat(*(ca.repmat(length, 1, order) for length in lengths))
    gap = phase.watch([event])(states[:, -1], currents[:, -1], inputs)
    return Block(
        event=event,
        phase=phase,
        states=states,
        log_time=log_time,
        ramp=ramp_time,
        equations=ca.vertcat(ca.vec(slopes - ca.repmat(steps, phase.state_size, 1) * rates), gap),
        every=every,
        currents=currents,
        weights=ca.vertcat(*(length * weights for length in lengths)),
    )


def _differences(elements: int, order: int) -> Any:
    """Matrix that takes the start and every point to derivatives at every point over an element's length (DM)."""
    _, derivative, _ = radau(order)
    blocks = ca.DM(elements * order + 1, elements * order)
    for first in range(0, elements * order, order):
        blocks[first : first + order + 1, first : first + order] = derivative
    return blocks


def at_each(phase: PhaseFunctions, function: Any, states: Any, currents: Any, inputs: Any) -> Any:
    """A function (state, current, inputs) of the phase applied to every column of `states`."""
    constants, varying = per_phase(phase, function)
    count = states.size2()
    return varying.map(count)(states, currents, ca.repmat(constants(inputs), 1, count))


def guess(trajectory: Trajectory, elements: int, ramp: tuple[int, float] = (0, 0.0), order: int = ORDER) -> Array:
    """Values for a block's states from a simulated trajectory, one column a point, with the ramp drawn in."""
    times = moments(elements, trajectory.times[-1], ramp, order)
    return trajectory.at(times / (times[-1] or 1.0))
