"""Yield of a study's limits at any of its designs, from scrambled Sobol points, and its account."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Self
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.child_process import own_processors
from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.solve.batch.batch_model import BatchModel
from tvimdesign.solve.batch.cycle_kernel import Pace
from tvimdesign.solve.nlp import spread
from tvimdesign.solve.nlp.constraints import ALGEBRAIC_TOLERANCE, Constraint, constraints_of, in_words, on_cycle
from tvimdesign.solve.nlp.solution import LostTo, TightenedTolerance, YieldReached
from tvimdesign.solve.nlp.solver_run import Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.uncertainty.output_sensitivity import OutputDerivatives
from tvimdesign.solve.uncertainty.uncertain_inputs import contributors_of, judges_modules

Array = NDArray[np.float64]

MODULES, FEW_MODULES = 1 << 12, 1 << 10
"""Modules drawn for one design, and how many of them tell a design that is far from a yield."""


@dataclass(frozen=True)
class Drawn:
    """The limits of one design in many modules: residuals, a row a limit, a column a module.

    A limit is met where its residual is at most the solver's tolerance: an active one that nothing spreads has that.
    """

    limits: tuple[Constraint, ...]
    residuals: Array
    inputs: tuple[str, ...] = ()  # Drawn inputs
    columns: Array = field(default_factory=lambda: np.zeros((0, MODULES)))
    """Its values [SI], a row an input, a column a module."""

    @property
    def shares(self) -> dict[str, float]:
        """Share of the modules that satisfies each limit, by its name."""
        satisfied = self.residuals <= ALGEBRAIC_TOLERANCE
        return {limit.name: float(np.mean(row)) for limit, row in zip(self.limits, satisfied, strict=True)}

    @property
    def together(self) -> spread.Yield:
        """Yield of all limits together."""
        return self.within(np.zeros(len(self.limits)))

    def with_more(self, more: "Drawn") -> Self:
        """Add further modules of the same design."""
        residuals = np.hstack([self.residuals, more.residuals])
        return replace(self, residuals=residuals, columns=np.hstack([self.columns, more.columns]))

    def within(self, shifts: Array) -> spread.Yield:
        """Return the yield if each limit's residuals fell by a shift."""
        return spread.share_kept(np.all(self.residuals <= shifts[:, None] + ALGEBRAIC_TOLERANCE, axis=0))

    def carriers(self, limit: str) -> dict[str, float]:
        """Inputs by their share of the variance of a limit's residual (squared rank correlation), the largest first."""
        row = self.residuals[[known_limit.name for known_limit in self.limits].index(limit)]
        ranks = _ranks(np.nan_to_num(row, nan=np.inf))
        if np.ptp(ranks) == 0.0:
            return {}
        correlations = {
            name: float(np.corrcoef(_ranks(column), ranks)[0, 1] ** 2)
            for name, column in zip(self.inputs, self.columns, strict=True)
        }
        return dict(sorted(correlations.items(), key=lambda item: -item[1]))


def _ranks(values: Array) -> Array:
    """Return the places of values in their order; equal ones share theirs."""
    places: Array = np.unique(values, return_inverse=True)[1].astype(float)
    return places


