"""The fixed program: a phase stepped through to its event, with peaks, energy, and derivatives along directions.

Singly diagonally implicit Runge-Kutta steps with a full Newton; sensitivities go along by the factors that each
stage's Newton ended with. Times of steps are a smooth number of the network, and the last step is as long as the event
needs, so that times are smooth in the design. The last direction is the length of the last step.
"""

from __future__ import annotations

import math

import numpy as np
from engine_cells import BY_PSI_K, BY_PSI_T, INVERSE, PSI, PSI_BY, RATE, freezing, frozen, melting
from engine_heat import FAST, flows, slopes, tangents, to_wall
from engine_network import Array, Network
from numba import njit

GAMMA = 1.0 - math.sqrt(0.5)
SECOND = np.array([[GAMMA, 0.0], [1.0 - GAMMA, GAMMA]])
_G = 0.4358665215084590
THIRD = np.array(
    [[_G, 0.0, 0.0], [0.5 * (1.0 - _G), _G, 0.0], [4.0 * _G - 1.5 * _G**2 - 0.25, 1.5 * _G**2 - 5.0 * _G + 1.25, _G]]
)
"""Alexander's methods of second and third order; both are stiffly accurate."""
NEWTON, EXACT = 12, 1e-3
"""Newton's steps at most; the change [K] below which one is the last: what is left is about its square."""
FIRST, GROWTH, LONGEST = 0.2, 2.5, 2000
SEARCHES, THERE = 20, 1e-4
"""Steps to the event at most, and from how near [K] its slope leads there."""
NEAR, MEAN, FAR, HOT, RIM, POWER, VOLTAGE, COLD, FROZEN, SOFT = range(10)
"""What is watched: faces and mean of the layer, pads' hot side, plate's face [K], power [W], voltage [V], pads' cold
side [K], least solid fraction [1], how soft the joint is beyond its threshold, as a logarithm."""
WATCHED = 10


@njit(cache=True, fastmath=FAST)
def factor(w: Array, net: Network) -> None:
    """Factor in place without pivots, by the network's pattern."""
    for k in range(net.nodes):
        inverse = 1.0 / w[k, k]
        w[k, k] = inverse
        for r in range(net.below_at[k], net.below_at[k + 1]):
            i = net.below[r]
            share = w[i, k] * inverse
            w[i, k] = share
            for c in range(net.right_at[k], net.right_at[k + 1]):
                w[i, net.right[c]] -= share * w[k, net.right[c]]


@njit(cache=True, fastmath=FAST)
def solve(w: Array, b: Array, net: Network) -> None:
    """Solve for the columns of `b` in place, by the factors."""
    count = b.shape[1]
    for i in range(net.nodes):
        for c in range(net.left_at[i], net.left_at[i + 1]):
            share = w[i, net.left[c]]
            for j in range(count):
                b[i, j] -= share * b[net.left[c], j]
    for k in range(net.nodes - 1, -1, -1):
        for c in range(net.right_at[k], net.right_at[k + 1]):
            share = w[k, net.right[c]]
            for j in range(count):
                b[k, j] -= share * b[net.right[c], j]
        for j in range(count):
            b[k, j] *= w[k, k]


@njit(cache=True, fastmath=FAST)
def solve_one(w: Array, b: Array, net: Network) -> None:
    """Solve for one vector in place, by the factors."""
    for i in range(net.nodes):
        whole = b[i]
        for c in range(net.left_at[i], net.left_at[i + 1]):
            whole -= w[i, net.left[c]] * b[net.left[c]]
        b[i] = whole
    for k in range(net.nodes - 1, -1, -1):
        whole = b[k]
        for c in range(net.right_at[k], net.right_at[k + 1]):
            whole -= w[k, net.right[c]] * b[net.right[c]]
        b[k] = whole * w[k, k]


