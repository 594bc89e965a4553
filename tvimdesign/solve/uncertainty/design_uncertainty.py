"""Uncertainty of one design by many modules: part-to-part variation and, separately, unmeasured inputs."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.child_process import own_processors
from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.device import Table
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule, resolve_design, resolve_study
from tvimdesign.solve.batch.batch_model import BatchModel
from tvimdesign.solve.batch.cycle_kernel import Pace
from tvimdesign.solve.nlp import spread
from tvimdesign.solve.nlp.constraints import ALGEBRAIC_TOLERANCE, Constraint, constraints_of
from tvimdesign.solve.uncertainty.output_sensitivity import behind_profiles
from tvimdesign.solve.uncertainty.uncertain_inputs import (
    Interval,
    UnmeasuredInput,
    before_measuring,
    contributors_of,
    covered,
    draw,
    intervals,
    judges_modules,
    unmeasured_inputs,
)
from tvimdesign.study import Design, Study, standard_tolerances

Array = NDArray[np.float64]
Rows = Callable[..., Array]

DRAWS = 1 << 9  # Modules drawn from the ranges of unmeasured inputs
_DOUBTFUL = 0.75  # Share of these modules that satisfy a limit below which it is in doubt


def share_in_doubt(plausible: float | None) -> float:
    """Return the share of modules below which a limit is in doubt: the usual one, or a larger one that is asked."""
    return max(_DOUBTFUL, plausible or 0.0)


class Need(NamedTuple):
    """Values of an unmeasured input with which alone a limit is met: those on one side of an end."""

    input: str
    sense: str
    end: float  # SI


@dataclass(frozen=True)
class DesignUncertainty:
    """Spread and, separately, effect of unmeasured inputs at one design."""

    together: spread.Yield | None
    """Yield of modules with parts within their tolerances and all else as assumed; None if no limit depends
    on what spreads."""
    limits: int  # Number of limits that the yield covers
    left_out: tuple[str, ...]  # Limits on outputs that never happen, or depend on a current that follows a profile
    intervals: dict[str, Interval]
    """Of each asked output, and of the limits in doubt, the worst at least: its range, parts as drawn and unmeasured
    inputs anywhere in their ranges."""
    holds: spread.Yield | None = None
    """Share of those ranges in which every limit is met, parts as drawn; None where no limit depends on them."""
    held: dict[str, float] = field(default_factory=dict)
    """That share for each limit that is not kept all over the ranges, the least first."""
    unmeasured: tuple[UnmeasuredInput, ...] = ()  # The inputs that were moved
    before: dict[str, tuple[float, float]] = field(default_factory=dict)
    """By asked output: between what it would lie had nothing been measured that a user's records have; empty where
    they have nothing."""
    need: Need | None = None  # What the main unmeasured input must be for the limit most in doubt


class UncertaintyModel:
    """Limits and asked outputs of a module as functions of what spreads, is unmeasured, or is free."""

    def __init__(self, resolved: ResolvedModule, requested: Sequence[str], free: Sequence[str] = ()) -> None:
        """Record. `free` are the inputs in which the designs that it is asked of may differ."""
        self._resolved, study, table = resolved, resolved.study, resolved.table
        lost = behind_profiles(table, {*study.profile.pieces(), *resolved.current_profiles})
        self.requested = tuple(name for name in dict.fromkeys(requested) if not _behind(table, name, lost))
        unmeasured = [quantity.name for quantity in unmeasured_inputs(resolved)]
        self._free = set(free)
        self._spreading = {name.partition("@")[0] for name in study.tolerances}
        moved = self._spreading | set(unmeasured)
        every = constraints_of(study, table, resolved.values)
        self.limits = [
            limit for limit in every if _behind(table, limit.output, moved) and judges_modules(limit, self._spreading)
        ]
        limited = [limit.output for limit in self.limits if not _behind(table, limit.output, lost)]
        self.outputs = list(dict.fromkeys([*limited, *self.requested]))
        counting = [name for name in unmeasured if any(_behind(table, output, {name}) for output in self.outputs)]
        moving = dict.fromkeys([*study.tolerances, *free, *counting])
        self.names = [name for name in moving if isinstance(resolved.values.get(name), int | float)]
        self._early = _phases_of(table, limited)
        drawn = bool(self.outputs and self.names)
        self._model = BatchModel(resolved.functions, self.names, self.outputs) if drawn else None
        self._pace: Pace | None = None
        """The pace of the last design whose modules were drawn, with its steps."""

    def fits(self, resolved: ResolvedModule) -> bool:
        """Return whether a module differs from the recorded one only in inputs that may change."""
        before, now = self._resolved.values, resolved.values
        same = self._resolved.study.tolerances == resolved.study.tolerances and before.keys() == now.keys()
        return same and all(before[name] == now[name] for name in before if name not in self.names)

    def at(
        self, resolved: ResolvedModule, modules: int, draws: int = DRAWS, deadline: Deadline = NEVER
    ) -> DesignUncertainty:
        """Draw `modules` (a power of two) of a design by the study's tolerances, `draws` from the ranges.

        Without `modules` there is no yield. Raises TimeOverError at the deadline.
        """
        if self._model is None:
            return DesignUncertainty(None, 0, tuple(limit.name for limit in self.limits), {})
        inputs = np.array([float(value) for value in resolved.values.values() if isinstance(value, int | float)])
        pace = self._model.pace_at(inputs)
        # Steps that are fitted to modules are too coarse for what lies far off over the ranges of assumed values.
        rows = partial(self._rows, resolved, pace, deadline)
        as_drawn = dict(zip(self.outputs, rows(np.zeros((0, 1)), ())[:, 0], strict=True))
        counted = [limit for limit in self.limits if np.isfinite(as_drawn.get(limit.output, np.nan))]
        spreading = [limit for limit in counted if _behind(resolved.table, limit.output, self._spreading)]
        names = {limit.name for limit in counted}
        left_out = tuple(limit.name for limit in self.limits if limit.name not in names)
        result = self._of_ranges(resolved, counted, draws, rows)
        parts = None
        if modules:
            self._pace = self._model.fitted(pace, inputs, beside=self._pace)
            parts = self._yield(resolved, spreading, modules, partial(self._rows, resolved, self._pace, deadline))
        return DesignUncertainty(parts, len(spreading), left_out, *result, self._before(resolved, draws, rows))

    def margins(self, resolved: ResolvedModule, share: float) -> dict[str, float]:
        """Return by limit the margin [share of its scale] that a share of the plausible cases needs, where it lacks.

        Limits that none of the free inputs moves are left out.
        """
        moved = [quantity for quantity in unmeasured_inputs(resolved) if quantity.name in self.names]
        if self._model is None or not moved:
            return {}
        inputs = np.array([float(value) for value in resolved.values.values() if isinstance(value, int | float)])
        rows, places = partial(self._rows, resolved, self._model.pace_at(inputs), NEVER), [each.name for each in moved]
        nominal, cases = rows(np.zeros((0, 1)), ()), rows(draw(moved, DRAWS, resolved.study.solver.seed), places)
        needed = {}
        for limit in self.limits:
            if limit.output not in self.outputs or not _behind(resolved.table, limit.output, self._free):
                continue
            at = self.outputs.index(limit.output)
            worst = float(np.quantile(np.nan_to_num(limit.residual(cases[at]), nan=np.inf), share))
            if ALGEBRAIC_TOLERANCE < worst < np.inf and np.isfinite(nominal[at, 0]):
                needed[limit.name] = worst - float(limit.residual(nominal[at, 0]))
        return needed

    def _rows(
        self, resolved: ResolvedModule, pace: Pace | None, deadline: Deadline, columns: Array, places: Sequence[str],
        only: Collection[str] | None = None,
    ) -> Array:  # fmt: skip
        """Rows for `outputs` of designs, all inputs but those in `places` as the design has them."""
        assert self._model is not None
        drawn = np.array([float(resolved.values[name]) for name in self.names])
        every = np.repeat(drawn[:, None], columns.shape[1], axis=1)
        every[[self.names.index(name) for name in places]] = columns
        return self._model(every, own_processors(), pace, only, deadline)

    def _yield(
        self, resolved: ResolvedModule, limits: Sequence[Constraint], modules: int, rows: Rows
    ) -> spread.Yield | None:
        """Modules that keep all of some limits, parts within their tolerances.

        Only the phases that limits ask for are gone through: what comes after the switch costs ten times as much.
        """
        contributors = contributors_of(resolved)
        if not limits or not contributors:
            return None
        places = [contributor.name for contributor in contributors]
        points = spread.sobol_points(len(contributors), modules, resolved.study.solver.seed)
        drawn = rows(spread.inputs_at(contributors, points.T), places, self._early)
        return spread.share_kept(np.all(_satisfied(limits, self.outputs, drawn), axis=0))

    def _before(self, resolved: ResolvedModule, draws: int, rows: Rows) -> dict[str, tuple[float, float]]:
        """Intervals of the asked outputs by the ranges that measured inputs had before."""
        moved = [quantity for quantity in unmeasured_inputs(resolved) if quantity.name in self.names]
        if all(quantity.before is None for quantity in moved):
            return {}
        drawn = draw(before_measuring(moved), draws, resolved.study.solver.seed)
        values = rows(drawn, [quantity.name for quantity in moved])
        return {name: covered(values[self.outputs.index(name)]) for name in self.requested}

    def _of_ranges(
        self, resolved: ResolvedModule, limits: Sequence[Constraint], draws: int, rows: Rows
    ) -> tuple[dict[str, Interval], spread.Yield | None, dict[str, float], tuple[UnmeasuredInput, ...]]:
        """Intervals of the asked outputs, and where in the ranges the limits are met."""
        moved = tuple(quantity for quantity in unmeasured_inputs(resolved) if quantity.name in self.names)
        if not moved:
            return {}, None, {}, ()
        places = [quantity.name for quantity in moved]

        def every(columns: Array) -> Array:
            return rows(columns, places)

        drawn = draw(moved, draws, resolved.study.solver.seed)
        values = every(drawn)
        ranges = intervals(every, moved, drawn, values, float(resolved.values["horizon"]))
        by_name = dict(zip(self.outputs, ranges, strict=True))
        requested = {name: by_name[name] for name in self.requested}
        hanging = [limit for limit in limits if _behind(resolved.table, limit.output, set(places))]
        if not hanging:
            return requested, None, {}, moved
        satisfied = _satisfied(hanging, self.outputs, values)
        shares = {limit.name: float(np.mean(row)) for limit, row in zip(hanging, satisfied, strict=True)}
        broken = sorted((item for item in shares.items() if item[1] < 1.0), key=lambda item: item[1])
        least = share_in_doubt(resolved.study.robust.plausible if resolved.study.robust else None)
        doubtful = [name for name, share in broken if share < least or name == broken[0][0]]
        in_doubt = {limit.output for limit in hanging if limit.name in doubtful}
        requested.update({name: by_name[name] for name in in_doubt})
        return requested, spread.share_kept(np.all(satisfied, axis=0)), dict(broken), moved


def uncertainty_at(
    design: Design, study: Study, shown: Sequence[str], modules: int, deadline: Deadline = NEVER
) -> DesignUncertainty:
    """Return the uncertainty of a design that answers a study, by its tolerances, else the standard ones.

    Intervals are those of what the study requires and minimises, and of what is `shown`. `modules` is a power of two;
    without modules there is no yield. Raises TimeOverError at the deadline.
    """

    def tolerant(resolved: ResolvedModule) -> ResolvedModule:
        tolerances = resolved.study.tolerances if study.tolerances else standard_tolerances(study.table)
        return replace(resolved, study=resolved.study.model_copy(update={"tolerances": tolerances}))

    required = [name for limit in study.require for name in (limit.output, *study.limited_with(limit.output))]
    requested = list(dict.fromkeys([*required, *study.minimize, *shown]))
    model = UncertaintyModel(tolerant(resolve_study(study)), requested, list(study.vary))
    resolved = tolerant(resolve_design(design))
    if not model.fits(resolved):  # another record was chosen
        model = UncertaintyModel(resolved, requested)
    uncertainty = model.at(resolved, modules, DRAWS, deadline=deadline)
    return replace(uncertainty, need=_need(model.limits, uncertainty))


def _need(limits: Sequence[Constraint], uncertainty: DesignUncertainty) -> Need | None:
    """Return the values of the main unmeasured input that the limit most in doubt is met with, alone, if there are any.

    Linear between the ends of its range and the value as drawn.
    """
    limit = next((limit for limit in limits if limit.name in list(uncertainty.held)[:1]), None)
    interval = uncertainty.intervals.get(limit.output) if limit else None
    swing = next((swing for swing in interval.swings if swing.moved.name == interval.first), None) if interval else None
    if limit is None or interval is None or swing is None:
        return None
    at = np.array([swing.moved.low, swing.moved.value, swing.moved.high])
    residuals = limit.residual(np.array([swing.at_low, interval.nominal, swing.at_high])) - ALGEBRAIC_TOLERANCE
    rising = residuals[0] < residuals[2]
    if not np.all(np.isfinite(residuals)) or np.min(residuals) > 0.0 or np.max(residuals) <= 0.0:
        return None
    order = slice(None) if rising else slice(None, None, -1)
    return Need(swing.moved.name, "<=" if rising else ">=", float(np.interp(0.0, residuals[order], at[order])))


def _satisfied(limits: Sequence[Constraint], outputs: Sequence[str], values: Array) -> NDArray[np.bool_]:
    """Return whether each module (column) satisfies each limit (row)."""
    with np.errstate(invalid="ignore"):
        return np.array([limit.keeps(values[outputs.index(limit.output)]) for limit in limits])


def _behind(table: Table, output: str, names: set[str]) -> bool:
    """Return whether an output is, or depends on, one of some quantities."""
    return bool(names & {output.partition("@")[0], *table.ancestors(output)})


def _phases_of(table: Table, outputs: Sequence[str]) -> set[str]:
    """Return the phases of the cycle that some outputs need, and those before them."""
    needed = {row.phase for row in table.supplied if any(_behind(table, output, {row.name}) for output in outputs)}
    before = {phase.after for phase in table.phases if phase.name in needed and phase.after}
    while not before <= needed:
        needed |= before
        before = {phase.after for phase in table.phases if phase.name in needed and phase.after}
    return needed
