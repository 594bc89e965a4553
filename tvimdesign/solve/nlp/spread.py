"""Spread of inputs, with worst case, root-sum-square and Monte Carlo for any function of columns.

A function takes one row for each contributor and one column a module, and returns one row for each output. Nothing here
knows what a module is; `solve/uncertainty/tolerance.py` does.

Moments of algebraic outputs, for independent, symmetric inputs of standard deviation s_j, to second order in s:
mean = f + 1/2 sum f_jj s_j^2, variance = sum (f_j s_j)^2; all derivatives are exact.
Source: Taylor series of moments, e.g. JCGM 100:2008 (GUM), 5.1.2 with its note.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.user_cache import find_code, keep_code
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.symbols import ca
from tvimdesign.study import Tolerance

Array = NDArray[np.float64]
Columns = Callable[[Array], Array]

CHUNK = 1 << 16  # Modules drawn at a time
MOST_CORNERS = 16  # Contributors up to which every corner of the worst case is looked at: 65 536
_CONFIDENCE = 1.959964  # Standard deviations of the interval in which a yield lies with 95 %
_EDGE = 1e-15  # How near to 0 and 1 a share is drawn: a normal part eight standard deviations off
_ALIKE = 0.01  # Difference, as a share of the worst case's span, below which two corners are the same
RARE = 0.00135  # Share of a normal distribution beyond three standard deviations on one side


def deviation_of(plus_minus: Any, distribution: str, sigma: float) -> Any:
    """Standard deviation of what lies within `plus_minus`: that many sigma of a normal one, 1/sqrt(3) of a uniform."""
    return plus_minus / (sigma if distribution == "normal" else math.sqrt(3.0))


@dataclass(frozen=True)
class Contributor:
    """One input that spreads, SI: its value as drawn, and how far it may lie from that to either side."""

    name: str
    nominal: float
    plus_minus: float
    distribution: Literal["normal", "uniform"] = "normal"
    sigma: float = 3.0
    lower: float = -math.inf
    upper: float = math.inf  # Limits within which there is such an input at all; draws beyond are put on them

    @property
    def deviation(self) -> float:
        """Standard deviation."""
        return float(deviation_of(self.plus_minus, self.distribution, self.sigma))

    def ppf(self, share: Any) -> Array:
        """Value below which a share of all parts lies."""
        from scipy.special import ndtri

        if self.distribution == "normal":
            drawn = self.nominal + self.deviation * ndtri(share)
        else:
            drawn = self.nominal + self.plus_minus * (2.0 * np.asarray(share) - 1.0)
        inside: Array = np.clip(drawn, self.lower, self.upper)
        return inside

    @property
    def ends(self) -> tuple[float, float]:
        """Least and largest value within the tolerance."""
        low, high = self.nominal - self.plus_minus, self.nominal + self.plus_minus
        return max(low, self.lower), min(high, self.upper)


@dataclass(frozen=True)
class WorstCase:
    """Least and largest value of each output with every input anywhere within its tolerance."""

    low: Array
    high: Array
    by_sign: Array  # Of each output, whether the corners that its derivatives point to are the worst of all corners
    corners: int  # How many corners were looked at


@dataclass(frozen=True)
class MonteCarlo:
    """Outputs of many modules."""

    values: Array  # One row an output, one column a module
    mean: Array
    deviation: Array
    low: Array
    high: Array  # Values that 0.135 % of the modules lie below, and above
    never: Array  # Share of the modules in which it never happens; they are left out of mean and deviation


@dataclass(frozen=True)
class Yield:
    """Share of the modules that keep a limit, with the interval in which it lies with 95 % (Wilson)."""

    share: float
    low: float
    high: float


def worst_case(function: Columns, contributors: Sequence[Contributor], derivatives: Array) -> WorstCase:
    """Corners by the signs of the derivatives, and all others where there are not too many of them."""
    ends = np.array([contributor.ends for contributor in contributors])
    signs = derivatives >= 0.0
    values = function(_corners(ends, np.concatenate([~signs, signs]).T))
    rows, count = np.arange(len(signs)), len(signs)
    low, high = values[rows, rows], values[rows, count + rows]
    least, most = np.fmin.reduce(values, axis=1), np.fmax.reduce(values, axis=1)
    looked_at = 2 * count
    if len(contributors) <= MOST_CORNERS:
        looked_at = 2 ** len(contributors)
        for first in range(0, looked_at, CHUNK):
            numbers = np.arange(first, min(first + CHUNK, looked_at))
            every = function(_corners(ends, (numbers >> np.arange(len(contributors))[:, None]) & 1))
            least = np.fmin(least, np.fmin.reduce(every, axis=1))
            most = np.fmax(most, np.fmax.reduce(every, axis=1))
    with np.errstate(invalid="ignore"):
        room = np.nan_to_num(_ALIKE * (most - least), posinf=0.0)
    by_sign = (low <= least + room) & ((high >= most - room) | (high == most))
    return WorstCase(least, most, by_sign, looked_at)


def _corners(ends: Array, which: Any) -> Array:
    """Columns of values: the lower end where `which` is false, the upper where it is true."""
    return np.where(which, ends[:, 1:], ends[:, :1])


def shares(contributors: Sequence[Contributor], derivatives: Array) -> tuple[Array, Array]:
    """Standard deviation of each output by root-sum-square, and each contributor's share of its variance."""
    parts = (derivatives * np.array([contributor.deviation for contributor in contributors])) ** 2
    variance = np.sum(parts, axis=1, keepdims=True)
    return np.sqrt(variance[:, 0]), np.divide(parts, variance, out=np.zeros_like(parts), where=variance > 0.0)


