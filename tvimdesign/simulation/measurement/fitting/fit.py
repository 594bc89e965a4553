"""A problem fitted: every parameter with its interval, what follows from them, residuals, and what has to be said."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tvimdesign.simulation.measurement.fitting.identifiability import correlation, in_words
from tvimdesign.simulation.measurement.fitting.intervals import Spread, moved_by, profile_end, spread
from tvimdesign.simulation.measurement.fitting.problem import Array, Parameter, Problem
from tvimdesign.simulation.measurement.fitting.residuals import Residuals
from tvimdesign.simulation.measurement.fitting.robust_fit import RobustFit, robust_fit

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


@dataclass(frozen=True)
class Fit:
    """What the data say."""

    problem: Problem
    parameters: tuple[Estimate, ...]
    derived: tuple[Estimate, ...]
    correlation: Array
    predicted: tuple[Array, ...]
    """What each channel should be [SI]."""
    noise: tuple[float, ...]
    """Standard deviation of each channel, in SI or as a share."""
    autocorrelation: tuple[float, ...]
    """Of each channel's noise from one value to the next, as the intervals count it."""
    words: tuple[str, ...]

    def value(self, name: str) -> float:
        """The value of a parameter, or of what follows [SI]."""
        return self[name].value

    def __getitem__(self, name: str) -> Estimate:
        """A parameter, or what follows, by its name."""
        return next(one for one in (*self.parameters, *self.derived) if one.name == name)


class BestFit(NamedTuple):
    """A problem's best parameters, before anything is said of how sure they are."""

    residuals: Residuals
    found: RobustFit

    @property
    def problem(self) -> Problem:
        """What was fitted."""
        return self.residuals.problem

    def predicted(self) -> list[Array]:
        """What each channel should be [SI]."""
        return self.residuals.predicted(self.found.inner)


def best_fit(problem: Problem) -> BestFit:
    """Fit a problem.

    Raises InputError where there are fewer values than parameters, or the equations give no number at the start.
    """
    residuals = Residuals(problem)
    return BestFit(residuals, robust_fit(residuals, np.array([one.inner(one.start) for one in problem.parameters])))


def fitted(problem: Problem, *, profiles: bool = True) -> Fit:
    """Fit a problem, and say how sure it is: `best_fit`, then `with_intervals`."""
    return with_intervals(best_fit(problem), profiles=profiles)


def with_intervals(fit: BestFit, *, profiles: bool = True) -> Fit:
    """The intervals of a best fit, and what follows from it; without `profiles` they are those of the covariance."""
    residuals, best = fit
    known = spread(residuals, best)
    free = {i for direction in known.free_directions for i in moved_by(direction)}
    parameters, words = [], in_words(fit.problem, known, best.inner)
    for i, one in enumerate(fit.problem.parameters):
        if one.nuisance:
            continue
        ends = (None, None) if i in free else _ends(residuals, best, known, i, profiles and one.profiled)
        words += _unbounded(one, ends)
        parameters.append(_estimate(one, best.inner[i], ends))
    return Fit(
        fit.problem, tuple(parameters), _derived(residuals, best, known), correlation(known.covariance),
        tuple(fit.predicted()), tuple(map(float, best.noise)),
        tuple(one.rho for one in known.follows), tuple(words),
    )  # fmt: skip


def _ends(residuals: Residuals, best: RobustFit, known: Spread, at: int, profiles: bool) -> tuple[float, float]:
    half = known.half(known.axis(at))
    if not profiles or half == 0.0:
        return _within(residuals.problem.parameters[at], best.inner[at] - half, best.inner[at] + half)
    return profile_end(residuals, best, known, at, -1), profile_end(residuals, best, known, at, 1)


def _within(one: Parameter, low: float, high: float) -> tuple[float, float]:
    """An interval within a parameter's bounds; open where a positive one reaches them: the data do not end it."""
    least, most = one.bounds
    if not one.positive:
        return max(low, least), min(high, most)
    return low if low > least else -np.inf, high if high < most else np.inf


def _estimate(one: Parameter, inner: float, ends: tuple[float | None, float | None]) -> Estimate:
    low, high = (None if end is None or not np.isfinite(end) else float(one.outer(float(end))) for end in ends)
    return Estimate(one.name, one.unit, one.meaning, float(one.outer(inner)), low, high)


def _unbounded(one: Parameter, ends: tuple[float | None, float | None]) -> list[str]:
    sides = [side for end, side in zip(ends, ("below", "above"), strict=True) if end is not None and np.isinf(end)]
    return [f"The data do not bound {one.name} from {side}." for side in sides]


def _derived(residuals: Residuals, best: RobustFit, known: Spread) -> tuple[Estimate, ...]:
    """What follows, with the intervals of its logarithm by the covariance; none where a free direction moves it."""
    logarithms, slopes = residuals.derived(best.inner)
    found = []
    for one, middle, slope in zip(residuals.problem.derived, logarithms, slopes, strict=True):
        half = known.half(slope)
        open_ = any(abs(slope @ direction) > 1e-6 * np.max(np.abs(slope)) for direction in known.free_directions)
        open_ = open_ or half > _UNKNOWN
        ends = (None, None) if open_ else (float(np.exp(middle - half)), float(np.exp(middle + half)))
        found.append(Estimate(one.name, one.unit, one.meaning, float(np.exp(middle)), *ends))
    return tuple(found)
