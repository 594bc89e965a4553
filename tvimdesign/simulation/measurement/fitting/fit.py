"""A problem fitted: every parameter with its interval, what follows from them, residuals, and what has to be said."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tvimdesign.simulation.measurement.fitting import intervals
from tvimdesign.simulation.measurement.fitting.intervals import Drifts, Spread
from tvimdesign.simulation.measurement.fitting.problem import Array, Parameter, Problem, Residuals
from tvimdesign.simulation.measurement.fitting.robust_fit import BETTER, RobustFit, criterion, robust_fit

CLOSE = 0.95  # Correlation from which on two parameters are named together
_FOLLOW = 0.5
_CHANCE = 0.05  # Correlation from which on it is named, and the probability that it is none up to which it is sure
_SAME = 0.05  # Share to which parameters must change alike for their ratios to be what is known
_TOO_ALIKE = 0.9  # Correlation of residuals from which on they are no noise
_NEGLIGIBLE = 2e-3  # Share of the range, or of the value, up to which residuals do not count as a misfit
_RARE = 3.1  # Deviations: 1 in 1000 by chance
_FEWEST_RUNS = 8
_AWAY, _ALSO = 4.5, 2.0
"""Deviations that two rows at an end of a series are off together, in the mean and each, where a law ends."""
_UNKNOWN = float(np.log(1e6))
"""Half the width of a logarithm's interval from which on the data say nothing of what follows."""


@dataclass(frozen=True)
class Estimate:
    """A value with its interval of 95 %, in SI; without one where the data do not determine it."""

    name: str
    unit: str
    meaning: str
    value: float
    low: float | None
    high: float | None
    drift: float = 0.0  # By how much drifts of the sensors that the residuals do not show may move it, in SI


@dataclass(frozen=True)
class Fit:
    """The outcome of a fit."""

    problem: Problem
    parameters: tuple[Estimate, ...]
    derived: tuple[Estimate, ...]
    correlation: Array
    predicted: tuple[Array, ...]  # Prediction of each channel [SI]
    noise: tuple[float, ...]  # Standard deviation of each channel, in SI or as a share
    autocorrelation: tuple[float, ...]  # Of each channel's noise from one value to the next, as the intervals count it
    words: tuple[str, ...]
    misfit: str = ""  # Why the equations do not describe the data, so that no record may follow; empty where they do

    def value(self, name: str) -> float:
        """Return the value of a parameter, or of what follows [SI]."""
        return self[name].value

    def __getitem__(self, name: str) -> Estimate:
        """Return a parameter, or what follows, by its name."""
        return next(estimate for estimate in (*self.parameters, *self.derived) if estimate.name == name)


class BestFit(NamedTuple):
    """A problem's best parameters, without their uncertainty."""

    residuals: Residuals
    fit: RobustFit

    @property
    def problem(self) -> Problem:
        """The problem that was fitted."""
        return self.residuals.problem


def best_fit(problem: Problem) -> BestFit:
    """Fit a problem.

    Raises InputError where there are fewer values than parameters, or the equations give no number at the start.
    """
    residuals, starts = Residuals(problem), [parameter.inner(parameter.start) for parameter in problem.parameters]
    return BestFit(residuals, robust_fit(residuals, np.array(starts)))


def simplest_fit(problems: Iterable[Problem]) -> tuple[int, BestFit]:
    """Return which of problems of more and more parameters the data bear, and its fit.

    It is the last up to which Schwarz's criterion falls by `BETTER`. Raises InputError as `best_fit` does.
    """
    fits = map(best_fit, problems)
    chosen, best = 0, next(fits)
    for at, candidate in enumerate(fits, start=1):
        if criterion(*candidate) > criterion(*best) - BETTER:
            break
        chosen, best = at, candidate
    return chosen, best


def fitted(problem: Problem, *, profiles: bool = True) -> Fit:
    """Fit a problem, and say how sure it is: `best_fit`, then `with_intervals`."""
    return with_intervals(best_fit(problem), profiles=profiles)


def with_intervals(fit: BestFit, *, profiles: bool = True) -> Fit:
    """Return intervals of a best fit, and what follows from it; without `profiles` they are those of the covariance."""
    residuals, best = fit
    known = intervals.spread(residuals, best)
    drift = intervals.drifts(residuals, best, known)
    free = {i for direction in known.free_directions for i in intervals.moved_by(direction)}
    parameters, words = [], in_words(fit.problem, known, best.inner)
    for i, parameter in enumerate(fit.problem.parameters):
        if parameter.nuisance:
            continue
        ends = (None, None) if i in free else _ends(residuals, best, known, i, profiles and parameter.profiled)
        sides = [side for end, side in zip(ends, ("below", "above"), strict=True) if end is not None and np.isinf(end)]
        words += [f"The data do not bound {parameter.name} from {side}." for side in sides]
        moved = drift.moved(known.axis(i))
        parameters.append(_estimate(parameter, best.inner[i], ends, moved))
    misfit = _misfit(residuals, best, known) or _drifting(fit.problem, drift)
    return Fit(
        fit.problem, tuple(parameters), _derived(residuals, best, known, drift), correlation(known.covariance),
        tuple(residuals.predicted(best.inner)), tuple(map(float, best.noise)),
        tuple(parameter.rho for parameter in known.follows), (*words, *([misfit] if misfit else [])), misfit,
    )  # fmt: skip


