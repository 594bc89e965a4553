"""A module whose parts and materials spread: the effect on its outputs, and the yield."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.solve.batch.batch_model import BatchModel
from tvimdesign.solve.nlp import spread
from tvimdesign.solve.nlp.constraints import Constraint, constraints_of, in_words
from tvimdesign.solve.uncertainty.output_sensitivity import output_sensitivities
from tvimdesign.solve.uncertainty.uncertain_inputs import FREE_ANGLE, contributors_of, judges_modules
from tvimdesign.study import Study

Array = NDArray[np.float64]
Progress = Callable[[str], None]

GOOD = 0.9973  # Yield from which a limit is no concern: three standard deviations to either side
_NO_SPREAD = 1e-9  # Standard deviation over the value below which an output does not spread
SOBOL_SAMPLES = 1 << 10  # Points of the Sobol indices; each costs as many modules as there are contributors, and two


@dataclass(frozen=True)
class LimitYield:
    """A limit and the yield of modules that satisfy it."""

    limit: Constraint
    text: str  # The limit in words
    share: spread.Yield
    capability: float  # C_pk of this side


@dataclass(frozen=True)
class Spread:
    """Spread of outputs from that of the inputs; arrays have one output a row, one contributor a column."""

    contributors: tuple[spread.Contributor, ...]
    outputs: tuple[str, ...]
    requested: tuple[str, ...]  # Those the study minimises or requires, or that a summary shows
    nominal: Array
    derivatives: Array  # Exact, SI over SI
    deviation: Array  # By root-sum-square
    shares: Array  # Of each contributor in that variance
    worst: spread.WorstCase
    drawn: spread.MonteCarlo
    first: Array  # First-order Sobol indices
    total: Array
    limit_yields: tuple[LimitYield, ...]
    together: spread.Yield  # Yield of all limits together
    left_out: tuple[str, ...]
    """Outputs nothing can be said about: they never happen as drawn, or hang on a current that follows a profile."""
    study: Study

    def spreads(self, i: int) -> bool:
        """Return whether an output spreads at all."""
        moves = self.deviation[i] > _NO_SPREAD * abs(self.nominal[i])
        return bool(moves) or bool(self.drawn.never[i] > 0.0)

    def share(self, limit_yield: LimitYield, contributor: int) -> float:
        """Return the share of the variance behind a limit that a contributor carries."""
        return float(self.shares[self.outputs.index(limit_yield.limit.output), contributor])

    @property
    def of_concern(self) -> list[LimitYield]:
        """Limits that too many modules violate, the worst first."""
        concern = [limit_yield for limit_yield in self.limit_yields if limit_yield.share.share < GOOD]
        return sorted(concern, key=lambda limit_yield: limit_yield.share.share)

    @property
    def violated_at_worst(self) -> int:
        """Count of the limits that are violated in the worst case."""
        worst = {"<=": self.worst.high, ">=": self.worst.low}
        limits = [each.limit for each in self.limit_yields]
        ends = (worst[limit.sense][self.outputs.index(limit.output)] for limit in limits)
        return sum(not float(limit.residual(end)) <= 1e-9 for limit, end in zip(limits, ends, strict=True))


@dataclass(frozen=True)
class Preload:
    """Effect of the free angle's tolerance on the joint, with and without adjusting the preload."""

    as_bought: float  # Tolerance to either side [rad]
    adjusted: float  # Rest where it can be adjusted [rad]
    over_stroke: float
    yield_as_bought: spread.Yield  # Yield of the limits that change with the free angle
    yield_adjusted: spread.Yield
    by_row: str  # The output that gives the tolerance; empty where the study states it


@dataclass(frozen=True)
class Draw:
    """Modules that are drawn: what of them spreads, and what is looked at."""

    contributors: tuple[spread.Contributor, ...]
    outputs: tuple[str, ...]


Drawn = Callable[[Draw], Array]  # Outputs of drawn modules, a column each; who computes them decides where


