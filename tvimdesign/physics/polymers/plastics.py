"""Stiffness and loss of a structure whose parts have temperatures of their own.

The modulus of a glassy plastic falls slowly with temperature and then, over some kelvins about its glass transition, to
that of a rubber; its loss factor peaks there. Sources: Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 2 and
12 (the two levels and the peak between them); Cremer and Heckl, Structure-Borne Sound, 2nd ed., ch. III (complex
moduli). The logistic step in ln E is an interpolation between data. A metal is the same law far below its step.

Creep of plastics under a lasting load, and what a preload loses by it.

Sources: [F] Findley, Lai and Onaran, Creep and Relaxation of Nonlinear Viscoelastic Materials (1976), ch. 3 (the power
law of time); [Fe] Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 11 (temperature shifts time; Arrhenius below
the glass transition); [Chr] Christensen, Theory of Viscoelasticity, 2nd ed. (quasi-elastic solution); [RHW] Richart,
Hall and Woods, Vibrations of Soils and Foundations (1970), ch. 10 (rigid discs on a half-space).
"""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.polymers.polymer import GAS_CONSTANT

REFERENCE = 296.15  # Temperature at which data sheets state moduli [K], 23 degC (ISO 291)


class Softening(NamedTuple):
    """Change of a material's modulus and loss with temperature."""

    slope: Any  # Fall of ln E below the step [1/K]
    temperature: Any  # Where the step in ln E is half done [K]
    width: Any  # [K]: from an eighth of the step to seven eighths is about four of it
    share: Any  # Modulus beyond the step over that before it [1]
    loss_factor: Any  # Below the step [1]
    peak_loss_factor: Any  # In the middle of the step [1]


def step(temperature: Any, law: Softening) -> Any:
    """Return the share of the step that is done, 1/(1 + exp(-(T - T_s)/w)) [1]."""
    return 1.0 / (1.0 + np.exp(-(temperature - law.temperature) / law.width))


def modulus_share(temperature: Any, law: Softening) -> Any:
    """Return the modulus at a temperature [K] over that at 23 degC [1], smooth and above zero everywhere.

    ln(E/E_23) = -a (T - T_23) + ln(share) (L(T) - L(T_23)), L as of `step`.
    """
    fall = np.log(law.share) * (step(temperature, law) - step(REFERENCE, law))
    return np.exp(fall - law.slope * (temperature - REFERENCE))


def loss_factor(temperature: Any, law: Softening) -> Any:
    """Return the loss factor at a temperature [K], eta_0 + (eta_p - eta_0) 4 L (1 - L) [1]."""
    done = step(temperature, law)
    return law.loss_factor + (law.peak_loss_factor - law.loss_factor) * 4.0 * done * (1.0 - done)


def complex_modulus(temperature: Any, law: Softening) -> tuple[Any, Any]:
    """Return the real and imaginary part of E*(T)/E(23 degC) [1]."""
    share = modulus_share(temperature, law)
    return share, share * loss_factor(temperature, law)


def series(parts: Iterable[tuple[Any, Any, Any]]) -> tuple[Any, Any]:
    """Return the real and imaginary stiffness [N*m/rad] of parts in series: (compliance at 23 degC, Re and Im of
    E*/E_23) each.

    1/K* = sum c/(E*/E_23). A part that is not there has a compliance of zero.
    """
    real, imaginary = 0.0, 0.0
    for compliance, storage, loss in parts:
        size = storage**2 + loss**2
        real, imaginary = real + compliance * storage / size, imaginary + compliance * loss / size
    size = real**2 + imaginary**2
    return real / size, imaginary / size


HOUR = 3600.0  # s


class Creep(NamedTuple):
    """Parameters of a material's creep."""

    share: Any  # Creep strain after an hour at 23 degC, of the elastic one [1]
    exponent: Any  # Power of time [1]
    activation_energy: Any  # By which temperature shifts time [J/mol]


def aged(time: Any, temperature: Any, law: Creep) -> Any:
    """Return the time at 23 degC [s] in which as much creeps as in a time [s] at a temperature [K] [Fe]."""
    return time * np.exp(law.activation_energy / GAS_CONSTANT * (1.0 / REFERENCE - 1.0 / temperature))


def growth(time: Any, law: Creep) -> Any:
    """Return the creep strain after a time at 23 degC [s], of the elastic one: m (t/1 h)^n [F]. Creep modulus: E/(1 +
    that)."""
    return law.share * (time / HOUR) ** law.exponent


def winding_left(rate: Any, *holds: tuple[Any, Any]) -> Any:
    """Return the share [1] of a spring's winding that is left where what holds it gives, 1/(1 + k sum c (1 + phi))
    [Chr].

    `rate` k [N*m/rad]; of each hold the elastic compliance c [rad/(N*m)] and its creep phi of that [1].
    """
    return 1.0 / (1.0 + rate * sum(compliance * (1.0 + crept) for compliance, crept in holds))


def peg_give(youngs_modulus: Any, poissons_ratio: Any, diameter: Any, height: Any) -> Any:
    """Return the way per force [m/N] of a round peg on a thick plate at a height: it bends, shears, and its foot tilts.

    h^3/(3 E I) + h/(0.9 G A) (Timoshenko) + h^2 3 (1 - nu^2)/(4 E r^3), a rigid disc rocking on a half-space [RHW].
    """
    radius = 0.5 * diameter
    shear_modulus = youngs_modulus / (2.0 * (1.0 + poissons_ratio))
    bending = height**3 / (3.0 * youngs_modulus * 0.25 * np.pi * radius**4)
    shearing = height / (0.9 * shear_modulus * np.pi * radius**2)
    return bending + shearing + height**2 * 0.75 * (1.0 - poissons_ratio**2) / (youngs_modulus * radius**3)


def twisted_hole_give(shear_modulus: Any, diameter: Any, length: Any) -> Any:
    """Return the angle per moment [rad/(N*m)] of a round wire twisted in a wide body about its own axis, 1/(4 pi G r^2
    L).

    Shear stress M/(2 pi r^2 L) falls as 1/r^2 (Timoshenko and Goodier, Theory of Elasticity, 3rd ed., ch. 4).
    """
    return 1.0 / (np.pi * shear_modulus * diameter**2 * length)
