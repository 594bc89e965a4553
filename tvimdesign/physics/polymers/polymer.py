"""Polycaprolactone between frozen and molten: enthalpy, solid fraction, and the relaxation spectrum of every state.

Temperatures in kelvin; specific enthalpy in J/kg, zero at 0 degC in the solid. Melting here is the equilibrium curve
over a window; freezing, which lags behind it by tens of kelvin, is not in these equations.
Sources: [F] Ferry, Viscoelastic Properties of Polymers, 3rd ed. (generalised Maxwell model, time-temperature shift);
[V] Voller and Prakash, Int. J. Heat Mass Transfer 30 (1987) 1709 (enthalpy form of melting over a range);
[S] Soskey and Winter, J. Rheol. 28 (1984) 625 (damping function of large strains);
[W] Winter, Rheol. Acta 47 (2008) 909 (spectrum of entangled chains: a power of time up to a longest one);
[M] Sangroniz et al., Eur. Polym. J. (2018) 495 (melts that were heated from the solid are more viscous).
"""

from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol, Self

import numpy as np

from tvimdesign.physics.solids.structure import shear_modulus

ZERO_CELSIUS = 273.15  # K
GAS_CONSTANT = 8.314462618  # J/(mol K), CODATA
PINNED_FREQUENCY = 2.0 * np.pi  # rad/s, 1 Hz
"""The angular frequency at which the frozen polymer's storage modulus is the data sheet's E/(2 (1 + nu)).

A flexural test takes seconds to minutes; with a loss factor of 0.05 the modulus changes 8 % a decade of frequency.
"""
MODES_PER_DECADE = 2
SPECTRUM_EXPONENT = -0.2
"""Power of time by which the moduli of a melt's modes go, assumed for chains of many lengths, as of Capa.

For chains of one length it is about +0.25 [W]: most of the modulus then relaxes with the longest time. From -0.5 to
+0.25, at the same viscosity and plateau, the storage modulus of an 80k melt at 1 Hz is 1.9 to 0.44 times as large, the
loss modulus 4 % less to 1 % more.
"""
LINEAR_DROP = 0.05
"""Share by which the storage modulus has fallen at the limit of the linear range: what rheometers' software takes."""

Modes = Sequence[tuple[Any, Any]]  # A relaxation spectrum: (relaxation time [s], modulus [Pa]) of each Maxwell element


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
        """Return the enthalpy at which melting starts [J/kg]."""
        return self.specific_heat_solid * (self.start - ZERO_CELSIUS)

    @property
    def enthalpy_end(self) -> Any:
        """Return the enthalpy at which melting ends [J/kg]: the latent heat and the mean sensible heat over the
        window."""
        mean = 0.5 * (self.specific_heat_solid + self.specific_heat_melt)
        return self.enthalpy_start + self.latent_heat + mean * (self.end - self.start)


def ramp(distance: Any, smoothing: Any) -> Any:
    """Return max(distance, 0) with a rounded corner of the width `smoothing`: (z + sqrt(z^2 + dz^2))/2."""
    return 0.5 * (distance + np.sqrt(distance**2 + smoothing**2))


def temperature(enthalpy: Any, melting: Melting) -> Any:
    """Return the temperature of specific enthalpy [K]: three straight pieces with rounded corners [V]."""
    h1, h2 = melting.enthalpy_start, melting.enthalpy_end
    solid, middle, melt = _slopes(melting)
    rise = (middle - solid) * ramp(enthalpy - h1, melting.smoothing)
    rise += (melt - middle) * ramp(enthalpy - h2, melting.smoothing)
    return ZERO_CELSIUS + solid * enthalpy + rise


def _slopes(melting: Melting) -> tuple[Any, Any, Any]:
    """Return how far the temperature rises with enthalpy before, in and behind the melting window [K kg/J]."""
    middle = (melting.end - melting.start) / (melting.enthalpy_end - melting.enthalpy_start)
    return 1.0 / melting.specific_heat_solid, middle, 1.0 / melting.specific_heat_melt


def solid_fraction(enthalpy: Any, melting: Melting) -> Any:
    """Return the share that is frozen at a specific enthalpy [1], 1 below and 0 above the melting window."""
    h1, h2 = melting.enthalpy_start, melting.enthalpy_end
    molten = ramp(enthalpy - h1, melting.smoothing) - ramp(enthalpy - h2, melting.smoothing)
    return 1.0 - molten / (h2 - h1)


