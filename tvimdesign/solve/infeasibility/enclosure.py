"""What the table's algebra can come to over ranges: interval evaluation of the compiled outputs, and of their slopes.

Walks the scalar operations of a CasADi function, each on all boxes at once. The result is certain but not tight:
an input that occurs twice counts as two. Slopes help: an output that only rises with a number has its ends at that
number's, and the mean-value form holds everywhere.
Source: Moore, Kearfott and Cloud, Introduction to Interval Analysis (2009), ch. 6.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.device import Event
from tvimdesign.simulation.casadi_setup import ca
from tvimdesign.simulation.device_functions import DeviceFunctions
from tvimdesign.solve.infeasibility.interval import OPERATIONS, Interval, add, anything, multiply, point, subtract

Array = NDArray[np.float64]


class Walk:
    """A CasADi function of scalar operations, ready to be walked with intervals."""

    def __init__(self, function: Any) -> None:
        """Read the operations off an SX function."""
        self._size = function.sz_w()
        self._outputs = function.nnz_out(0)
        self._steps = [
            (
                function.instruction_id(k), function.instruction_input(k), function.instruction_output(k),
                function.instruction_constant(k) if function.instruction_id(k) == ca.OP_CONST else 0.0,
            )
            for k in range(function.n_instructions())
        ]  # fmt: skip

    def __call__(self, *arguments: Sequence[Interval]) -> list[Interval]:
        """The function's first output, an interval for each of its numbers."""
        work: list[Any] = [None] * self._size
        found: list[Any] = [None] * self._outputs
        with np.errstate(all="ignore"):
            for operation, read, written, constant in self._steps:
                if operation == ca.OP_INPUT:
                    work[written[0]] = arguments[read[0]][read[1]]
                elif operation == ca.OP_OUTPUT:
                    found[written[1]] = work[read[0]]
                elif operation == ca.OP_CONST:
                    work[written[0]] = point(constant)
                else:
                    work[written[0]] = OPERATIONS.get(operation, anything)(*(work[place] for place in read))
        return found


@dataclass(frozen=True)
class Bounds:
    """Ends of every output, boxes by outputs; `whole` where it is defined and without jumps throughout the box."""

    low: Array
    high: Array
    whole: NDArray[np.bool_]


@dataclass(frozen=True)
class Slopes:
    """Ends of every derivative, boxes by outputs by free numbers; everything where there is no telling."""

    low: Array
    high: Array


def _time() -> Interval:
    """What is known of a time."""
    return Interval(np.array([0.0]), np.array([np.inf]), np.array([False]))


class Enclosure:
    """Outputs of a model as functions of the numbers that are free, everything else as in its start.

    Of what a simulation supplies nothing is known, but that a time is never negative.
    """

    def __init__(self, model: DeviceFunctions, outputs: Sequence[str], free: Sequence[str]) -> None:
        """Compile the outputs."""
        self.model, self.outputs, self.free = model, tuple(outputs), tuple(free)
        self._places = [model.index[name] for name in free]
        self._function = model.outputs(self.outputs)
        self._walk = Walk(self._function)
        self._switch = [_time() if isinstance(row, Event) else anything(point(0.0)) for row in model.table.supplied]

    @cached_property
    def _slope_walk(self) -> Walk:
        inputs = ca.SX.sym("inputs", len(self.model.names))
        cycle = ca.SX.sym("cycle", len(self.model.switch_names))
        slopes = ca.jacobian(self._function(inputs, cycle), inputs)[:, self._places]
        return Walk(ca.Function("slopes", [inputs, cycle], [ca.densify(slopes)]))

    def values(self, point_: Array) -> Array:
        """The outputs at one point, in floating-point numbers."""
        inputs = self.model.start.copy()
        inputs[self._places] = point_
        return np.asarray(self._function(inputs, np.zeros(len(self._switch)))).ravel()

    def _inputs(self, low: Array, high: Array) -> list[Interval]:
        inputs = [point(value) for value in self.model.start]
        sure = np.ones(len(low), dtype=bool)
        for i, place in enumerate(self._places):
            inputs[place] = Interval(low[:, i], high[:, i], sure)
        return inputs

    def natural(self, low: Array, high: Array) -> Bounds:
        """Operation by operation, over boxes given as rows of lower and upper ends."""
        found = self._walk(self._inputs(low, high), self._switch)
        return Bounds(*(self._columns(found, field, len(low)) for field in ("low", "high", "whole")))

    def slopes(self, low: Array, high: Array) -> Slopes:
        """Derivatives of the outputs by the free numbers over boxes; by a kink's both sides where there is one."""
        found = self._slope_walk(self._inputs(low, high), self._switch)
        shape = (len(low), len(self.free), len(self.outputs))
        ends = {field: self._columns(found, field, len(low)).reshape(shape) for field in ("low", "high", "whole")}
        least = np.where(ends["whole"], ends["low"], -np.inf)
        most = np.where(ends["whole"], ends["high"], np.inf)
        return Slopes(np.swapaxes(least, 1, 2), np.swapaxes(most, 1, 2))

    @staticmethod
    def _columns(found: Sequence[Interval], field: str, boxes: int) -> Any:
        return np.column_stack([np.broadcast_to(getattr(one, field), boxes) for one in found])

    def bounds(self, low: Array, high: Array) -> Bounds:
        """The best of three over one box: operation by operation, the mean-value form, and ends where it only rises."""
        natural, slopes = self.natural(low[None], high[None]), self.slopes(low[None], high[None])
        mean = mean_value(self, natural, slopes, low[None], high[None])
        usable = natural.whole[0] & np.all(np.isfinite(slopes.low[0]) & np.isfinite(slopes.high[0]), axis=1)
        rising = usable[:, None] & (slopes.low[0] >= 0.0)
        falling = usable[:, None] & (slopes.high[0] <= 0.0) & ~rising
        ends = []
        for up, down in ((rising, falling), (falling, rising)):  # where the least lies, then where the greatest does
            corner = self.natural(np.where(down, high, low), np.where(up, low, high))
            ends.append(corner)
        diagonal = np.arange(len(self.outputs))
        least = np.maximum(mean.low[0], ends[0].low[diagonal, diagonal])
        most = np.minimum(mean.high[0], ends[1].high[diagonal, diagonal])
        return Bounds(least, most, natural.whole[0])


def mean_value(enclosure: Enclosure, natural: Bounds, slopes: Slopes, low: Array, high: Array) -> Bounds:
    """Each output's bounds met with f(c) + sum of slope times distance from the middle c, where it is defined."""
    middle = 0.5 * (low + high)
    at_middle = enclosure.natural(middle, middle)
    sure = np.ones((len(low), 1), dtype=bool)
    with np.errstate(all="ignore"):
        total = Interval(at_middle.low, at_middle.high, sure)
        for i in range(len(enclosure.free)):
            slope = Interval(slopes.low[:, :, i], slopes.high[:, :, i], sure)
            ends = Interval(low[:, i : i + 1], high[:, i : i + 1], sure)
            centre = Interval(middle[:, i : i + 1], middle[:, i : i + 1], sure)
            total = add(total, multiply(slope, subtract(ends, centre)))
    usable = natural.whole
    return Bounds(
        np.where(usable, np.maximum(natural.low, total.low), natural.low),
        np.where(usable, np.minimum(natural.high, total.high), natural.high),
        natural.whole,
    )
