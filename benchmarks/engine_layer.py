"""Impedance of the joint at an instant: the layer in columns of slices, each of its own temperature, and its structure.

All in complex numbers: a slice of modulus G = G' + i G'' gives by 1/G, slices of a column add up what they give, and
columns their moduli. Numbers of the layer in `q`, from `net.impedance` on: see `engine_network.Assembler.of_layer`.
Constants `r`: see `engine_network.Assembler.rheology`.
"""

from __future__ import annotations

import math

import numpy as np
from engine_cells import BY_PSI_T, ZERO, ramp
from engine_heat import FAST, KM, KS, potential
from engine_network import Array, Network
from numba import njit

MODES = 16
"""Where the modes' logarithms begin in the constants: times and shares of the solid, times and moduli of the melt."""
PARTS = 7
"""Parts of the structure: core, beside, plate, walls, floor, pads, and what is without loss."""


@njit(cache=True, fastmath=FAST)
def fraction_at(kelvin: float, m: Array) -> tuple[float, float]:
    """Return the solid fraction on the melting curve at a temperature, and its slope."""
    middle = (m[5] - m[4]) / (m[3] - m[2])
    solid, melt = 1.0 / m[0], 1.0 / m[1]
    one, up_one = ramp(kelvin - m[4], m[6] * math.sqrt(solid * middle))
    two, up_two = ramp(kelvin - m[5], m[6] * math.sqrt(middle * melt))
    rise, fall = 1.0 / middle - m[0], m[1] - 1.0 / middle
    heat, steep = m[0] * (kelvin - ZERO) + rise * one + fall * two, m[0] + rise * up_one + fall * up_two
    first, up = ramp(heat - m[2], m[6])
    last, beyond = ramp(heat - m[3], m[6])
    return 1.0 - (first - last) / (m[3] - m[2]), -(up - beyond) * steep / (m[3] - m[2])


@njit(cache=True, fastmath=FAST)
def modulus(kelvin: float, m: Array, r: Array) -> tuple[complex, complex]:
    """Return the complex shear modulus of a slice that melts [Pa], and its slope by temperature."""
    fraction, by_fraction = fraction_at(kelvin, m)
    risen = math.exp((kelvin - r[4]) / r[5])
    level, by_level = r[1] - r[3] * r[5] * math.log1p(risen), -r[3] * risen / (1.0 + risen)
    shift, by_shift = r[7] * (1.0 / kelvin - 1.0 / r[8]), -r[7] / kelvin**2
    count, molten = (r.size - MODES) // 4, 1.0 - fraction
    storage, loss, up, out = 0.0, 0.0, 0.0, 0.0
    for k in range(count):
        solid, share = r[MODES + k], level + r[MODES + count + k]
        time, melt = shift + r[MODES + 2 * count + k], r[MODES + 3 * count + k]
        x = r[0] * math.exp(fraction * solid + molten * time)
        g = math.exp(fraction * share + molten * melt)
        slower = by_fraction * (solid - time) + molten * by_shift
        stiffer = by_fraction * (share - melt) + fraction * by_level
        less = 1.0 / (1.0 + x * x)
        real, imaginary = g * x * x * less, g * x * less
        storage += real
        loss += imaginary
        up += real * (stiffer + 2.0 * less * slower)
        out += imaginary * (stiffer + (1.0 - x * x) * less * slower)
    return complex(storage, loss), complex(up, out)


@njit(cache=True, fastmath=FAST)
def softened(kelvin: float, r: Array) -> tuple[complex, complex]:
    """Return the complex modulus of the structure over that at 23 degC, and its slope by temperature."""
    step = 1.0 / (1.0 + math.exp(-(kelvin - r[10]) / r[11]))
    at_23 = 1.0 / (1.0 + math.exp(-(296.15 - r[10]) / r[11]))
    fall, by = math.log(r[12]), step * (1.0 - step) / r[11]
    share = math.exp(fall * (step - at_23) - r[9] * (kelvin - 296.15))
    over = r[14] - r[13]
    factor = complex(1.0, r[13] + over * 4.0 * step * (1.0 - step) + r[15])
    return share * factor, share * ((fall * by - r[9]) * factor + complex(0.0, over * 4.0 * (1.0 - 2.0 * step) * by))


