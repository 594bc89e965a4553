"""The reference problem's heat written out by hand for numba: through pads, layer and plate, and its derivatives.

Beside the plate and around the pads stand bodies that take heat, with air between them.
States in kelvin and J/kg, in the order of `hand_chain`; the last two are the mean of the plate and the hot side, which
take no step.
"""

from __future__ import annotations

import math

import numpy as np
from hand_chain import BODIES, CELLS, CHAIN, PLATE, TOUCH
from hand_module import (
    AMBIENT,
    BLACK,
    C_PETG,
    EMISSIVITY,
    FLOOR,
    K_MELT,
    K_PETG,
    K_SOLID,
    PAD,
    RHO_PCL,
    RHO_PETG,
    ROTOR,
    Array,
)
from hand_polymer import C_MELT, C_SOLID, H_MELTS, H_MOLTEN, MELTS, MOLTEN, ROUNDING
from numba import njit

COLD_WALL, LEDGE, CORNER = 4, 10, 11
"""Places among the bodies: beside the cold sides, below them, beside the hot sides."""
JOINED = np.array([
    (0, 1), (1, 2), (2, 3), (11, 5), (4, 5), (5, 6), (6, 12), (7, 8), (8, 9), (9, 12), (11, 4), (4, 7), (5, 8), (6, 9),
    (10, 7), (0, 11), (1, 5), (2, 6),
])  # fmt: skip
"""Bodies that conduct to one another; the last three pairs radiate as well."""
LINKS = len(JOINED)
CAPACITIES, SURFACES, EDGES, CONDUCTS = 6, 6 + BODIES, 6 + 2 * BODIES, 12 + 2 * BODIES
OF_LAYER = CONDUCTS + LINKS + 3
FALLING = 2.0 * (1.0 - (np.arange(CELLS) + 0.5) / CELLS) / CELLS
"""Where the switch's numbers have the bodies' heat capacities and surfaces; plate to its edge, and what differs from
its mean; hot sides to the corner, either side to its wall, cold ones to the ledges, hot ones to the plate's edge; the
links. Then the share of what passes the layer's free side that its cells give in the hot sides' place, falling evenly
over their depth; last what bodies above the floor's faces and cold sides, and those below, lose to the air besides."""
ABOVE_FACES, BELOW_FACES, OVER, UNDER = OF_LAYER + 1, OF_LAYER + 5, np.array([4, 5, 6]), np.array([7, 8, 9, 10])
OF_LEGS_EDGE = 5.0
"""What half of the legs gives a wall over what a side does: five sixths of half a pad's height for one."""
LEGS, OF_SIDE, OF_LEGS = BODIES, 2.0 / 9.0, 5.0 / 9.0
"""Place of the legs' middle in the border; shares of the pads' heat capacity. Temperatures are on a parabola."""
SEEBECK, RESISTANCE, CONDUCTANCE = 0.025, 3.0, 0.12
CONTACT = 1e4
OPEN_AIR, PARTS_AIR = 10.0, 5.0
RADIATION = EMISSIVITY * BLACK
SAME, CORNERS = 0.5, 0.1 * (MOLTEN - MELTS)  # K
WITHIN = 0.5 * ROTOR / PLATE / K_PETG  # K m^2/W, half a cell of the plate
BEHIND = np.array([ROTOR] * 4 + [0.0] * 3 + [FLOOR - PAD] * 4 + [0.0] * 2) / 3.0 / K_PETG  # faces of the bodies
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
def loss(kelvin: float, air: float, behind: float) -> tuple[float, float]:
    """Heat [W/m^2] lost by a surface to air and surroundings, through what lies before it, and its slope."""
    face, slope = kelvin, 1.0
    if behind:
        outside = air + RADIATION * (kelvin**2 + AMBIENT**2) * (kelvin + AMBIENT)
        steep = RADIATION * (3.0 * kelvin**2 + 2.0 * kelvin * AMBIENT + AMBIENT**2)
        less = 1.0 / (1.0 + outside * behind)
        face, slope = AMBIENT + less * (kelvin - AMBIENT), less * (1.0 - less * behind * steep * (kelvin - AMBIENT))
    outside = air + RADIATION * (face**2 + AMBIENT**2) * (face + AMBIENT)
    steep = RADIATION * (3.0 * face**2 + 2.0 * face * AMBIENT + AMBIENT**2) * slope
    less = 1.0 / (1.0 + outside * behind)
    return less * outside * (kelvin - AMBIENT), less * (outside + less * steep * (kelvin - AMBIENT))


@njit(cache=True)
def lose(bodies: Array, q: Array, gain: Array) -> None:
    """Rates of the bodies from what they gain: less what they lose to the air, by faces not as warm as their means."""
    for i in range(3):
        gain[OVER[i]] -= q[ABOVE_FACES + i] * (bodies[OVER[i]] - AMBIENT)
    for i in range(4):
        gain[UNDER[i]] -= q[BELOW_FACES + i] * (bodies[UNDER[i]] - AMBIENT)
    for k in range(BODIES):
        lost, _ = loss(bodies[k], PARTS_AIR, BEHIND[k])
        gain[k] = (gain[k] - q[SURFACES + k] * lost) / q[CAPACITIES + k]