def _misfit(residuals: Residuals, best: RobustFit, known: Spread) -> str:
    """Say which channel the equations do not describe: by correlation, or by runs of one sign in what it leaves.

    Noise may follow itself, and intervals count that up to `_TOO_ALIKE`; a runs test (Wald and Wolfowitz, Ann. Math.
    Statist. 11 (1940) 147) of the residuals less their correlation finds what is no such noise.
    """
    values = residuals.at(best.inner)
    for group in residuals.groups:
        channel, follows = residuals.problem.channels[group[0]], known.follows[group[0]]
        size = 1.0 if channel.relative else max(float(np.ptp(residuals.problem.channels[i].measured)) for i in group)
        if best.noise[group[0]] <= _NEGLIGIBLE * size:
            continue
        why = ""
        if follows.rho > _TOO_ALIKE and follows.by_chance <= _CHANCE:
            why = f"follow one another (correlation {follows.rho:.2f})"
        parts = [values[residuals.parts[i]] for i in group]
        off = max((_off_at_an_end(part / best.noise[group[0]]) for part in parts), default=0.0)
        short = _missing_runs([part[1:] - follows.rho * part[:-1] for part in parts])
        if not why and short > _RARE:
            why = f"keep their sign for longer than chance explains ({short:.1f} deviations)"
        if not why and off > _AWAY:
            why = f"at an end are {off:.1f} deviations, as where a law's range ends"
        if why:
            return (
                f"The equations do not describe {channel.name}: its residuals {why}. No record is written. The figure "
                "and residuals.csv show where the data part from the equations; leave those rows out."
            )
    return ""


def _drifting(problem: Problem, drift: Drifts) -> str:
    """Say which channel's residuals drift over the test, if one's do."""
    most = int(np.argmax(np.abs(drift.sizes)))
    channel = [channel for channel in problem.channels for _ in range(channel.sensors)][most]
    size = drift.sizes[most]
    if drift.deviations < _RARE or abs(size) < intervals.LEAST_DRIFT:
        return ""
    of = "value" if channel.relative and not channel.zero_drifts else "range"
    return (
        f"{channel.name[0].upper()}{channel.name[1:]} drifts by {100.0 * size:.1f} % of its {of} over the test "
        f"({drift.deviations:.1f} deviations). No record is written: let instrument and sample settle, measure again."
    )


def _off_at_an_end(z: Array) -> float:
    """Return the mean size of the residuals of the first or last two rows, where both are off to the same side."""
    pairs = [z[:2], z[-2:]] if len(z) >= _FEWEST_RUNS else []
    alike = [pair for pair in pairs if np.all(pair > _ALSO) or np.all(pair < -_ALSO)]
    return max((float(np.mean(np.abs(pair))) for pair in alike), default=0.0)


def _missing_runs(series: Sequence[Array]) -> float:
    """Return by how many deviations the runs of one sign are fewer than those of independent values."""
    missing, variance = 0.0, 0.0
    for values in series:
        above = values[values != 0.0] > 0.0
        n, up = len(above), int(np.sum(above))
        if n < _FEWEST_RUNS or up in {0, n}:
            continue
        both = 2.0 * up * (n - up)
        missing += 1.0 + both / n - (1 + int(np.sum(above[1:] != above[:-1])))
        variance += both * (both - n) / (n**2 * (n - 1.0))
    return missing / float(np.sqrt(variance)) if variance > 0.0 else 0.0


def _ends(residuals: Residuals, best: RobustFit, known: Spread, at: int, profiles: bool) -> tuple[float, float]:
    half = known.half(known.axis(at))
    if not profiles or half == 0.0:
        return _within(residuals.problem.parameters[at], best.inner[at] - half, best.inner[at] + half)
    return intervals.profile_end(residuals, best, known, at, -1), intervals.profile_end(residuals, best, known, at, 1)


def _within(parameter: Parameter, low: float, high: float) -> tuple[float, float]:
    """Return an interval within a parameter's bounds; open where a positive one reaches them."""
    least, most = parameter.bounds
    if not parameter.positive:
        return max(low, least), min(high, most)
    return low if low > least else -np.inf, high if high < most else np.inf


