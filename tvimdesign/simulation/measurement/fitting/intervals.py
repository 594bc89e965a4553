"""Uncertainty of parameters: covariance, profile of the likelihood, and which of them the data cannot tell apart.

Sources: [H] Huber and Ronchetti, Robust Statistics, 2nd ed., ch. 7 (covariance of M-estimates in regression); [B] Bates
and Watts, Nonlinear Regression Analysis and Its Applications, ch. 6 (profiles); [KR] Kenward and Roger, Biometrics 53
(1997) 983 (covariance where the weights are estimated); [S] Satterthwaite, Biometrics Bull. 2 (1946) 110, as in the GUM
(JCGM 100:2008, G.4) (degrees of freedom of a sum of estimated variances); [R] the same, 4.3.7 (variance of what is
known to lie between two ends).

Serial correlation of a series' noise, and its effect on what was fitted.

The noise is taken as autoregressive of first order with one coefficient rho for all channels that err alike. Parameters
follow slow noise, so that residuals look less alike than the noise is; the restricted likelihood counts that [PT, CR].
Few values do not tell rho well, and the likeliest rho alone is too sure of it: what is used is the mean of Fisher's z =
artanh(rho) [F] over the posterior from the reference prior 1/sqrt(1 - rho^2) [BY], and 0 where that is negative. As
exp(2 z) = (1 + rho)/(1 - rho) values of a long series are worth one that stands alone [Bay], this is the geometric mean
of the variance.

Sources: [PT] Patterson and Thompson, Biometrika 58 (1971) 545 (restricted likelihood); [CR] Cheang and Reinsel, J. Am.
Statist. Assoc. 95 (2000) 1173 (the same for regressions with autoregressive noise: bias of order 1/n taken away); [BY]
Berger and Yang, Econometric Theory 10 (1994) 461 (reference prior of rho); [F] Fisher, Metron 1 (1921) 3 (z); [Bay]
Bayley and Hammersley, J. R. Statist. Soc. Suppl. 8 (1946) 184.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt
from typing import Literal, NamedTuple

import numpy as np
from scipy.linalg import block_diag
from scipy.signal import lfilter
from scipy.special import fdtrc, ndtri, stdtrit

from tvimdesign.simulation.measurement.fitting import robust_fit
from tvimdesign.simulation.measurement.fitting.problem import Array, Parameter, Residuals

FEWEST = 10  # Values below which their correlation cannot be estimated: they count as independent
_MOST_ALIKE = 0.99
"""Largest coefficient that is counted: beyond it the equations are wrong, and no interval says by how much."""
_POINTS = 200
_RHO = np.sin(np.pi * ((np.arange(_POINTS) + 0.5) / _POINTS - 0.5))
"""Coefficients in equal steps of their arc sine, in which the reference prior is even."""
_FAINT = 1e-10  # Share of a parameter's information below which a direction counts as without any


class Series(NamedTuple):
    """Residuals of a channel over their noise, as they pull the fit, and their derivatives by the numbers fitted."""

    pulls: Array
    slopes: Array


class Following(NamedTuple):
    """The estimated serial correlation of a noise."""

    rho: float  # Coefficient to count with
    by_chance: float  # Posterior probability that there is none, or a negative one
    wider: float  # Variance of the noise with that coefficient, over that of independent residuals


INDEPENDENT = Following(0.0, 1.0, 1.0)


def following(series: Sequence[Series], others: Array, freedom: float) -> Following:
    """Estimate the serial correlation from the residuals of channels that err alike.

    `others` is what all else says of the numbers fitted (their curvature), `freedom` the values less the parameters
    that they determine.
    """
    if sum(len(each.pulls) for each in series) < FEWEST or not any(np.any(each.pulls) for each in series):
        return INDEPENDENT
    whole, neighbours, inner = (np.sum(part, axis=0) for part in zip(*map(_products, series), strict=True))
    size = np.sqrt(np.append(np.diag(others), 0.0) + np.diag(whole))
    size[size == 0.0] = 1.0
    squares = [each / np.outer(size, size) for each in (whole, neighbours, inner)]
    at = np.append(_RHO, 0.0)
    left, logarithm = _left_and_logarithm(squares, others / np.outer(size, size)[:-1, :-1], at)
    ends = sum(len(each.pulls) - 1 for each in series)
    likelihood = -0.5 * (ends * np.log1p(-(at**2)) + logarithm + freedom * np.log(left))[:-1]
    chance = np.exp(likelihood - np.max(likelihood))
    chance /= np.sum(chance)
    rho = float(np.clip(np.tanh(chance @ np.arctanh(_RHO)), 0.0, _MOST_ALIKE))
    with_it = _left_and_logarithm(squares, others / np.outer(size, size)[:-1, :-1], np.array([rho]))[0]
    return Following(rho, float(np.sum(chance[_RHO <= 0.0])), float(with_it[0] / left[-1]))


def moved_by_noise(slopes: Array, rho: float) -> Array:
    """Return X' R X, R = rho^|i-j|: covariance of the gradient of a sum of squares under such noise of variance one.

    Never less than X' X in any direction: a noise that follows itself moves what swings from value to value less, but
    only a noise of exactly this kind does.
    """
    square = np.asarray(slopes.T @ slopes)
    if rho == 0.0:
        return square
    before = lfilter([1.0], [1.0, -rho], slopes, axis=0)
    size = np.sqrt(np.diag(square))
    size[size == 0.0] = 1.0
    more, directions = np.linalg.eigh((slopes.T @ before + before.T @ slopes - 2.0 * square) / np.outer(size, size))
    wider = np.outer(size, size) * ((directions * np.maximum(more, 0.0)) @ directions.T)
    return np.asarray(square + wider)


def _products(each: Series) -> tuple[Array, Array, Array]:
    """Return sums of products of rows (slopes, pull): with themselves, with neighbours, and without both ends."""
    rows = np.column_stack([each.slopes, each.pulls])
    beside = rows[1:].T @ rows[:-1]
    return rows.T @ rows, beside + beside.T, rows[1:-1].T @ rows[1:-1]


def _left_and_logarithm(squares: Sequence[Array], others: Array, rho: Array) -> tuple[Array, Array]:
    """Return the sum of squares left where the noise follows itself by `rho`, and the log of the curvature's size.

    R^-1 has 1, 1 + rho^2, ..., 1 and -rho beside them, over 1 - rho^2. The fit at hand has no gradient: that of the
    other data is minus that of these as if they were independent.
    """
    whole, neighbours, inner = squares
    r = rho[:, None, None]
    white = (whole - r * neighbours + r**2 * inner) / (1.0 - r**2)
    curvature = white[:, :-1, :-1] + others + _FAINT * np.eye(len(others))
    gradient = white[:, :-1, -1:] - whole[:-1, -1:]
    better = np.sum(gradient * np.linalg.solve(curvature, gradient), axis=(1, 2))
    left = np.maximum(white[:, -1, -1] - better, _FAINT * whole[-1, -1])
    return left, np.linalg.slogdet(curvature)[1]


CONFIDENCE = 0.95
LEAST_DRIFT, _MOST_DRIFT = 0.005, 0.05
"""Share of its range, or of its value, by which a sensor may always drift over a test unseen; and at most."""
_UNSEEN = 3.7  # Deviations of a drift that the residuals show in most tests, as from 3.1 on it counts as shown
_SMALLEST = 1e-7
"""Singular value over the largest, of derivatives by numbers scaled alike, below which a direction changes nothing."""
_PART = 0.2  # Part of such a direction from which on a parameter is among those it moves
_TRIES = 12
_NEAR = 0.03  # Share to which the loss at an interval's end is what it shall be: 1.5 % of the interval
_FARTHEST = 12.0  # Deviations beyond which a profile is not followed


@dataclass(frozen=True)
class Spread:
    """Covariance of the solver's numbers, and the directions that change no prediction."""

    covariance: Array
    free_directions: tuple[Array, ...]
    parts: tuple[Array, ...]
    """What the noise of each group of channels that err alike gives to the covariance; last, nuisances' bounds."""
    freedom: tuple[float, ...]  # Degrees of freedom of each group's noise; of bounds, infinite
    follows: tuple[Following, ...]  # How far the noise of each channel follows itself
    slack: Array  # Covariance over that of the loss's own curvature, for each number

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