@njit(cache=True, fastmath=FAST)
def temperatures(y: Array, base: Array, h: float, net: Network, m: Array, history: bool, p: Array, t: Array) -> None:
    """Fill the cells' table and the nodes' temperatures; `base` and `h` are those of psi's stage."""
    if history:
        freezing(y, base, h, net.cells, m, p)
    else:
        melting(y, net.cells, m, p)
    t[:] = y
    t[: net.cells] = p[0]


@njit(cache=True, fastmath=FAST)
def stage(
    y: Array,
    s: Array,
    base: Array,
    sb: Array,
    h: float,
    lengths: Array,
    q: Array,
    dq: Array,
    m: Array,
    net: Network,
    history: bool,
    p: Array,
    t: Array,
    w: Array,
    direct: Array,
) -> bool:
    """Solve M (y - base) = h f(y) from y, where M are the capacities, and the sensitivities.

    States and `s` hold psi of each cell after the nodes. `lengths` is what h moves by along each direction.
    """
    n, nodes = net.cells, net.nodes
    f, right = np.empty(nodes), np.empty(nodes)
    done = False
    for _ in range(NEWTON):
        temperatures(y[:nodes], base[nodes:], h, net, m, history, p, t)
        flows(t, p, q, m, net, history, f)
        slopes(t, p, q, m, net, history, w, -h, 1.0)
        for i in range(nodes):
            w[i, i] += q[i]
            right[i] = q[i] * (base[i] - y[i]) + h * f[i]
        factor(w, net)
        solve_one(w, right, net)
        far = 0.0
        for i in range(nodes):
            y[i] += right[i]
            far = max(far, abs(right[i]))
        if not far > EXACT:
            done = not math.isnan(far)
            break
    temperatures(y[:nodes], base[nodes:], h, net, m, history, p, t)
    if history:
        y[nodes:] = p[PSI]
    d, count = np.empty((nodes, dq.shape[1])), dq.shape[1]
    tangents(t, p, q, dq, m, net, history, d)
    for i in range(nodes):
        moved = y[i] - base[i]
        rate = q[i] * moved / h
        for j in range(count):
            d[i, j] = q[i] * sb[i, j] - dq[i, j] * moved + h * d[i, j] + lengths[j] * rate
    if history:
        _of_history(sb, h, lengths, q, m, net, p, t, direct, d)
    solve(w, d, net)
    s[:nodes] = d
    if history:
        for i in range(n):
            for j in range(count):
                s[nodes + i, j] = direct[i, j] + p[PSI_BY, i] * d[i, j]
    return done


@njit(cache=True, fastmath=FAST)
def _of_history(
    sb: Array, h: float, lengths: Array, q: Array, m: Array, net: Network, p: Array, t: Array, direct: Array, d: Array
) -> None:
    """Add to tangents what psi moves by at a fixed enthalpy, its base and the step's length moving."""
    n, count = net.cells, d.shape[1]
    other, moved = p.copy(), np.empty((net.nodes, net.nodes))
    other[1], other[3] = p[BY_PSI_T], p[BY_PSI_K]
    slopes(t, other, q, m, net, True, moved, h, 0.0)
    for k in range(n):
        for j in range(count):
            direct[k, j] = p[INVERSE, k] * (sb[net.nodes + k, j] + lengths[j] * p[RATE, k])
    for i in range(net.nodes):
        for k in range(n):
            if moved[i, k] != 0.0:
                share = moved[i, k]
                for j in range(count):
                    d[i, j] += share * direct[k, j]


@njit(cache=True, fastmath=FAST)
def step(
    y: Array,
    s: Array,
    h: float,
    lengths: Array,
    q: Array,
    dq: Array,
    m: Array,
    net: Network,
    history: bool,
    tableau: Array,
    p: Array,
    t: Array,
    w: Array,
    direct: Array,
    ahead: Array,
) -> bool:
    """Take one step in place. `ahead` is what the state is expected to move by in the first stage, then in the last."""
    stages, gamma = tableau.shape[0], tableau[0, 0]
    base, sb, begin, sbegin, good = y.copy(), s.copy(), y.copy(), s.copy(), True
    slope, of_slope = np.empty((stages, y.size)), np.empty((stages, s.shape[0], s.shape[1]))
    for i in range(stages):
        base[:] = begin
        sb[:] = sbegin
        for j in range(i):
            share = tableau[i, j] / gamma
            base += share * slope[j]
            sb += share * of_slope[j]
        y[:] = base + (slope[i - 1] if i > 0 else ahead)
        good = stage(y, s, base, sb, gamma * h, gamma * lengths, q, dq, m, net, history, p, t, w, direct) and good
        slope[i] = y - base
        of_slope[i] = s - sb
    ahead[:] = slope[stages - 1]
    return good


