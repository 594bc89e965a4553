"""One switch as equations: direct collocation of the heat equation over an unknown final time.

Radau points of order three on equal elements, time scaled by the final time, which is itself unknown; the last point of
an element is the start of the next, so the states need no continuity equations. States have no bounds.
Source: Biegler, Nonlinear Programming (2010), ch. 10.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.solve.backend import ca
from tvimdesign.solve.model import Model
from tvimdesign.solve.simulate import Trajectory

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
    """The unknowns and equations of one switch that ends at one event."""

    event: str
    states: Any
    """MX, one column a collocation point."""
    log_time: Any
    """MX, the logarithm of the final time in seconds."""
    equations: Any
    """MX, zero on a solution: the heat equation at every point, and the event at the last."""
    every: Any
    """MX, the states at the start and at every point, one column each."""
    weights: Array
    """Quadrature weights of the points, in units of the final time; the start has none."""

    @property
    def final_time(self) -> Any:
        """[s]"""
        return ca.exp(self.log_time)


def switch_block(model: Model, event: str, elements: int, inputs: Any) -> Block:
    """Write the equations of a switch for symbolic inputs (MX)."""
    _, derivative, weights = radau()
    count = elements * ORDER
    states = ca.MX.sym(f"states_{event}", model.rates.size1_in(0), count)
    log_time = ca.MX.sym(f"log_time_{event}")
    start = model.initial(inputs)
    rates = at_each(model, model.rates, states, inputs)
    step = ca.exp(log_time) / elements
    equations = []
    for element in range(elements):
        columns = slice(element * ORDER, (element + 1) * ORDER)
        before = start if element == 0 else states[:, element * ORDER - 1]
        slopes = ca.mtimes(ca.horzcat(before, states[:, columns]), derivative)
        equations.append(ca.vec(slopes - step * rates[:, columns]))
    gap = model.watch([event])(states[:, -1], inputs)
    return Block(
        event=event,
        states=states,
        log_time=log_time,
        equations=ca.vertcat(*equations, gap),
        every=ca.horzcat(start, states),
        weights=np.tile(weights, elements) / elements,
    )


def at_each(model: Model, function: Any, states: Any, inputs: Any) -> Any:
    """A function (state, inputs) of the model applied to every column of `states`."""
    constants, varying = model.per_switch(function)
    count = states.size2()
    return varying.map(count)(states, ca.repmat(constants(inputs), 1, count))


def guess(trajectory: Trajectory, elements: int) -> Array:
    """Values for a block's states from a simulated trajectory, one column a point."""
    points, _, _ = radau()
    fractions = np.concatenate([(element + points) / elements for element in range(elements)])
    return trajectory.at(fractions)