class Yields:
    """Limits that what spreads can move, as functions of that and of what the study frees."""

    def __init__(self, optimizer: Optimizer) -> None:
        """Record the limits. A current that follows a profile is not a number: those on its phases are left out."""
        study, table = optimizer.study, optimizer.table
        self._study, self._model = study, optimizer.model
        spreading = [name for name in study.tolerances if name in optimizer.model.index]
        self._moving = list(dict.fromkeys([*spreading, *(free.name for free in optimizer.free)]))
        bases = {name.partition("@")[0] for name in spreading}
        self.limits = tuple(
            limit for limit in constraints_of(study, table, optimizer.model.words)
            if bases & {limit.output.partition("@")[0], *table.ancestors(limit.output)}
            and judges_modules(limit, bases)
            and not (optimizer.currents and on_cycle(table, limit.output))
        )  # fmt: skip
        self._outputs = list(dict.fromkeys(limit.output for limit in self.limits))
        start = dict(zip(optimizer.model.names, optimizer.model.start, strict=True))
        self._drawn: dict[tuple[bytes, int | None], Drawn] = {}
        self._first_orders: dict[bytes, Array] = {}
        self._pace: Pace | None = None
        self._paced = b""
        """The pace of the last design whose modules were drawn, and its inputs."""
        functions = self._rig(start).functions if optimizer.mixtures else optimizer.model
        self._many = BatchModel(functions, self._moving, self._outputs) if self._outputs else None

    def _rig(self, values: Mapping[str, Any]) -> ResolvedModule:
        numbers = {name: float(values[name]) for name in self._model.names}
        return ResolvedModule(self._study, {**numbers, **self._model.words})

    def at(self, inputs: Array, seed: int | None = None, deadline: Deadline = NEVER, count: int = MODULES) -> Drawn:
        """Draw modules of the design with these inputs, `count` or more, from the study's seed unless another is given.

        Drawn inputs before is not drawn again. Raises TimeOverError at the deadline.
        """
        key = (inputs.tobytes(), seed)
        before = self._drawn.get(key)
        first = 0 if before is None else before.residuals.shape[1]
        if first < count:
            more = self._draw(inputs, seed, deadline, range(first, count))
            self._drawn[key] = more if before is None else before.with_more(more)
        return self._drawn[key]

    def compared(self, inputs: Array, share: float, deadline: Deadline) -> Drawn:
        """Draw modules until they tell whether a design reaches a share, few or all. Raises TimeOverError."""
        few = self.at(inputs, deadline=deadline, count=FEW_MODULES)
        return few if few.together.high < share else self.at(inputs, deadline=deadline)

    def beside(self, inputs: Array, other: Array, drawn: Drawn) -> Drawn:
        """Predict what modules of a design come to from those that were `drawn` of `other` inputs.

        The same modules are moved by the difference of both designs' first order, so that what is not linear stays as
        drawn; what never happened in them follows from the first order alone. Raises SimulationError.
        """
        if not drawn.limits:
            return drawn
        count = drawn.residuals.shape[1]
        linear = self._linear(inputs)[:, :count]
        moved = drawn.residuals + np.nan_to_num(linear - self._linear(other)[:, :count])
        return replace(drawn, residuals=np.where(np.isfinite(drawn.residuals), moved, linear))

    def _linear(self, inputs: Array) -> Array:
        """Return the limits' residuals in the modules of a design, to first order."""
        key = inputs.tobytes()
        if key not in self._first_orders:
            model, contributors = self._model, self.contributors(inputs)
            names = [contributor.name for contributor in contributors]
            values, slopes, _ = self._derivatives.at(inputs, names)
            points = spread.sobol_points(len(names), MODULES, self._study.solver.seed)
            off = spread.inputs_at(contributors, points.T) - inputs[[model.index[name] for name in names]][:, None]
            every = values[:, None] + slopes @ off
            residuals = [limit.residual(every[self._outputs.index(limit.output)]) for limit in self.limits]
            self._first_orders[key] = np.array(residuals)
        return self._first_orders[key]

    @cached_property
    def _derivatives(self) -> OutputDerivatives:
        return OutputDerivatives(self._model, self._outputs)

    def contributors(self, inputs: Array) -> list[spread.Contributor]:
        """Return the tolerances at the design with these inputs."""
        return contributors_of(self._rig(dict(zip(self._model.names, inputs, strict=True))))

    def _draw(self, inputs: Array, seed: int | None, deadline: Deadline, which: range) -> Drawn:
        model, contributors = self._model, self.contributors(inputs)
        if self._many is None or not contributors:  # nothing moves any limit
            return Drawn((), np.zeros((0, len(which))))
        places = [self._moving.index(contributor.name) for contributor in contributors]
        drawn = np.array([inputs[model.index[name]] for name in self._moving])
        if self._paced != inputs.tobytes():
            self._pace = self._many.fitted(self._many.pace_at(inputs), inputs, beside=self._pace)
            self._paced = inputs.tobytes()
        seed = self._study.solver.seed if seed is None else seed
        points = spread.sobol_points(len(contributors), MODULES, seed)[which.start : which.stop]
        columns = spread.inputs_at(contributors, points.T)
        every = np.repeat(drawn[:, None], columns.shape[1], axis=1)
        every[places] = columns
        values = self._many(every, own_processors(), self._pace, deadline=deadline)
        with np.errstate(invalid="ignore"):
            residuals = [limit.residual(values[self._outputs.index(limit.output)]) for limit in self.limits]
        names = tuple(contributor.name for contributor in contributors)
        return Drawn(self.limits, np.array(residuals), names, columns)