@njit(cache=True)
def rates(y: Array, q: Array, p: Array, f: Array) -> float:
    """Rates of all states; returns the temperature that the far face is below its last cell [K]."""
    current, area, thick, scale, capacity, windows = q[0], q[1], q[2], q[3], OF_SIDE * q[4], q[5]
    warm, gain, bodies = p[0], f[CHAIN:], y[CHAIN:]
    to_edge, uneven, to_corner, to_side, to_ledge, up = q[EDGES : EDGES + 6]
    joule, carried = current**2 * RESISTANCE * scale, SEEBECK * current * scale
    through = CONDUCTANCE * scale * (warm[1] - warm[0])
    lost, _ = loss(warm[0], OPEN_AIR, 0.0)
    above = 8.0 / 3.0 * CONDUCTANCE * scale * (bodies[LEGS] - 0.5 * (warm[0] + warm[1]))
    legs, apart = (warm[0] + 4.0 * bodies[LEGS] + warm[1]) / 6.0, 0.25 * (warm[1] - warm[0])
    by_legs = OF_LEGS_EDGE * to_side
    lower, upper = by_legs * (legs - apart - bodies[COLD_WALL]), by_legs * (legs + apart - bodies[CORNER])
    of_legs, tilt = lower + upper, 0.25 * (upper - lower)
    gain[:] = 0.0
    gain[COLD_WALL], gain[LEDGE] = to_side * (warm[0] - bodies[COLD_WALL]), to_ledge * (warm[0] - bodies[LEDGE])
    gain[CORNER], gain[0] = to_corner * (warm[1] - bodies[CORNER]), up * (warm[1] - bodies[0])
    cooled, made = (
        gain[COLD_WALL] + gain[LEDGE] + q[ABOVE_FACES + 3] * (warm[0] - AMBIENT),
        (joule - of_legs) / 6.0 + above,
    )
    f[0] = (made + tilt + through - carried * warm[0] - windows * lost - cooled) / capacity
    half, contact = 0.5 * thick / CELLS / area, 1.0 / (CONTACT * area)
    flow, _, _, _ = to_wall(2, warm[1], half, contact, p)
    flow = -flow
    f[1] = (made - tilt - through + carried * warm[1] - flow - gain[CORNER] - gain[0]) / capacity
    side = q[OF_LAYER] * ((to_corner - to_side) * (warm[1] - bodies[CORNER]) + gain[0])
    f[1] += side / capacity
    gain[LEGS] = (2.0 / 3.0 * (joule - of_legs) - 2.0 * above) / (OF_LEGS * q[4])
    gain[COLD_WALL] += lower
    gain[CORNER] += upper
    mass = RHO_PCL * area * thick / CELLS
    first, plate = 2 + CELLS, WITHIN / area
    across, _, _, within = to_wall(first - 1, warm[first], half, contact + plate, p)
    for i in range(2, first):
        on = 0.5 * (p[4, i] - p[4, i + 1]) / half if i + 1 < first else across
        f[i] = (flow - on - side * FALLING[i - 2]) / mass
        flow = on
    heat, mean = RHO_PETG * C_PETG * area * ROTOR / PLATE, np.mean(warm[first:CHAIN])
    for i in range(first, CHAIN):
        if i + 1 < CHAIN:
            on = (warm[i] - warm[i + 1]) / (2.0 * plate)
        else:
            grey = RADIATION * (warm[i] ** 2 + AMBIENT**2) * (warm[i] + AMBIENT)
            on = (warm[i] - AMBIENT) / (plate + 1.0 / ((PARTS_AIR + grey) * area))
        aside = (to_edge * (mean - bodies[0]) + uneven * (warm[i] - mean)) / PLATE
        f[i] = (flow - on - aside) / heat
        gain[0] += aside
        flow = on
    for n in range(LINKS):
        a, b = JOINED[n]
        near, other = bodies[a], bodies[b]
        passed = q[CONDUCTS + n] * (near - other)
        if n >= LINKS - 3:
            passed += q[CONDUCTS + n + 3] * BLACK * (near**4 - other**4)
        gain[a] -= passed
        gain[b] += passed
    lose(bodies, q, gain)
    return across * within


