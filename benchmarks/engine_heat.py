"""Heat flows of a network, their slopes by its state, and their tangents along directions of its numbers.

Temperatures in kelvin, enthalpies of the layer's cells in `HEAT_UNIT`. On the equilibrium curve a cell is one state;
with a history its solid fraction follows an extended variable, which is solved for within each cell (`engine_cells`).
Rows of the cells' table `p`: temperature and its slope by the state, conductivity and its slope, potential and its
slope (equilibrium only).
"""

from __future__ import annotations

import math

from engine_network import Array, Network
from numba import njit

FAST = {"contract", "reassoc", "nsz", "arcp"}
KS, KM, START, END, AIR = 7, 8, 4, 5, 9
"""Places in the material's numbers: conductivities [W/m K], melting window [K], ambient [K]."""
SAME, CORNERS = 0.5, 0.1
"""Differences of temperature taken as none [K], rounded corners of the potential over the window."""


@njit(cache=True, fastmath=FAST)
def potential(kelvin: float, m: Array) -> tuple[float, float]:
    """Return the integral of the conductivity over temperature [W/m] from the melting's start, and the conductivity."""
    window = m[END] - m[START]
    a, b, square = kelvin - m[START], kelvin - m[END], (CORNERS * window) ** 2
    root_a, root_b = math.sqrt(a * a + square), math.sqrt(b * b + square)
    first, last, share = 0.5 * (a + root_a), 0.5 * (b + root_b), (m[KM] - m[KS]) / window
    conducts = m[KS] + share * (first**2 / root_a - last**2 / root_b)
    return m[KS] * a + 0.5 * share * (first**2 - last**2), conducts


@njit(cache=True, fastmath=FAST)
def mean_to(i: int, wall: float, p: Array, m: Array, history: bool) -> tuple[float, float, float]:
    """Return the mean conductivity between a cell and a wall, and its slopes by the cell's state and the wall."""
    if history:
        return p[2, i], p[3, i], 0.0
    apart, (there, at_wall) = wall - p[0, i], potential(wall, m)
    risen, square = there - p[4, i], apart * apart + SAME**2
    mean = (risen * apart + SAME**2 * p[2, i]) / square
    by_cell = (SAME**2 * p[3, i] - p[5, i] * apart - (risen - 2.0 * mean * apart) * p[1, i]) / square
    return mean, by_cell, (at_wall * apart + risen - 2.0 * mean * apart) / square


@njit(cache=True, fastmath=FAST)
def mean_of_pads(hot: float, wall: float, p: Array, m: Array, history: bool) -> tuple[float, float, float, float]:
    """Return the mean conductivity between the pads and a wall, and its slopes by the first cell, pads and wall."""
    if history:
        return p[2, 0], p[3, 0], 0.0, 0.0
    apart, (there, at_wall), (here, at_hot) = wall - hot, potential(wall, m), potential(hot, m)
    risen, square = there - here, apart * apart + SAME**2
    mean = (risen * apart + SAME**2 * p[2, 0]) / square
    steep = risen - 2.0 * mean * apart
    return mean, SAME**2 * p[3, 0] / square, -(at_hot * apart + steep) / square, (at_wall * apart + steep) / square


@njit(cache=True, fastmath=FAST)
def to_wall(
    i: int, wall: float, g: float, other: float, p: Array, m: Array, history: bool
) -> tuple[float, float, float, float]:
    """Return the heat [W] from a cell to a wall through half the cell and another resistance [K/W].

    Then its slopes by the cell's state and the wall's temperature, and the resistance of the half cell.
    """
    mean, by_cell, by_wall = mean_to(i, wall, p, m, history)
    within = 0.5 / (g * mean)
    flow = (p[0, i] - wall) / (within + other)
    bend = flow / (within + other) * within / mean
    return flow, p[1, i] / (within + other) + bend * by_cell, bend * by_wall - 1.0 / (within + other), within


@njit(cache=True, fastmath=FAST)
def surface(kelvin: float, air: float, one: Array) -> tuple[float, float]:
    """Return the heat [W] that a surface loses, and its slope by temperature."""
    area, h, e, behind, series = one[0], one[1], one[2], one[3], one[4]
    over, face, by = kelvin - air, kelvin, 1.0
    if behind != 0.0:
        out = h + e * (kelvin**2 + air**2) * (kelvin + air)
        less = 1.0 / (1.0 + out * behind)
        face = air + over * less
        by = less - over * less**2 * behind * e * (3.0 * kelvin**2 + 2.0 * kelvin * air + air**2)
    out = h + e * (face**2 + air**2) * (face + air)
    less = 1.0 / (1.0 + out * series)
    steep = e * (3.0 * face**2 + 2.0 * face * air + air**2) * by
    return area * out * less * over, area * (out * less + over * less**2 * steep)


