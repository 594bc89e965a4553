"""The working cycle of many designs at once: the same heat equation, events and paths as the simulator's, compiled.

Time runs in fixed steps of SDIRK2 (Alexander 1977, L-stable), one exact Newton step a stage. Where an event is passed
the step is gone through once more in smaller ones. Every design is on its own: its bits do not hang on its neighbours.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.device import Event, Path, Steady
from tvimdesign.simulation.device_functions import Model
from tvimdesign.solve.batch.phase_kernel import Passage, StageKernel, Steps

Array = NDArray[np.float64]

BLOCK = 512
"""Designs that go through the cycle together."""
STEPS = Steps(of_pace=20, in_window=4, close=4, first=0.25)
FREEZING = Steps(of_pace=40, in_window=4, close=4, first=1.0 / 16.0)
"""Steps of a stage in which the polymer has a history."""
"""With these, times are within 0.2 % of the converged simulation (tests hold that for all shipped studies)."""


@dataclass(frozen=True)
class Pace:
    """How the study's own design goes through the cycle: what the steps of all others are measured by."""

    times: Mapping[str, float]
    """About how long each stage takes [s], by name."""
    balances: Mapping[str, Array]
    """State and current that stay where a stage ended, by stage."""


class SwitchKernel:
    """The supplied rows of many designs of one model, as functions of some of its inputs."""

    def __init__(
        self,
        model: Model,
        moving: Sequence[str],
        wanted: Collection[str],
        steps: Steps = STEPS,
        freezing: Steps = FREEZING,
    ) -> None:
        """Compile what the wanted supplied rows need; all inputs but the `moving` are constants."""
        self.model = model
        rows = {row.name: row for row in model.table.supplied if row.name in wanted}
        self.names = tuple(rows)
        ending = {s.stage.ends for s in model.stages.values() if self._must_end(s.stage.name, rows.values())}
        self.stages = {
            name: StageKernel(
                model, stage, moving,
                [row.name for row in stage.events if row.name in rows or row.name in ending],
                [row.name for row in stage.paths if row.name in rows],
                [row.name for row in stage.steadies if row.name in rows],
                freezing if stage.stage.after else steps,
            )
            for name, stage in model.stages.items()
            if any(row.stage == name for row in rows.values()) or stage.stage.ends in ending
        }  # fmt: skip

    def _must_end(self, name: str, rows: Collection[Event | Path | Steady]) -> bool:
        """Whether the end of a stage is needed: by its own paths and steady rows, or by a stage that comes after."""
        mine = any(not isinstance(row, Event) for row in rows if row.stage == name)
        after = [other.stage for other in self.model.stages.values() if other.stage.after == name]
        return mine or any(self._must_end(s.name, rows) or any(r.stage == s.name for r in rows) for s in after)

    def __call__(self, columns: Array, pace: Pace, workers: int = 1) -> Array:
        """Values of `names`, one row each, for designs whose moving inputs are the columns; infinite where never."""
        count = columns.shape[1]
        found = np.empty((len(self.names), count))
        starts = range(0, count, BLOCK)

        def fill(start: int) -> None:
            values = self._block(np.ascontiguousarray(columns[:, start : start + BLOCK]), pace)
            for i, name in enumerate(self.names):
                found[i, start : start + BLOCK] = values[name]

        with ThreadPoolExecutor(workers) as pool:
            for _ in pool.map(fill, starts):
                pass
        return found

    def _block(self, columns: Array, pace: Pace) -> dict[str, Array]:
        never = np.full(columns.shape[1], np.inf)
        values = dict.fromkeys(self.names, never)
        passed: dict[str, Passage] = {}
        for name, stage in self.stages.items():
            before = passed[stage.after].end if stage.after else None
            passed[name] = stage.run(columns, before, pace.times[name], pace.balances.get(name))
            ended = ~np.isnan(before[0]) if before is not None else np.ones(columns.shape[1], dtype=bool)
            values |= {row: np.where(ended, found, np.inf) for row, found in passed[name].values.items()}
        return {name: values[name] for name in self.names}
