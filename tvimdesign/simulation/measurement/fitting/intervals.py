"""How sure parameters are: covariance, profile of the likelihood, and which of them the data cannot tell apart.

Sources: [H] Huber and Ronchetti, Robust Statistics, 2nd ed., ch. 7 (covariance of M-estimates in regression); [B] Bates
and Watts, Nonlinear Regression Analysis and Its Applications, ch. 6 (profiles); [Bay] Bayley and Hammersley, J. R.
Statist. Soc. Suppl. 8 (1946) 184 (how many independent values a series of correlated ones is worth).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.special import stdtrit

from tvimdesign.simulation.measurement.fitting.problem import Array
from tvimdesign.simulation.measurement.fitting.residuals import Residuals
from tvimdesign.simulation.measurement.fitting.robust_fit import (
    RobustFit,
    cost,
    influence,
    parameters_of,
    solved,
    weights_of,
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
    quantile: float
    """Deviations to the end of an interval of `CONFIDENCE`."""
    autocorrelation: Array
    """Of each channel's residuals from one to the next."""
    slack: Array
    """Covariance over that of the loss's own curvature, for each number."""


def spread(residuals: Residuals, fit: RobustFit) -> Spread:
    """Covariance H^-1 M H^-1 of the robust fit [H], M widened where residuals follow one another [Bay]."""
    weights = weights_of(residuals, fit.noise)
    z = residuals.at(fit.inner) * weights
    jacobian = residuals.jacobian(fit.inner) * weights[:, None]
    free = jacobian.shape[1]
    pull, slope = influence(z)
    curvature, moved, worth, follows = np.zeros((free, free)), np.zeros((free, free)), 0.0, []
    taken = parameters_of(residuals, fit.inner, fit.noise)
    for part, alike in zip(residuals.parts, residuals.alike, strict=True):
        count = sum(residuals.parts[i].stop - residuals.parts[i].start for i in alike)
        rho = _autocorrelation(z[part])
        wider = (1.0 + rho) / (1.0 - rho)
        square = jacobian[part].T @ jacobian[part]
        left = max(1.0 - float(np.sum(taken[alike])) / count, 0.05)
        together = np.concatenate([np.arange(residuals.parts[i].start, residuals.parts[i].stop) for i in alike])
        mean = float(np.mean(slope[together]))
        few = 1.0 + (1.0 - left) * float(np.var(slope[together])) / mean**2  # [H], correction for few data
        curvature += mean * square
        moved += wider * few**2 * np.mean(pull[together] ** 2) / left * square
        worth += len(z[part]) / wider
        follows.append(rho)
    inverse, directions = _inverse(curvature)
    covariance = inverse @ moved @ inverse
    quantile = float(stdtrit(max(worth - free, 1.0), 0.5 + 0.5 * CONFIDENCE))
    own = np.diag(inverse)
    slack = np.divide(np.diag(covariance), own, out=np.ones(free), where=own > 0.0)
    return Spread(covariance, directions, quantile, np.array(follows), slack)


def _autocorrelation(z: Array) -> float:
    """From one residual to the next; 0 where that may be by chance."""
    if len(z) < 10:
        return 0.0
    rho = float(np.sum(z[1:] * z[:-1]) / np.sum(z**2)) if np.any(z) else 0.0
    return min(rho, 0.99) if rho > 3.0 / np.sqrt(len(z)) else 0.0


def _inverse(matrix: Array) -> tuple[Array, tuple[Array, ...]]:
    """Inverse of a curvature without the directions in which there is none, and these."""
    scale = np.sqrt(np.diag(matrix))
    scale[scale == 0.0] = 1.0
    values, vectors = np.linalg.eigh(matrix / np.outer(scale, scale))
    flat = values < _SMALLEST**2 * len(values) + 1e-13
    kept = np.where(flat, 0.0, 1.0 / np.where(flat, 1.0, values))
    inverse = (vectors * kept) @ vectors.T / np.outer(scale, scale)
    directions = (vectors[:, flat] / scale[:, None]).T
    return inverse, tuple(direction / np.max(np.abs(direction)) for direction in directions)


def moved_by(direction: Array) -> list[int]:
    """The parameters that a direction moves."""
    return [i for i, part in enumerate(np.abs(direction)) if part > _PART]


def profile_end(residuals: Residuals, fit: RobustFit, known: Spread, at: int, side: Literal[-1, 1]) -> float:
    """The end of a parameter's interval: where the best fit with it held there is worse by what chance explains [B].

    The solver's number, no farther than the parameter's bound; infinite where the data do not bound it within
    `_FARTHEST` deviations.
    """
    deviation = float(np.sqrt(known.covariance[at, at]))
    allowed = known.quantile**2 * known.slack[at]
    along = known.covariance[:, at] / known.covariance[at, at]
    parameter = residuals.problem.parameters[at]
    bound = parameter.bounds[0] if side < 0 and not parameter.positive else side * np.inf
    most = abs(bound - fit.inner[at]) / deviation
    steps, low, high = known.quantile, 0.0, np.inf
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
