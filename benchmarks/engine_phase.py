"""One phase of the working cycle: from its start to the event that ends it."""

from __future__ import annotations

import numpy as np
from engine_cells import PSI, ROWS, extended, ramp
from engine_heat import FAST
from engine_layer import softness
from engine_network import HEAT_UNIT, Array, Network
from engine_steps import FIRST, GROWTH, LONGEST, SEARCHES, SOFT, THERE, WATCHED, step, temperatures, watch
from numba import njit

TIME = WATCHED
"""Row of the results that holds the time of the event [s]."""


@njit(cache=True, fastmath=FAST)
def phase(
    y: Array,
    s: Array,
    q: Array,
    dq: Array,
    m: Array,
    r: Array,
    net: Network,
    history: bool,
    tableau: Array,
    which: int,
    target: float,
    sense: float,
    ends: Array,
    of_ends: Array,
    peaks: Array,
    of_peaks: Array,
) -> int:
    """Step from `y` with sensitivities `s` to where what is watched passes a target.

    The last column of `dq` and `s` is zero: it is the direction of a step's length. On return `y` and `s` are at the
    event. `ends` holds what is watched there, then the time, `peaks` the maxima; `of_ends` and `of_peaks` their
    derivatives along the directions. Returns the count of steps, or -1 where there is no end.
    """
    last, nodes = dq.shape[1] - 1, net.nodes
    pace, p, t, w = q[net.layer + 7], np.zeros((ROWS, net.cells)), np.empty(nodes), np.empty((nodes, nodes))
    direct, o, do = np.zeros((net.cells, last + 1)), np.zeros(WATCHED), np.zeros((WATCHED, last + 1))
    if history:
        p[PSI] = y[nodes:]
        direct[:] = s[nodes:]
    temperatures(y[:nodes], y[nodes:], 0.0, net, m, history, p, t)
    _look(y, s, q, dq, m, r, net, history, which, p, t, direct, o, do, False)
    peaks[:WATCHED], of_peaks[:WATCHED] = o, do
    before, sbefore, ahead, lengths = y.copy(), s.copy(), np.zeros(y.size), np.zeros(last + 1)
    share, passed, gap, steps, rise = FIRST, 0.0, sense * (o[which] - target), 0, 0.0
    length, last_gap, last_rise = 0.0, gap, 0.0
    while gap < 0.0:
        before[:], sbefore[:], last_gap, last_rise = y, s, gap, rise
        length = share * pace
        lengths[:] = share * dq[net.layer + 7]
        lengths[last] = 1.0
        good = step(y, s, length, lengths, q, dq, m, net, history, tableau, p, t, w, direct, ahead)
        _look(y, s, q, dq, m, r, net, history, which, p, t, direct, o, do, False)
        gap, rise, steps = sense * (o[which] - target), sense * do[which, last], steps + 1
        if not good or steps > LONGEST:
            return -1
        if gap < 0.0:
            passed += share
            _keep(peaks, of_peaks, o, do)
            s[:, last] = 0.0
            ahead *= min(1.0 / share, GROWTH)
            share = min(1.0, GROWTH * share)
    if steps > 0:
        low, high = 0.0, length
        length = _within(length, last_gap, gap, last_rise, rise)
        lengths[:last] = 0.0
        for _ in range(SEARCHES):
            y[:], s[:] = before, sbefore
            ahead[:] = 0.0
            step(y, s, length, lengths, q, dq, m, net, history, tableau, p, t, w, direct, ahead)
            _look(y, s, q, dq, m, r, net, history, which, p, t, direct, o, do, True)
            gap = sense * (o[which] - target)
            if abs(gap) < THERE:
                break
            low, high = (length, high) if gap < 0.0 else (low, length)
            length -= gap / (sense * do[which, last])
            if not low < length < high:
                length = 0.5 * (low + high)
        length += _on_target(y, s, o, do, which, target, passed * dq[net.layer + 7], of_ends[TIME])
    ends[:WATCHED], of_ends[:WATCHED], ends[TIME] = o, do, passed * pace + length
    _keep(peaks, of_peaks, o, do)
    return steps


@njit(cache=True, fastmath=FAST)
def _look(
    y: Array,
    s: Array,
    q: Array,
    dq: Array,
    m: Array,
    r: Array,
    net: Network,
    history: bool,
    which: int,
    p: Array,
    t: Array,
    direct: Array,
    o: Array,
    do: Array,
    sloped: bool,
) -> None:
    """Watch an instant; the impedance only where it is the event, its derivatives only where wanted."""
    watch(y, s, q, dq, m, net, history, p, t, direct, o, do)
    if which == SOFT:
        o[SOFT] = softness(t, p, s, q, dq, m, r, net, direct, do[SOFT] if sloped else do[SOFT, :0])


@njit(cache=True, fastmath=FAST)
def _on_target(
    y: Array, s: Array, o: Array, do: Array, which: int, target: float, of_passed: Array, of_time: Array
) -> float:
    """Move along the last direction, time, to the target, and turn derivatives at one time into those at the event.

    Returns what is added to the time, and fills in its derivatives.
    """
    last = of_time.size - 1
    nearer: float = (target - o[which]) / do[which, last]
    y += nearer * s[:, last]
    o += nearer * do[:, last]
    for j in range(last):
        longer = -do[which, j] / do[which, last]
        of_time[j] = of_passed[j] + longer
        s[:, j] += longer * s[:, last]
        do[:, j] += longer * do[:, last]
    s[:, last] = 0.0
    return nearer


@njit(cache=True, fastmath=FAST)
def _within(length: float, low: float, high: float, rise: float, end: float) -> float:
    """Return about where a gap passes zero within a step, from its values and slopes at both ends (cubic)."""
    if rise <= 0.0:
        return length * low / (low - high)
    x, a, b = low / (low - high), length * rise, length * end
    for _ in range(4):
        one = 1.0 - x
        value = low * one**2 * (1.0 + 2.0 * x) + high * x**2 * (3.0 - 2.0 * x) + x * one * (a * one - b * x)
        steep = 6.0 * x * one * (high - low) + a * one * (1.0 - 3.0 * x) + b * x * (3.0 * x - 2.0)
        x = min(max(x - value / steep, 0.0), 1.0)
    return length * x


@njit(cache=True, fastmath=FAST)
def _keep(peaks: Array, of_peaks: Array, o: Array, do: Array) -> None:
    """Take what is higher than before."""
    for i in range(WATCHED):
        if o[i] > peaks[i]:
            peaks[i], of_peaks[i] = o[i], do[i]


@njit(cache=True, fastmath=FAST)
def with_history(y: Array, s: Array, net: Network, m: Array) -> tuple[Array, Array]:
    """Return a state of the melting curve, and its sensitivities, as a layer with a history goes on from it."""
    n, nodes = net.cells, net.nodes
    later, slopes = np.empty(nodes + n), np.empty((nodes + n, s.shape[1]))
    later[:nodes], slopes[:nodes] = y, s
    for i in range(n):
        first, up = ramp(HEAT_UNIT * y[i] - m[2], m[6])
        last, beyond = ramp(HEAT_UNIT * y[i] - m[3], m[6])
        later[nodes + i], by = extended(1.0 - (first - last) / (m[3] - m[2]), m[11])
        slopes[nodes + i] = -HEAT_UNIT * by * (up - beyond) / (m[3] - m[2]) * s[i]
    return later, slopes
