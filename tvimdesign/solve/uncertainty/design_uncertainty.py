"""How sure one design is: the yield under its tolerances, and what each assumed input moves, by one compiled kernel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.record import Record
from tvimdesign.device import Table
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule
from tvimdesign.solve.batch.batch_model import BatchModel
from tvimdesign.solve.nlp import spread
from tvimdesign.solve.nlp.constraints import constraints_of
from tvimdesign.solve.sensitivity.output_sensitivity import behind_profiles
from tvimdesign.solve.uncertainty.contributors import contributors_of

Array = NDArray[np.float64]


@dataclass(frozen=True)
class AssumedInput:
    """An input whose value a chosen record assumes, with its plausible range; SI."""

    name: str
    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Swing:
    """What an output is with one assumed input at the low and at the high end of its range, all else as drawn; SI."""

    assumed: AssumedInput
    at_low: float
    at_high: float

    @property
    def size(self) -> float:
        """Largest change between the ends; infinite where the output never happens at one of them."""
        change = abs(self.at_high - self.at_low)
        return change if np.isfinite(change) else np.inf


@dataclass(frozen=True)
class DesignUncertainty:
    """What spreads and what is assumed come to at one design."""

    together: spread.Yield | None
    """Modules that keep every limit; None where no limit depends on what spreads."""
    limits: int
    """How many limits that is said of."""
    left_out: tuple[str, ...]
    """Limits on outputs that never happen, or depend on a current that follows a profile."""
    swings: dict[str, tuple[Swing, ...]]
    """By output: what each assumed input moves, the largest first."""


def assumed_inputs(resolved: ResolvedModule) -> list[AssumedInput]:
    """The inputs that still have a value which a chosen record assumes and gives a range."""
    found = []
    for row in resolved.table.inputs:
        record = resolved.values[row.record[0]] if row.record else None
        entry = record.entries.get(row.record[1]) if row.record and isinstance(record, Record) else None
        if entry is None or entry.status != "assumed" or entry.low is None or entry.high is None:
            continue
        if resolved.values[row.name] == entry.value:
            found.append(AssumedInput(row.name, entry.value, entry.low, entry.high))
    return found


class UncertaintyModel:
    """Limits and asked outputs of a module as compiled functions of what spreads, is assumed, or is free."""

    def __init__(self, resolved: ResolvedModule, asked: Sequence[str], free: Sequence[str] = ()) -> None:
        """Compile. `free` are the inputs in which the designs that it is asked of may differ."""
        self.asked = tuple(asked)
        self._resolved = resolved
        study, table = resolved.study, resolved.table
        spreading = {name.partition("@")[0] for name in study.tolerances}
        limits = constraints_of(study, table, resolved.values)
        self.limits = [limit for limit in limits if _behind(table, limit.output, spreading)]
        driven = {*study.profile.pieces(), *resolved.current_profiles}
        lost = behind_profiles(table, driven)
        every = dict.fromkeys([*(limit.output for limit in self.limits), *asked])
        self.outputs = [name for name in every if not _behind(table, name, lost)]
        assumed = [one.name for one in assumed_inputs(resolved)]
        assumed = [name for name in assumed if any(_behind(table, output, {name}) for output in self.outputs)]
        moving = dict.fromkeys([*study.tolerances, *free, *assumed])
        self.names = [name for name in moving if isinstance(resolved.values.get(name), int | float)]
        self._model = BatchModel(resolved, self.names, self.outputs) if self.outputs and self.names else None

    def fits(self, resolved: ResolvedModule) -> bool:
        """Whether a module differs from the compiled one in nothing but what may."""
        before, now = self._resolved.values, resolved.values
        same = self._resolved.study.tolerances == resolved.study.tolerances and before.keys() == now.keys()
        return same and all(before[name] == now[name] for name in before if name not in self.names)

    def at(self, resolved: ResolvedModule, modules: int, workers: int = 1) -> DesignUncertainty:
        """Draw `modules` (a power of two) of a design by the study's tolerances, and move what is assumed."""
        if self._model is None:
            return DesignUncertainty(None, 0, tuple(limit.name for limit in self.limits), {})
        nominal = np.array([float(resolved.values[name]) for name in self.names])
        inputs = np.array([float(value) for value in resolved.values.values() if isinstance(value, int | float)])
        model, pace = self._model, self._model.pace_at(inputs)

        def outputs(columns: Array, places: Sequence[str]) -> Array:
            every = np.repeat(nominal[:, None], columns.shape[1], axis=1)
            every[[self.names.index(name) for name in places]] = columns
            return model(every, workers, pace)

        happens = dict(zip(self.outputs, np.isfinite(outputs(nominal[:, None], self.names)[:, 0]), strict=True))
        counted = [limit for limit in self.limits if happens.get(limit.output, False)]
        together, contributors = None, contributors_of(resolved)
        if counted and contributors:
            spreading = [contributor.name for contributor in contributors]
            seed = resolved.study.solver.seed
            drawn = spread.monte_carlo(lambda columns: outputs(columns, spreading), contributors, modules, seed).values
            with np.errstate(invalid="ignore"):
                kept = [limit.residual(drawn[self.outputs.index(limit.output)]) <= 0.0 for limit in counted]
            together = spread.share_kept(np.all(kept, axis=0))
        assumed = [one for one in assumed_inputs(resolved) if one.name in self.names]
        ends = outputs(_at_ends(assumed, nominal, self.names), self.names) if assumed else np.empty((0, 0))
        swings = {name: _swings(assumed, values) for name, values in zip(self.outputs, ends, strict=False)}
        left_out = tuple(limit.name for limit in self.limits if limit not in counted)
        asked = {name: swings[name] for name in self.asked if name in swings}
        return DesignUncertainty(together, len(counted), left_out, asked)


def _behind(table: Table, output: str, names: set[str]) -> bool:
    """Whether an output is, or depends on, one of some quantities."""
    return bool(names & {output.partition("@")[0], *table.ancestors(output)})


def _at_ends(assumed: Sequence[AssumedInput], nominal: Array, names: Sequence[str]) -> Array:
    """Columns of all moving inputs: each assumed one at its low and at its high end, all else as drawn."""
    columns = np.repeat(nominal[:, None], 2 * len(assumed), axis=1)
    for i, one in enumerate(assumed):
        columns[names.index(one.name), 2 * i : 2 * i + 2] = one.low, one.high
    return columns


def _swings(assumed: Sequence[AssumedInput], values: Array) -> tuple[Swing, ...]:
    """What each assumed input moves of one output, the largest first; nothing where it moves nothing."""
    swings = [Swing(one, float(values[2 * i]), float(values[2 * i + 1])) for i, one in enumerate(assumed)]
    return tuple(sorted((swing for swing in swings if swing.at_low != swing.at_high), key=lambda swing: -swing.size))
