"""The structure's loss in motions in time: Maxwell elements that lose as much at every pace, in series with the PCL.

A stiffness with a constant loss factor eta goes as (i omega)^alpha, alpha = 2/pi atan(eta): with a loss at every pace a
structure is the stiffer the quicker it is loaded. Maxwell elements whose strengths go as tau^-alpha are that law
between the quickest and the slowest of them (Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 4). Such a
structure behind a PCL of Maxwell elements is once more a body of Maxwell elements, those of `in_series`, behind a
rigid structure.
"""

from __future__ import annotations

import numpy as np

from tvimdesign.physics.motions.motion import Joint, Modes
from tvimdesign.simulation.link_motion.sampled_motion import Array

BAND = (0.1, 100.0)
"""Frequencies [Hz] between which elements follow the law, and wider where a point lies out."""
BEYOND = 10.0
"""Factor by which the elements reach beyond that band."""
PER_DECADE = 1.5
"""With these the stiffness is within 0.5 % of the law in the band, and its loss factor within 1 %."""
FITTED = 40
"""Frequencies in the band at which the elements are fitted."""
EXACT = 1e3
"""Weight of the point's own frequency, to be met exactly, over that of the others."""
RIGID = 1e12
"""Stiffness of a structure whose give is in the modes [N*m/rad]."""
HALVINGS = 80
REACH = 40.0
"""Logit of the share of an interval within which a rate is sought: to 1e-17 of its ends."""
APART = 1e-7
"""Share by which a rate of the structure is moved where the PCL has the same."""


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
