"""A CasADi function of scalars for columns of designs, by the tape's interpreter: nothing is compiled for it.

Every design is computed by the same operations in the same order wherever it stands and however many threads share the
work: results are the same bit for bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.engine.lanes import evaluate, lanes_of
from tvimdesign.engine.tape import Tape
from tvimdesign.simulation.working_cycle.casadi_setup import ca

Array = NDArray[np.float64]

_BLOCK = 4096
"""Designs a thread takes at a time: some milliseconds of work."""


class Kernel:
    """A function of vectors, recorded to run down columns of designs."""

    def __init__(self, function: Any) -> None:
        """Record. Raises ValueError for an operation that the interpreter does not know."""
        scalar = function if function.is_a("SXFunction") else function.expand()
        arguments = [ca.densify(argument) for argument in scalar.sx_in()]
        results = [ca.densify(result) for result in scalar.call(arguments, True, False)]
        self._tape = Tape.of(arguments, results)
        self._places = np.arange(self._tape.arguments[-1])
        self._results = np.concatenate(self._tape.results)
        self.rows_in, self.rows_out = len(self._places), len(self._results)

    def __call__(self, columns: Array, workers: int = 1) -> Array:
        """Evaluate: one row for each scalar of all arguments, one column a design, to rows of results."""
        given = np.ascontiguousarray(columns, dtype=np.float64)
        rows, count = given.shape
        if rows != self.rows_in:
            raise ValueError(f"the kernel takes {self.rows_in} rows, got {rows}")
        results = np.empty((self.rows_out, count))

        def fill(start: int) -> None:
            end = min(start + _BLOCK, count)
            evaluate(self._tape.code, lanes_of(self._tape), self._places, given, self._results, results, start, end)

        if workers == 1 or count <= _BLOCK:
            for start in range(0, count, _BLOCK):
                fill(start)
            return results
        with ThreadPoolExecutor(workers) as pool:
            for _ in pool.map(fill, range(0, count, _BLOCK)):
                pass
        return results


def of_columns(function: Any, base: Sequence[Array], moving: Sequence[tuple[int, int]]) -> Any:
    """Return a function of some entries of its arguments; all others are constants that are folded in.

    `base` are the arguments' values, `moving` the (argument, entry) that stay free, in the order of the new vector.
    """
    free = ca.SX.sym("moving", len(moving))
    arguments = [ca.SX(ca.DM(np.asarray(values))) for values in base]
    for i, (argument, entry) in enumerate(moving):
        arguments[argument][entry] = free[i]
    return ca.Function("moving", [free], function.call(arguments, True, False))
