"""Cells that change phase: temperature and conductivity by enthalpy, on the melting curve or with a history.

With a history each cell has an extended variable psi, and dpsi/dt follows from its temperature and itself. A stage of
the time step solves it within the cell, so that a cell is one unknown to the network either way.
Rows of the table `p`: temperature, slope, conductivity, slope, potential, slope; then for a history psi, what
temperature and conductivity move by with psi at one enthalpy, slope of psi by enthalpy, one over what psi's equation
moves by, and psi's rate.
"""

from __future__ import annotations

import math

from engine_heat import FAST, potential
from engine_network import HEAT_UNIT, Array
from numba import njit

GAS = 8.314462618
ZERO = 273.15
ROWS = 12
PSI, BY_PSI_T, BY_PSI_K, PSI_BY, INVERSE, RATE = 6, 7, 8, 9, 10, 11


@njit(cache=True, fastmath=FAST)
def ramp(z: float, width: float) -> tuple[float, float]:
    """Return max(z, 0) with a rounded corner, and its slope."""
    root = math.sqrt(z * z + width * width)
    return 0.5 * (z + root), 0.5 * (1.0 + z / root)


@njit(cache=True, fastmath=FAST)
def melting(y: Array, n: int, m: Array, p: Array) -> None:
    """Fill the table of cells on the equilibrium curve."""
    cs, cm, h1, h2, start, end, width, ks, km = m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]
    middle = (end - start) / (h2 - h1)
    for i in range(n):
        h = HEAT_UNIT * y[i]
        first, up = ramp(h - h1, width)
        last, beyond = ramp(h - h2, width)
        p[0, i] = ZERO + h / cs + (middle - 1.0 / cs) * first + (1.0 / cm - middle) * last
        p[1, i] = HEAT_UNIT * (1.0 / cs + (middle - 1.0 / cs) * up + (1.0 / cm - middle) * beyond)
        p[2, i] = ks - (ks - km) * (first - last) / (h2 - h1)
        p[3, i] = -HEAT_UNIT * (ks - km) * (up - beyond) / (h2 - h1)
        p[4, i], conducts = potential(p[0, i], m)
        p[5, i] = conducts * p[1, i]


@njit(cache=True, fastmath=FAST)
def _growth(kelvin: float, m: Array) -> tuple[float, float]:
    """Return the logarithm of the growth rate but for a constant, and its slope by temperature."""
    above, up = ramp(kelvin - (m[16] - 30.0), 0.5)
    under, down = ramp(m[15] - kelvin, 0.5)
    twice = kelvin + m[15]
    correction = 2.0 * kelvin / twice
    nucleation = m[14] / (kelvin * under * correction)
    transport = m[17] / (GAS * above)
    by = -1.0 / kelvin + down / under - (1.0 / kelvin - 1.0 / twice)
    return -transport - nucleation, transport * up / above - nucleation * by


@njit(cache=True, fastmath=FAST)
def extended(fraction: float, n: float) -> tuple[float, float]:
    """Return psi of a solid fraction, and its slope."""
    over, up = ramp(1.0 - fraction - 1e-4, 1e-4)
    molten = 1e-4 + over
    extent, by = -math.log(molten), up / molten
    square, power = extent**2 + 1e-6, 0.5 / n - 0.5
    root = square**power
    return extent * root, by * (root + 2.0 * power * extent**2 * root / square)


@njit(cache=True, fastmath=FAST)
def frozen(psi: float, n: float) -> tuple[float, float]:
    """Return the solid fraction of psi, and its slope."""
    above, up = ramp(psi, 1e-3)
    raised = above**n
    left = math.exp(-raised)
    return 1.0 - left, left * n * raised / above * up


@njit(cache=True, fastmath=FAST)
def psi_rate(kelvin: float, psi: float, level: float, m: Array) -> tuple[float, float, float]:
    """Return the rate of psi [1/s] and its slopes by temperature and psi; `level` is `_growth` at the reference."""
    logarithm, steep = _growth(kelvin, m)
    above, up = ramp(logarithm - level + 200.0, 0.1)
    speed = math.log(2.0) ** (1.0 / m[11]) / m[12] * math.exp(above - 200.0)
    one, up_one = ramp(kelvin - m[4], 0.5)
    two, up_two = ramp(kelvin - m[5], 0.5)
    window = m[5] - m[4]
    largest, by = extended(1.0 - (one - two) / window, m[11])
    by *= -(up_one - up_two) / window
    excess, more = ramp(psi - largest, 1e-3)
    none, less = ramp(-largest, 1e-3)
    return speed - (excess - none) / m[18], speed * up * steep - (less - more) * by / m[18], -more / m[18]


@njit(cache=True, fastmath=FAST)
def freezing(y: Array, base: Array, h: float, n: int, m: Array, p: Array) -> None:
    """Fill the table of cells with a history: psi = base + h rate, solved from the psi that the table has."""
    cs, cm, ks, km = m[0], m[1], m[7], m[8]
    at_zero = m[3] + cm * (ZERO - m[5])
    level, _ = _growth(m[13], m)
    for i in range(n):
        heat, psi = HEAT_UNIT * y[i], p[PSI, i]
        for _ in range(30):
            x, x_psi = frozen(psi, m[11])
            capacity = x * cs + (1.0 - x) * cm
            t = ZERO + (heat - (1.0 - x) * at_zero) / capacity
            t_psi = (at_zero - (t - ZERO) * (cs - cm)) / capacity * x_psi
            rate, by_t, by_psi = psi_rate(t, psi, level, m)
            inverse = 1.0 / (1.0 - h * (by_t * t_psi + by_psi))
            step = inverse * (base[i] + h * rate - psi)
            if abs(step) < 1e-10:
                break
            psi += min(max(step, -0.5), 0.5)
        t_heat = HEAT_UNIT / capacity
        p[PSI, i], p[INVERSE, i], p[RATE, i], p[PSI_BY, i] = psi, inverse, rate, inverse * h * by_t * t_heat
        p[BY_PSI_T, i], p[BY_PSI_K, i] = t_psi, (ks - km) * x_psi
        p[0, i], p[1, i] = t, t_heat + t_psi * p[PSI_BY, i]
        p[2, i], p[3, i] = km + x * (ks - km), p[BY_PSI_K, i] * p[PSI_BY, i]
