"""The working cycle of many designs at once; the bits of each do not depend on its neighbours."""

import math
from collections.abc import Collection, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.device import Event, Path, Steady
from tvimdesign.engine.vectors import LANES, Array
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.batch.phase_kernel import Course, Fit, Passage, PhaseKernel, Steps

BLOCK = 128  # Designs that go through the cycle together; smaller ones share threads evenly
STEPS = Steps(40, 1.0 / 32.0, 1.15)
COARSE = (
    Steps(8, 0.25, 2.0), Steps(10, 0.125, 2.0), Steps(12, 0.125, 2.0), Steps(16, 0.0625, 1.5), Steps(20, 0.03125, 1.5),
    Steps(24, 0.03125, 1.15), Steps(40, 0.03125, 1.15), Steps(64, 0.03125, 1.15),
)  # fmt: skip
"""Steps that are tried; taken are the first that will do."""
FINE = Steps(96, 1.0 / 64.0, 1.1)
CLOSE, MOST = 8e-4, 0.9
"""Largest difference from fine steps in the values of so many designs. Where an event is only just reached, no step is
fine enough."""
LATE = 3.0  # Times of the study's own design up to which others are followed there
MORE, WIDTH = 8, 0.05
"""Designs that steps are tried on, beside one for each moving input, and how far from the one they are about."""


@dataclass(frozen=True)
class Pace:
    """The study's own design on its way through the cycle; it scales the steps of all other designs."""

    times: Mapping[str, float]  # About how long each phase takes [s], by name
    balances: Mapping[str, Array]  # State and current that stay where a phase ended, by phase
    fits: Mapping[str, Fit] = field(default_factory=dict)
    """How finely each phase is stepped, where that is known (`CycleKernel.fitted`)."""


class CycleKernel:
    """The supplied rows of many designs of one model, as functions of some of its inputs."""

    def __init__(
        self, model: DeviceFunctions, moving: Sequence[str], wanted: Collection[str], steps: Steps = STEPS
    ) -> None:
        """Take what the wanted supplied rows need; all inputs but the `moving` are constants."""
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
                steps,
            )
            for name, phase in model.phases.items()
            if any(row.phase == name for row in rows.values()) or phase.phase.ends in ending
        }  # fmt: skip

    def _must_end(self, name: str, rows: Collection[Event | Path | Steady]) -> bool:
        """Return whether the end of a phase is needed, by its own paths and steady rows or by a later phase."""
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
        results = np.empty((len(self.names), count))
        starts = range(0, count, BLOCK)

        def fill(start: int) -> None:
            deadline.check("all modules were drawn")
            values = self._block(np.ascontiguousarray(columns[:, start : start + BLOCK]), pace, only)
            for i, name in enumerate(self.names):
                results[i, start : start + BLOCK] = values[name]

        with ThreadPoolExecutor(workers) as pool:
            for _ in pool.map(fill, starts):
                pass
        return results

    def fitted(self, pace: Pace, column: Array) -> Pace:
        """Choose the steps of each phase for designs about one, as coarse as is exact enough for all values."""
        tried = LANES * math.ceil((len(column) + MORE) / LANES)
        drawn = np.random.default_rng(0).uniform(-WIDTH, WIDTH, (len(column), tried))
        drawn[:, 0] = 0.0
        columns, ends, fits = column[:, None] * (1.0 + drawn), dict[str, Array](), dict[str, Fit]()
        for name, phase in self.phases.items():
            before = ends[phase.after] if phase.after else None
            usual, balance = pace.times[name], pace.balances.get(name)
            whole = Fit(FINE, column, np.zeros(len(column)), {})
            exact = phase.run(columns, before, usual, balance, whole, until=LATE * usual)
            ends[name] = exact.end
            times = {event: exact.values[event] / usual for event in phase.events}
            shares = {event: float(share[0]) for event, share in times.items() if 0.0 < share[0] < np.inf}
            longest = times[max(shares, key=shares.__getitem__)] if shares else np.ones(tried)
            known = np.isfinite(longest)
            slopes = np.linalg.lstsq(drawn[:, known].T, longest[known] / longest[0] - 1.0)[0]
            some = _of(columns, known), None if before is None else _of(before, known), usual, balance
            values = {row: values_of_row[known] for row, values_of_row in exact.values.items()}
            for steps in COARSE:
                fits[name] = Fit(steps, column, slopes, shares)
                if _apart(phase.run(*some, fits[name], until=LATE * usual).values, values) < CLOSE:
                    break
        return replace(pace, fits=fits)

    def course(self, column: Array, pace: Pace) -> tuple[dict[str, float], dict[str, Course]]:
        """Values of `names` for one design, and its states step by step through each phase to what ends it."""
        courses: dict[str, Course] = {name: [] for name in self.phases}
        values = self._block(np.ascontiguousarray(column[:, None]), pace, None, courses)
        return {name: float(samples[0]) for name, samples in values.items()}, courses

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
            passed[name] = phase.run(
                columns, before, pace.times[name], pace.balances.get(name), pace.fits.get(name), course
            )
            ended = ~np.isnan(before[0]) if before is not None else np.ones(columns.shape[1], dtype=bool)
            values |= {row: np.where(ended, reached, np.inf) for row, reached in passed[name].values.items()}
        return {name: values[name] for name in self.names}


def _of(rows: Array, designs: NDArray[np.bool_]) -> Array:
    """Return the columns of some designs, in the layout that the engine is compiled for."""
    return np.ascontiguousarray(rows[:, designs])


def _apart(values: Mapping[str, Array], exact: Mapping[str, Array]) -> float:
    """Return the difference, as a share, that most designs' values keep within where both are finite."""
    with np.errstate(all="ignore"):
        apart = np.array([np.abs(values[name] / exact[name] - 1.0) for name in exact])
    worst = np.where(np.isfinite(apart), apart, 0.0).max(axis=0, initial=0.0)
    return float(np.quantile(worst, MOST)) if worst.size else 0.0