@njit(cache=True, fastmath=FAST)
def softness(
    t: Array, p: Array, s: Array, q: Array, dq: Array, m: Array, r: Array, net: Network, direct: Array, d: Array
) -> float:
    """Return how far the joint is below its threshold, as a logarithm; its derivatives along the directions in `d`.

    A layer on the melting curve. Without columns of `d` the derivatives are left out.
    """
    n, columns, count, nodes = net.cells, net.layer_columns, d.size, net.nodes
    at = net.impedance
    in_plate = at + 3 * nodes
    share_at, warmer = in_plate + columns, in_plate + columns + n
    below = warmer + columns * n
    last = below + columns * n
    pads, plate, through = 0.0, 0.0, 0.0
    for i in range(nodes):
        pads += q[at + i] * t[i]
        plate += q[at + nodes + i] * t[i]
        through += q[at + 2 * nodes + i] * t[i]
    wall = t[net.lip + 1] if net.lip >= 0 else t[n + net.plate + 2]
    at_wall, k_wall = potential(wall, m)
    middle = 0.5 * (m[KS] + m[KM])
    theta, conducts = np.empty(n), np.empty(n)
    for j in range(n):
        theta[j], conducts[j] = potential(t[j], m)
    of_slices, of_columns = np.empty((columns, n), np.complex128), np.empty(columns, np.complex128)
    weights, whole = np.zeros((columns, n, 4)), 0.0j
    shares, fed = net.column_shares, net.fed_evenly
    for i in range(columns):
        given = 0.0j
        for j in range(n):
            w, share = q[warmer + i * n + j], q[share_at + j]
            even = wall + w * (t[j] - wall)
            at_even, k_even = potential(even, m)
            kelvin = even - (at_even - at_wall - w * (theta[j] - at_wall)) / middle
            near, far = pads * fed[i], plate * q[in_plate + i]
            g, steep = modulus(kelvin - through * q[below + i * n + j] - near - (far - near) * share, m, r)
            given += 1.0 / g
            of_slices[i, j] = steep / (g * g)
            weights[i, j, 0] = w - w * (k_even - conducts[j]) / middle
            weights[i, j, 1] = (1.0 - w) * (1.0 - (k_even - k_wall) / middle)
            weights[i, j, 2] = t[j] - wall - (k_even * (t[j] - wall) - theta[j] + at_wall) / middle
            weights[i, j, 3] = far - near
        of_columns[i] = n / given
        whole += shares[i] * of_columns[i]
    moment, springs, threshold, parts = q[last], q[last + 1], q[last + 2], last + 3
    layer, cold, hot, beside = whole * moment, n + net.plate, n + net.plate + 2, n + net.plate + 3
    core = beside + net.beside - 1
    moduli, by = np.ones(PARTS, np.complex128), np.zeros(PARTS, np.complex128)
    moduli[0], by[0] = softened(t[core], r)
    moduli[1], by[1] = softened(t[core] + (t[beside] - t[core]) / 3.0, r)
    moduli[2] = 0.0
    of_plate = np.empty(net.plate, np.complex128)
    for k in range(net.plate):
        one, of_plate[k] = softened(t[n + k], r)
        moduli[2] += one / net.plate
    moduli[3], by[3] = softened(0.5 * (t[hot] + t[cold]), r)
    moduli[4], by[4] = softened(t[cold], r)
    moduli[5] = complex(1.0, r[13] + r[15])
    give = 0.0j
    for k in range(PARTS):
        give += q[parts + k] / moduli[k]
    branch = 1.0 / (1.0 / layer + give)
    joint = springs + branch
    size = abs(joint)
    if count == 0:
        return math.log(threshold) - math.log(size)
    of_branch = joint.conjugate() / size * branch * branch
    of_layer = of_branch / (layer * layer)
    for j in range(count):
        moved = (joint.conjugate() / size).real * dq[last + 1, j] + (of_layer * whole).real * dq[last, j]
        for k in range(PARTS):
            moved -= (of_branch / moduli[k]).real * dq[parts + k, j]
        d[j] = moved
    heated = np.zeros(nodes)
    for k in (0, 1, 3, 4):
        along = (of_branch * by[k] / moduli[k] ** 2).real * q[parts + k]
        if k == 1:
            heated[core] += 2.0 / 3.0 * along
            heated[beside] += along / 3.0
        elif k == 3:
            heated[hot] += 0.5 * along
            heated[cold] += 0.5 * along
        else:
            heated[core if k == 0 else cold] += along
    for k in range(net.plate):
        heated[n + k] += (of_branch * of_plate[k] / moduli[2] ** 2).real * q[parts + 2] / net.plate
    for i in range(columns):
        of_column = of_layer * moment * shares[i] * of_columns[i] ** 2 / n
        for j in range(n):
            along, share = (of_column * of_slices[i, j]).real, q[share_at + j]
            heated[j] += along * weights[i, j, 0]
            heated[net.lip + 1 if net.lip >= 0 else hot] += along * weights[i, j, 1]
            of_pads, of_plate_drop = -along * (1.0 - share) * fed[i], -along * share * q[in_plate + i]
            of_through = -along * q[below + i * n + j]
            for k in range(count):
                d[k] += along * (weights[i, j, 2] * dq[warmer + i * n + j, k] - through * dq[below + i * n + j, k])
                d[k] -= along * (weights[i, j, 3] * dq[share_at + j, k] + share * plate * dq[in_plate + i, k])
            weights[i, j, 0], weights[i, j, 1], weights[i, j, 2] = of_pads, of_plate_drop, of_through
    of_drops = np.zeros(3)
    for i in range(columns):
        for j in range(n):
            for k in range(3):
                of_drops[k] += weights[i, j, k]
    for i in range(nodes):
        for part in range(3):
            heated[i] += of_drops[part] * q[at + part * nodes + i]
            for j in range(count):
                d[j] += of_drops[part] * t[i] * dq[at + part * nodes + i, j]
        slope = p[1, i] if i < n else 1.0
        for j in range(count):
            d[j] += heated[i] * slope * s[i, j]
            if i < n and direct.size > 0:
                d[j] += heated[i] * p[BY_PSI_T, i] * direct[i, j]
    for j in range(count):
        d[j] = dq[last + 2, j] / threshold - d[j] / size
    return math.log(threshold) - math.log(size)