def yields_of(optimizer: Optimizer) -> Yields:
    """Return the yield of the limits at any design of a problem.
    It is recorded at the first request and lives as long as the problem.
    """
    if optimizer not in _RECORDED:
        optimizer.progress("preparing the equations for random deviations")
        _RECORDED[optimizer] = Yields(optimizer)
    return _RECORDED[optimizer]


_RECORDED: WeakKeyDictionary[Optimizer, Yields] = WeakKeyDictionary()


_NAMED = 3


def account_of_yield(optimizer: Optimizer, run: Run, nominal: Run, share: float) -> YieldReached:
    """Draw modules apart from those the design was found by, and simulate the `nominal` optimum without margins.

    Raises TimeOverError where the time is over first.
    """
    deadline = optimizer.deadline.late
    yields, seed = yields_of(optimizer), optimizer.study.solver.seed
    drawn = yields.at(run.inputs, seed + 1, deadline)
    without = yields.at(nominal.inputs, deadline=deadline, count=FEW_MODULES).together.share
    table, points = optimizer.table, tuple(optimizer.study.operating_points)
    cycle = optimizer.simulator.run(nominal.inputs, nominal.current_profiles)
    values = optimizer.model.values(nominal.inputs, cycle.values)
    names = [name for name in table.names(points) if table.output(name).headline]
    return YieldReached(
        target=share, modules=drawn.residuals.shape[1], shares=drawn.shares, together=drawn.together.share,
        lost_to=tuple(_lost(drawn, optimizer)), nominal_together=without,
        nominal={name: float(values[name]) for name in dict.fromkeys([*optimizer.study.minimize, *names])},
        tightened=tightened(drawn, yields.contributors(run.inputs), share), eased=optimizer.eased,
    )  # fmt: skip


_HALVINGS = 10


def tightened(drawn: Drawn, contributors: Sequence[spread.Contributor], share: float) -> TightenedTolerance | None:
    """Return the tolerance that needs least tightening for a yield; None where that is reached.

    The modules that were drawn are moved by the limits' slopes, which are fitted to them.
    """
    if drawn.together.share >= share or not contributors:
        return None
    off = drawn.columns - np.array([contributor.nominal for contributor in contributors])[:, None]
    centred = off - np.mean(off, axis=1, keepdims=True)
    residuals = np.where(np.isfinite(drawn.residuals), drawn.residuals, np.nan)
    around = np.nan_to_num(residuals - np.nanmean(residuals, axis=1, keepdims=True))
    slopes = around @ centred.T / np.sum(centred**2, axis=1)

    def yield_with(i: int, factor: float) -> float:
        moved = drawn.residuals + (factor - 1.0) * slopes[:, i, None] * off[i]
        return spread.share_kept(np.all(moved <= ALGEBRAIC_TOLERANCE, axis=0)).share

    def least(i: int) -> float:
        low, high = 0.0, 1.0
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if yield_with(i, middle) >= share else (low, middle)
        return low

    without = {i: yield_with(i, 0.0) for i in range(len(contributors))}
    factors = {i: least(i) for i in without if without[i] >= share}
    best = max(factors or without, key=lambda i: (factors or without)[i])
    size, factor = contributors[best].plus_minus, factors.get(best, 0.0)
    return TightenedTolerance(contributors[best].name, size, factor * size, yield_with(best, factor))


def _lost(drawn: Drawn, optimizer: Optimizer) -> list[LostTo]:
    """Return the limits that most modules violate, the worst first, with the strongest contributors to their spread."""
    worst = sorted(drawn.limits, key=lambda limit: drawn.shares[limit.name])[:_NAMED]
    return [
        LostTo(in_words(limit, optimizer.table), drawn.shares[limit.name], _first(drawn.carriers(limit.name)))
        for limit in worst if drawn.shares[limit.name] < 1.0
    ]  # fmt: skip


def _first(carriers: dict[str, float]) -> dict[str, float]:
    return dict(list(carriers.items())[:_NAMED])
