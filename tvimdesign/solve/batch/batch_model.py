"""Outputs of many modules at once: the table's arithmetic and its working cycle, as one function.

Every design is computed by the same operations in the same order wherever it stands and however many threads share the
work: results are the same bit for bit.
"""

from collections.abc import Collection, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.engine.lanes import evaluate, lanes_of
from tvimdesign.engine.tape import Tape
from tvimdesign.engine.vectors import Array
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.symbols import ca
from tvimdesign.solve.batch.cycle_kernel import CycleKernel, Pace

_LOOSE = 2e-3  # Tolerance of a simulation that a pace is taken from
_SLOW = 0.1  # Share of the horizon that a phase is paced by which never ends as drawn


def pace_of(simulator: Simulator, inputs: Array, phases: Collection[str] | None = None) -> Pace:
    """Return how the design with these inputs goes through some phases of its cycle, or all."""
    cycle = simulator.run(inputs, phases=phases)
    slow = _SLOW * float(inputs[simulator.model.index["horizon"]])
    ends = {name: cycle.values[phase.phase.ends] for name, phase in simulator.model.phases.items()}
    return Pace({n: t if 0.0 < t < np.inf else slow for n, t in ends.items()}, cycle.balances)


class BatchModel:
    """Some outputs of one module as a function of columns of some of its inputs."""

    def __init__(self, model: DeviceFunctions, moving: Sequence[str], outputs: Sequence[str]) -> None:
        """Record. All inputs but the `moving` are constants."""
        needed = {base for name in outputs for base in (name.partition("@")[0], *model.table.ancestors(name))}
        supplied = [name for name in model.switch_names if name in needed]
        self.cycle = CycleKernel(model, moving, supplied) if supplied else None
        names = self.cycle.names if self.cycle else ()
        seen = np.ones(len(model.switch_names))
        places = [(0, model.index[name]) for name in moving] + [(1, model.switch_names.index(name)) for name in names]
        self._arithmetic = Kernel(of_columns(model.outputs(outputs), [model.start, seen], places))
        self._places = [model.index[name] for name in moving]
        self._simulator = Simulator(model, _LOOSE, samples=2)

    @cached_property
    def _pace(self) -> Pace | None:
        """That of the module as drawn, for who gives none."""
        start = self._simulator.model.start
        return self.fitted(self.pace_at(start), start)

    def pace_at(self, inputs: Array) -> Pace | None:
        """Return how the design with these inputs goes through its cycle; None if nothing depends on it."""
        if self.cycle is None:
            return None
        return pace_of(self._simulator, inputs, list(self.cycle.phases))

    def fitted(self, pace: Pace | None, inputs: Array, beside: Pace | None = None) -> Pace | None:
        """Return a pace with steps as coarse as modules of its design bear.

        The steps are those of a design `beside` it, if given, and chosen anew otherwise.
        """
        if self.cycle is None or pace is None:
            return None
        column = inputs[self._places]
        if beside is None:
            return self.cycle.fitted(pace, column)
        return replace(pace, fits={name: replace(fit, about=column) for name, fit in beside.fits.items()})

    def __call__(
        self, columns: Array, workers: int = 1, pace: Pace | None = None, only: Collection[str] | None = None,
        deadline: Deadline = NEVER,
    ) -> Array:  # fmt: skip
        """Return one row for each output; infinite or NaN where something never happens.

        `pace` is that of another design than the one it was recorded at, where the columns are modules of that. With
        `only` some phases of the cycle, by name, outputs of the others mean nothing. Raises TimeOverError.
        """
        pace = pace or self._pace
        if self.cycle is None or pace is None:
            return self._arithmetic(columns, workers)
        return self._arithmetic(np.concatenate([columns, self.cycle(columns, pace, workers, only, deadline)]), workers)


_BLOCK = 4096  # Designs a thread takes at a time: some milliseconds of work


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