@njit(cache=True, fastmath=FAST)
def watch(
    y: Array,
    s: Array,
    q: Array,
    dq: Array,
    m: Array,
    net: Network,
    history: bool,
    p: Array,
    t: Array,
    direct: Array,
    o: Array,
    do: Array,
) -> None:
    """What is watched at an instant, and its derivatives along the directions."""
    n, first, count = net.cells, net.cells, s.shape[1]
    cold, hot = n + net.plate, n + net.plate + 2
    for i, wall, place, face in ((0, hot, 1, 0), (n - 1, first, 2, 2)):
        g, other = q[net.layer], q[net.layer + place]
        flow, by_cell, by_wall, within = to_wall(i, t[wall], g, other, p, m, history)
        o[face] = t[wall] + other * flow
        if face == FAR:
            o[RIM] = t[wall] + q[net.layer + 3] * flow
        for j in range(count):
            moved = by_cell * s[i, j] + by_wall * s[wall, j]
            moved += flow / (within + other) * (within / g * dq[net.layer, j] - dq[net.layer + place, j])
            if history:
                by_k = flow * within / p[2, i] * p[BY_PSI_K, i]
                moved += (p[BY_PSI_T, i] + by_k) / (within + other) * direct[i, j]
            do[face, j] = s[wall, j] + other * moved + flow * dq[net.layer + place, j]
            if face == FAR:
                do[RIM, j] = s[wall, j] + q[net.layer + 3] * moved + flow * dq[net.layer + 3, j]
    seebeck, resistance, current = q[net.layer + 4], q[net.layer + 5], q[net.layer + 6]
    o[HOT], o[COLD] = t[hot], t[cold]
    signed = seebeck * (t[hot] - t[cold]) + current * resistance
    o[VOLTAGE] = abs(signed)
    power = current * signed
    root = math.sqrt(power * power + 1e-4)
    o[POWER] = 0.5 * (power + root)
    o[MEAN], o[FROZEN], sharp = 0.0, 0.0, 0.0
    for i in range(n):
        o[MEAN] += t[i] / n
        if history:
            sharp += math.exp(-80.0 * (frozen(y[net.nodes + i], m[11])[0] - 0.5)) / n
    if history:
        o[FROZEN] = 0.5 - math.log(sharp) / 80.0
    do[FROZEN] = 0.0
    for j in range(count):
        do[HOT, j], do[COLD, j], do[MEAN, j] = s[hot, j], s[cold, j], 0.0
        moved = (t[hot] - t[cold]) * dq[net.layer + 4, j] + seebeck * (s[hot, j] - s[cold, j])
        moved += current * dq[net.layer + 5, j] + resistance * dq[net.layer + 6, j]
        do[VOLTAGE, j] = moved if signed > 0.0 else -moved
        do[POWER, j] = 0.5 * (1.0 + power / root) * (current * moved + signed * dq[net.layer + 6, j])
    for i in range(n):
        fraction, by = frozen(y[net.nodes + i], m[11]) if history else (0.0, 0.0)
        for j in range(count):
            do[MEAN, j] += p[1, i] * s[i, j] / n
            if history:
                do[MEAN, j] += p[BY_PSI_T, i] * direct[i, j] / n
                do[FROZEN, j] += math.exp(-80.0 * (fraction - 0.5)) / n / sharp * by * s[net.nodes + i, j]