@njit(cache=True, fastmath=FAST)
def flows(t: Array, p: Array, q: Array, m: Array, net: Network, history: bool, f: Array) -> None:
    """Heat [W] that every node gets, at the nodes' temperatures `t`."""
    n, hot, first = net.cells, net.cells + net.plate + 2, net.cells
    for i in range(net.nodes):
        f[i] = q[net.constant + i]
    for k in range(net.rows.size):
        f[net.rows[k]] += q[net.linear + k] * t[net.columns[k]]
    for k in range(net.exposed.size):
        lost, _ = surface(t[net.exposed[k]], m[AIR], q[net.surface + 5 * k : net.surface + 5 * k + 5])
        f[net.exposed[k]] -= lost
    for k in range(net.radiating.shape[0]):
        a, b = net.radiating[k, 0], net.radiating[k, 1]
        heat = q[net.pairs + k] * (t[a] ** 4 - t[b] ** 4)
        f[a] -= heat
        f[b] += heat
    g, near, far = q[net.layer], q[net.layer + 1], q[net.layer + 2]
    heat, _, _, _ = to_wall(0, t[hot], g, near, p, m, history)
    f[0] -= heat
    f[hot] += heat
    for i in range(n - 1):
        if history:
            heat = 2.0 * g * (t[i] - t[i + 1]) / (1.0 / p[2, i] + 1.0 / p[2, i + 1])
        else:
            heat = g * (p[4, i] - p[4, i + 1])
        f[i] -= heat
        f[i + 1] += heat
    heat, _, _, _ = to_wall(n - 1, t[first], g, far, p, m, history)
    f[n - 1] -= heat
    f[first] += heat
    if net.lip >= 0:
        _to_lip(t, p, q, m, net, history, f)


@njit(cache=True, fastmath=FAST)
def _to_lip(t: Array, p: Array, q: Array, m: Array, net: Network, history: bool, f: Array) -> None:
    """Heat that the layer's cells and the pads give to the lip through the layer."""
    alike, lip, hot, mean = t[net.lip], t[net.lip + 1], net.cells + net.plate + 2, 0.5 * (m[KS] + m[KM])
    for i in range(net.cells + 1):
        if i < net.cells:
            k, _, _ = mean_to(i, alike, p, m, history)
        else:
            k, _, _, _ = mean_of_pads(t[hot], alike, p, m, history)
        node = i if i < net.cells else hot
        heat = q[net.layer + (8 if i < net.cells else 9)] * k / mean * (t[node] - lip)
        f[node] -= heat
        f[net.lip + 1] += heat


@njit(cache=True, fastmath=FAST)
def slopes(
    t: Array, p: Array, q: Array, m: Array, net: Network, history: bool, a: Array, scale: float, others: float
) -> None:
    """Slopes of the flows by the states, dense, times `scale`.

    `others` is what the temperature of a node without phase change moves by with its state: one, or nothing.
    """
    n, hot, first = net.cells, net.cells + net.plate + 2, net.cells
    a[:, :] = 0.0
    rest = scale * others
    for k in range(net.rows.size):
        c = net.columns[k]
        a[net.rows[k], c] += q[net.linear + k] * (scale * p[1, c] if c < n else rest)
    for k in range(net.exposed.size):
        i = net.exposed[k]
        _, by = surface(t[i], m[AIR], q[net.surface + 5 * k : net.surface + 5 * k + 5])
        a[i, i] -= by * rest
    for k in range(net.radiating.shape[0]):
        one, other, r = net.radiating[k, 0], net.radiating[k, 1], 4.0 * rest * q[net.pairs + k]
        a[one, one] -= r * t[one] ** 3
        a[other, one] += r * t[one] ** 3
        a[one, other] += r * t[other] ** 3
        a[other, other] -= r * t[other] ** 3
    g, near, far = q[net.layer], q[net.layer + 1], q[net.layer + 2]
    for i, wall, other in ((0, hot, near), (n - 1, first, far)):
        _, by_cell, by_wall, _ = to_wall(i, t[wall], g, other, p, m, history)
        a[i, i] -= scale * by_cell
        a[wall, i] += scale * by_cell
        a[i, wall] -= by_wall * rest
        a[wall, wall] += by_wall * rest
    g *= scale
    for i in range(n - 1):
        if history:
            whole = 1.0 / p[2, i] + 1.0 / p[2, i + 1]
            heat = 2.0 * g * (t[i] - t[i + 1]) / whole
            here = 2.0 * g * p[1, i] / whole + heat / whole * p[3, i] / p[2, i] ** 2
            there = -2.0 * g * p[1, i + 1] / whole + heat / whole * p[3, i + 1] / p[2, i + 1] ** 2
        else:
            here, there = g * p[5, i], -g * p[5, i + 1]
        a[i, i] -= here
        a[i + 1, i] += here
        a[i, i + 1] -= there
        a[i + 1, i + 1] += there
    if net.lip >= 0:
        _slopes_to_lip(t, p, q, m, net, history, a, scale, others)