def spread(residuals: Residuals, fit: robust_fit.RobustFit) -> Spread:
    """Return covariance H^-1 M H^-1 of the robust fit [H], M by noise that may follow itself (`serial_correlation`).

    The weight of each group of channels is estimated, and errs: the covariance is widened for it [KR].
    """
    weights = robust_fit.weights_of(residuals, fit.noise)
    z = residuals.at(fit.inner) * weights
    jacobian = residuals.jacobian(fit.inner) * weights[:, None]
    taken = robust_fit.parameters_of(residuals, fit.inner, fit.noise)
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


class Drifts(NamedTuple):
    """Sensors that drift evenly over a test, channel after channel."""

    moves: Array  # Changes of the solver's numbers by a drift of one of each; a row for each sensor
    unseen: Array  # Square of the drifts that may go unseen: a quadratic form, as a covariance is
    sizes: Array  # Drifts that the residuals show, as shares of the range or of the value
    deviations: float  # By how many deviations all of them together differ from none

    def moved(self, slope: Array) -> float:
        """Return how far they may move a linear combination of the solver's numbers: all at once, or two deviations."""
        by_each = self.moves @ slope
        at_once = float(np.abs(by_each) @ np.sqrt(np.diag(self.unseen)))
        return min(at_once, 2.0 * sqrt(max(float(by_each @ self.unseen @ by_each), 0.0)))


