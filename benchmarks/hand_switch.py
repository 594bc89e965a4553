"""The reference problem's switch written out by hand for numba: heat through pads, layer and plate, with derivatives.

Steps of SDIRK2 with a full Newton. Sensitivities to the variables go along, each step's by the factors its Newton
ended with. The last step is as long as the far face needs to be at 100 degC, so that the time is smooth in the design.

States in kelvin and J/kg: cold side, hot side, cells of the layer, cells of the plate, plate beside the arcs, core.
"""

from __future__ import annotations

import math

import numpy as np
from hand_chain import BESIDE, CELLS, CHAIN, CORE, PLATE, STATES, factor, solve
from hand_module import (
    C_MELT,
    C_PETG,
    C_SOLID,
    H_MELTS,
    H_MOLTEN,
    K_PETG,
    MELTS,
    MOLTEN,
    RHO_PCL,
    RHO_PETG,
    ROTOR,
    ROUNDING,
    Array,
)
from numba import njit

FREE = 8
SEEBECK, RESISTANCE, CONDUCTANCE = 0.025, 3.0, 0.12
AMBIENT, TARGET, CONTACT = 295.15, 373.15, 1e4
OPEN_AIR, ROTOR_AIR, RADIATION = 10.0, 5.0, 0.9 * 5.670374419e-8
K_SOLID, K_MELT = 0.225, 0.18
WITHIN = 0.5 * ROTOR / PLATE / K_PETG  # K m^2/W, half a cell of the plate
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
IN_MELTING = (MOLTEN - MELTS) / (H_MOLTEN - H_MELTS)


@njit(cache=True)
def phases(y: Array, warm: Array, slope: Array, conducts: Array, bends: Array) -> None:
    """Temperatures along the chain with their slopes, and conductivities of the layer's cells with theirs."""
    warm[:] = y[:CHAIN]
    slope[:] = 1.0
    for i in range(CELLS):
        a, b = y[2 + i] - H_MELTS, y[2 + i] - H_MOLTEN
        root_a, root_b = math.sqrt(a * a + ROUNDING**2), math.sqrt(b * b + ROUNDING**2)
        up_a, up_b = 0.5 + 0.5 * a / root_a, 0.5 + 0.5 * b / root_b
        first, last = 0.5 * (a + root_a), 0.5 * (b + root_b)
        rise, fall = IN_MELTING - 1.0 / C_SOLID, 1.0 / C_MELT - IN_MELTING
        warm[2 + i] = 273.15 + y[2 + i] / C_SOLID + rise * first + fall * last
        slope[2 + i] = 1.0 / C_SOLID + rise * up_a + fall * up_b
        bends[i] = -(K_SOLID - K_MELT) * (up_a - up_b) / (H_MOLTEN - H_MELTS)
        conducts[i] = K_SOLID - (K_SOLID - K_MELT) * (first - last) / (H_MOLTEN - H_MELTS)


@njit(cache=True)
def loss(kelvin: float, air: float) -> tuple[float, float]:
    """Heat [W/m^2] lost by a surface to air and surroundings, and its slope."""
    grey = RADIATION * (kelvin**2 + AMBIENT**2) * (kelvin + AMBIENT)
    steep = RADIATION * (3.0 * kelvin**2 + 2.0 * kelvin * AMBIENT + AMBIENT**2)
    return (air + grey) * (kelvin - AMBIENT), air + grey + steep * (kelvin - AMBIENT)


