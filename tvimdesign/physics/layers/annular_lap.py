"""A bonded ring between sheets, of which a torque enters one at the inner edge: a lap joint in the round.

With F the share of the torque T that a layer of the stiffness k has handed over from one sheet to the next, up to r,
and the compliances a of its sheets, F'' - 3 F'/r = k (a_below M_below - a_above M_above)/T; F is 0 at the inner edge
and 1 at the outer. Of two sheets, l^2 = k (a_1 + a_2). Of three with two layers between, the same holds of two
mixtures of both F, each with an l of its own: the eigenvectors of what couples them.
Sources: Volkersen, Luftfahrtforschung 15 (1938) 41-47, the same of a straight lap. F, but for what it is far from the
edges, is r^2 times the modified Bessel functions of order 2, here by the first term of their uniform expansion,
e^(+-p)/sqrt(q), q^2 = 4 + l^2 r^2, p' = q/r (NIST Digital Library of Mathematical Functions, 10.41), which is exact
for stiff sheets.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)


class Mode(NamedTuple):
    """A part of the torque that comes over from the upper sheet, besides what has far from the edges."""

    lag: Any
    """Rate at which it comes over [1/m], l."""
    at_inner: Any
    """Its share of the torque [1] at the inner edge."""
    at_outer: Any
    """Its share at the outer edge."""


class AnnularLap(NamedTuple):
    """A ring over which a sheet hands a torque on."""

    modes: tuple[Mode, ...]
    """Load that comes over: one mode for each layer between sheets."""
    rest: Any
    """Share n of the torque [1] that would stay in the upper sheet of a long lap."""
    inner: Any
    """Inner radius [m]."""
    outer: Any
    """Outer radius [m]."""


def annular_lap(layer: Any, upper: Any, lower: Any, radii: tuple[Any, Any]) -> AnnularLap:
    """Return the lap of a layer of the stiffness k per area [Pa/m] between sheets of the compliances 1/(G h)
    [1/(Pa*m)].

    Each counts with the share of the circle that it takes up.
    """
    both = upper + lower
    rest = lower / both
    return AnnularLap((Mode(np.sqrt(layer * both), rest - 1.0, rest),), rest, *radii)


def lap_of_three(layers: tuple[Any, Any], sheets: tuple[Any, Any, Any], radii: tuple[Any, Any]) -> AnnularLap:
    """Return the lap of two layers [Pa/m] between three sheets [1/(Pa*m)]; the torque enters the first and leaves the
    third.

    What each mode has of the first layer's F is its projection, (A - l_other^2)/(l^2 - l_other^2), A what couples both.
    """
    (first, second), (upper, between, lower) = layers, sheets
    own, other, cross = first * (upper + between), second * (between + lower), first * between
    middle, half = 0.5 * (own + other), np.sqrt(0.25 * (own - other) ** 2 + cross * second * between)
    whole = upper * between + upper * lower + between * lower
    long = upper * (between + lower) / whole, upper * between / whole
    modes = []
    for square, away in ((middle + half, middle - half), (middle - half, middle + half)):
        of_first, of_second = (own - away) / (square - away), -cross / (square - away)
        ends = (tuple(edge - one for one in long) for edge in (0.0, 1.0))
        modes.append(Mode(np.sqrt(square), *(of_first * one + of_second * two for one, two in ends)))
    return AnnularLap(tuple(modes), between * lower / whole, *radii)


def edge_rises(lap: AnnularLap) -> tuple[Any, Any]:
    """Return the traction at the inner and at the outer edge over T r_o/J, J the layer's polar moment [1]."""
    a, b, inner, outer = lap.inner, lap.outer, 0.0, 0.0
    for lag, at_inner, at_outer in lap.modes:
        at_a, at_b = _slope(lag * a), _slope(lag * b)
        long = _reach(lag * b) - _reach(lag * a)
        across = np.sqrt(at_a * at_b) / np.sinh(long)
        leaves_inner = at_a / np.tanh(long) + 0.5 * (lag * a / at_a) ** 2 - 2.0
        leaves_outer = at_b / np.tanh(long) - 0.5 * (lag * b / at_b) ** 2 + 2.0
        inner += at_outer * (a / b) ** 2 * across - at_inner * leaves_inner
        outer += at_outer * leaves_outer - at_inner * (b / a) ** 2 * across
    even = 0.25 * (b**4 - a**4)
    return inner * even / (a**3 * b), outer * even / b**4


def upper_share(lap: AnnularLap) -> Any:
    """Return the compliance of the upper sheet over that of its ring turned inner edge against outer [1]."""
    worked = sum(weight * (torque / radius) ** 2 for weight, radius, torque, _ in _nodes(lap))  # it turns by M/r^3
    return worked * lap.inner**2 / (0.5 * (1.0 - (lap.inner / lap.outer) ** 2))


def unevenness(lap: AnnularLap) -> Any:
    """Return the mean square of the layer's traction over that of one in proportion to the radius, of the same torque
    [1]."""
    worked = sum(weight * (slope / radius) ** 2 for weight, radius, _, slope in _nodes(lap))
    return worked * (lap.outer**4 - lap.inner**4) / 4.0


def _nodes(lap: AnnularLap) -> list[tuple[Any, Any, Any, Any]]:
    """Return the weight of dr/r, radius, M/T of the upper sheet and its slope [1/m] at nodes between both edges."""
    a, b, nodes = lap.inner, lap.outer, []
    for node, weight in zip(0.5 * (1.0 + NODES), 0.5 * WEIGHTS * np.log(b / a), strict=True):
        radius = a * np.exp(node * np.log(b / a))
        stays = [_still(mode, (a, b), radius) for mode in lap.modes]
        torque = lap.rest + sum(still for still, _ in stays)
        nodes.append((weight, radius, torque, sum(slope for _, slope in stays) / radius))
    return nodes


def _still(mode: Mode, edges: tuple[Any, Any], radius: Any) -> tuple[Any, Any]:
    """Return what a mode leaves in the upper sheet at a radius, over the torque, and r times its slope [1]."""
    (lag, at_inner, at_outer), (a, b) = mode, edges
    ends, here, slope = (_reach(lag * a), _reach(lag * b)), _reach(lag * radius), _slope(lag * radius)
    whole = np.sinh(ends[1] - ends[0])
    came = -at_inner * (radius / a) ** 2 * np.sqrt(_slope(lag * a) / slope) / whole
    stays = at_outer * (radius / b) ** 2 * np.sqrt(_slope(lag * b) / slope) / whole
    still = came * np.sinh(ends[1] - here) - stays * np.sinh(here - ends[0])
    falls = (came * np.cosh(ends[1] - here) + stays * np.cosh(here - ends[0])) * slope
    return still, still * (2.0 - 0.5 * (lag * radius / slope) ** 2) - falls


def _slope(x: Any) -> Any:
    """Return r p' [1] at l r = x."""
    return np.sqrt(4.0 + x**2)


def _reach(x: Any) -> Any:
    """Return p [1] at l r = x, but for what does not depend on x."""
    return _slope(x) + 2.0 * np.log(x / (2.0 + _slope(x)))
