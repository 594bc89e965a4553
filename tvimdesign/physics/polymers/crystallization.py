"""Freezing of a semicrystalline polymer below its melting window, and melting again: rate, solid fraction, temperature.

The state is psi [1], the extended variable of nucleation and growth; the solid fraction is X = 1 - exp(-psi^n). At a
constant temperature psi = K t, which is Avrami's law; at a changing one its integral is Nakamura's. The solid cannot be
more than its equilibrium fraction: what is above it melts within `melting_time`. Temperatures in kelvin, from 200 to
500 K; specific enthalpy in J/kg, zero at 0 degC in the solid. Every function is smooth, corners are rounded.
Sources: [A] Avrami, J. Chem. Phys. 8 (1940) 212; [N] Nakamura, Katayama and Amano, J. Appl. Polym. Sci. 17 (1973) 1031;
[H] Hoffman, Davis and Lauritzen, in Treatise on Solid State Chemistry 3 (1976) ch. 7 (growth rate, U, f, T_inf).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.polymers.polymer import GAS_CONSTANT, ZERO_CELSIUS, Melting, ramp

BELOW_GLASS = 30.0  # K; molecules stop moving that far below the glass transition [H]
# Roundings, each small against what it rounds.
_UNDERCOOLING_ROUNDING = 0.5  # K
_WINDOW_ROUNDING = 0.5  # K
_PSI_ROUNDING = 1e-3
_LEAST_MELT = 1e-4  # psi ends where this share is left molten: at 2.1 for n = 3
_LEAST_NUCLEI = 1e-3  # below this -ln(1 - X), psi goes straight to zero, not with the root's infinite slope
_SLOWEST = (
    -200.0
)  # the logarithm of the rate goes no lower: K is then 1e-87 of its reference, and no half-time infinite


class Kinetics(NamedTuple):
    """Parameters of the freezing of one material."""

    avrami_exponent: Any
    """n [1]."""
    reference_half_time: Any
    """Time in which half of it freezes at the reference temperature [s]."""
    reference: Any
    """[K]"""
    nucleation_constant: Any
    """K_g [K^2]."""
    equilibrium_melting: Any
    """T_m0, at which crystals of infinite thickness melt [K]: no freezing above it."""
    glass_transition: Any
    transport_energy: Any
    """U [J/mol]."""
    melting_time: Any
    """Time constant with which solid above the equilibrium fraction melts [s]; the lag of melting behind heating."""


def _mobility_and_nucleation(temperature_kelvin: Any, kinetics: Kinetics) -> Any:
    """Return the logarithm of the growth rate but for a constant: -U/(R (T - T_inf)) - K_g/(T dT f), f = 2 T/(T + T_m0)
    [H]."""
    above_frozen = ramp(temperature_kelvin - (kinetics.glass_transition - BELOW_GLASS), _UNDERCOOLING_ROUNDING)
    undercooling = ramp(kinetics.equilibrium_melting - temperature_kelvin, _UNDERCOOLING_ROUNDING)
    correction = 2.0 * temperature_kelvin / (temperature_kelvin + kinetics.equilibrium_melting)
    transport = kinetics.transport_energy / (GAS_CONSTANT * above_frozen)
    return -transport - kinetics.nucleation_constant / (temperature_kelvin * undercooling * correction)


def _speed(temperature_kelvin: Any, kinetics: Kinetics) -> Any:
    """Return the rate of freezing over that at the reference temperature [1]."""
    reference = _mobility_and_nucleation(kinetics.reference, kinetics)
    logarithm = _mobility_and_nucleation(temperature_kelvin, kinetics) - reference
    return np.exp(_SLOWEST + ramp(logarithm - _SLOWEST, 0.1))


def rate_constant(temperature_kelvin: Any, kinetics: Kinetics) -> Any:
    """Return K = (ln 2)^(1/n)/t_half [1/s], with which psi rises at a temperature [N]."""
    at_reference = np.log(2.0) ** (1.0 / kinetics.avrami_exponent) / kinetics.reference_half_time
    return at_reference * _speed(temperature_kelvin, kinetics)


def solid_fraction(psi: Any, kinetics: Kinetics) -> Any:
    """Return the share that is frozen [1], X = 1 - exp(-psi^n) [A]; none for psi at and below zero."""
    return 1.0 - np.exp(-(ramp(psi, _PSI_ROUNDING) ** kinetics.avrami_exponent))


def extended(fraction: Any, kinetics: Kinetics) -> Any:
    """Return the psi of a solid fraction, (-ln(1 - X))^(1/n) [A]; X may be 0, 1 and a little beyond, as rounded curves
    give it.

    Near X = 0 the root is a straight line through zero, near X = 1 psi ends at what leaves a 10^-4 part molten.
    """
    molten = _LEAST_MELT + ramp(1.0 - fraction - _LEAST_MELT, _LEAST_MELT)
    extent = -np.log(molten)
    return extent * (extent**2 + _LEAST_NUCLEI**2) ** (0.5 / kinetics.avrami_exponent - 0.5)


def equilibrium_fraction(temperature_kelvin: Any, melting: Melting) -> Any:
    """Return the largest share that can be solid at a temperature [1]: 1 below, 0 above the melting window, straight
    within."""
    molten = ramp(temperature_kelvin - melting.start, _WINDOW_ROUNDING)
    molten = molten - ramp(temperature_kelvin - melting.end, _WINDOW_ROUNDING)
    return 1.0 - molten / (melting.end - melting.start)


def rate(temperature_kelvin: Any, psi: Any, kinetics: Kinetics, melting: Melting) -> Any:
    """Return the time derivative of psi [1/s]: freezing with K(T) [N], melting of what is above equilibrium.

    d psi/dt = K(T) - max(psi - psi_eq(T), 0)/tau. K does not depend on psi, so a melt without a crystal freezes too.
    Heated at a rate r, the solid fraction follows the equilibrium curve tau r behind.
    """
    largest = extended(equilibrium_fraction(temperature_kelvin, melting), kinetics)
    # The second ramp is the first at psi = 0: what is not there does not melt, not even in the rounded corner.
    excess = ramp(psi - largest, _PSI_ROUNDING) - ramp(-largest, _PSI_ROUNDING)
    return rate_constant(temperature_kelvin, kinetics) - excess / kinetics.melting_time


def enthalpy(temperature_kelvin: Any, fraction: Any, melting: Melting) -> Any:
    """Return the specific enthalpy [J/kg] of solid and melt at one temperature: X h_s(T) + (1 - X) h_m(T).

    h_s = c_s (T - T_0), h_m = h_2 + c_m (T - T_end), both lines drawn on beyond the window. So the heat of freezing,
    h_m - h_s, changes with temperature by c_m - c_s a kelvin: Kirchhoff's law follows.
    """
    solid = melting.specific_heat_solid * (temperature_kelvin - ZERO_CELSIUS)
    melt = melting.enthalpy_end + melting.specific_heat_melt * (temperature_kelvin - melting.end)
    return fraction * solid + (1.0 - fraction) * melt


def temperature(specific_enthalpy: Any, fraction: Any, melting: Melting) -> Any:
    """Return the temperature [K] of a specific enthalpy [J/kg] and a solid fraction: `enthalpy` solved for T, linear in
    it."""
    at_zero = enthalpy(ZERO_CELSIUS, fraction, melting)
    capacity = fraction * melting.specific_heat_solid + (1.0 - fraction) * melting.specific_heat_melt
    return ZERO_CELSIUS + (specific_enthalpy - at_zero) / capacity