@njit(cache=True)
def rates(y: Array, q: Array, warm: Array, conducts: Array, f: Array) -> float:
    """Rates of all states; returns the heat out of the layer [W] times half its last cell's resistance [K]."""
    current, area, thick, scale, capacity, windows = q[0], q[1], q[2], q[3], q[4], q[5]
    lump, sideways, onward, core = q[6], q[7], q[8], q[9]
    joule, carried = 0.5 * current**2 * RESISTANCE * scale, SEEBECK * current * scale
    through = CONDUCTANCE * scale * (warm[1] - warm[0])
    lost, _ = loss(warm[0], OPEN_AIR)
    f[0] = -(carried * warm[0] - joule - through + windows * lost) / capacity
    half = 0.5 * thick / CELLS / area
    flow = (warm[1] - warm[2]) / (1.0 / (CONTACT * area) + half / conducts[0])
    f[1] = (carried * warm[1] + joule - through - flow) / capacity
    mass = RHO_PCL * area * thick / CELLS
    for i in range(CELLS - 1):
        on = (warm[2 + i] - warm[3 + i]) / (half / conducts[i] + half / conducts[i + 1])
        f[2 + i] = (flow - on) / mass
        flow = on
    first, plate = 2 + CELLS, WITHIN / area
    across = (warm[first - 1] - warm[first]) / (half / conducts[CELLS - 1] + 1.0 / (CONTACT * area) + plate)
    f[first - 1] = (flow - across) / mass
    flow, heat, taken = across, RHO_PETG * C_PETG * area * ROTOR / PLATE, 0.0
    for i in range(first, CHAIN):
        if i + 1 < CHAIN:
            on = (warm[i] - warm[i + 1]) / (2.0 * plate)
        else:
            grey = RADIATION * (warm[i] ** 2 + AMBIENT**2) * (warm[i] + AMBIENT)
            on = (warm[i] - AMBIENT) / (plate + 1.0 / ((ROTOR_AIR + grey) * area))
        side = sideways / PLATE * (warm[i] - y[BESIDE])
        f[i] = (flow - on - side) / heat
        taken += side
        flow = on
    lost, _ = loss(y[BESIDE], ROTOR_AIR)
    on = onward * (y[BESIDE] - y[CORE])
    f[BESIDE] = (taken - on - lump * lost) / (lump * ROTOR * RHO_PETG * C_PETG)
    f[CORE] = on / core
    return across * half / conducts[CELLS - 1]


@njit(cache=True)
def jacobian(y: Array, q: Array, warm: Array, slope: Array, conducts: Array, bends: Array, a: Array) -> None:
    """Rows of `a`: below, on and above the diagonal; what the chain has from the body beside it, and gives to that."""
    current, area, thick, scale, capacity, windows = q[0], q[1], q[2], q[3], q[4], q[5]
    lump, sideways, onward, core = q[6], q[7], q[8], q[9]
    carried, through = SEEBECK * current * scale, CONDUCTANCE * scale
    _, steep = loss(warm[0], OPEN_AIR)
    a[:] = 0.0
    a[1, 0] = -(carried + through + windows * steep) / capacity
    a[2, 0] = through / capacity
    a[0, 1] = through / capacity
    a[1, 1] = (carried - through) / capacity
    half, mass = 0.5 * thick / CELLS / area, RHO_PCL * area * thick / CELLS
    first, plate, heat = 2 + CELLS, WITHIN / area, RHO_PETG * C_PETG * area * ROTOR / PLATE
    for i in range(1, CHAIN - 1):
        resistance, here, there = 2.0 * plate, 0.0, 0.0
        if i < first:
            left, right = 1.0 / (CONTACT * area), 1.0 / (CONTACT * area) + plate
            if i > 1:
                left, here = half / conducts[i - 2], -half * bends[i - 2] / conducts[i - 2] ** 2
            if i < first - 1:
                right, there = half / conducts[i - 1], -half * bends[i - 1] / conducts[i - 1] ** 2
            resistance = left + right
        flow = (warm[i] - warm[i + 1]) / resistance
        from_here = (slope[i] - flow * here) / resistance
        from_there = (-slope[i + 1] - flow * there) / resistance
        one = capacity if i == 1 else (mass if i < first else heat)
        other = mass if i + 1 < first else heat
        a[1, i] -= from_here / one
        a[2, i] -= from_there / one
        a[0, i + 1] += from_here / other
        a[1, i + 1] += from_there / other
    last = warm[CHAIN - 1]
    grey = ROTOR_AIR + RADIATION * (last**2 + AMBIENT**2) * (last + AMBIENT)
    steep = RADIATION * (3.0 * last**2 + 2.0 * last * AMBIENT + AMBIENT**2)
    resistance = plate + 1.0 / (grey * area)
    a[1, CHAIN - 1] -= (1.0 + (last - AMBIENT) / resistance * steep / (grey**2 * area)) / resistance / heat
    body = lump * ROTOR * RHO_PETG * C_PETG
    for i in range(first, CHAIN):
        a[1, i] -= sideways / PLATE / heat
        a[3, i] = sideways / PLATE / heat
        a[4, i] = sideways / PLATE / body
    _, steep = loss(y[BESIDE], ROTOR_AIR)
    a[1, BESIDE] = -(sideways + onward + lump * steep) / body
    a[2, BESIDE] = onward / body
    a[0, CORE] = onward / core
    a[1, CORE] = -onward / core