def columns_of(
    resolved: ResolvedModule, names: Sequence[str], many: BatchModel, draw: Draw, workers: int
) -> spread.Columns:
    """Outputs as a function of a draw's contributors, all others of the `names` as drawn."""
    place = [names.index(contributor.name) for contributor in draw.contributors]
    drawn = np.array([float(resolved.values[name]) for name in names])

    def outputs(columns: Array) -> Array:
        every = np.repeat(drawn[:, None], columns.shape[1], axis=1)
        every[place] = columns
        return many(every, workers)

    return outputs


class Tolerancing:
    """One design with its study's tolerances: the functions of what spreads, recorded once."""

    def __init__(self, resolved: ResolvedModule, progress: Progress, workers: int = 1) -> None:
        """Differentiate and record. Raises InputError where nothing spreads, SimulationError."""
        self.resolved, self.progress, self.workers = resolved, progress, workers
        self.contributors = contributors_of(resolved)
        # A free angle that is adjusted out altogether still has a column: it is compared with one that is not.
        ever = {contributor.name for contributor in contributors_of(resolved, adjusted=False)}
        names = [name for name in resolved.study.tolerances if name in ever]
        if not names:
            raise InputError(
                f"{resolved.study.name}: nothing spreads; give `tolerances: standard`, or tolerances of your own"
            )
        self.limits = [
            limit
            for limit in constraints_of(resolved.study, resolved.table, resolved.values)
            if self._moves(limit.output, names) and judges_modules(limit, names)
        ]
        wanted = dict.fromkeys([*self._requested(), *(limit.output for limit in self.limits)])
        if not wanted:
            raise InputError(
                f"{resolved.study.name}: nothing that is required, minimised or limited depends on {', '.join(names)}; "
                "give tolerances of other inputs, or require what depends on these"
            )
        progress("computing sensitivities to the tolerances")
        exact = output_sensitivities(resolved, list(wanted), names)
        progress("preparing the equations for random deviations")
        self.names, self.outputs = names, exact.outputs
        self.exact, self.nominal, self.left_out = exact.derivatives, exact.values, exact.left_out
        self.requested = tuple(name for name in dict.fromkeys(self._requested()) if name in self.outputs)
        self.limits = [limit for limit in self.limits if limit.output in self.outputs]
        self.many = BatchModel(resolved.functions, names, self.outputs)
        self.horizon = float(resolved.values["horizon"])

    def _requested(self) -> list[str]:
        """Return the minimised and required outputs; without any, those that a summary shows up to the switch.

        What comes after the switch costs ten times as much, and is looked at where it is asked for.
        """
        study, table = self.resolved.study, self.resolved.table
        requested = [*study.minimize, *(limit.output for limit in self.limits if limit.origin == "require")]
        if study.minimize or study.require:
            return requested
        names = (name for name in table.names(self.resolved.points) if table.output(name).headline)
        later = {row.name for row in table.supplied if table.phase(row.phase).after}
        return [
            name for name in names
            if self._moves(name, list(study.tolerances)) and not later & {name, *table.ancestors(name)}
        ]  # fmt: skip

    def _moves(self, output: str, names: Sequence[str]) -> bool:
        """Return whether an output depends on anything that spreads."""
        above = {output.partition("@")[0], *self.resolved.table.ancestors(output)}
        return any(name.partition("@")[0] in above for name in names)

    @property
    def whole(self) -> Draw:
        """Modules in which all that spreads does."""
        return Draw(tuple(self.contributors), self.outputs)

    @property
    def on_preload(self) -> tuple[Draw, Draw] | None:
        """Modules with the free angle as bought, and adjusted; None where it has no tolerance, or nothing hangs on it.

        What is looked at is what is limited and changes with the free angle.
        """
        if self.resolved.study.tolerances.get(FREE_ANGLE) is None or FREE_ANGLE not in self.names:
            return None
        outputs = tuple(dict.fromkeys(limit.output for limit in self._limits_on_preload))
        bought, adjusted = (tuple(contributors_of(self.resolved, adjusted)) for adjusted in (False, True))
        return (Draw(bought, outputs), Draw(adjusted, outputs)) if outputs else None

    @property
    def _limits_on_preload(self) -> list[Constraint]:
        """Return the limits on outputs that change with the free angle."""
        changes = self.exact[:, self.names.index(FREE_ANGLE)]
        return [limit for limit in self.limits if changes[self.outputs.index(limit.output)] != 0.0]

    def _draws(self, samples: int, seed: int) -> Drawn:
        models = {self.outputs: self.many}

        def drawn(draw: Draw) -> Array:
            if draw.outputs not in models:
                models[draw.outputs] = BatchModel(self.resolved.functions, self.names, list(draw.outputs))
            columns = columns_of(self.resolved, self.names, models[draw.outputs], draw, self.workers)
            return spread.drawn_values(columns, draw.contributors, spread.power_of_two(samples), seed)

        return drawn

    def analyse(self, samples: int, seed: int) -> Spread:
        """Return worst case, root-sum-square and Monte Carlo, side by side."""
        contributors = self.contributors
        function = columns_of(self.resolved, self.names, self.many, self.whole, self.workers)
        place = [self.names.index(contributor.name) for contributor in contributors]
        derivatives = self.exact[:, place]
        deviation, shares = spread.shares(contributors, derivatives)
        self.progress("checking the extremes of the tolerances")
        worst = spread.worst_case(function, contributors, derivatives)
        self.progress(f"simulating {spread.power_of_two(samples)} modules with random deviations")
        results = spread.moments_of(self._draws(samples, seed)(self.whole))
        self.progress("finding which tolerance matters most")
        first, total = spread.sobol_indices(function, contributors, SOBOL_SAMPLES, seed, self.horizon)
        satisfied, together = self._satisfied(results)
        return Spread(
            tuple(contributors), self.outputs, self.requested, self.nominal, derivatives, deviation, shares, worst,
            results, first, total, satisfied, together, self.left_out, self.resolved.study,
        )  # fmt: skip

    def _satisfied(self, drawn: spread.MonteCarlo) -> tuple[tuple[LimitYield, ...], spread.Yield]:
        shares = []
        every = np.ones(drawn.values.shape[1], dtype=bool)
        for limit in self.limits:
            i = self.outputs.index(limit.output)
            with np.errstate(invalid="ignore"):
                keeps = np.asarray(limit.keeps(drawn.values[i]))
            every &= keeps
            able = spread.capability(float(drawn.mean[i]), float(drawn.deviation[i]), limit.limit, limit.sense)
            shares.append(LimitYield(limit, in_words(limit, self.resolved.table), spread.share_kept(keeps), able))
        return tuple(shares), spread.share_kept(every)

    def preload(self, samples: int, seed: int) -> Preload | None:
        """Return the free angle as bought and adjusted; None if it has no tolerance, or nothing depends on it."""
        draws = self.on_preload
        if draws is None:
            return None
        self.progress("adjusting the preload")
        values_of, limits, outputs = self._draws(samples, seed), self._limits_on_preload, draws[0].outputs
        sizes, yields = [], []
        for draw in draws:
            values = values_of(draw)
            satisfied = [limit.keeps(values[outputs.index(limit.output)]) for limit in limits]
            yields.append(spread.share_kept(np.all(satisfied, axis=0)))
            sizes.append(
                next(
                    (contributor.plus_minus for contributor in draw.contributors if contributor.name == FREE_ANGLE), 0.0
                )
            )
        stroke = abs(float(self.resolved.values["stroke"]))
        tolerance = self.resolved.study.tolerances[FREE_ANGLE]
        return Preload(sizes[0], sizes[1], sizes[0] / stroke, yields[0], yields[1], tolerance.row or "")
