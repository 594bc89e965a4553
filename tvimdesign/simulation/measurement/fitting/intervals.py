"""Uncertainty of parameters: covariance, profile of the likelihood, and which of them the data cannot tell apart.

Sources: [H] Huber and Ronchetti, Robust Statistics, 2nd ed., ch. 7 (covariance of M-estimates in regression); [B] Bates
and Watts, Nonlinear Regression Analysis and Its Applications, ch. 6 (profiles); [KR] Kenward and Roger, Biometrics 53
(1997) 983 (covariance where the weights are estimated); [S] Satterthwaite, Biometrics Bull. 2 (1946) 110, as in the GUM
(JCGM 100:2008, G.4) (degrees of freedom of a sum of estimated variances); [R] the same, 4.3.7 (variance of what is
known to lie between two ends).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt
from typing import Literal, NamedTuple

import numpy as np
from scipy.special import stdtrit

from tvimdesign.simulation.measurement.fitting.problem import Array, Parameter, Residuals
from tvimdesign.simulation.measurement.fitting.robust_fit import (
    MEAN_SQUARE,
    RobustFit,
    cost,
    influence,
    parameters_of,
    solved,
    weights_of,
)
from tvimdesign.simulation.measurement.fitting.serial_correlation import (
    INDEPENDENT,
    Following,
    Series,
    following,
    moved_by_noise,
)

CONFIDENCE = 0.95
_SMALLEST = 1e-7
"""Singular value over the largest, of derivatives by numbers scaled alike, below which a direction changes nothing."""
_PART = 0.2
"""Part of such a direction from which on a parameter is among those it moves."""
_TRIES = 12
_NEAR = 0.03
"""Share to which the loss at an interval's end is what it shall be: 1.5 % of the interval."""
_FARTHEST = 12.0
"""Deviations beyond which a profile is not followed."""


@dataclass(frozen=True)
class Spread:
    """Covariance of the solver's numbers, and the directions that change no prediction."""

    covariance: Array
    free_directions: tuple[Array, ...]
    parts: tuple[Array, ...]
    """What the noise of each group of channels that err alike gives to the covariance; last, nuisances' bounds."""
    freedom: tuple[float, ...]
    """Degrees of freedom of each group's noise; of bounds, infinite."""
    follows: tuple[Following, ...]
    """How far the noise of each channel follows itself."""
    slack: Array
    """Covariance over that of the loss's own curvature, for each number."""

    def deviation(self, direction: Array) -> float:
        """Return the standard deviation of a linear combination of the numbers."""
        return sqrt(max(float(direction @ self.covariance @ direction), 0.0))

    def quantile(self, direction: Array) -> float:
        """Return deviations of a linear combination to the end of its interval of `CONFIDENCE`."""
        variances = [max(float(direction @ part @ direction), 0.0) for part in self.parts]
        return float(stdtrit(effective_freedom(variances, self.freedom), 0.5 + 0.5 * CONFIDENCE))

    def half(self, direction: Array) -> float:
        """Return half the width of that interval."""
        return self.quantile(direction) * self.deviation(direction)

    def axis(self, at: int) -> Array:
        """Return the combination that is one of the numbers alone."""
        return np.asarray(np.eye(len(self.covariance))[at])


def effective_freedom(variances: Sequence[float], freedom: Sequence[float]) -> float:
    """Return degrees of freedom of a sum of estimated variances that have `freedom` each: (sum v)^2 / sum v^2/f [S]."""
    parts = np.asarray(variances) / (max(variances) or 1.0)
    squares = float(np.sum(parts**2 / np.asarray(freedom)))
    return float(np.sum(parts)) ** 2 / squares if squares > 0.0 else min(freedom)


def spread(residuals: Residuals, fit: RobustFit) -> Spread:
    """Return covariance H^-1 M H^-1 of the robust fit [H], M by noise that may follow itself (`serial_correlation`).

    The weight of each group of channels is estimated, and errs: the covariance is widened for it [KR].
    """
    weights = weights_of(residuals, fit.noise)
    z = residuals.at(fit.inner) * weights
    jacobian = residuals.jacobian(fit.inner) * weights[:, None]
    taken = parameters_of(residuals, fit.inner, fit.noise)
    within = np.diag([_box(parameter) for parameter in residuals.problem.parameters])
    everything = within + jacobian.T @ jacobian
    groups = [
        _group([(z[part], jacobian[part]) for part in (residuals.parts[i] for i in alike)], everything,
               float(np.sum(taken[alike])))
        for alike in residuals.groups
    ]  # fmt: skip
    inverse, directions = _inverse(np.sum([within, *(group.curvature for group in groups)], axis=0))
    given = [inverse @ group.moved @ inverse for group in groups]
    parts, freedom = [*given, inverse @ within @ inverse], [*(group.freedom for group in groups), np.inf]
    covariance = np.sum(parts, axis=0) + 2.0 * _of_weights(groups, given, inverse)
    own = np.diag(inverse)
    slack = np.divide(np.diag(covariance), own, out=np.ones(len(own)), where=own > 0.0)
    follows = [INDEPENDENT] * len(residuals.parts)
    for alike, group in zip(residuals.groups, groups, strict=True):
        for i in alike:
            follows[i] = group.follows
    return Spread(covariance, directions, tuple(parts), tuple(freedom), tuple(follows), slack)