@njit(cache=True)
def implicit(
    y: Array, base: Array, h: float, q: Array, moved: Array, lengths: Array, s: Array, work: Array, sensitive: bool
) -> float:
    """Solve y = base + h f(y), from y, and with it the sensitivities, where `s` holds those of the base.

    `moved` are the numbers of the switch with each variable moved by `STEP_OF`, `lengths` what h is then. Returns how
    far the far face is from its target.
    """
    warm, slope, conducts, bends = work[0, :CHAIN], work[1, :CHAIN], work[2, :CELLS], work[3, :CELLS]
    f, right, other, a, w = work[4], work[5], work[6], work[7:12], work[12:17]
    phases(y, warm, slope, conducts, bends)
    for _ in range(NEWTON):
        rates(y, q, warm, conducts, f)
        jacobian(y, q, warm, slope, conducts, bends, a)
        factor(a, h, w)
        far = 0.0
        for i in range(STATES):
            right[i] = base[i] + h * f[i] - y[i]
        solve(w, right)
        for i in range(STATES):
            y[i] += right[i]
            far = max(far, abs(right[i]) / (1e5 if 2 <= i < 2 + CELLS else 100.0))
        phases(y, warm, slope, conducts, bends)
        if not far > EXACT:
            break
    drop = rates(y, q, warm, conducts, f)
    if sensitive:
        for k in range(FREE):
            rates(y, moved[k], warm, conducts, other)
            for i in range(STATES):
                s[k, i] += (lengths[k] * other[i] - h * f[i]) / STEP_OF
            solve(w, s[k])
        for i in range(STATES):
            s[FREE, i] += (lengths[FREE] - h) / STEP_OF * f[i]
        solve(w, s[FREE])
    return warm[1 + CELLS] - drop - TARGET


STEP_OF = 1e-6
"""What a variable's logarithm is moved by for its derivatives."""


@njit(cache=True)
def step(y: Array, h: float, q: Array, moved: Array, lengths: Array, s: Array, work: Array, sensitive: bool) -> float:
    """One step of SDIRK2 in place; returns how far the far face is from its target."""
    begin, base = work[17], work[18]
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
    s, old, work = np.zeros((FREE + 1, STATES)), np.zeros((FREE + 1, STATES)), np.zeros((19, STATES))
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
        found = step(y, length, q, moved, fixed, s, work, False)
        if abs(found) < THERE:
            break
        if found < 0.0:
            low, low_gap, high_gap = length, found, 0.5 * high_gap
        else:
            high, high_gap, low_gap = length, found, 0.5 * low_gap
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
    """What the far face moves by with each variable, and with the length of the last step."""
    warm, slope, conducts, bends, f = work[0, :CHAIN], work[1, :CHAIN], work[2, :CELLS], work[3, :CELLS], work[4]
    for k in range(FREE + 1):
        ends = np.empty(2)
        for side in range(2):
            moving = y + (side * STEP_OF) * s[k]
            phases(moving, warm, slope, conducts, bends)
            ends[side] = -rates(moving, moved[k] if side and k < FREE else q, warm, conducts, f) + warm[1 + CELLS]
        gaps[k] = (ends[1] - ends[0]) / STEP_OF
