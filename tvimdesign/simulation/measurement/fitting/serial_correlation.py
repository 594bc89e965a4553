"""Serial correlation of a series' noise, and its effect on what was fitted.

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

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.signal import lfilter

from tvimdesign.simulation.measurement.fitting.problem import Array

FEWEST = 10
"""Values below which their correlation cannot be estimated: they count as independent."""
_MOST_ALIKE = 0.99
"""Largest coefficient that is counted: beyond it the equations are wrong, and no interval says by how much."""
_POINTS = 200
_RHO = np.sin(np.pi * ((np.arange(_POINTS) + 0.5) / _POINTS - 0.5))
"""Coefficients in equal steps of their arc sine, in which the reference prior is even."""
_FAINT = 1e-10
"""Share of a parameter's information below which a direction counts as without any."""


class Series(NamedTuple):
    """Residuals of a channel over their noise, as they pull the fit, and their derivatives by the numbers fitted."""

    pulls: Array
    slopes: Array


class Following(NamedTuple):
    """The estimated serial correlation of a noise."""

    rho: float
    """Coefficient to count with."""
    by_chance: float
    """Posterior probability that there is none, or a negative one."""
    wider: float
    """Variance of the noise with that coefficient, over that of independent residuals."""


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