def drifts(residuals: Residuals, fit: robust_fit.RobustFit, known: Spread) -> Drifts:
    """Return the drifts of all channels' sensors.

    The residuals do not show a drift that some parameters follow: up to `_MOST_DRIFT` it may be there unseen.
    """
    weights = robust_fit.weights_of(residuals, fit.noise)
    jacobian = residuals.jacobian(fit.inner) * weights[:, None]
    pull, _ = robust_fit.influence(residuals.at(fit.inner) * weights)
    within = np.diag([_box(parameter) for parameter in residuals.problem.parameters])
    predicted = zip(residuals.problem.channels, residuals.predicted(fit.inner), strict=True)
    courses = block_diag(*(channel.drifts(values) for channel, values in predicted)) * weights[:, None]
    moves, seen, information = _unfolded(jacobian, courses, within)
    least = np.eye(len(information)) / _MOST_DRIFT**2
    left = pull - seen @ np.linalg.solve(information + least, seen.T @ pull)
    taken = robust_fit.parameters_of(residuals, fit.inner, fit.noise)
    freedom = [max(part.stop - part.start - count, 2.0) for part, count in zip(residuals.parts, taken, strict=True)]
    own = np.ones(len(weights))
    for part, follows, free in zip(residuals.parts, known.follows, freedom, strict=True):
        own[part] = 1.0 / _scatter(pull[part], left[part], free, follows.rho)
    _, seen, information = _unfolded(jacobian * own[:, None], courses * own[:, None], within)
    shown = seen.T @ (pull * own)
    sizes = np.linalg.solve(information + least, shown)
    square = float(shown @ np.linalg.pinv(information, rcond=_FAINT) @ shown)
    chance = float(fdtrc(len(shown), sum(freedom), square / len(shown)))
    unseen = np.linalg.inv(information / _UNSEEN**2 + least) + LEAST_DRIFT**2 * np.eye(len(shown))
    return Drifts(-moves.T, unseen, np.asarray(sizes), float(-ndtri(max(0.5 * chance, 1e-300))))


def _unfolded(jacobian: Array, courses: Array, within: Array) -> tuple[Array, Array, Array]:
    """Return how parameters follow courses, what residuals show of these then, and the information on each."""
    moves = _inverse(jacobian.T @ jacobian + within)[0] @ (jacobian.T @ courses)
    seen = courses - jacobian @ moves
    information = courses.T @ seen
    return moves, seen, 0.5 * (information + information.T)


def _scatter(pull: Array, left: Array, freedom: float, rho: float) -> float:
    """Return the deviation of slow noise over that of the whole noise; `left` is the pull without its drift.

    The drift itself makes residuals scatter and follow one another: their correlation is that without it, less biased
    by two parameters (Marriott and Pope, Biometrika 41 (1954) 390), or `rho` where that is less.
    """
    count, square = len(left), float(left @ left)
    smaller = square / (float(pull @ pull) or 1.0) * freedom / (freedom - 1.0)
    if count >= FEWEST and square > 0.0:
        of_itself = (count * float(left[1:] @ left[:-1]) / square + 2.0) / (count - 4.0)
        rho = min(max(of_itself, 0.0), rho)
    return sqrt(min(smaller, 1.0) * (1.0 + rho) / (1.0 - rho)) or 1.0


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
    pull, slope = robust_fit.influence(z)
    mean, left = float(np.mean(slope)), max(1.0 - taken / len(z), 0.05)
    few = 1.0 + (1.0 - left) * float(np.var(slope)) / mean**2  # [H], correction for few data
    squares = np.sum([slopes.T @ slopes for _, slopes in channels], axis=0)
    freedom = max(len(z) - taken, 1.0)
    series = [Series(robust_fit.influence(channel)[0], slopes) for channel, slopes in channels]
    follows = following(series, everything - squares, freedom)
    moved = np.sum([moved_by_noise(slopes, follows.rho) for _, slopes in channels], axis=0)
    scatter = max(
        float(np.mean(pull**2)) / left, robust_fit.MEAN_SQUARE
    )  # more than the residuals' where a step bounds the noise
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


def profile_end(residuals: Residuals, fit: robust_fit.RobustFit, known: Spread, at: int, side: Literal[-1, 1]) -> float:
    """Find the end of an interval: where the best fit with the parameter held is worse by what chance explains [B].

    The solver's number, no farther than the parameter's bound; infinite where the data do not bound it within
    `_FARTHEST` deviations, or within the bounds of a positive one.
    """
    deviation, quantile = known.deviation(known.axis(at)), known.quantile(known.axis(at))
    allowed = quantile**2 * known.slack[at]
    along = known.covariance[:, at] / known.covariance[at, at]
    parameter = residuals.problem.parameters[at]
    end = parameter.bounds[0 if side < 0 else 1]
    bound = side * np.inf if parameter.positive else end
    most = abs(end - fit.inner[at]) / deviation
    steps, low, high = quantile, 0.0, np.inf
    for _ in range(_TRIES):
        steps = min(steps, most)
        inner = fit.inner + side * steps * deviation * along
        worse = (
            robust_fit.cost(residuals, robust_fit.solved(residuals, inner, fit.noise, fixed=at), fit.noise) - fit.cost
        )
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
