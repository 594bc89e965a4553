"""The reference problem's switch written out by hand for numba: heat through pads, layer and plate, with derivatives.

Beside the plate and around the pads stand bodies that take heat, with air between them. Steps of SDIRK2 with a full
Newton. Sensitivities to the variables go along, each step's by the factors its Newton
ended with. The last step is as long as the far face needs to be at 100 degC, so that the time is smooth in the design.

States in kelvin and J/kg, in the order of `hand_chain`; the last is the mean of the plate, which takes no step.
"""

from __future__ import annotations

import math

import numpy as np
from hand_chain import BODIES, CELLS, CHAIN, PLATE, ROWS, STATES, TOUCH, factor, solve
from hand_module import (
    C_MELT,
    C_PETG,
    C_SOLID,
    EMISSIVITY,
    H_MELTS,
    H_MOLTEN,
    K_MELT,
    K_PETG,
    K_SOLID,
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
COLD_WALL, LEDGE, CORNER = 4, 10, 11
"""Places among the bodies: beside the cold sides, below them, beside the hot sides."""
JOINED = np.array([
    (0, 1), (1, 2), (2, 3), (11, 5), (4, 5), (5, 6), (6, 12), (7, 8), (8, 9), (9, 12), (11, 4), (4, 7), (5, 8), (6, 9),
    (10, 7), (0, 11), (1, 5), (2, 6),
])  # fmt: skip
"""Bodies that conduct to one another; the last three pairs radiate as well."""
LINKS = len(JOINED)
CAPACITIES, SURFACES, EDGES, CONDUCTS = 6, 6 + BODIES, 6 + 2 * BODIES, 12 + 2 * BODIES
"""Where the switch's numbers have the bodies' heat capacities and surfaces; plate to its edge, and what differs from
its mean; hot sides to the corner, cold ones to the wall and to the ledges, hot ones to the plate's edge; the links."""
SEEBECK, RESISTANCE, CONDUCTANCE = 0.025, 3.0, 0.12
AMBIENT, TARGET, CONTACT = 295.15, 373.15, 1e4
OPEN_AIR, PARTS_AIR, BLACK = 10.0, 5.0, 5.670374419e-8
RADIATION = EMISSIVITY * BLACK
SAME, CORNERS = 0.5, 0.1 * (MOLTEN - MELTS)  # K
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
def potential(kelvin: float) -> tuple[float, float]:
    """Integral of the conductivity over temperature [W/m], and the conductivity."""
    a, b = kelvin - MELTS, kelvin - MOLTEN
    root_a, root_b = math.sqrt(a * a + CORNERS**2), math.sqrt(b * b + CORNERS**2)
    first, last = 0.5 * (a + root_a), 0.5 * (b + root_b)
    share = (K_MELT - K_SOLID) / (MOLTEN - MELTS)
    conducts = K_SOLID + share * (first**2 / root_a - last**2 / root_b)
    return K_SOLID * a + 0.5 * share * (first**2 - last**2), conducts


@njit(cache=True)
def phases(y: Array, p: Array) -> None:
    """Along the chain temperatures with their slopes; of the layer's cells conductivities and potentials with theirs.

    Rows of `p`: temperature and its slope, conductivity of the mixture and its slope, potential and its slope.
    """
    p[0, :CHAIN] = y[:CHAIN]
    p[1, :CHAIN] = 1.0
    for i in range(2, 2 + CELLS):
        a, b = y[i] - H_MELTS, y[i] - H_MOLTEN
        root_a, root_b = math.sqrt(a * a + ROUNDING**2), math.sqrt(b * b + ROUNDING**2)
        up_a, up_b = 0.5 + 0.5 * a / root_a, 0.5 + 0.5 * b / root_b
        first, last = 0.5 * (a + root_a), 0.5 * (b + root_b)
        rise, fall = IN_MELTING - 1.0 / C_SOLID, 1.0 / C_MELT - IN_MELTING
        p[0, i] = 273.15 + y[i] / C_SOLID + rise * first + fall * last
        p[1, i] = 1.0 / C_SOLID + rise * up_a + fall * up_b
        p[2, i] = K_SOLID - (K_SOLID - K_MELT) * (first - last) / (H_MOLTEN - H_MELTS)
        p[3, i] = -(K_SOLID - K_MELT) * (up_a - up_b) / (H_MOLTEN - H_MELTS)
        p[4, i], conducts = potential(p[0, i])
        p[5, i] = conducts * p[1, i]


@njit(cache=True)
def to_wall(i: int, wall: float, half: float, other: float, p: Array) -> tuple[float, float, float, float]:
    """Heat [W] from a cell to a wall at a temperature, through half a cell and another resistance.

    Returns it, its slopes by the cell's state and by the wall's temperature, and the resistance of the half cell.
    """
    apart, (there, at_wall) = wall - p[0, i], potential(wall)
    risen, square = there - p[4, i], apart**2 + SAME**2
    mean = (risen * apart + SAME**2 * p[2, i]) / square
    by_wall = (at_wall * apart + risen - 2.0 * mean * apart) / square
    by_cell = (SAME**2 * p[3, i] - p[5, i] * apart - (risen - 2.0 * mean * apart) * p[1, i]) / square
    within = half / mean
    flow = -apart / (within + other)
    bend = flow / (within + other) * within / mean
    return flow, p[1, i] / (within + other) + bend * by_cell, bend * by_wall - 1.0 / (within + other), within


@njit(cache=True)
def loss(kelvin: float, air: float) -> tuple[float, float]:
    """Heat [W/m^2] lost by a surface to air and surroundings, and its slope."""
    grey = RADIATION * (kelvin**2 + AMBIENT**2) * (kelvin + AMBIENT)
    steep = RADIATION * (3.0 * kelvin**2 + 2.0 * kelvin * AMBIENT + AMBIENT**2)
    return (air + grey) * (kelvin - AMBIENT), air + grey + steep * (kelvin - AMBIENT)


@njit(cache=True)
def rates(y: Array, q: Array, p: Array, f: Array) -> float:
    """Rates of all states; returns the temperature that the far face is below its last cell [K]."""
    current, area, thick, scale, capacity, windows = q[0], q[1], q[2], q[3], q[4], q[5]
    warm, gain, bodies = p[0], f[CHAIN:], y[CHAIN:]
    to_edge, uneven, to_corner, to_side, to_ledge, up = q[EDGES : EDGES + 6]
    joule, carried = 0.5 * current**2 * RESISTANCE * scale, SEEBECK * current * scale
    through = CONDUCTANCE * scale * (warm[1] - warm[0])
    lost, _ = loss(warm[0], OPEN_AIR)
    gain[:] = 0.0
    gain[COLD_WALL], gain[LEDGE] = to_side * (warm[0] - bodies[COLD_WALL]), to_ledge * (warm[0] - bodies[LEDGE])
    gain[CORNER], gain[0] = to_corner * (warm[1] - bodies[CORNER]), up * (warm[1] - bodies[0])
    f[0] = -(carried * warm[0] - joule - through + windows * lost + gain[COLD_WALL] + gain[LEDGE]) / capacity
    half, contact = 0.5 * thick / CELLS / area, 1.0 / (CONTACT * area)
    flow, _, _, _ = to_wall(2, warm[1], half, contact, p)
    flow = -flow
    f[1] = (carried * warm[1] + joule - through - flow - gain[CORNER] - gain[0]) / capacity
    mass = RHO_PCL * area * thick / CELLS
    first, plate = 2 + CELLS, WITHIN / area
    across, _, _, within = to_wall(first - 1, warm[first], half, contact + plate, p)
    for i in range(2, first):
        on = 0.5 * (p[4, i] - p[4, i + 1]) / half if i + 1 < first else across
        f[i] = (flow - on) / mass
        flow = on
    heat, mean = RHO_PETG * C_PETG * area * ROTOR / PLATE, np.mean(warm[first:CHAIN])
    for i in range(first, CHAIN):
        if i + 1 < CHAIN:
            on = (warm[i] - warm[i + 1]) / (2.0 * plate)
        else:
            grey = RADIATION * (warm[i] ** 2 + AMBIENT**2) * (warm[i] + AMBIENT)
            on = (warm[i] - AMBIENT) / (plate + 1.0 / ((PARTS_AIR + grey) * area))
        side = (to_edge * (mean - bodies[0]) + uneven * (warm[i] - mean)) / PLATE
        f[i] = (flow - on - side) / heat
        gain[0] += side
        flow = on
    for n in range(LINKS):
        a, b = JOINED[n]
        one, other = bodies[a], bodies[b]
        passed = q[CONDUCTS + n] * (one - other)
        if n >= LINKS - 3:
            passed += q[CONDUCTS + n + 3] * BLACK * (one**4 - other**4)
        gain[a] -= passed
        gain[b] += passed
    for k in range(BODIES):
        lost, _ = loss(bodies[k], PARTS_AIR)
        gain[k] = (gain[k] - q[SURFACES + k] * lost) / q[CAPACITIES + k]
    return across * within


@njit(cache=True)
def of_bodies(bodies: Array, q: Array, among: Array) -> None:
    """Slopes of the bodies' rates by the bodies' temperatures and the plate's mean."""
    to_edge, _, to_corner, to_side, to_ledge, up = q[EDGES : EDGES + 6]
    among[0, 0], among[0, BODIES] = -to_edge - up, to_edge
    among[COLD_WALL, COLD_WALL], among[LEDGE, LEDGE], among[CORNER, CORNER] = -to_side, -to_ledge, -to_corner
    for n in range(LINKS):
        a, b = JOINED[n]
        by_one, by_other = q[CONDUCTS + n], q[CONDUCTS + n]
        if n >= LINKS - 3:
            by_one += 4.0 * q[CONDUCTS + n + 3] * BLACK * bodies[a] ** 3
            by_other += 4.0 * q[CONDUCTS + n + 3] * BLACK * bodies[b] ** 3
        among[a, a] -= by_one
        among[a, b] += by_other
        among[b, a] += by_one
        among[b, b] -= by_other
    for k in range(BODIES):
        _, steep = loss(bodies[k], PARTS_AIR)
        among[k, k] -= q[SURFACES + k] * steep
        among[k] /= q[CAPACITIES + k]


@njit(cache=True)
def jacobian(y: Array, q: Array, p: Array, a: Array) -> None:
    """Slopes of the rates, in rows as `hand_chain.ROWS` says."""
    current, area, thick, scale, capacity, windows = q[0], q[1], q[2], q[3], q[4], q[5]
    to_edge, uneven, to_corner, to_side, to_ledge, up = q[EDGES : EDGES + 6]
    warm = p[0]
    carried, through = SEEBECK * current * scale, CONDUCTANCE * scale
    _, steep = loss(warm[0], OPEN_AIR)
    a[:] = 0.0
    had, given = a[3 : 3 + TOUCH], a[3 + TOUCH : 3 + 2 * TOUCH]
    a[1, 0] = -(carried + through + windows * steep + to_side + to_ledge) / capacity
    a[2, 0] = through / capacity
    a[0, 1] = through / capacity
    a[1, 1] = (carried - through - to_corner - up) / capacity
    had[0, 1], had[1, 0], had[2, 0], had[3, 1] = up, to_side, to_ledge, to_corner
    given[:, :2] = had[:, :2]
    had[:, :2] /= capacity
    given[0] /= q[CAPACITIES]
    given[1] /= q[CAPACITIES + COLD_WALL]
    given[2] /= q[CAPACITIES + LEDGE]
    given[3] /= q[CAPACITIES + CORNER]
    half, contact, mass = 0.5 * thick / CELLS / area, 1.0 / (CONTACT * area), RHO_PCL * area * thick / CELLS
    first, plate, heat = 2 + CELLS, WITHIN / area, RHO_PETG * C_PETG * area * ROTOR / PLATE
    for i in range(1, CHAIN - 1):
        if i == 1:
            _, by_cell, by_wall, _ = to_wall(2, warm[1], half, contact, p)
            from_here, from_there = -by_wall, -by_cell
        elif i < first - 1:
            from_here, from_there = 0.5 * p[5, i] / half, -0.5 * p[5, i + 1] / half
        elif i == first - 1:
            _, from_here, from_there, _ = to_wall(i, warm[first], half, contact + plate, p)
        else:
            from_here, from_there = 0.5 / plate, -0.5 / plate
        one = capacity if i == 1 else (mass if i < first else heat)
        other = mass if i + 1 < first else heat
        a[1, i] -= from_here / one
        a[2, i] -= from_there / one
        a[0, i + 1] += from_here / other
        a[1, i + 1] += from_there / other
    last = warm[CHAIN - 1]
    grey = PARTS_AIR + RADIATION * (last**2 + AMBIENT**2) * (last + AMBIENT)
    steep = RADIATION * (3.0 * last**2 + 2.0 * last * AMBIENT + AMBIENT**2)
    resistance = plate + 1.0 / (grey * area)
    a[1, CHAIN - 1] -= (1.0 + (last - AMBIENT) / resistance * steep / (grey**2 * area)) / resistance / heat
    for i in range(first, CHAIN):
        a[1, i] -= uneven / PLATE / heat
        had[0, i], had[TOUCH - 1, i] = to_edge / PLATE / heat, (uneven - to_edge) / PLATE / heat
        given[TOUCH - 1, i] = 1.0 / PLATE
    of_bodies(y[CHAIN:], q, a[3 + 2 * TOUCH :])


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
        right[STATES - 1] = np.mean(y[2 + CELLS : CHAIN]) - y[STATES - 1]
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
            s[k, STATES - 1] = 0.0
            solve(w, s[k])
        for i in range(STATES):
            s[FREE, i] += (lengths[FREE] - h) / STEP_OF * f[i]
        s[FREE, STATES - 1] = 0.0
        solve(w, s[FREE])
    return p[0, 1 + CELLS] - drop - TARGET


STEP_OF = 1e-6
"""What a variable's logarithm is moved by for its derivatives."""


@njit(cache=True)
def step(y: Array, h: float, q: Array, moved: Array, lengths: Array, s: Array, work: Array, sensitive: bool) -> float:
    """One step of SDIRK2 in place; returns how far the far face is from its target."""
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
    p, f = work[:6], work[6]
    for k in range(FREE + 1):
        ends = np.empty(2)
        for side in range(2):
            moving = y + (side * STEP_OF) * s[k]
            phases(moving, p)
            ends[side] = -rates(moving, moved[k] if side and k < FREE else q, p, f) + p[0, 1 + CELLS]
        gaps[k] = (ends[1] - ends[0]) / STEP_OF
