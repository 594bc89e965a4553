"""A sampled motion of the link, what is read off it, and the steps in which it is sampled.

Samples come in stretches of one step each. Steps that double from stretch to stretch resolve microseconds and hours in
a few hundred samples, and no step is too long for a stiff system, as the matrix exponential carries the state.

The structure's loss in motions in time: Maxwell elements that lose as much at every pace, in series with the PCL.

A stiffness with a constant loss factor eta goes as (i omega)^alpha, alpha = 2/pi atan(eta): with a loss at every pace a
structure is the stiffer the quicker it is loaded. Maxwell elements whose strengths go as tau^-alpha are that law
between the quickest and the slowest of them (Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 4). Such a
structure behind a PCL of Maxwell elements is once more a body of Maxwell elements, those of `in_series`, behind a
rigid structure.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.physics.motions import one_sided
from tvimdesign.physics.motions.motion import Joint, Modes
from tvimdesign.physics.motions.one_sided import Touching

Array = NDArray[np.float64]
Stretch = tuple[float, int]  # (step [s], count of steps)
PER_STRETCH = 24  # samples of one doubling of time
SAMPLES_A_PERIOD = 24
DEAD = 1e-3  # share of its start at which a swing is no longer worth its samples, and the whole motion is over
LONGEST = 3600.0  # s, after which a release is given up
MOST_SAMPLES = 6_000  # what a joint that hardly damps is shown for
RESTING = 1e-12  # Share of the largest speed up to which a link rests
TURNS_OF_A_SWING = 2


@dataclass(frozen=True)
class Motion:
    """A motion, sampled: times [s], angle [rad], torque of the module on the link [N*m], stored energy [J]."""

    times: Array
    angle: Array
    speed: Array
    internal: Array  # Internal angle of each mode [rad], one row a mode
    torque: Array
    energy: Array
    stretches: tuple[Stretch, ...]  # The steps in which it was sampled


@dataclass(frozen=True)
class ContactEvent:
    """A block left or met."""

    time: float  # [s]
    side: int  # 0: the first block, 1: the second
    touching: bool  # True if it touches from here on


@dataclass(frozen=True)
class OneSided:
    """A motion between blocks; every event is one of its samples."""

    motion: Motion  # `internal` has the rows of the first block, then those of the second
    touching: NDArray[np.bool_]  # True where a block touches from a sample to the next; one row a block
    events: tuple[ContactEvent, ...]
    rest_angle: float | None = None
    """Angle at which friction holds the link for good [rad]; None where it is free, or still moves."""

    def lost_share(self, start: float, end: float) -> float:
        """Return the share of the time between two moments [s] in which no block touches."""
        return self.average(one_sided.out_of_contact(Touching(*self.touching.astype(float))), start, end)

    def average(self, values: Array, start: float, end: float) -> float:
        """Return the mean over the time between two moments [s] of what has one value from a sample to the next."""
        edges = np.clip(self.motion.times, start, end)
        return float(np.sum(np.diff(edges) * values[:-1]) / (end - start))

    def first_swing(self) -> float:
        """Return time [s] at which the link turns round for the second time; the end of the motion if it never does."""
        turns = turns_of(self.motion.speed)
        enough = len(turns) >= TURNS_OF_A_SWING
        return float(self.motion.times[turns[TURNS_OF_A_SWING - 1]] if enough else self.motion.times[-1])

    def settling_time(self, share: float) -> float:
        """Return time [s] after which it stays within a share of its start from its rest; infinite if that is not seen.

        A curve that ends while the link swings may end just as it passes its rest: a whole swing must be within.
        """
        times, turns = self.motion.times, turns_of(self.motion.speed)
        settled = settling_time(times, self.motion.angle - (self.rest_angle or 0.0), share)
        if self.rest_angle is None and len(turns) > TURNS_OF_A_SWING:
            swing = times[turns[-1]] - times[turns[-1 - TURNS_OF_A_SWING]]
            return settled if times[-1] - settled >= swing else float("inf")
        return settled


def turns_of(speed: Array) -> NDArray[np.int64]:
    """Return samples just after a link that started at rest has turned round."""
    # At rest, at the start or where friction stops it, a link has the speed of rounding.
    moving = np.flatnonzero(np.abs(speed[1:]) > RESTING * np.max(np.abs(speed))) + 1
    return moving[1:][speed[moving[1:]] * speed[moving[:-1]] < 0.0]


def settling_time(times: Array, angle: Array, share: float) -> float:
    """Return time [s] after which the angle stays within a share of its start; infinite if not within the samples."""
    limit = share * abs(angle[0])
    last = int(np.flatnonzero(np.abs(angle) > limit)[-1])
    if last + 1 == len(times):
        return float("inf")
    before, after = abs(angle[last]), abs(angle[last + 1])
    return float(times[last] + (before - limit) / (before - after) * (times[last + 1] - times[last]))


def doubling(first: float, last: float) -> list[Stretch]:
    """Return stretches from 0 to `last`: the first of step `first`, each later one of twice the step before."""
    stretches: list[Stretch] = []
    time, step = 0.0, min(first, last / PER_STRETCH)
    while time < last * (1.0 - 1e-9):
        count = min(PER_STRETCH, int(np.ceil((last - time) / step - 1e-9)))
        stretches.append((min(step, (last - time) / count), count))
        time, step = time + stretches[-1][0] * count, 2.0 * step
    return stretches


def growing(first: float, values: Array) -> Iterator[Stretch]:
    """Return stretches whose step doubles as soon as every swing that still lives is sampled finely enough."""
    swings = [(-value.real, 2.0 * np.pi / (value.imag * SAMPLES_A_PERIOD)) for value in values if value.imag > 0.0]
    time, step = 0.0, first
    while time < LONGEST:
        count = min(PER_STRETCH, int(np.ceil((LONGEST - time) / step)))
        yield step, count
        time += step * count
        finest = min((need for decay, need in swings if decay * time < -np.log(DEAD)), default=np.inf)
        if 2.0 * step <= finest:
            step *= 2.0


def stretches_of(durations: Iterable[float]) -> tuple[Stretch, ...]:
    """Return steps of the same length, one after the other, as stretches."""
    stretches: list[Stretch] = []
    for step in durations:
        same = bool(stretches) and stretches[-1][0] == step
        stretches[-1:] = [(step, stretches[-1][1] + 1)] if same else [*stretches[-1:], (step, 1)]
    return tuple(stretches)


BAND = (0.1, 100.0)  # Frequencies [Hz] between which elements follow the law, and wider where a point lies out
BEYOND = 10.0  # Factor by which the elements reach beyond that band
PER_DECADE = 1.5  # With these the stiffness is within 0.5 % of the law in the band, and its loss factor within 1 %
FITTED = 40  # Frequencies in the band at which the elements are fitted
EXACT = 1e3  # Weight of the point's own frequency, to be met exactly, over that of the others
RIGID = 1e12  # Stiffness of a structure whose give is in the modes [N*m/rad]
HALVINGS = 80
REACH = 40.0  # Logit of the share of an interval within which a rate is sought: to 1e-17 of its ends
APART = 1e-7  # Share by which a rate of the structure is moved where the PCL has the same


def with_loss(joint: Joint, modes: Modes, loss: float, frequency: float) -> tuple[Joint, Modes]:
    """Return joint and modes that have the structure's stiffness and loss [N*m/rad] at a frequency [Hz]; floats.

    A structure without loss stays as it is.
    """
    if loss <= 0.0:
        return joint, modes
    spring, elements = spectrum(float(joint.structure_stiffness), loss, frequency)
    return joint._replace(structure_stiffness=RIGID), in_series(modes, spring, elements)


def spectrum(stiffness: float, loss: float, frequency: float) -> tuple[float, Modes]:
    """Return spring [N*m/rad] and elements (time [s], stiffness [N*m/rad]) of a loss factor, exact at a frequency.

    Least squares without negative stiffnesses, of what each is of the law at frequencies over the band.
    """
    from scipy.optimize import nnls

    low, high = min(BAND[0], frequency), max(BAND[1], frequency)
    count = int(np.ceil(PER_DECADE * np.log10(high / low * BEYOND**2))) + 1
    times = 1.0 / (2.0 * np.pi * np.geomspace(low / BEYOND, high * BEYOND, count))
    frequencies = np.append(np.geomspace(low, high, FITTED), frequency)
    weights = np.append(np.ones(FITTED), EXACT)[:, None]
    power = 2.0 / np.pi * np.arctan2(loss, stiffness)
    law = complex(stiffness, loss) * (frequencies / frequency) ** power
    turns = 2j * np.pi * frequencies[:, None] * times
    shares = np.column_stack([np.ones(len(law)), turns / (1.0 + turns)]) / law[:, None] * weights
    lossier = max(stiffness / loss, 1.0)  # a loss that is small counts as much
    weights_found, _ = nnls(np.concatenate([shares.real, shares.imag * lossier]), np.append(weights, 0.0 * weights))
    return float(weights_found[0]), [
        (float(t), float(k)) for t, k in zip(times, weights_found[1:], strict=True) if k > 0.0
    ]


def in_series(layer: Modes, spring: float, elements: Modes) -> Modes:
    """Return the modes of a layer of Maxwell elements in series with a spring beside Maxwell elements, or alone.

    K = Q S/(Q + S) with Q, S = sum k s/(s + r) along s = -x: one zero of Q + S lies below the least rate r and one
    between each two, and is the rate of a mode; its stiffness is Q^2/(x d(Q + S)/ds) there.
    """
    of_layer, of_structure = (np.array(modes, dtype=float).reshape(-1, 2).T for modes in (layer, elements))
    rates = _apart(1.0 / of_layer[0], 1.0 / of_structure[0])
    stiffnesses = np.concatenate([of_layer[1], of_structure[1]])
    order = np.argsort(rates)
    ends = np.concatenate([[0.0], rates[order]])
    zeros, gaps = _zeros(ends, stiffnesses[order], spring)
    own = order < len(of_layer[0])
    behind = zeros[:, None] * stiffnesses[order] / gaps
    slope = stiffnesses[order] * rates[order] / gaps**2
    strengths = np.sum(behind[:, own], axis=1) ** 2 / (zeros * np.sum(slope, axis=1))
    first = 0 if spring > 0.0 else 1  # without a spring the structure flows, and the slowest mode bears nothing
    return list(zip((1.0 / zeros[first:]).tolist(), strengths[first:].tolist(), strict=True))


def _apart(layer: Array, structure: Array) -> Array:
    """Return all rates [1/s], none of the structure's the same as one of the layer's."""
    same = np.any(np.abs(structure[:, None] / layer - 1.0) < APART, axis=1)
    return np.concatenate([layer, np.where(same, structure * (1.0 + 2.0 * APART), structure)])


def _zeros(ends: Array, stiffnesses: Array, spring: float) -> tuple[Array, Array]:
    """Return zeros x of spring + sum k x/(x - r) between each two ends, and x - r, a row a zero, exact at the ends."""
    width, count = np.diff(ends), len(stiffnesses)
    low, high = np.full(count, -REACH), np.full(count, REACH)
    below, above = np.arange(1, count), np.arange(count)

    def at(logit: Array) -> tuple[Array, Array]:
        share = 1.0 / (1.0 + np.exp(-logit))
        zeros = ends[:-1] + width * share
        gaps = zeros[:, None] - ends[1:]
        gaps[above, above] = -width / (1.0 + np.exp(logit))
        gaps[below, below - 1] = (width * share)[1:]
        return zeros, gaps

    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        roots, gaps = at(middle)
        rising = spring + np.sum(stiffnesses * roots[:, None] / gaps, axis=1) > 0.0
        low, high = np.where(rising, middle, low), np.where(rising, high, middle)
    return at(0.5 * (low + high))