def enthalpy(temperature_kelvin: Any, melting: Melting) -> Any:
    """Return the specific enthalpy of a temperature [J/kg]: the three straight pieces, corners not rounded."""
    h1, h2 = melting.enthalpy_start, melting.enthalpy_end
    window = melting.end - melting.start
    below = np.fmin(temperature_kelvin, melting.start) - ZERO_CELSIUS
    inside = np.fmin(np.fmax(temperature_kelvin - melting.start, 0.0), window)
    above = np.fmax(temperature_kelvin - melting.end, 0.0)
    return melting.specific_heat_solid * below + (h2 - h1) / window * inside + melting.specific_heat_melt * above


def fraction_at(temperature_kelvin: Any, melting: Melting) -> Any:
    """Return the share that is frozen at a temperature on the melting curve with its rounded corners [1], smooth
    everywhere.

    `temperature` turned round in closed form: a corner between the slopes a and b [K kg/J] that is rounded over the
    enthalpy z is one rounded over the temperature z sqrt(a b). The other corner's rounding is left out, a few mK of it.
    """
    slopes = _slopes(melting)
    heat = melting.specific_heat_solid * (temperature_kelvin - ZERO_CELSIUS)
    for corner, before, after in zip((melting.start, melting.end), slopes[:-1], slopes[1:], strict=True):
        width = melting.smoothing * np.sqrt(before * after)
        heat = heat + (1.0 / after - 1.0 / before) * ramp(temperature_kelvin - corner, width)
    return solid_fraction(heat, melting)


class SolidModulus(NamedTuple):
    """The frozen polymer's stiffness: E at a reference, and a slope that sets in with temperature."""

    reference_modulus: Any  # Young's modulus at the reference temperature [Pa]
    reference_temperature: Any
    slope: Any  # d ln E/dT far above the onset [1/K]
    onset: Any
    width: Any
    poissons_ratio: Any


def solid_shear_modulus(temperature_kelvin: Any, solid: SolidModulus) -> Any:
    """Return the storage shear modulus of the frozen polymer at the pinned frequency [Pa].

    G = E/(2 (1 + nu)); ln E falls by slope*width*ln(1 + exp((T - onset)/width)), which is flat well below the onset and
    straight well above it. Calibrated to E at 23, 37 and 50 degC.
    """

    def fall(t: Any) -> Any:
        return solid.slope * solid.width * np.log1p(np.exp((t - solid.onset) / solid.width))

    modulus = solid.reference_modulus * np.exp(fall(solid.reference_temperature) - fall(temperature_kelvin))
    return shear_modulus(modulus, solid.poissons_ratio)


def arrhenius_shift(temperature_kelvin: Any, reference: Any, activation_energy: Any) -> Any:
    """Return the time-temperature shift factor a_T = exp(E_a/R (1/T - 1/T_ref)) [1] [F ch. 11]."""
    return np.exp(activation_energy / GAS_CONSTANT * (1.0 / temperature_kelvin - 1.0 / reference))


def maxwell_moduli(angular_frequency: Any, modes: Modes) -> tuple[Any, Any]:
    """Return the storage and loss modulus [Pa] of a generalised Maxwell body [F ch. 3].

    `modes` holds (relaxation time [s], modulus [Pa]); G' = sum G (w t)^2/(1 + (w t)^2), G'' = sum G w t/(1 + (w t)^2).
    """
    storage: Any = 0.0
    loss: Any = 0.0
    for time, modulus in modes:
        x = angular_frequency * time
        storage = storage + modulus * x**2 / (1.0 + x**2)
        loss = loss + modulus * x / (1.0 + x**2)
    return storage, loss


def melt_spectrum(zero_shear_viscosity: Any, plateau_modulus: Any, count: int) -> list[tuple[Any, Any]]:
    """Return the relaxation spectrum of an entangled melt (time [s], modulus [Pa]) from its viscosity [Pa s] and
    plateau [Pa].

    Modes G_i ~ t_i^`SPECTRUM_EXPONENT` at `MODES_PER_DECADE` times a decade, down from a longest one [W]; their moduli
    sum up to the plateau modulus, and modulus times time to the viscosity [F ch. 3].
    """
    times = [10.0 ** (-i / MODES_PER_DECADE) for i in range(count)]
    weights = [time**SPECTRUM_EXPONENT for time in times]
    shares = [weight / sum(weights) for weight in weights]
    mean = sum(share * time for share, time in zip(shares, times, strict=True))
    longest = zero_shear_viscosity / (plateau_modulus * mean)
    return [(longest * time, plateau_modulus * share) for time, share in zip(times, shares, strict=True)]


MEMORY_HOLD = 300.0
"""Time in the melt [s] that a temperature of fading goes with: five minutes, the usual hold in a calorimeter."""


class MeltMemory(NamedTuple):
    """Memory of its crystals in a melt that was heated from the solid: it relaxes more slowly [M]."""

    ratio: Any  # Viscosity of a melt that remembers all over that of the equilibrated melt [1]
    temperature: Any  # Temperature at which half of the ratio's logarithm is left after `MEMORY_HOLD` [K]
    width: Any  # Rise of temperature that makes the memory fade e times as fast [K]
    time: Any  # Time in the melt [s]


