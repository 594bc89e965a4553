"""Robust least squares: an outlier pulls with less than its square, and each channel's noise is read off its residuals.

Sources: [H] Huber and Ronchetti, Robust Statistics, 2nd ed. (M-estimates, "proposal 2" for the scale);
loss and solver as in scipy.optimize.least_squares (soft_l1, trust-region reflective); [Sch] Schwarz, Ann. Statist. 6
(1978) 461 (criterion of how many parameters the data bear).
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares
from scipy.special import erfcx

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.fitting.problem import Array, Channel, Residuals

BETTER = 6.0
"""By how much Schwarz's criterion has to fall for more parameters: strong evidence (Kass and Raftery, 1995)."""
LINEAR_UP_TO = 2.0
"""Deviations from which on a residual pulls as its size and no more as its square; 3 % wider intervals without
outliers."""
_NORMAL = 1.4826  # deviation over the median of the sizes, for a normal distribution
_ROUNDS, _PASSES = 20, 8
_EXACT, _MOST_STEPS = 1e-9, 100
_ROUGH, _FEW_STEPS = 1e-6, 8
_PASSING = 1e-4  # Tolerance of the loss while the noise is not settled
_SETTLED = 1e-3
_LEAST_NOISE, _LEAST_SQUARE = 1e-9, 1e-14
_LARGEST = 1e120  # Residual whose square, or whose share of a small one, still is a number


@dataclass(frozen=True)
class RobustFit:
    """The parameters that fit best, and each channel's noise."""

    inner: Array
    noise: Array  # Standard deviation of each channel, in its unit or as a share
    cost: float  # Sum of the loss of all residuals over their noise


def loss(z: Array) -> Array:
    """Return the loss of residuals over their noise, 2 c^2 (sqrt(1 + z^2/c^2) - 1): z^2 for small ones."""
    return np.asarray(2.0 * LINEAR_UP_TO**2 * (np.hypot(1.0, z / LINEAR_UP_TO) - 1.0))


def influence(z: Array) -> tuple[Array, Array]:
    """Return half the derivative of the loss by the residual, and its slope."""
    slant = np.hypot(1.0, z / LINEAR_UP_TO)
    return z / slant, slant**-3.0


MEAN_SQUARE = LINEAR_UP_TO**2 * float(1.0 - LINEAR_UP_TO * np.sqrt(0.5 * np.pi) * erfcx(LINEAR_UP_TO / np.sqrt(2.0)))
"""Mean square of the influence of an error of normal distribution."""


def robust_fit(residuals: Residuals, start: Array) -> RobustFit:
    """Fit from a start. Raises InputError where the equations give no number there, or there are too few data."""
    count = len(start)
    if residuals.problem.count <= count:
        raise InputError(
            f"{residuals.problem.count} values do not give {count} parameters; give more rows, or more files"
        )
    if not np.all(np.isfinite(residuals.at(start))):
        raise InputError(
            "the equations give no number at the start of the fit; look at units and ranges of the columns"
        )
    sizes = np.abs(residuals.at(start))  # the square of a wild one, or it over the others, is no number
    for part in residuals.parts:
        farthest, usual = float(np.max(sizes[part])), float(np.median(sizes[part]))
        if farthest > _LARGEST or farthest / _LARGEST**0.5 > usual > 0.0:
            raise InputError(f"a value is {farthest:.0e} away from the others; look for a wrong number")
    for parameter in residuals.problem.parameters:
        least, most = parameter.bounds
        if not least < most:
            raise InputError(
                f"{parameter.name}: the data suggest {parameter.start:.0e} {parameter.unit}; look for a wrong number"
            )
    floor = np.array([_floor(channel) for channel in residuals.problem.channels])
    noise = _noises(residuals, start, np.zeros(len(residuals.parts)))
    noise = np.where(noise > 0.0, noise, floor)
    inner = start
    for _ in range(_PASSES):
        inner = solved(residuals, inner, noise, passing=True)
        now = _noises(residuals, inner, parameters_of(residuals, inner, noise))
        now = np.maximum(now, floor)
        settled = np.all(np.abs(now / noise - 1.0) < _SETTLED)
        noise = now
        if settled:
            break
    inner = solved(residuals, inner, noise)
    return RobustFit(inner, noise, cost(residuals, inner, noise))


