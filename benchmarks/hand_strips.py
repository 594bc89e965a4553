"""The reference problem's strips written out by hand for numba: plate and floor beside the arcs, and the air between.

Each is three bodies; the ledges below the pads are one more.
"""

from __future__ import annotations

import math

import numpy as np
from hand_module import (
    AMBIENT,
    ARCS,
    BEND,
    BLACK,
    C_PETG,
    CORE,
    EMISSIVITY,
    FLOOR,
    INNER,
    K_MELT,
    K_PETG,
    K_SOLID,
    PAD,
    PI,
    RADIAL,
    RHO_PETG,
    RIM,
    ROTOR,
    Array,
)
from hand_polymer import MOLTEN
from numba import njit

K_PAD, PAD_EDGE = 6.0, 150.0  # in their plane; into the walls of their pockets [W/m^2 K]
K_UP = 0.12 / 1.6e-3 * PAD  # across them
STRIP, WAYS, BEYOND = (0.087, 0.247, 0.666), (0.029, 0.153, 0.395), 0.423
INTO_SLOT, BEFORE_SLOT, K_AIR, ZETA_3, HOUSING_AIR = 0.2619, 0.27993, 0.028, 1.2020569032, 5.0


@njit(cache=True)
def along_cold_sides(share: float, width: float) -> float:
    """Return the resistance along the pads' cold side to a share of it, times the length of the pads' edges [m K/W]."""
    mean = math.sqrt(K_PAD * K_UP)
    sheet, depth = K_PAD * PAD / (12.0 * mean * width), 10.0 / 12.0 * PAD * math.sqrt(K_PAD / K_UP) / width
    fall = 0.0
    for i in range(1, 9):
        wave = i * PI
        along = math.tanh(wave * depth) + wave * sheet
        fall += 2.0 * math.sin(wave * share) ** 2 / (wave**3 * share**2 * along)
    return fall / mean