def memory_shift(temperature_kelvin: Any, memory: MeltMemory) -> Any:
    """Return the logarithm of how much later a melt relaxes that remembers its crystals [1].

    ln r/(1 + t/t_1(T)) with t_1 = `MEMORY_HOLD` exp(-(T - T_1)/w): the form is assumed, the ratio r observed [M].
    """
    faded = memory.time / MEMORY_HOLD * np.exp((temperature_kelvin - memory.temperature) / memory.width)
    return np.log(memory.ratio) / (1.0 + faded)


class Rheology(NamedTuple):
    """Parameters of the spectrum of a polymer, frozen and molten; the two tables pair row by row."""

    solid: SolidModulus
    solid_modes: Modes  # Relaxation spectrum of the solid: (time [s], modulus relative to the others [1])
    melt_modes: Modes  # Relaxation spectrum of the melt at its reference temperature: (time [s], modulus [Pa])
    activation_energy: Any
    melt_reference: Any
    memory: MeltMemory | None = None

    @property
    def equilibrated(self) -> Self:
        """Return the same without memory: of a melt that cools, or was hot for long."""
        return self._replace(memory=None)


class OneSpectrum(Protocol):
    """A material whose spectrum follows from temperature alone, as a glass's does."""

    def at(self, temperature_kelvin: Any) -> list[tuple[Any, Any]]:
        """Return the relaxation spectrum (time [s], modulus [Pa]) at a temperature."""

    @property
    def equilibrated(self) -> Self:
        """Return the spectrum itself: it has no memory."""


AnyRheology = Rheology | OneSpectrum


def spectrum(temperature_kelvin: Any, fraction: Any, rheology: AnyRheology) -> list[tuple[Any, Any]]:
    """Return the relaxation spectrum (time [s], modulus [Pa]) at a temperature and a solid fraction X.

    Paired modes mix by their logarithms: ln G = X ln G_solid + (1 - X) ln G_melt, ln tau likewise. So moduli and times
    are positive in every state, which is therefore passive, and every test in time or frequency follows from one
    spectrum. Lichtenecker's rule, assumed: between the pure phases it is right in order of magnitude only. The melt's
    times shift with temperature and memory, the solid's do not; the solid's moduli follow `solid_shear_modulus`.
    """
    if not isinstance(rheology, Rheology):
        return rheology.at(temperature_kelvin)
    pinned, _ = maxwell_moduli(PINNED_FREQUENCY, rheology.solid_modes)
    level = np.log(solid_shear_modulus(temperature_kelvin, rheology.solid)) - np.log(pinned)
    shift = np.log(arrhenius_shift(temperature_kelvin, rheology.melt_reference, rheology.activation_energy))
    if rheology.memory is not None:
        shift = shift + memory_shift(temperature_kelvin, rheology.memory)
    molten = 1.0 - fraction
    return [
        (
            np.exp(fraction * np.log(solid_time) + molten * (shift + np.log(melt_time))),
            np.exp(fraction * (level + np.log(share)) + molten * np.log(melt_modulus)),
        )
        for (solid_time, share), (melt_time, melt_modulus) in zip(
            rheology.solid_modes, rheology.melt_modes, strict=True
        )
    ]


def moduli(temperature_kelvin: Any, fraction: Any, angular_frequency: Any, rheology: AnyRheology) -> tuple[Any, Any]:
    """Return the storage and loss shear modulus [Pa] at a temperature, a solid fraction and an angular frequency."""
    return maxwell_moduli(angular_frequency, spectrum(temperature_kelvin, fraction, rheology))


class LinearRange(NamedTuple):
    """Shear strains [1] at which the storage modulus of the two phases has fallen by `LINEAR_DROP`."""

    solid: Any
    melt: Any


def linear_strain(fraction: Any, limits: LinearRange) -> Any:
    """Return the limit of the linear range at a solid fraction [1]: the phases' limits mixed by their logarithms,
    assumed."""
    return np.exp(fraction * np.log(limits.solid) + (1.0 - fraction) * np.log(limits.melt))


def damping_function(strain: Any, limit: Any) -> Any:
    """Return the share of the linear modulus that is left at a strain, h = 1/(1 + a (gamma/gamma_L)^2) [1] [S, exponent
    2].

    a = d/(1 - d) makes the drop at the linear limit gamma_L be d = `LINEAR_DROP`.
    """
    return 1.0 / (1.0 + LINEAR_DROP / (1.0 - LINEAR_DROP) * (strain / limit) ** 2)
