"""One stage as equations: direct collocation of the heat equation over an unknown final time.

Radau points of order three on equal elements, time scaled by the final time, which is itself unknown; the last point of
an element is the start of the next, so the states need no continuity equations. States have no bounds. The current is
straight between evenly spaced nodes.
Source: Biegler, Nonlinear Programming (2010), ch. 10.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.solve.backend import ca
from tvimdesign.solve.simulate import Trajectory
from tvimdesign.solve.stage_model import StageModel

ORDER = 3
Array = NDArray[np.float64]


@cache
def radau() -> tuple[Array, Array, Array]:
    """Collocation points on (0, 1], derivative matrix [start and points, points], quadrature weights."""
    points = ca.collocation_points(ORDER, "radau")
    derivative, _, weights = ca.collocation_coeff(points)
    return np.array(points), np.asarray(derivative), np.asarray(weights).ravel()


@dataclass(frozen=True)
class Block:
    """The unknowns and equations of one stage that ends at one event."""

    event: str
    stage: StageModel
    states: Any
    """MX, one column a collocation point."""
    log_time: Any
    """MX, the logarithm of the final time in seconds."""
    equations: Any
    """MX, zero on a solution: the heat equation at every point, and the event at the last."""
    every: Any
    """MX, the states at the start and at every point, one column each."""
    currents: Any
    """MX, the current at the start and at every point, one row."""
    weights: Array
    """Quadrature weights of the points, in units of the final time; the start has none."""

    @property
    def final_time(self) -> Any:
        """[s]"""
        return ca.exp(self.log_time)

    @property
    def unknowns(self) -> Any:
        """MX, states column by column, then the log time."""
        return ca.vertcat(ca.vec(self.states), self.log_time)


def fractions(elements: int) -> Array:
    """The collocation points as fractions of the final time."""
    return np.concatenate([(element + radau()[0]) / elements for element in range(elements)])


def between_nodes(elements: int, nodes: int) -> Array:
    """Matrix that takes currents at evenly spaced nodes to the start and every collocation point [nodes, points]."""
    at = np.concatenate([[0.0], fractions(elements)])
    if nodes == 1:
        return np.ones((1, len(at)))
    places = np.linspace(0.0, 1.0, nodes)
    return np.array([np.interp(at, places, row) for row in np.eye(nodes)])


def stage_block(stage: StageModel, event: str, elements: int, inputs: Any, start: Any, nodes: Any) -> Block:
    """Write the equations of a stage for symbolic inputs, starting state and currents at the nodes (MX)."""
    _, derivative, weights = radau()
    count = elements * ORDER
    states = ca.MX.sym(f"states_{event}", stage.state_size, count)
    log_time = ca.MX.sym(f"log_time_{event}")
    currents = ca.mtimes(nodes.T, between_nodes(elements, nodes.numel()))
    rates = at_each(stage, stage.rates, states, currents[:, 1:], inputs)
    step = ca.exp(log_time) / elements
    equations = []
    for element in range(elements):
        columns = slice(element * ORDER, (element + 1) * ORDER)
        before = start if element == 0 else states[:, element * ORDER - 1]
        slopes = ca.mtimes(ca.horzcat(before, states[:, columns]), derivative)
        equations.append(ca.vec(slopes - step * rates[:, columns]))
    gap = stage.watch([event])(states[:, -1], currents[:, -1], inputs)
    return Block(
        event=event,
        stage=stage,
        states=states,
        log_time=log_time,
        equations=ca.vertcat(*equations, gap),
        every=ca.horzcat(start, states),
        currents=currents,
        weights=np.tile(weights, elements) / elements,
    )


def at_each(stage: StageModel, function: Any, states: Any, currents: Any, inputs: Any) -> Any:
    """A function (state, current, inputs) of the stage applied to every column of `states`."""
    constants, varying = stage.per_stage(function)
    count = states.size2()
    return varying.map(count)(states, currents, ca.repmat(constants(inputs), 1, count))


def guess(trajectory: Trajectory, elements: int) -> Array:
    """Values for a block's states from a simulated trajectory, one column a point."""
    return trajectory.at(fractions(elements))
