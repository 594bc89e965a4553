"""Outputs of many modules at once: the table's arithmetic and its working cycle, as one function."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.batch.cycle_kernel import CycleKernel, Pace
from tvimdesign.solve.batch.kernel import Kernel, of_columns

Array = NDArray[np.float64]

SLOW = 0.1
"""Share of the horizon that a phase is paced by which never ends as drawn."""


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
        self._simulator = Simulator(model)

    @cached_property
    def _pace(self) -> Pace | None:
        """That of the module as drawn, for who gives none."""
        return self.pace_at(self._simulator.model.start)

    def pace_at(self, inputs: Array, beside: Pace | None = None) -> Pace | None:
        """Return how the design with these inputs goes through its cycle; None if nothing depends on it.

        Its steps are those of a design `beside` it, if given, and chosen anew otherwise.
        """
        if self.cycle is None:
            return None
        model = self._simulator.model
        cycle = self._simulator.run(inputs, phases=list(self.cycle.phases))
        slow = SLOW * float(inputs[model.index["horizon"]])
        ends = {name: cycle.values[phase.phase.ends] for name, phase in model.phases.items()}
        pace = Pace({n: t if 0.0 < t < np.inf else slow for n, t in ends.items()}, cycle.balances)
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
