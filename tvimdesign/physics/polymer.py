"""Polycaprolactone between frozen and molten: enthalpy, solid fraction and complex shear modulus.

Temperatures in kelvin; specific enthalpy in J/kg, zero at 0 degC in the solid. Melting here is the equilibrium curve
over a window; freezing, which lags behind it by tens of kelvin, is not in these equations.
Sources: [F] Ferry, Viscoelastic Properties of Polymers, 3rd ed. (generalised Maxwell model, time-temperature shift);
[V] Voller and Prakash, Int. J. Heat Mass Transfer 30 (1987) 1709 (enthalpy form of melting over a range).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

GAS_CONSTANT = 8.314462618  # J/(mol K), CODATA
ZERO_CELSIUS = 273.15  # K


class Melting(NamedTuple):
    """The melting of one material: specific heats [J/kg K], latent heat [J/kg], window [K], smoothing [J/kg]."""

    specific_heat_solid: Any
    specific_heat_melt: Any
    latent_heat: Any
    start: Any
    end: Any
    smoothing: Any

    @property
    def enthalpy_start(self) -> Any:
        """Enthalpy at which melting starts [J/kg]."""
        return self.specific_heat_solid * (self.start - ZERO_CELSIUS)

    @property
    def enthalpy_end(self) -> Any:
        """Enthalpy at which melting ends [J/kg]: the latent heat and the mean sensible heat over the window."""
        mean = 0.5 * (self.specific_heat_solid + self.specific_heat_melt)
        return self.enthalpy_start + self.latent_heat + mean * (self.end - self.start)


def ramp(distance: Any, smoothing: Any) -> Any:
    """max(distance, 0) with a rounded corner of the width `smoothing`: (z + sqrt(z^2 + dz^2))/2."""
    return 0.5 * (distance + np.sqrt(distance**2 + smoothing**2))


def temperature(enthalpy: Any, melting: Melting) -> Any:
    """Temperature of specific enthalpy [K]: three straight pieces with rounded corners [V]."""
    h1, h2 = melting.enthalpy_start, melting.enthalpy_end
    solid = 1.0 / melting.specific_heat_solid
    middle = (melting.end - melting.start) / (h2 - h1)
    melt = 1.0 / melting.specific_heat_melt
    rise = (middle - solid) * ramp(enthalpy - h1, melting.smoothing)
    rise += (melt - middle) * ramp(enthalpy - h2, melting.smoothing)
    return ZERO_CELSIUS + solid * enthalpy + rise


def solid_fraction(enthalpy: Any, melting: Melting) -> Any:
    """Share that is frozen at a specific enthalpy [1], 1 below and 0 above the melting window."""
    h1, h2 = melting.enthalpy_start, melting.enthalpy_end
    molten = ramp(enthalpy - h1, melting.smoothing) - ramp(enthalpy - h2, melting.smoothing)
    return 1.0 - molten / (h2 - h1)


def enthalpy(temperature_kelvin: Any, melting: Melting) -> Any:
    """Specific enthalpy of a temperature [J/kg]: the three straight pieces, corners not rounded."""
    h1, h2 = melting.enthalpy_start, melting.enthalpy_end
    window = melting.end - melting.start
    below = np.fmin(temperature_kelvin, melting.start) - ZERO_CELSIUS
    inside = np.fmin(np.fmax(temperature_kelvin - melting.start, 0.0), window)
    above = np.fmax(temperature_kelvin - melting.end, 0.0)
    return melting.specific_heat_solid * below + (h2 - h1) / window * inside + melting.specific_heat_melt * above


class SolidModulus(NamedTuple):
    """The frozen polymer's stiffness: E at a reference, and a slope that sets in with temperature."""

    reference_modulus: Any
    """Young's modulus at the reference temperature [Pa]."""
    reference_temperature: Any
    slope: Any
    """d ln E/dT far above the onset [1/K]."""
    onset: Any
    width: Any
    poissons_ratio: Any
    loss_factor: Any


def solid_shear_modulus(temperature_kelvin: Any, solid: SolidModulus) -> Any:
    """Storage shear modulus of the frozen polymer [Pa].

    G = E/(2 (1 + nu)); ln E falls by slope*width*ln(1 + exp((T - onset)/width)), which is flat well below the onset and
    straight well above it. Calibrated to E at 23, 37 and 50 degC.
    """

    def fall(t: Any) -> Any:
        return solid.slope * solid.width * np.log1p(np.exp((t - solid.onset) / solid.width))

    modulus = solid.reference_modulus * np.exp(fall(solid.reference_temperature) - fall(temperature_kelvin))
    return modulus / (2.0 * (1.0 + solid.poissons_ratio))


def arrhenius_shift(temperature_kelvin: Any, reference: Any, activation_energy: Any) -> Any:
    """Time-temperature shift factor a_T = exp(E_a/R (1/T - 1/T_ref)) [1] [F ch. 11]."""
    return np.exp(activation_energy / GAS_CONSTANT * (1.0 / temperature_kelvin - 1.0 / reference))


def maxwell_moduli(angular_frequency: Any, modes: Sequence[tuple[Any, Any]]) -> tuple[Any, Any]:
    """Storage and loss modulus [Pa] of a generalised Maxwell fluid [F ch. 3].

    `modes` holds (relaxation time [s], modulus [Pa]); G' = sum G (w t)^2/(1 + (w t)^2), G'' = sum G w t/(1 + (w t)^2).
    """
    storage: Any = 0.0
    loss: Any = 0.0
    for time, modulus in modes:
        x = angular_frequency * time
        storage = storage + modulus * x**2 / (1.0 + x**2)
        loss = loss + modulus * x / (1.0 + x**2)
    return storage, loss


SOLID_MODES = ((1e10, 0.83776), (10.0, 0.07414), (1.0, 0.06814), (0.1, 0.07545), (0.01, 0.07776), (0.001, 0.10444))
"""The frozen polymer's spectrum: (relaxation time [s], modulus over the storage modulus at 1 Hz); assumed."""


class Rheology(NamedTuple):
    """What the complex modulus of a polymer follows from, frozen and molten."""

    solid: SolidModulus
    modes: Sequence[tuple[Any, Any]]
    """Relaxation spectrum of the melt at its reference temperature: (time [s], modulus [Pa])."""
    activation_energy: Any
    melt_reference: Any


def spectrum(temperature_kelvin: Any, fraction: Any, rheology: Rheology) -> list[tuple[Any, Any]]:
    """Relaxation spectrum (time [s], modulus [Pa]): paired modes of solid and melt mix by their logarithms."""
    shift = arrhenius_shift(temperature_kelvin, rheology.melt_reference, rheology.activation_energy)
    solid = solid_shear_modulus(temperature_kelvin, rheology.solid)
    molten = 1.0 - fraction
    return [
        (
            np.exp(fraction * np.log(solid_time) + molten * np.log(shift * time)),
            np.exp(fraction * np.log(solid * share) + molten * np.log(modulus)),
        )
        for (solid_time, share), (time, modulus) in zip(SOLID_MODES, rheology.modes, strict=True)
    ]


def moduli(temperature_kelvin: Any, fraction: Any, angular_frequency: Any, rheology: Rheology) -> tuple[Any, Any]:
    """Storage and loss shear modulus [Pa] at a temperature, a solid fraction and an angular frequency."""
    return maxwell_moduli(angular_frequency, spectrum(temperature_kelvin, fraction, rheology))
