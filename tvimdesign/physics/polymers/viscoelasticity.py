"""Answers of a relaxation spectrum in tests: relaxation, creep and recovery, start-up of flow, oscillation.

A spectrum is a list of (relaxation time [s], modulus [Pa]), the Maxwell elements of a generalised Maxwell body. Its
creep is exact too: the retardation spectrum has one time fewer, and a viscosity.
Sources: [F] Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 3 and 4; [T] Tschoegl, The Phenomenological Theory
of Linear Viscoelastic Behavior (interconversion; the times of retardation lie between those of relaxation).

The springs and dashpots of textbooks: Kelvin-Voigt, Maxwell and standard linear solid, in the three kinds of test.

Sources: Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 3; Findley, Lai and Onaran, Creep and Relaxation of
Nonlinear Viscoelastic Materials, ch. 5.

Yield of a frozen polymer: a relaxation spectrum whose times all shorten with the stress.

Each Maxwell mode keeps its modulus; its time is multiplied by a(tau) = x/sinh(x) with x = tau/tau_0 of the whole stress
tau. Small stresses relax as in the linear spectrum. At a constant rate the stress rises to a plateau, the yield stress.
Sources: [E] Eyring, J. Chem. Phys. 4 (1936) 283; [T] Tervoort, Klompen and Govaert, J. Rheol. 40 (1996) 779.
"""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from tvimdesign.physics.polymers.polymer import Modes, maxwell_moduli


def relaxation_modulus(time: Any, modes: Modes) -> Any:
    """Return the stress over strain [Pa] a time [s] after a step of strain, G(t) = sum G exp(-t/tau) [F ch. 3]."""
    return sum(modulus * np.exp(-time / tau) for tau, modulus in modes)


def start_up_viscosity(time: Any, modes: Modes) -> Any:
    """Return the stress over shear rate [Pa s] a time [s] after flow starts: sum G tau (1 - exp(-t/tau)), the integral
    of G."""
    return sum(modulus * tau * -np.expm1(-time / tau) for tau, modulus in modes)


def zero_shear_viscosity(modes: Modes) -> Any:
    """Return the viscosity of slow steady flow [Pa s]: sum G tau [F ch. 3]."""
    return sum(modulus * tau for tau, modulus in modes)


def complex_viscosity(angular_frequency: Any, modes: Modes) -> Any:
    """Return the magnitude of the complex viscosity [Pa s], sqrt(G'^2 + G''^2)/w."""
    storage, loss = maxwell_moduli(angular_frequency, modes)
    return np.sqrt(storage**2 + loss**2) / angular_frequency


def loss_factor(angular_frequency: Any, modes: Modes) -> Any:
    """Return the loss over storage modulus, tan(delta) [1]."""
    storage, loss = maxwell_moduli(angular_frequency, modes)
    return loss / storage


class Retardation(NamedTuple):
    """Response of a body to constant stress: strain at once, strain that comes later, and flow."""

    instant_compliance: float  # Compliance at once [1/Pa]
    modes: tuple[tuple[float, float], ...]  # (retardation time [s], compliance [1/Pa]) of each Kelvin-Voigt element
    viscosity: float  # Viscosity of the flow [Pa s]


def retardation(modes: Modes) -> Retardation:
    """Return the retardation spectrum of a relaxation spectrum, exactly [T].

    With the rates p = 1/tau the operational modulus is Q(s) = s F(s), F(s) = sum G/(s + p), and the compliance is the
    partial fractions of 1/Q: one rate r between each two neighbouring p, F(-r) = 0, with the compliance
    1/(r^2 sum G/(p - r)^2). Numbers only.
    """
    rates, moduli = _distinct_rates(modes)
    slow = []
    for lower in range(len(rates) - 1):
        rate = _zero_between(rates, moduli, lower)
        compliance = 1.0 / (rate**2 * np.sum(moduli / (rates - rate) ** 2))
        slow.append((1.0 / rate, float(compliance)))
    return Retardation(float(1.0 / np.sum(moduli)), tuple(slow), float(np.sum(moduli / rates)))


def _distinct_rates(modes: Modes) -> tuple[Any, Any]:
    """Return the rates 1/tau, rising, and the moduli; modes of one time are one mode."""
    together: dict[float, float] = {}
    for tau, modulus in modes:
        together[1.0 / tau] = together.get(1.0 / tau, 0.0) + modulus
    rates = sorted(together)
    return np.array(rates), np.array([together[rate] for rate in rates])