@njit(cache=True)
def beside(x: Array, heat: Array) -> None:
    """Fill in the bodies beside the plate and around the pads, what joins them, and what pads and plate give them."""
    area, t, windows, outer = heat[1], heat[2], heat[5], x[4]
    rotor, inside = outer + RIM, x[3] + math.sqrt(0.25 * x[1] ** 2 + (BEND * x[0]) ** 2) + 0.5 * x[0] + RADIAL
    edge = ARCS * (2.0 * (outer - INNER) + x[5] * (INNER + outer))
    bare, web, per_volume = PI * rotor**2 - area, FLOOR - PAD, RHO_PETG * C_PETG
    way, ledge = area / edge / 3.0, area - windows
    slim = area / edge * math.sqrt(0.5 * (K_SOLID + K_MELT) / t / (K_PETG * ROTOR))
    over = area / edge * (1.0 / (slim * math.tanh(slim)) - slim**-2.0)
    own = np.array([share * bare / edge for share in STRIP])
    wide = bare / edge
    half = WAYS[0] * wide
    # heat capacities and surfaces, in the order of hand_chain
    for i in range(3):
        heat[6 + i], heat[19 + i] = own[i] * edge * ROTOR * per_volume, own[i] * edge
        heat[10 + i], heat[23 + i] = own[i] * edge * PAD * per_volume * (1.0 if i else 0.5), 0.0
        heat[13 + i], heat[26 + i] = own[i] * edge * web * per_volume, own[i] * edge
    heat[16], heat[29], heat[17], heat[30] = ledge * web * per_volume, ledge, heat[10], 0.0
    # plate to its edge, and what differs over its depth from its mean; a side of the pads, a sixth of half their height
    sheet = K_PETG * ROTOR * edge
    heat[32], heat[33] = sheet / (over + half), sheet / (over + ROTOR / PI)
    side = 0.5 * PAD * edge
    heat[35] = 1.0 / 6.0 / (way / (K_PAD * side) + 1.0 / (PAD_EDGE * side) + half / (K_PETG * side))
    # the layer's side: through the end of the gap to the floor's corner, and to the plate
    grey = EMISSIVITY / (2.0 - EMISSIVITY)
    crosswise = K_AIR + t * grey * BLACK * (MOLTEN**2 + AMBIENT**2) * (MOLTEN + AMBIENT)
    evenly = math.sqrt(K_AIR * crosswise)
    near = math.log(1.0 + (0.5 * PAD_EDGE * t / evenly) ** 2) / PI + INTO_SLOT
    through = edge / (1.0 / evenly + 1.0 / K_MELT)
    heat[34] = heat[35] + 1.0 / (1.0 / (near * through) + near / (3.0 * K_PETG * edge))
    far = 2.0 / PI * math.log(2.0)
    heat[37] = far * through
    whole = 3.5 * ZETA_3 / PI**3
    heat[59] = 12.0 * whole / (1.0 + BEFORE_SLOT * evenly / (PAD_EDGE * t) / whole) / (near + far)
    # ledges: heated over their face, and on to their root
    slim = ledge / edge / web
    falling = 0.0
    for i in range(1, 4):
        falling += math.exp(-2.0 * i * PI * slim) / i**3
    aside = along_cold_sides(ledge / area, area / edge) / edge
    heat[36] = 1.0 / (aside + (1.0 / (3.0 * slim) - (ZETA_3 - falling) / (PI**3 * slim**2)) / (K_PETG * edge))
    # links: along the plate, along the floor and down into it, ledges, the gap
    heat[38], heat[39] = sheet / (WAYS[1] * wide), sheet / (WAYS[2] * wide)
    ring = math.log(inside / rotor) / (2.0 * PI * K_PETG)
    upper, lower = K_PETG * PAD * edge, K_PETG * web * edge
    heat[41] = heat[42] = 0.5 * upper / (WAYS[1] * wide)
    heat[43], heat[44] = upper / (WAYS[2] * wide), 1.0 / (BEYOND * wide / upper + ring / PAD)
    heat[45], heat[46] = lower / (WAYS[1] * wide), lower / (WAYS[2] * wide)
    # the lower strip's end is colder than its last body, and loses heat there
    along, out, share = lower / (BEYOND * wide), web / ring, 1.0 - 0.5 * STRIP[2] / BEYOND
    open_air = HOUSING_AIR + 4.0 * EMISSIVITY * BLACK * AMBIENT**3
    ends = share * heat[28]
    total = along + out + ends / (1.0 / open_air + web / (3.0 * K_PETG))
    heat[47] = along * out / total
    heat[28] -= ends * (1.0 - along / total)
    heat[31] += ends * out / total
    heat[48] = K_PETG * own[0] * edge / (0.5 * PAD)
    for i in range(3):
        heat[49 + i] = K_PETG * own[i] * edge / ((0.5 if i else 0.25) * PAD + web / 3.0)
    heat[52] = lower / (slim * web / 3.0 + half)
    # what is above a slab that cools below warms its lower face less than its mean: three of the floor, and the ledges
    air = HOUSING_AIR + 4.0 * EMISSIVITY * BLACK * AMBIENT**3
    turned = 0.0
    for i in range(1, 4):
        turned += (-1.0) ** (i + 1) * math.exp(-2.0 * i * PI * slim) / i**3
    for i in range(4):
        if i < 3:
            place, through, less = 49 + i, 26 + i, web / 6.0 / (K_PETG * own[i] * edge)
        else:
            place, through = 36, 29
            less = (1.0 / (6.0 * slim) - (0.75 * ZETA_3 - turned) / (PI**3 * slim**2)) / (K_PETG * edge)
        crossed = less * heat[through] * air / (1.0 + air * web / (3.0 * K_PETG))
        whole = 1.0 / heat[place] - less * crossed
        heat[place], heat[60 + i] = (1.0 + crossed) / whole, -crossed / whole
        heat[64 + i] = (1.0 + crossed) * crossed / whole
    heat[40] = 1.0 / (math.log(INNER / CORE) / (2.0 * PI * K_PETG * ROTOR) + BEYOND * wide / sheet)
    walls = (ROTOR / 3.0 + 0.5 * PAD) / K_PETG
    share = 1.0 / (1.0 + walls * (K_AIR / t + 4.0 * grey * BLACK * AMBIENT**3))
    for i in range(3):
        heat[53 + i], heat[56 + i] = share * K_AIR / t * own[i] * edge, share * grey * own[i] * edge
    heat[18] -= np.sum(heat[10:18])
