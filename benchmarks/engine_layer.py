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
from numpy.typing import NDArray

Complex = NDArray[np.complex128]

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
def columns_of(
    t: Array, drops: Array, q: Array, m: Array, r: Array, net: Network, slices: Complex, columns: Complex, by: Array
) -> complex:
    """Return the complex modulus of a layer on the melting curve [Pa]: columns side by side, slices in series.

    Fills in what each slice gives more with its temperature, the columns' moduli, and what a slice's temperature moves
    by with that of its cell, the end's, its share of the way between the two, and the plate's drop over the pads'.
    """
    n, place = net.cells, net.impedance + 3 * net.nodes
    wall, middle = t[end_of(net)], 0.5 * (m[KS] + m[KM])
    at_wall, k_wall = potential(wall, m)
    whole = 0.0j
    for i in range(net.layer_columns):
        give = 0.0j
        near, far = drops[0] * net.fed_evenly[i], drops[1] * q[place + i]
        for j in range(n):
            here = place + net.layer_columns + n + i * n + j
            w, below, share = q[here], q[here + net.layer_columns * n], q[place + net.layer_columns + j]
            (theta, k_cell), over = potential(t[j], m), t[j] - wall
            at_even, k_even = potential(wall + w * over, m)
            kelvin = wall + w * over - (at_even - at_wall - w * (theta - at_wall)) / middle
            g, steep = modulus(kelvin - drops[2] * below - near - (far - near) * share, m, r)
            give += 1.0 / g
            slices[i, j] = steep / (g * g)
            by[i, j, 0] = w - w * (k_even - k_cell) / middle
            by[i, j, 1] = (1.0 - w) * (1.0 - (k_even - k_wall) / middle)
            by[i, j, 2] = over - (k_even * over - theta + at_wall) / middle
            by[i, j, 3] = far - near
        columns[i] = n / give
        whole += net.column_shares[i] * columns[i]
    return whole


@njit(cache=True, fastmath=FAST)
def end_of(net: Network) -> int:
    """Return the node at the layer's end: the lip, or the pads where nothing of it counts."""
    return net.lip + 1 if net.lip >= 0 else net.cells + net.plate + 2


@njit(cache=True, fastmath=FAST)
def structure(t: Array, q: Array, r: Array, net: Network, at: int, moduli: Complex, heated: Array) -> complex:
    """Return the complex compliance of the structure [rad/(N*m)] and its parts' moduli, compliances from `at` on.

    Fills in by how much each node's temperature adds to the compliance: real and imaginary part, a row each.
    """
    n, cold, hot, beside = net.cells, net.cells + net.plate, net.cells + net.plate + 2, net.cells + net.plate + 3
    core, by = beside + net.beside - 1, np.zeros(PARTS, np.complex128)
    moduli[0], by[0] = softened(t[core], r)
    moduli[1], by[1] = softened(t[core] + (t[beside] - t[core]) / 3.0, r)
    moduli[2], moduli[5], moduli[6] = 0.0, complex(1.0, r[13] + r[15]), 1.0
    of_plate = np.empty(net.plate, np.complex128)
    for k in range(net.plate):
        one, of_plate[k] = softened(t[n + k], r)
        moduli[2] += one / net.plate
    moduli[3], by[3] = softened(0.5 * (t[hot] + t[cold]), r)
    moduli[4], by[4] = softened(t[cold], r)
    give = 0.0j
    for k in range(PARTS):
        give += q[at + k] / moduli[k]
        by[k] *= -q[at + k] / moduli[k] ** 2
    for node, one in (
        (core, by[0] + by[1] * (2.0 / 3.0)),
        (beside, by[1] * (1.0 / 3.0)),
        (hot, by[3] * 0.5),
        (cold, by[3] * 0.5 + by[4]),
    ):
        heated[0, node] += one.real
        heated[1, node] += one.imag
    for k in range(net.plate):
        one = -q[at + 2] / net.plate * of_plate[k] / moduli[2] ** 2
        heated[0, n + k] += one.real
        heated[1, n + k] += one.imag
    return give