def _zero_between(rates: Any, moduli: Any, lower: int) -> float:
    """Return the zero of sum G/(p - r) between a rate and the next, where (p_k - r)(p_l - r) has taken its poles
    away."""
    from scipy.optimize import brentq

    below, above = rates[lower], rates[lower + 1]
    apart = np.delete(np.arange(len(rates)), [lower, lower + 1])

    def gap(rate: float) -> float:
        others = np.sum(moduli[apart] / (rates[apart] - rate))
        poles = moduli[lower] * (above - rate) + moduli[lower + 1] * (below - rate)
        return float((poles + (below - rate) * (above - rate) * others) / (above - below))

    return float(brentq(gap, below, above, xtol=1e-300, rtol=1e-15, maxiter=500))


def creep_compliance(time: Any, response: Retardation) -> Any:
    """Return the strain over stress [1/Pa] a time [s] after a step of stress, J(t) = J_g + sum J (1 - exp(-t/lambda)) +
    t/eta.

    Zero before the step. [F ch. 3]
    """
    elapsed = np.maximum(time, 0.0)
    later = sum(compliance * -np.expm1(-elapsed / tau) for tau, compliance in response.modes)
    return (time >= 0.0) * (response.instant_compliance + later + elapsed / response.viscosity)


def creep_and_recovery(time: Any, stress: float, release: float, response: Retardation) -> Any:
    """Return the strain [1] under a stress [Pa] that is taken off at `release` [s]: sigma (J(t) - J(t - t_1)),
    superposed."""
    return stress * (creep_compliance(time, response) - creep_compliance(time - release, response))


def ramped_stress(time: Any, strain: float, rise: float, modes: Modes) -> Any:
    """Return the stress [Pa] while and after a strain is reached at a constant rate within `rise` seconds.

    Each mode rises as in `start_up_viscosity` and fades from the end of the rise on; the difference of two starts would
    cancel there.
    """
    rising, after = np.minimum(time, rise), np.maximum(time - rise, 0.0)
    fading = [(tau, modulus * np.exp(-after / tau)) for tau, modulus in modes]
    return strain / rise * start_up_viscosity(rising, fading)


class Body(Protocol):
    """Moduli of a body: complex modulus [Pa], relaxation modulus [Pa] and creep compliance [1/Pa]."""

    def modulus(self, angular_frequency: Any) -> Any:
        """Return the complex modulus G' + i G'' [Pa]."""

    def relaxation(self, time: Any) -> Any:
        """Return the relaxation modulus [Pa]."""

    def creep(self, time: Any) -> Any:
        """Return the creep compliance [1/Pa]."""


@dataclass(frozen=True)
class KelvinVoigt:
    """A spring and a dashpot side by side: it never flows, and cannot be strained at once."""

    stiffness: float  # [Pa]
    viscosity: float  # [Pa s]

    def modulus(self, angular_frequency: Any) -> Any:
        """Return G + i w eta."""
        return self.stiffness + 1j * angular_frequency * self.viscosity

    def relaxation(self, time: Any) -> Any:
        """Return the G, for ever, after an infinite stress in the instant of the step."""
        return self.stiffness + 0.0 * time

    def creep(self, time: Any) -> Any:
        """Return (1 - exp(-G t/eta))/G."""
        return -np.expm1(-self.stiffness / self.viscosity * time) / self.stiffness


@dataclass(frozen=True)
class Maxwell:
    """A spring and a dashpot one after the other: under load it flows without end."""

    stiffness: float  # [Pa]
    viscosity: float  # [Pa s]

    def modulus(self, angular_frequency: Any) -> Any:
        """Return 1/(1/G + 1/(i w eta))."""
        return 1.0 / (1.0 / self.stiffness + 1.0 / (1j * angular_frequency * self.viscosity))

    def relaxation(self, time: Any) -> Any:
        """Return G exp(-G t/eta)."""
        return self.stiffness * np.exp(-self.stiffness / self.viscosity * time)

    def creep(self, time: Any) -> Any:
        """Return 1/G + t/eta."""
        return 1.0 / self.stiffness + time / self.viscosity


