"""The reference problem's switch stepped through by hand for numba, with sensitivities.

Steps of SDIRK2 with a full Newton, through the heat of `hand_heat`. Sensitivities to the variables go along, each
step's by the factors its Newton ended with. The last step is as long as the far face needs to be at 100 degC, so that
the time is smooth in the design.
"""

from __future__ import annotations

import math

import numpy as np
from hand_chain import CELLS, CHAIN, ROWS, STATES, factor, solve
from hand_heat import RESISTANCE, SEEBECK, jacobian, phases, rates
from hand_module import AMBIENT, RHO_PCL, Array
from hand_polymer import C_MELT, C_SOLID, H_MOLTEN, MOLTEN
from numba import njit

FREE = 8
TARGET = 373.15
GAMMA = 1.0 - math.sqrt(0.5)
STEPS = 20.0
"""Steps in about the time that the heat of the layer takes at the power of the pads."""
FIRST, GROWTH = 0.05, 1.5
"""The first step over those later on, and what the next ones grow by."""
NEWTON = 10
EXACT = 1e-10
"""Share of 100 K or 1e5 J/kg below which a Newton step is the last."""
SECANTS, THERE = 40, 1e-7  # K
LONGEST = 3600.0  # s
H_AMBIENT = C_SOLID * (AMBIENT - 273.15)
FULL = H_MOLTEN + C_MELT * (TARGET - MOLTEN)


@njit(cache=True)
def implicit(
    y: Array, base: Array, h: float, q: Array, moved: Array, lengths: Array, s: Array, work: Array, sensitive: bool
) -> float:
    """Solve y = base + h f(y), from y, and with it the sensitivities, where `s` holds those of the base.

    `moved` are the numbers of the switch with each variable moved by `STEP_OF`, `lengths` what h is then. Returns how
    far the far face is from its target.
    """
    p, f, right, other = work[:6], work[6], work[7], work[8]
    a, w = work[9 : 9 + ROWS], work[9 + ROWS : 9 + 2 * ROWS]
    phases(y, p)
    for _ in range(NEWTON):
        rates(y, q, p, f)
        jacobian(y, q, p, a)
        factor(a, h, w)
        far = 0.0
        for i in range(STATES):
            right[i] = base[i] + h * f[i] - y[i]
        right[STATES - 2], right[STATES - 1] = np.mean(y[2 + CELLS : CHAIN]) - y[STATES - 2], y[1] - y[STATES - 1]
        solve(w, right)
        for i in range(STATES):
            y[i] += right[i]
            far = max(far, abs(right[i]) / (1e5 if 2 <= i < 2 + CELLS else 100.0))
        phases(y, p)
        if not far > EXACT:
            break
    drop = rates(y, q, p, f)
    if sensitive:
        for k in range(FREE):
            rates(y, moved[k], p, other)
            for i in range(STATES):
                s[k, i] += (lengths[k] * other[i] - h * f[i]) / STEP_OF
            s[k, STATES - 2 :] = 0.0
            solve(w, s[k])
        for i in range(STATES):
            s[FREE, i] += (lengths[FREE] - h) / STEP_OF * f[i]
        s[FREE, STATES - 2 :] = 0.0
        solve(w, s[FREE])
    return p[0, 1 + CELLS] - drop - TARGET


STEP_OF = 1e-6
"""What a variable's logarithm is moved by for its derivatives."""


@njit(cache=True)
def step(y: Array, h: float, q: Array, moved: Array, lengths: Array, s: Array, work: Array, sensitive: bool) -> float:
    """Take a step of SDIRK2 in place; return how far the far face is from its target."""
    begin, base = work[9 + 2 * ROWS], work[10 + 2 * ROWS]
    begin[:] = y
    old = s.copy() if sensitive else s
    implicit(y, begin, GAMMA * h, q, moved, GAMMA * lengths, s, work, sensitive)
    part = (1.0 - GAMMA) / GAMMA
    for i in range(STATES):
        base[i] = begin[i] + part * (y[i] - begin[i])
        y[i] = begin[i] + (y[i] - begin[i]) / GAMMA
    if sensitive:
        s[:] = old + part * (s - old)
    return implicit(y, base, GAMMA * h, q, moved, GAMMA * lengths, s, work, sensitive)


@njit(cache=True)
def pace(q: Array) -> float:
    """About the time of a step [s]: the layer's heat over the pads' power, in parts."""
    power = q[3] * (SEEBECK * q[0] * 330.0 + 0.5 * q[0] ** 2 * RESISTANCE)
    return RHO_PCL * q[1] * q[2] * (FULL - H_AMBIENT) / power / STEPS


@njit(cache=True)
def cycle(q: Array, moved: Array, slopes: Array, sensitive: bool) -> float:
    """Time [s] until the far face is at its target, and its slopes by the logarithms of the variables."""
    y, before = np.full(STATES, AMBIENT), np.empty(STATES)
    y[2 : 2 + CELLS] = H_AMBIENT
    s, old, work = np.zeros((FREE + 1, STATES)), np.zeros((FREE + 1, STATES)), np.zeros((11 + 2 * ROWS, STATES))
    usual, lengths = pace(q), np.empty(FREE + 1)
    lengths[:] = usual
    if sensitive:
        for k in range(FREE):
            lengths[k] = pace(moved[k])
    now, share, gap, last = 0.0, FIRST, -1.0, 0.0
    while now < LONGEST:
        before[:], old[:], last = y, s, gap
        gap = step(y, share * usual, q, moved, share * lengths, s, work, sensitive)
        if not gap < 0.0:
            break
        now += share * usual
        share = min(1.0, GROWTH * share)
    slopes[:] = 0.0
    if not gap >= 0.0:
        return LONGEST
    low, low_gap, high, high_gap = 0.0, min(last, -1e-9), share * usual, gap
    fixed = np.empty(FREE + 1)
    for _ in range(SECANTS):  # Illinois: the root stays between the two
        length = high - high_gap * (high - low) / (high_gap - low_gap)
        y[:] = before
        fixed[:] = length
        fixed[FREE] = length + STEP_OF
        distance = step(y, length, q, moved, fixed, s, work, False)
        if abs(distance) < THERE:
            break
        if distance < 0.0:
            low, low_gap, high_gap = length, distance, 0.5 * high_gap
        else:
            high, high_gap, low_gap = length, distance, 0.5 * low_gap
    if sensitive:
        y[:], s[:] = before, old
        step(y, length, q, moved, fixed, s, work, True)
        gaps = np.empty(FREE + 1)
        slope_of_gap(y, q, moved, s, work, gaps)
        for k in range(FREE):
            slopes[k] = now / usual * (lengths[k] - usual) / STEP_OF - gaps[k] / gaps[FREE]
    return now + length


@njit(cache=True)
def slope_of_gap(y: Array, q: Array, moved: Array, s: Array, work: Array, gaps: Array) -> None:
    """Return the far face's derivative by each variable, and with the length of the last step."""
    p, f = work[:6], work[6]
    for k in range(FREE + 1):
        ends = np.empty(2)
        for side in range(2):
            moving = y + (side * STEP_OF) * s[k]
            phases(moving, p)
            ends[side] = -rates(moving, moved[k] if side and k < FREE else q, p, f) + p[0, 1 + CELLS]
        gaps[k] = (ends[1] - ends[0]) / STEP_OF
