"""Outputs of many modules at once: the table's arithmetic and its working cycle, as one function.

Every design is computed by the same operations in the same order wherever it stands and however many threads share the
work: results are the same bit for bit.
"""

from collections.abc import Collection, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cached_property

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
        self._arithmetic = kernel_of(model, outputs, moving, names)
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
    """A tape that runs down columns of designs."""

    def __init__(self, tape: Tape, *constants: Array) -> None:
        """Take a tape; its last arguments may be `constants`, the same for all designs."""
        self.rows_in = int(tape.arguments[-1 - len(constants)])
        registers = tape.registers.copy()
        registers[self.rows_in : tape.arguments[-1]] = np.concatenate([np.zeros(0), *constants])
        self._tape, self._places = replace(tape, registers=registers), np.arange(self.rows_in)
        self._results = np.concatenate(tape.results)
        self.rows_out = len(self._results)

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


def kernel_of(model: DeviceFunctions, outputs: Sequence[str], moving: Sequence[str], supplied: Sequence[str]) -> Kernel:
    """Return outputs as a function of some inputs, then of some of what the cycle supplies; other inputs stay."""

    def record() -> tuple[Tape, Tape]:
        free, fixed = ca.SX.sym("free", len(moving) + len(supplied)), ca.SX.sym("fixed", len(model.names))
        inputs, cycle = ca.SX(fixed), ca.SX.ones(len(model.switch_names))
        for i, name in enumerate(moving):
            inputs[model.index[name]] = free[i]
        for i, name in enumerate(supplied, start=len(moving)):
            cycle[model.switch_names.index(name)] = free[i]
        return Tape.parted([free, fixed], model.outputs(outputs).call([inputs, cycle], True, False), inverses=False)

    key = f"{' '.join(outputs)} by {' '.join(moving)} and {' '.join(supplied)}"
    constants, tape = model.recordings(outputs).tapes(key, 2, record)
    return Kernel(tape, *constants.values(model.start))
