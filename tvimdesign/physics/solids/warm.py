"""Stiffness and loss of a structure whose parts have temperatures of their own.

The modulus of a glassy plastic falls slowly with temperature and then, over some kelvins about its glass transition, to
that of a rubber; its loss factor peaks there. Sources: Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 2 and
12 (the two levels and the peak between them); Cremer and Heckl, Structure-Borne Sound, 2nd ed., ch. III (complex
moduli). The logistic step in ln E is an interpolation between data. A metal is the same law far below its step.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

REFERENCE = 296.15
"""Temperature at which data sheets state moduli [K], 23 degC (ISO 291)."""


class Softening(NamedTuple):
    """Change of a material's modulus and loss with temperature."""

    slope: Any
    """Fall of ln E below the step [1/K]."""
    temperature: Any
    """Where the step in ln E is half done [K]."""
    width: Any
    """[K]: from an eighth of the step to seven eighths is about four of it."""
    share: Any
    """Modulus beyond the step over that before it [1]."""
    loss_factor: Any
    """Below the step [1]."""
    peak_loss_factor: Any
    """In the middle of the step [1]."""


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