def drawn_values(function: Columns, contributors: Sequence[Contributor], samples: int, seed: int) -> Array:
    """Outputs of `samples` modules, a column each; the same however they are parted."""
    from scipy.stats import qmc

    points, columns = qmc.Sobol(len(contributors), rng=np.random.default_rng(seed)), []
    for done in range(0, samples, CHUNK):
        drawn = points.random(min(CHUNK, samples - done)).T
        columns.append(function(inputs_at(contributors, drawn)))
    return np.concatenate(columns, axis=1)


def sobol_points(dimensions: int, count: int, seed: int) -> Array:
    """Return the first scrambled Sobol points of the unit cube, one a row; `count` is a power of two.

    They are stored from one run to the next: to load scipy's takes 0.7 s.
    """
    key = (f"scipy {version('scipy')}, numpy {version('numpy')}", f"Sobol {dimensions} {count} {seed}")
    cached = find_code(*key)
    if cached is not None:
        return np.frombuffer(cached).reshape(count, dimensions)
    from scipy.stats import qmc

    points: Array = qmc.Sobol(dimensions, rng=np.random.default_rng(seed)).random(count)
    keep_code(points.tobytes(), *key)
    return points


def moments_of(values: Array) -> MonteCarlo:
    """Mean, deviation and ends of every output over the modules in which it happens."""
    happens = np.isfinite(values)
    finite = np.where(happens, values, np.nan)
    count = np.sum(happens, axis=1)
    mean = np.full(len(values), np.nan)
    deviation, low, high = mean.copy(), mean.copy(), mean.copy()
    for i in np.flatnonzero(count > 1):
        mean[i], deviation[i] = np.nanmean(finite[i]), np.nanstd(finite[i], ddof=1)
        low[i], high[i] = np.nanquantile(finite[i], [RARE, 1.0 - RARE])
    return MonteCarlo(values, mean, deviation, low, high, 1.0 - count / values.shape[1])


def power_of_two(samples: int) -> int:
    """Return the least power of two that is not less; Sobol points are even only in such numbers."""
    return 1 << max(samples - 1, 1).bit_length()


def inputs_at(contributors: Sequence[Contributor], drawn: Array) -> Array:
    """Values of inputs at points of the unit cube, a row an input, a column a module."""
    inside = np.clip(drawn, _EDGE, 1.0 - _EDGE)
    return np.array([contributor.ppf(row) for contributor, row in zip(contributors, inside, strict=True)])


def sobol_indices(
    function: Columns, contributors: Sequence[Contributor], samples: int, seed: int, instead: float
) -> tuple[Array, Array]:
    """First-order and total indices of every output by every contributor (Saltelli 2010, scipy).

    `instead` stands for what never happens. Outputs that do not spread have indices of zero.
    """
    from scipy import stats

    def finite(columns: Array) -> Array:
        values = function(np.ascontiguousarray(columns))
        return np.where(np.isfinite(values), values, instead)

    if len(contributors) == 1:  # all there is; scipy asks for two
        values = finite(np.array([contributors[0].ends]))
        alone = (values[:, :1] != values[:, 1:]).astype(float)
        return alone, alone
    dists: list[Any] = list(contributors)
    with np.errstate(invalid="ignore", divide="ignore"):
        indices = stats.sobol_indices(func=finite, n=samples, dists=dists, rng=np.random.default_rng(seed))
    return np.nan_to_num(np.atleast_2d(indices.first_order)), np.nan_to_num(np.atleast_2d(indices.total_order))


