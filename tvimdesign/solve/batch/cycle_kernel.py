"""The working cycle of many designs at once: the same heat equation, events and paths as the simulator's, compiled.

Time runs in fixed steps of SDIRK2 (Alexander 1977, L-stable), one exact Newton step a phase. Where an event is passed
the step is gone through once more in smaller ones. Every design is on its own: its bits do not hang on its neighbours.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.device import Event, Path, Steady
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions
from tvimdesign.solve.batch.phase_kernel import Course, Passage, PhaseKernel, Steps
from tvimdesign.solve.batch.vector_code import LANES

Array = NDArray[np.float64]

BLOCK = 512
"""Designs that go through the cycle together."""
STEPS = Steps(of_pace=20, in_window=4, close=8, first=0.25)
EARLIER = Steps(of_pace=24, in_window=4, close=8, first=1.0 / 32.0, growth=1.5)
"""Steps of a phase of which events are wanted that come before its end, some at a twentieth of its time."""
FREEZING = Steps(of_pace=40, in_window=4, close=4, first=1.0 / 16.0)
"""Steps of a phase in which the polymer has a history."""
"""With these, times are within 0.2 % of the converged simulation (tests hold that for all shipped studies)."""


@dataclass(frozen=True)
class Pace:
    """How the study's own design goes through the cycle: what the steps of all others are measured by."""

    times: Mapping[str, float]
    """About how long each phase takes [s], by name."""
    balances: Mapping[str, Array]
    """State and current that stay where a phase ended, by phase."""


class CycleKernel:
    """The supplied rows of many designs of one model, as functions of some of its inputs."""

    def __init__(
        self,
        model: DeviceFunctions,
        moving: Sequence[str],
        wanted: Collection[str],
        steps: Steps = STEPS,
        freezing: Steps = FREEZING,
        earlier: Steps = EARLIER,
        often: Collection[str] = (),
        deadline: Deadline = NEVER,
    ) -> None:
        """Compile what the wanted supplied rows need; all inputs but the `moving` are constants.

        Phases that are gone through `often`, by name, are compiled to run as fast as can be.
        """
        self.model = model
        rows = {row.name: row for row in model.table.supplied if row.name in wanted}
        self.names = tuple(rows)
        ending = {s.phase.ends for s in model.phases.values() if self._must_end(s.phase.name, rows.values())}
        self.phases = {
            name: PhaseKernel(
                model, phase, moving,
                [row.name for row in phase.events if row.name in rows or row.name in ending],
                [row.name for row in phase.paths if row.name in rows],
                [row.name for row in phase.steadies if row.name in rows],
                freezing if phase.phase.after else earlier if self._before_end(phase, rows) else steps,
                often=name in often, deadline=deadline,
            )
            for name, phase in model.phases.items()
            if any(row.phase == name for row in rows.values()) or phase.phase.ends in ending
        }  # fmt: skip

    @staticmethod
    def _before_end(phase: PhaseFunctions, rows: Collection[str]) -> bool:
        """Whether an event is wanted that is not the one which ends the phase."""
        return any(row.name in rows and row.name != phase.phase.ends for row in phase.events)

    def _must_end(self, name: str, rows: Collection[Event | Path | Steady]) -> bool:
        """Whether the end of a phase is needed: by its own paths and steady rows, or by a phase that comes after."""
        mine = any(not isinstance(row, Event) for row in rows if row.phase == name)
        after = [other.phase for other in self.model.phases.values() if other.phase.after == name]
        return mine or any(self._must_end(s.name, rows) or any(r.phase == s.name for r in rows) for s in after)

    def __call__(
        self, columns: Array, pace: Pace, workers: int = 1, only: Collection[str] | None = None,
        deadline: Deadline = NEVER,
    ) -> Array:  # fmt: skip
        """Values of `names`, one row each, for designs whose moving inputs are the columns; infinite where never.

        With `only` some phases, by name, what belongs to the others is infinite. Raises TimeOverError at the deadline.
        """
        count = columns.shape[1]
        found = np.empty((len(self.names), count))
        starts = range(0, count, BLOCK)

        def fill(start: int) -> None:
            deadline.check("all modules were drawn")
            values = self._block(np.ascontiguousarray(columns[:, start : start + BLOCK]), pace, only)
            for i, name in enumerate(self.names):
                found[i, start : start + BLOCK] = values[name]

        with ThreadPoolExecutor(workers) as pool:
            for _ in pool.map(fill, starts):
                pass
        return found

    def course(self, column: Array, pace: Pace) -> tuple[dict[str, float], dict[str, Course]]:
        """Values of `names` for one design, and its states step by step through each phase to what ends it."""
        kept: dict[str, Course] = {name: [] for name in self.phases}
        # As many columns as a register holds: a kernel would fill it up at every call.
        values = self._block(np.repeat(column[:, None], LANES, axis=1), pace, None, kept)
        return {name: float(found[0]) for name, found in values.items()}, kept

    def _block(
        self, columns: Array, pace: Pace, only: Collection[str] | None, keep: Mapping[str, Course] | None = None
    ) -> dict[str, Array]:
        never = np.full(columns.shape[1], np.inf)
        values = dict.fromkeys(self.names, never)
        passed: dict[str, Passage] = {}
        for name, phase in self.phases.items():
            if only is not None and name not in only:
                continue
            before = passed[phase.after].end if phase.after else None
            course = keep[name] if keep else None
            passed[name] = phase.run(columns, before, pace.times[name], pace.balances.get(name), course)
            ended = ~np.isnan(before[0]) if before is not None else np.ones(columns.shape[1], dtype=bool)
            values |= {row: np.where(ended, found, np.inf) for row, found in passed[name].values.items()}
        return {name: values[name] for name in self.names}
