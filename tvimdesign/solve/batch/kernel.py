"""Compiled kernels: a CasADi function of scalars as machine code that runs down columns of designs.

The instructions of the expanded function are written out as LLVM's language, several designs side by side in one vector
register, and compiled when first called. Every design is computed by the same operations in the same order wherever it
stands and however many threads share the work: results are the same bit for bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.solve.batch.vector_code import LANES, Code, module_text

Array = NDArray[np.float64]

_BLOCK = 512 * LANES
"""Designs a thread takes at a time: some milliseconds of work."""


class Kernel:
    """A CasADi function of vectors, compiled for columns of designs."""

    def __init__(self, function: Any, often: bool = False, deadline: Deadline = NEVER) -> None:
        """Compile, what runs `often` as well as can be.

        Raises NotImplementedError naming what has no vector form, TimeOverError at the deadline.
        """
        scalar = function if function.is_a("SXFunction") else function.expand()
        self.rows_in = sum(scalar.numel_in(i) for i in range(scalar.n_in()))
        self.rows_out = sum(scalar.numel_out(i) for i in range(scalar.n_out()))
        self._code = Code(module_text(scalar), often, deadline)

    def __call__(self, columns: Array, workers: int = 1, out: Array | None = None) -> Array:
        """Evaluate: one row for each scalar of all arguments, one column a design, to rows of results."""
        given = np.ascontiguousarray(columns, dtype=np.float64)
        rows, count = given.shape
        if rows != self.rows_in:
            raise ValueError(f"the kernel takes {self.rows_in} rows, got {rows}")
        found = np.empty((self.rows_out, count)) if out is None else out
        if workers == 1 or count <= _BLOCK:
            self.run(given, found)
            return found
        starts = range(0, count, _BLOCK)
        with ThreadPoolExecutor(workers) as pool:
            for _ in pool.map(lambda start: self.run(given, found, start, min(start + _BLOCK, count)), starts):
                pass
        return found

    def run(self, given: Array, found: Array, start: int = 0, end: int | None = None) -> None:
        """Fill `found` from column `start` to `end`; both arrays contiguous row by row, with as many columns."""
        if not (given.flags.c_contiguous and found.flags.c_contiguous and given.shape[1] == found.shape[1]):
            raise ValueError("a kernel reads and writes arrays that are contiguous row by row, with as many columns")
        count = given.shape[1]
        last = count if end is None else end
        whole = start + (last - start) // LANES * LANES
        self._code(given.ctypes.data, found.ctypes.data, count, count, start, whole)
        if whole < last:  # what does not fill a register is computed in one that is filled up
            rest = np.repeat(given[:, last - 1 : last], LANES, axis=1)
            rest[:, : last - whole] = given[:, whole:last]
            after = np.empty((self.rows_out, LANES))
            self._code(rest.ctypes.data, after.ctypes.data, LANES, LANES, 0, LANES)
            found[:, whole:last] = after[:, : last - whole]


def stacked(*parts: Array) -> Array:
    """Rows one below the other, contiguous as a kernel wants them; numpy's own follows the order of the parts."""
    found = np.empty((sum(len(part) for part in parts), parts[0].shape[1]))
    np.concatenate(parts, out=found)
    return found


def of_columns(function: Any, base: Sequence[Array], moving: Sequence[tuple[int, int]]) -> Any:
    """A function of some entries of its arguments alone, all others constants that are folded in.

    `base` are the arguments' values, `moving` the (argument, entry) that stay free, in the order of the new vector.
    """
    free = ca.SX.sym("moving", len(moving))
    arguments = [ca.SX(ca.DM(np.asarray(values))) for values in base]
    for i, (argument, entry) in enumerate(moving):
        arguments[argument][entry] = free[i]
    return ca.Function("moving", [free], function.call(arguments, True, False))