def solved(
    residuals: Residuals, start: Array, noise: Array, fixed: int | None = None, *, passing: bool = False
) -> Array:
    """Find the numbers of least loss for a given noise; one may stay fixed, and the tolerance is then larger."""
    tolerance, steps = (_EXACT, _MOST_STEPS) if fixed is None else (_ROUGH, _FEW_STEPS)
    free = np.arange(len(start)) != fixed
    weights = weights_of(residuals, noise)
    bounds = np.array([parameter.bounds for parameter in residuals.problem.parameters])[free]

    def whole(part: Array) -> Array:
        inner = start.copy()
        inner[free] = part
        return inner

    def values(part: Array) -> Array:
        return residuals.at(whole(part)) * weights

    def jacobian(part: Array) -> Array:
        return (residuals.jacobian(whole(part)) * weights[:, None])[:, free]

    solution = least_squares(
        values,
        np.clip(start[free], bounds[:, 0], bounds[:, 1]), jac=jacobian, bounds=(bounds[:, 0], bounds[:, 1]),
        loss="soft_l1", f_scale=LINEAR_UP_TO, xtol=tolerance, ftol=_PASSING if passing else tolerance, gtol=tolerance,
        max_nfev=steps, x_scale="jac",
    )  # fmt: skip
    return whole(solution.x)


def parameters_of(residuals: Residuals, inner: Array, noise: Array) -> Array:
    """Return how many parameters each channel determines: the sum of the leverages of its values."""
    jacobian = residuals.jacobian(inner) * weights_of(residuals, noise)[:, None]
    left, sizes, _ = np.linalg.svd(jacobian, full_matrices=False)
    leverage = np.sum(left[:, sizes > 1e-10 * sizes[0]] ** 2, axis=1)
    return np.array([float(np.sum(leverage[part])) for part in residuals.parts])


def weights_of(residuals: Residuals, noise: Array) -> Array:
    """Return one over the noise, for every value."""
    weights = np.empty(residuals.problem.count)
    for part, deviation in zip(residuals.parts, noise, strict=True):
        weights[part] = 1.0 / deviation
    return weights


def cost(residuals: Residuals, inner: Array, noise: Array) -> float:
    """Return the sum of the loss."""
    return float(np.sum(loss(residuals.at(inner) * weights_of(residuals, noise))))


def criterion(residuals: Residuals, fit: RobustFit) -> float:
    """Return Schwarz's criterion, less is better: n ln(mean square) of what errs alike, and ln(n) a parameter [Sch]."""
    values, total = residuals.at(fit.inner), len(fit.inner) * float(np.log(residuals.problem.count))
    for group in residuals.groups:
        left = np.concatenate([values[residuals.parts[i]] for i in group])
        channels = [residuals.problem.channels[i] for i in group]
        size = 1.0 if channels[0].relative else max(float(np.ptp(channel.measured)) for channel in channels)
        total += len(left) * float(np.log(max(float(np.mean((left / size) ** 2)), _LEAST_SQUARE)))
    return total


def _noises(residuals: Residuals, inner: Array, taken: Array) -> Array:
    """Return each channel's noise, from the residuals of all that err alike; `taken` is as of `parameters_of`."""
    values = residuals.at(inner)
    noises = [
        _noise_of(np.concatenate([values[residuals.parts[i]] for i in alike]), float(np.sum(taken[alike])))
        for alike in residuals.alike
    ]
    return np.array(noises)


def _noise_of(values: Array, parameters: float) -> float:
    """Return deviation of a channel, for which the mean square of the influence is what it is of a normal error [H].

    Parameters take their share of the residuals away. Begins at the median of the sizes; 0 where all are zero.
    """
    share = max(1.0 - parameters / len(values), 0.1)
    noise = float(_NORMAL * np.median(np.abs(values))) or float(np.std(values))
    for _ in range(_ROUNDS if noise > 0.0 else 0):
        pull, _ = influence(values / noise)
        noise *= float(np.sqrt(np.mean(pull**2) / (share * MEAN_SQUARE)))
    return noise


def _floor(channel: Channel) -> float:
    """Return the least noise of a channel: that of rounding to its step, a deviation of step/sqrt(12)."""
    size = 1.0 if channel.relative else float(np.max(np.abs(channel.measured))) or 1.0
    return max(_LEAST_NOISE * size, channel.step / float(np.sqrt(12.0)))