def share_kept(satisfied: NDArray[np.bool_]) -> Yield:
    """Return the yield of modules from whether each satisfies a limit."""
    return yield_of(float(np.mean(satisfied)), len(satisfied))


def yield_of(share: float, count: int) -> Yield:
    """Return the yield from the share of so many modules that satisfy a limit."""
    z = _CONFIDENCE
    middle = (share + z**2 / (2.0 * count)) / (1.0 + z**2 / count)
    half = z / (1.0 + z**2 / count) * math.sqrt(share * (1.0 - share) / count + (z / (2.0 * count)) ** 2)
    return Yield(share, max(middle - half, 0.0), min(middle + half, 1.0))


def capability(mean: float, deviation: float, limit: float, sense: str) -> float:
    """Distance of the mean from a limit over three standard deviations, C_pk of one side; infinite without spread."""
    room = limit - mean if sense == "<=" else mean - limit
    return room / (3.0 * deviation) if deviation > 0.0 else math.copysign(math.inf, room)


_NOTHING = 1e-12  # Share of its size that is added to a deviation inside the root, which has no slope at zero


def moments(
    model: DeviceFunctions, tolerances: Mapping[str, Tolerance], outputs: Sequence[str], sizes: Sequence[float]
) -> Any:
    """Return the function inputs -> (shift of the mean, standard deviation) of each output; one column each.

    `sizes` are the outputs' orders of magnitude. The outputs must not depend on a simulation.
    """
    inputs = ca.SX.sym("inputs", len(model.names))
    spreading = [name for name in tolerances if name in model.index]
    values = ca.densify(_of(model, outputs, inputs))
    variance, shift = ca.SX.zeros(len(outputs)), ca.SX.zeros(len(outputs))
    for name in spreading:
        x = inputs[model.index[name]]
        deviation = _deviation(model, tolerances[name], x, inputs)
        slope = ca.jacobian(values, x)
        variance += (slope * deviation) ** 2
        shift += 0.5 * ca.jacobian(slope, x) * deviation**2
    roots = [
        ca.sqrt(variance[i] + (_NOTHING * size) ** 2) if not variance[i].is_zero() else ca.SX(0.0)
        for i, size in enumerate(sizes)
    ]
    return ca.Function("moments", [inputs], [ca.densify(shift), ca.vertcat(*roots)], {"cse": True})


def _of(model: DeviceFunctions, outputs: Sequence[str], inputs: Any) -> Any:
    cycle = ca.DM(np.full(len(model.switch_names), np.nan))
    return model.outputs(outputs).call([inputs, cycle], True, False)[0]


def _deviation(model: DeviceFunctions, tolerance: Tolerance, value: Any, inputs: Any) -> Any:
    """Standard deviation of an input at this design; what is adjusted is no wider than what adjusting leaves."""
    if tolerance.row is not None:
        size = _of(model, [tolerance.row], inputs)
    elif tolerance.share is not None:
        size = tolerance.share * ca.fabs(value)
    else:
        size = ca.SX(tolerance.plus_minus or 0.0)
    if tolerance.adjustable:
        size = ca.fmin(size, tolerance.adjusted_to or 0.0)
    return deviation_of(size, tolerance.distribution, tolerance.sigma)


def moments_at(
    model: DeviceFunctions, tolerances: Mapping[str, Tolerance], outputs: Sequence[str], sizes: Sequence[float],
    inputs: Any,
) -> tuple[Any, Any]:  # fmt: skip
    """Return the shifts of the means and the standard deviations of outputs at a design's inputs."""
    key = f"moments of {list(outputs)} over {list(sizes)} by {dict(tolerances)}"
    shift, deviation = model.built(key, lambda: moments(model, tolerances, outputs, sizes))(inputs)
    return np.asarray(shift).ravel(), np.asarray(deviation).ravel()