def _box(parameter: Parameter) -> float:
    """Return one over the variance of a nuisance that is known to lie between two ends, width^2/12 [R]; 0 of others."""
    least, most = parameter.bounds
    bounded = parameter.nuisance and not parameter.positive and np.isfinite(most - least)
    return 12.0 / (most - least) ** 2 if bounded else 0.0


class _Group(NamedTuple):
    """Channels that err alike: their part of H, their part of M, and the degrees of freedom of their noise."""

    curvature: Array
    moved: Array
    freedom: float
    follows: Following


def _group(channels: Sequence[tuple[Array, Array]], everything: Array, taken: float) -> _Group:
    """Build a group from each channel's scaled residuals with derivatives, and how many parameters they determine.

    `everything` is the curvature of the sum of squares of all data.
    """
    z = np.concatenate([misfits for misfits, _ in channels])
    pull, slope = influence(z)
    mean, left = float(np.mean(slope)), max(1.0 - taken / len(z), 0.05)
    few = 1.0 + (1.0 - left) * float(np.var(slope)) / mean**2  # [H], correction for few data
    squares = np.sum([slopes.T @ slopes for _, slopes in channels], axis=0)
    freedom = max(len(z) - taken, 1.0)
    series = [Series(influence(channel)[0], slopes) for channel, slopes in channels]
    follows = following(series, everything - squares, freedom)
    moved = np.sum([moved_by_noise(slopes, follows.rho) for _, slopes in channels], axis=0)
    scatter = max(float(np.mean(pull**2)) / left, MEAN_SQUARE)  # more than the residuals' where a step bounds the noise
    size = few**2 * scatter * follows.wider
    return _Group(mean * squares, size * moved, freedom, follows)


def _of_weights(groups: Sequence[_Group], given: Sequence[Array], inverse: Array) -> Array:
    """Return the covariance due to errors of the estimated noises: sum of 2/f (P - P H C), symmetric [KR].

    P is what a group gives to the covariance, H its curvature, f the degrees of freedom of its noise, C the inverse of
    all curvatures together. It is none where one group has all the data. [KR] counts it twice: the numbers scatter more
    by it, and the covariance without it is as much too small.
    """
    added = np.zeros_like(inverse)
    for group, part in zip(groups, given, strict=True):
        shared = part @ group.curvature @ inverse
        added += 2.0 / group.freedom * (part - 0.5 * (shared + shared.T))
    return added


def _inverse(matrix: Array) -> tuple[Array, tuple[Array, ...]]:
    """Invert a curvature without the directions in which there is none, and return these too."""
    scale = np.sqrt(np.diag(matrix))
    scale[scale == 0.0] = 1.0
    values, vectors = np.linalg.eigh(matrix / np.outer(scale, scale))
    flat = values < _SMALLEST**2 * len(values) + 1e-13
    inverses = np.where(flat, 0.0, 1.0 / np.where(flat, 1.0, values))
    inverse = (vectors * inverses) @ vectors.T / np.outer(scale, scale)
    directions = (vectors[:, flat] / scale[:, None]).T
    return inverse, tuple(direction / np.max(np.abs(direction)) for direction in directions)


def moved_by(direction: Array) -> list[int]:
    """Return the parameters that a direction moves."""
    return [i for i, part in enumerate(np.abs(direction)) if part > _PART]


def profile_end(residuals: Residuals, fit: RobustFit, known: Spread, at: int, side: Literal[-1, 1]) -> float:
    """Find the end of an interval: where the best fit with the parameter held is worse by what chance explains [B].

    The solver's number, no farther than the parameter's bound; infinite where the data do not bound it within
    `_FARTHEST` deviations.
    """
    deviation, quantile = known.deviation(known.axis(at)), known.quantile(known.axis(at))
    allowed = quantile**2 * known.slack[at]
    along = known.covariance[:, at] / known.covariance[at, at]
    parameter = residuals.problem.parameters[at]
    bound = parameter.bounds[0] if side < 0 and not parameter.positive else side * np.inf
    most = abs(bound - fit.inner[at]) / deviation
    steps, low, high = quantile, 0.0, np.inf
    for _ in range(_TRIES):
        steps = min(steps, most)
        inner = fit.inner + side * steps * deviation * along
        worse = cost(residuals, solved(residuals, inner, fit.noise, fixed=at), fit.noise) - fit.cost
        if abs(worse / allowed - 1.0) < _NEAR:
            break
        if steps == most and worse < allowed:
            return bound
        low, high = (steps, high) if worse < allowed else (low, steps)
        if low > _FARTHEST:
            return side * np.inf
        # A parabola through the best fit; bounds where it is none.
        steps = float(np.clip(steps * np.sqrt(allowed / max(worse, 1e-3 * allowed)), 0.3 * steps, 2.0 * steps))
        if not low < steps < high:
            steps = 0.5 * (low + min(high, 2.0 * low))
    return float(fit.inner[at] + side * steps * deviation)