@njit(cache=True, fastmath=FAST)
def softness(
    t: Array, p: Array, s: Array, q: Array, dq: Array, m: Array, r: Array, net: Network, direct: Array, d: Array
) -> float:
    """Return how far the joint is below its threshold, as a logarithm; its derivatives along the directions in `d`.

    Without columns of `d` the derivatives are left out.
    """
    n, columns, nodes = net.cells, net.layer_columns, net.nodes
    last = net.impedance + 3 * nodes + columns + n + 2 * columns * n
    drops = np.zeros(3)
    for k in range(3):
        for i in range(nodes):
            drops[k] += q[net.impedance + k * nodes + i] * t[i]
    slices, of_columns = np.empty((columns, n), np.complex128), np.empty(columns, np.complex128)
    by, moduli, heated = np.empty((columns, n, 4)), np.empty(PARTS, np.complex128), np.zeros((2, nodes))
    whole = columns_of(t, drops, q, m, r, net, slices, of_columns, by)
    give = structure(t, q, r, net, last + 3, moduli, heated)
    layer = whole * q[last]
    branch = 1.0 / (1.0 / layer + give)
    joint = q[last + 1] + branch
    size = abs(joint)
    if d.size == 0:
        return math.log(q[last + 2]) - math.log(size)
    # What the size moves by with compliances of the branch, and with the layer's modulus.
    of_give = -joint.conjugate() / size * branch * branch
    of_whole = -of_give / (layer * whole)
    for j in range(d.size):
        d[j] = (joint.conjugate() / size).real * dq[last + 1, j] + (of_whole * whole / q[last]).real * dq[last, j]
        for k in range(PARTS):
            d[j] += (of_give / moduli[k]).real * dq[last + 3 + k, j]
    along = heated[0] * of_give.real - heated[1] * of_give.imag
    for i in range(columns):
        of_slice = of_whole * net.column_shares[i] * of_columns[i] ** 2 / n
        for j in range(n):
            slices[i, j] = slices[i, j] * of_slice
    _of_slices(drops, q, dq, net, slices, by, t, along, d)
    for i in range(nodes):
        slope = p[1, i] if i < n else 1.0
        for j in range(d.size):
            d[j] += along[i] * slope * s[i, j]
            if i < n and direct.size > 0:
                d[j] += along[i] * p[BY_PSI_T, i] * direct[i, j]
    for j in range(d.size):
        d[j] = dq[last + 2, j] / q[last + 2] - d[j] / size
    return math.log(q[last + 2]) - math.log(size)


@njit(cache=True, fastmath=FAST)
def _of_slices(
    drops: Array, q: Array, dq: Array, net: Network, slices: Complex, by: Array, t: Array, along: Array, d: Array
) -> None:
    """Add what slices of the layer move by: to `along` by the nodes' temperatures, to `d` by the numbers."""
    n, columns, nodes, of_drops = net.cells, net.layer_columns, net.nodes, np.zeros(3)
    place = net.impedance + 3 * nodes
    for i in range(columns):
        for j in range(n):
            here, share = place + columns + n + i * n + j, place + columns + j
            below, one = here + columns * n, slices[i, j].real
            along[j] += one * by[i, j, 0]
            along[end_of(net)] += one * by[i, j, 1]
            of_drops[0] -= one * (1.0 - q[share]) * net.fed_evenly[i]
            of_drops[1] -= one * q[share] * q[place + i]
            of_drops[2] -= one * q[below]
            for k in range(d.size):
                d[k] += one * (by[i, j, 2] * dq[here, k] - drops[2] * dq[below, k] - by[i, j, 3] * dq[share, k])
                d[k] -= one * q[share] * drops[1] * dq[place + i, k]
    for k in range(3):
        for i in range(nodes):
            at = net.impedance + k * nodes + i
            along[i] += of_drops[k] * q[at]
            for j in range(d.size):
                d[j] += of_drops[k] * t[i] * dq[at, j]