@njit(cache=True)
def of_bodies(bodies: Array, q: Array, among: Array) -> None:
    """Slopes of the rates of bodies and legs by their temperatures and the plate's mean."""
    to_edge, _, to_corner, to_side, to_ledge, up = q[EDGES : EDGES + 6]
    among[0, 0], among[0, BODIES + 1] = -to_edge - up, to_edge
    by_legs = OF_LEGS_EDGE * to_side
    among[COLD_WALL, COLD_WALL], among[LEDGE, LEDGE], among[CORNER, CORNER] = (
        -to_side - by_legs, -to_ledge, -to_corner - by_legs
    )  # fmt: skip
    among[COLD_WALL, LEGS] = among[CORNER, LEGS] = 2.0 / 3.0 * by_legs
    legs, own = among[LEGS], OF_LEGS * q[4]
    legs[COLD_WALL] = legs[CORNER] = 2.0 / 3.0 * by_legs / own
    legs[LEGS] = -(16.0 / 3.0 * CONDUCTANCE * q[3] + 8.0 / 9.0 * by_legs) / own
    for i in range(3):
        among[OVER[i], OVER[i]] -= q[ABOVE_FACES + i]
    for i in range(4):
        among[UNDER[i], UNDER[i]] -= q[BELOW_FACES + i]
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
        _, steep = loss(bodies[k], PARTS_AIR, BEHIND[k])
        among[k, k] -= q[SURFACES + k] * steep
        among[k] /= q[CAPACITIES + k]


@njit(cache=True)
def of_free_side(q: Array, a: Array) -> None:
    """Slopes of what the layer's cells give at their free side in the hot sides' place, which stand in the border once
    more."""
    to_corner, to_side, up = q[EDGES + 2], q[EDGES + 3], q[EDGES + 5]
    side, above = q[OF_LAYER] * (to_corner - to_side), q[OF_LAYER] * up
    had, capacity, mass = a[3 : 3 + TOUCH], OF_SIDE * q[4], RHO_PCL * q[1] * q[2] / CELLS
    a[1, 1] += (side + above) / capacity
    had[0, 1] -= above / capacity
    had[3, 1] -= side / capacity
    a[2 + 2 * TOUCH, 1] = 1.0
    for i in range(CELLS):
        part = FALLING[i] / mass
        had[0, 2 + i], had[3, 2 + i], had[TOUCH - 1, 2 + i] = above * part, side * part, -(side + above) * part


@njit(cache=True)
def jacobian(y: Array, q: Array, p: Array, a: Array) -> None:
    """Slopes of the rates, in rows as `hand_chain.ROWS` says."""
    current, area, thick, scale, capacity, windows = q[0], q[1], q[2], q[3], OF_SIDE * q[4], q[5]
    to_edge, uneven, to_corner, to_side, to_ledge, up = q[EDGES : EDGES + 6]
    warm = p[0]
    carried, through, of_legs = SEEBECK * current * scale, CONDUCTANCE * scale, OF_LEGS_EDGE * to_side
    _, steep = loss(warm[0], OPEN_AIR, 0.0)
    a[:] = 0.0
    had, given = a[3 : 3 + TOUCH], a[3 + TOUCH : 3 + 2 * TOUCH]
    within = 7.0 / 3.0 * through + 13.0 / 72.0 * of_legs
    a[1, 0] = -(carried + within + windows * steep + to_side + to_ledge + q[ABOVE_FACES + 3]) / capacity
    a[2, 0] = a[0, 1] = (5.0 / 72.0 * of_legs - through / 3.0) / capacity
    a[1, 1] = (carried - within - to_corner - up) / capacity
    had[0, 1], had[1, 0], had[2, 0], had[3, 1] = (
        up, to_side + 5.0 / 12.0 * of_legs, to_ledge, to_corner + 5.0 / 12.0 * of_legs
    )  # fmt: skip
    had[1, 1] = had[3, 0] = -of_legs / 12.0
    had[4, 0] = had[4, 1] = 8.0 / 3.0 * through - 2.0 / 9.0 * of_legs
    given[:, :2] = had[:, :2]
    had[:, :2] /= capacity
    given[0] /= q[CAPACITIES]
    given[1] /= q[CAPACITIES + COLD_WALL]
    given[2] /= q[CAPACITIES + LEDGE]
    given[3] /= q[CAPACITIES + CORNER]
    given[4] /= OF_LEGS * q[4]
    of_free_side(q, a)
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
        divisor = capacity if i == 1 else (mass if i < first else heat)
        other = mass if i + 1 < first else heat
        a[1, i] -= from_here / divisor
        a[2, i] -= from_there / divisor
        a[0, i + 1] += from_here / other
        a[1, i + 1] += from_there / other
    last = warm[CHAIN - 1]
    grey = PARTS_AIR + RADIATION * (last**2 + AMBIENT**2) * (last + AMBIENT)
    steep = RADIATION * (3.0 * last**2 + 2.0 * last * AMBIENT + AMBIENT**2)
    resistance = plate + 1.0 / (grey * area)
    a[1, CHAIN - 1] -= (1.0 + (last - AMBIENT) / resistance * steep / (grey**2 * area)) / resistance / heat
    for i in range(first, CHAIN):
        a[1, i] -= uneven / PLATE / heat
        had[0, i], had[TOUCH - 2, i] = to_edge / PLATE / heat, (uneven - to_edge) / PLATE / heat
        given[TOUCH - 2, i] = 1.0 / PLATE
    of_bodies(y[CHAIN:], q, a[3 + 2 * TOUCH :])
