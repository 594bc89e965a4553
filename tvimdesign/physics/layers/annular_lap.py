"""A bonded ring between two sheets, of which a torque enters one at the inner edge: a lap joint in the round.

With M the torque of the upper sheet, T all of it, and the sheets' compliances a_1, a_2,
M'' - 3 M'/r = k (a_1 + a_2) (M - n T), M = T at the inner edge and 0 at the outer, n = a_2/(a_1 + a_2).
Sources: Volkersen, Luftfahrtforschung 15 (1938) 41-47, the same of a straight lap. M - n T is r^2 times the modified
Bessel functions of order 2, here by the first term of their uniform expansion, e^(+-p)/sqrt(q), q^2 = 4 + l^2 r^2,
p' = q/r (NIST Digital Library of Mathematical Functions, 10.41), which is exact for stiff sheets.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)


class AnnularLap(NamedTuple):
    """A ring that two sheets hand a torque over."""

    lag: Any
    """How fast the torque comes over [1/m], l: l^2 = k (a_1 + a_2)."""
    rest: Any
    """Share n of the torque [1] that would stay in the upper sheet of a long lap, a_2/(a_1 + a_2)."""
    inner: Any
    """Inner radius [m]."""
    outer: Any
    """Outer radius [m]."""


def annular_lap(layer: Any, upper: Any, lower: Any, radii: tuple[Any, Any]) -> AnnularLap:
    """Lap of a layer of the stiffness k per area [Pa/m] between sheets of the compliances 1/(G h) [1/(Pa*m)].

    Each counts with the share of the circle that it takes up.
    """
    both = upper + lower
    return AnnularLap(np.sqrt(layer * both), lower / both, *radii)


def edge_rises(lap: AnnularLap) -> tuple[Any, Any]:
    """Traction at the inner and at the outer edge over T r_o/J, J the layer's polar moment [1]."""
    a, b, rest = lap.inner, lap.outer, lap.rest
    at_a, at_b = _slope(lap.lag * a), _slope(lap.lag * b)
    long = _reach(lap.lag * b) - _reach(lap.lag * a)
    across = np.sqrt(at_a * at_b) / np.sinh(long)
    leaves_inner = at_a / np.tanh(long) + 0.5 * (lap.lag * a / at_a) ** 2 - 2.0
    leaves_outer = at_b / np.tanh(long) - 0.5 * (lap.lag * b / at_b) ** 2 + 2.0
    inner = (1.0 - rest) * leaves_inner + rest * (a / b) ** 2 * across
    outer = rest * leaves_outer + (1.0 - rest) * (b / a) ** 2 * across
    even = 0.25 * (b**4 - a**4)
    return inner * even / (a**3 * b), outer * even / b**4


def upper_share(lap: AnnularLap) -> Any:
    """Compliance of the upper sheet over that of its ring turned inner edge against outer [1]."""
    worked = sum(weight * (torque / radius) ** 2 for weight, radius, torque, _ in _nodes(lap))  # it turns by M/r^3
    return worked * lap.inner**2 / (0.5 * (1.0 - (lap.inner / lap.outer) ** 2))


def unevenness(lap: AnnularLap) -> Any:
    """Mean square of the layer's traction over that of one in proportion to the radius, of the same torque [1]."""
    worked = sum(weight * (slope / radius) ** 2 for weight, radius, _, slope in _nodes(lap))
    return worked * (lap.outer**4 - lap.inner**4) / 4.0


def _nodes(lap: AnnularLap) -> list[tuple[Any, Any, Any, Any]]:
    """Weight of dr/r, radius, M/T and its slope [1/m] at nodes between both edges."""
    a, b, rest = lap.inner, lap.outer, lap.rest
    ends = _reach(lap.lag * a), _reach(lap.lag * b)
    whole, found = np.sinh(ends[1] - ends[0]), []
    for node, weight in zip(0.5 * (1.0 + NODES), 0.5 * WEIGHTS * np.log(b / a), strict=True):
        radius = a * np.exp(node * np.log(b / a))
        here, slope = _reach(lap.lag * radius), _slope(lap.lag * radius)
        came = (1.0 - rest) * (radius / a) ** 2 * np.sqrt(_slope(lap.lag * a) / slope) / whole
        stays = rest * (radius / b) ** 2 * np.sqrt(_slope(lap.lag * b) / slope) / whole
        still = came * np.sinh(ends[1] - here) - stays * np.sinh(here - ends[0])
        falls = (came * np.cosh(ends[1] - here) + stays * np.cosh(here - ends[0])) * slope
        grows = still * (2.0 - 0.5 * (lap.lag * radius / slope) ** 2)
        found.append((weight, radius, rest + still, (grows - falls) / radius))
    return found


def _slope(x: Any) -> Any:
    """r p' [1] at l r = x."""
    return np.sqrt(4.0 + x**2)


def _reach(x: Any) -> Any:
    """p [1] at l r = x, but for what does not depend on x."""
    return _slope(x) + 2.0 * np.log(x / (2.0 + _slope(x)))