@dataclass(frozen=True)
class StandardLinearSolid:
    """A spring beside a Maxwell body (Zener's): stiff at once, softer later, and it never flows."""

    equilibrium: float  # Modulus that is left [Pa]
    stiffness: float  # Modulus that relaxes [Pa]
    viscosity: float  # [Pa s]

    def modulus(self, angular_frequency: Any) -> Any:
        """Return the modulus of the spring and of the Maxwell body together."""
        return self.equilibrium + Maxwell(self.stiffness, self.viscosity).modulus(angular_frequency)

    def relaxation(self, time: Any) -> Any:
        """Return the rest and what the Maxwell body has left."""
        return self.equilibrium + Maxwell(self.stiffness, self.viscosity).relaxation(time)

    def creep(self, time: Any) -> Any:
        """Return 1/R - (1/R - 1/(R + G)) exp(-t/lambda), lambda = eta (R + G)/(R G), R the modulus that is left."""
        whole = self.equilibrium + self.stiffness
        slow = self.viscosity * whole / (self.equilibrium * self.stiffness)
        return 1.0 / self.equilibrium - (1.0 / self.equilibrium - 1.0 / whole) * np.exp(-time / slow)


Array = NDArray[np.float64]

SHEET_RATE = 0.01
"""Shear rate [1/s] of the test that a yield strength comes from, in order of magnitude: a tensile bar in minutes."""
_LARGEST = 300.0  # Largest stress over tau_0 that is looked at; sinh stays finite
_ERROR = 1e-7  # Relative error of the integration


def yield_stress(rate: float, activation_stress: float, modes: Modes) -> float:
    """Return the stress of flow at a shear rate, tau_0 asinh(eta rate/tau_0) with eta = sum G tau [T].

    Parameters
    ----------
    rate : shear rate [1/s]
    activation_stress : tau_0 [Pa]
    modes : relaxation spectrum, (time [s], modulus [Pa])
    """
    viscosity = float(zero_shear_viscosity(modes))
    return activation_stress * math.asinh(viscosity * rate / activation_stress)


def activation_stress(strength: float, modes: Modes, rate: float = SHEET_RATE) -> float:
    """Return the tau_0 [Pa] with which the spectrum yields at a strength [Pa] at a shear rate [1/s].

    Raises ValueError where the spectrum flows at a lower stress than that without any yield.
    """
    from scipy.optimize import brentq

    viscosity = float(zero_shear_viscosity(modes))
    flow = viscosity * rate
    if flow <= strength:
        raise ValueError(f"the spectrum flows at {flow:.3g} Pa, below its yield strength of {strength:.3g} Pa")
    return float(brentq(lambda stress: yield_stress(rate, stress, modes) - strength, 1e-3 * strength, 1e6 * strength))


def stress_of_a_ramp(time: Array, strain: float, rise: float, modes: Modes, activation_stress: float) -> Array:
    """Return the stress [Pa] while and after a strain [1] is reached at a constant rate within `rise` [s].

    Parameters
    ----------
    time : instants [s], rising
    strain, rise : shear strain and the time in which it is reached
    modes : relaxation spectrum, (time [s], modulus [Pa])
    activation_stress : tau_0 [Pa]
    """
    from scipy.integrate import solve_ivp

    times, moduli = (np.array([float(value) for value in column]) for column in zip(*modes, strict=True))

    def rates(stresses: Array, rate: float) -> Array:
        x = min(abs(float(np.sum(stresses))) / activation_stress, _LARGEST)
        slowing = x / math.sinh(x) if x > 1e-6 else 1.0
        result: Array = moduli * rate - stresses / (times * slowing)
        return result

    stress, stresses = np.zeros(len(time)), np.zeros(len(times))
    for first, last, rate in ((0.0, rise, strain / rise), (rise, float(time[-1]), 0.0)):
        here = (time > first) & (time <= last)
        if last <= first:
            continue
        ends = np.append(time[here], last) if not np.any(time[here] == last) else time[here]
        solved = solve_ivp(
            lambda _, y, rate=rate: rates(y, rate), (first, last), stresses, "BDF", ends, rtol=_ERROR,
            atol=_ERROR * 1e-3 * activation_stress,
        )  # fmt: skip
        stress[here] = solved.y.sum(axis=0)[: np.count_nonzero(here)]
        stresses = solved.y[:, -1]
    return stress