def _estimate(parameter: Parameter, inner: float, ends: tuple[float | None, float | None], moved: float) -> Estimate:
    low, high = (None if end is None or not np.isfinite(end) else float(parameter.outer(float(end))) for end in ends)
    value = float(parameter.outer(inner))
    drift = moved * (value if parameter.positive else parameter.scale)
    return Estimate(parameter.name, parameter.unit, parameter.meaning, value, low, high, drift)


def _derived(residuals: Residuals, best: RobustFit, known: Spread, drift: Drifts) -> tuple[Estimate, ...]:
    """Return derived quantities with intervals by the covariance; none where a free direction moves one."""
    logarithms, slopes = residuals.derived(best.inner)
    estimates = []
    for quantity, middle, slope in zip(residuals.problem.derived, logarithms, slopes, strict=True):
        half = known.half(slope)
        open_ = any(abs(slope @ direction) > 1e-6 * np.max(np.abs(slope)) for direction in known.free_directions)
        open_ = open_ or half > _UNKNOWN
        low, high = (None, None) if open_ else (float(np.exp(middle - half)), float(np.exp(middle + half)))
        value = float(np.exp(middle))
        moved = value * drift.moved(slope)
        estimates.append(Estimate(quantity.name, quantity.unit, quantity.meaning, value, low, high, moved))
    return tuple(estimates)


def in_words(problem: Problem, known: Spread, inner: Array) -> list[str]:
    """Return sentences about free directions, close correlations, and residuals that follow one another.

    `inner` are the solver's numbers of the best fit.
    """
    undetermined: set[int] = set()
    sentences = []
    for direction in known.free_directions:
        moved = intervals.moved_by(direction)
        undetermined.update(moved)
        named = [i for i in moved if not problem.parameters[i].nuisance]
        sentences += [_free(problem.parameters, direction, named, inner)] if named else []
    sentences += _correlated(problem.parameters, correlation(known.covariance), undetermined)
    return sentences + _following(problem, known)


def _following(problem: Problem, known: Spread) -> list[str]:
    """Return whether residuals follow one another, or are so few that nobody can tell."""
    most = max(range(len(known.follows)), key=lambda i: known.follows[i].rho)
    rho, name = known.follows[most].rho, problem.channels[most].name
    wider = np.sqrt((1.0 + rho) / (1.0 - rho))
    if rho <= _FOLLOW:
        return []
    if known.follows[most].by_chance > _CHANCE:
        return [
            f"The residuals of {name} are too few to tell whether they follow one another (correlation {rho:.2f}, if "
            f"they do): what they say counts as {wider:.1f} times less sure. Give more rows."
        ]
    return [
        f"Residuals follow one another, most those of {name} (correlation {rho:.2f}): the equations leave something "
        f"out, or the instrument smooths. What these data say counts as {wider:.1f} times less sure."
    ]


def correlation(covariance: Array) -> Array:
    """Return the correlation of the parameters; zero where one has no spread."""
    deviation = np.sqrt(np.diag(covariance))
    deviation[deviation == 0.0] = np.inf
    return np.asarray(covariance / np.outer(deviation, deviation))


def _free(parameters: Sequence[Parameter], direction: Array, moved: Sequence[int], inner: Array) -> str:
    names = [parameters[i].name for i in moved]
    if len(moved) == 1:
        return f"The data say nothing of {names[0]}: no prediction depends on it. Its value is the start of the fit."
    together = "rise together" if len({np.sign(direction[i]) for i in moved}) == 1 else "make up for one another"
    shares = np.array([direction[i] if parameters[i].positive else direction[i] / (inner[i] or np.inf) for i in moved])
    ratio = " Only their ratios are known." if np.ptp(shares) < _SAME * np.max(np.abs(shares)) else ""
    return (
        f"The data cannot tell {', '.join(names[:-1])} and {names[-1]} apart: they {together} without changing any "
        f"prediction.{ratio} Measure one of them otherwise and give it with --set."
    )


def _correlated(parameters: Sequence[Parameter], rho: Array, left_out: set[int]) -> list[str]:
    sentences = []
    for i, parameter in enumerate(parameters):
        for j in range(i + 1, len(parameters)):
            if abs(rho[i, j]) < CLOSE or {i, j} & left_out or parameter.nuisance or parameters[j].nuisance:
                continue
            how = "rises with" if rho[i, j] > 0.0 else "falls as"
            end = "" if rho[i, j] > 0.0 else " rises"
            sentences.append(
                f"The data hardly tell {parameter.name} and {parameters[j].name} apart (correlation {rho[i, j]:.3f}): "
                f"{parameter.name} {how} {parameters[j].name}{end}, and each alone is less sure than both together."
            )
    return sentences