@njit(cache=True, fastmath=FAST)
def _slopes_to_lip(
    t: Array, p: Array, q: Array, m: Array, net: Network, history: bool, a: Array, scale: float, others: float
) -> None:
    """Add the slopes of the heat that the lip gets through the layer."""
    alike, lip, hot, mean = t[net.lip], t[net.lip + 1], net.cells + net.plate + 2, 0.5 * (m[KS] + m[KM])
    for i in range(net.cells):
        k, by_cell, by_wall = mean_to(i, alike, p, m, history)
        share = scale * q[net.layer + 8] / mean
        here = share * (by_cell * (t[i] - lip) + k * p[1, i])
        a[i, i] -= here
        a[net.lip + 1, i] += here
        a[i, net.lip] -= share * by_wall * (t[i] - lip) * others
        a[net.lip + 1, net.lip] += share * by_wall * (t[i] - lip) * others
        a[i, net.lip + 1] += share * k * others
        a[net.lip + 1, net.lip + 1] -= share * k * others
    k, by_cell, by_hot, by_wall = mean_of_pads(t[hot], alike, p, m, history)
    share, over = scale * q[net.layer + 9] / mean, t[hot] - lip
    for node, by in (
        (0, by_cell * over),
        (hot, (by_hot * over + k) * others),
        (net.lip, by_wall * over * others),
        (net.lip + 1, -k * others),
    ):
        a[hot, node] -= share * by
        a[net.lip + 1, node] += share * by


@njit(cache=True, fastmath=FAST)
def tangents(t: Array, p: Array, q: Array, dq: Array, m: Array, net: Network, history: bool, d: Array) -> None:
    """Tangents of the flows along directions `dq` of the numbers at a fixed state, a column each."""
    n, hot, first, count = net.cells, net.cells + net.plate + 2, net.cells, dq.shape[1]
    for i in range(net.nodes):
        for j in range(count):
            d[i, j] = dq[net.constant + i, j]
    for k in range(net.rows.size):
        i, there = net.rows[k], t[net.columns[k]]
        for j in range(count):
            d[i, j] += there * dq[net.linear + k, j]
    for k in range(net.exposed.size):
        _of_surface(t[net.exposed[k]], m[AIR], q, dq, net.surface + 5 * k, d[net.exposed[k]])
    for k in range(net.radiating.shape[0]):
        a, b = net.radiating[k, 0], net.radiating[k, 1]
        apart = t[a] ** 4 - t[b] ** 4
        for j in range(count):
            heat = apart * dq[net.pairs + k, j]
            d[a, j] -= heat
            d[b, j] += heat
    g = q[net.layer]
    for i, wall, place in ((0, hot, 1), (n - 1, first, 2)):
        other = q[net.layer + place]
        flow, _, _, within = to_wall(i, t[wall], g, other, p, m, history)
        by = flow / (within + other)
        for j in range(count):
            heat = by * (within / g * dq[net.layer, j] - dq[net.layer + place, j])
            d[i, j] -= heat
            d[wall, j] += heat
    for i in range(n - 1):
        by = 2.0 * (t[i] - t[i + 1]) / (1.0 / p[2, i] + 1.0 / p[2, i + 1]) if history else p[4, i] - p[4, i + 1]
        for j in range(count):
            heat = by * dq[net.layer, j]
            d[i, j] -= heat
            d[i + 1, j] += heat
    if net.lip >= 0:
        _tangents_to_lip(t, p, dq, m, net, history, d)


@njit(cache=True, fastmath=FAST)
def _tangents_to_lip(t: Array, p: Array, dq: Array, m: Array, net: Network, history: bool, d: Array) -> None:
    """Add the tangents of the heat that the lip gets through the layer."""
    n, hot, count = net.cells, net.cells + net.plate + 2, dq.shape[1]
    alike, lip, mean = t[net.lip], t[net.lip + 1], 0.5 * (m[KS] + m[KM])
    for i in range(n + 1):
        if i < n:
            k, _, _ = mean_to(i, alike, p, m, history)
        else:
            k, _, _, _ = mean_of_pads(t[hot], alike, p, m, history)
        node, place = (i, net.layer + 8) if i < n else (hot, net.layer + 9)
        by = k / mean * (t[node] - lip)
        for j in range(count):
            d[node, j] -= by * dq[place, j]
            d[net.lip + 1, j] += by * dq[place, j]


@njit(cache=True, fastmath=FAST)
def _of_surface(kelvin: float, air: float, q: Array, dq: Array, at: int, d: Array) -> None:
    """Tangents of what a surface loses, taken from what its node gets."""
    area, h, e, behind, series = q[at], q[at + 1], q[at + 2], q[at + 3], q[at + 4]
    over, face, by_h, by_behind = kelvin - air, kelvin, 0.0, 0.0
    if behind != 0.0:
        out = h + e * (kelvin**2 + air**2) * (kelvin + air)
        less = 1.0 / (1.0 + out * behind)
        face = air + over * less
        by_h, by_behind = -over * less**2 * behind, -over * less**2 * out
    out = h + e * (face**2 + air**2) * (face + air)
    less, steep = 1.0 / (1.0 + out * series), e * (3.0 * face**2 + 2.0 * face * air + air**2)
    by_out = area * over * less**2
    for j in range(dq.shape[1]):
        lost = out * less * over * dq[at, j] + by_out * (1.0 + steep * by_h) * dq[at + 1, j]
        d[j] -= lost + by_out * (steep * by_behind * dq[at + 3, j] - out**2 * dq[at + 4, j])
