"""Creep of plastics under a lasting load, and what a preload loses by it.

Sources: [F] Findley, Lai and Onaran, Creep and Relaxation of Nonlinear Viscoelastic Materials (1976), ch. 3 (the power
law of time); [Fe] Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 11 (temperature shifts time; Arrhenius below
the glass transition); [Chr] Christensen, Theory of Viscoelasticity, 2nd ed. (quasi-elastic solution); [RHW] Richart,
Hall and Woods, Vibrations of Soils and Foundations (1970), ch. 10 (rigid discs on a half-space).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.polymers.polymer import GAS_CONSTANT
from tvimdesign.physics.solids.warm import REFERENCE

HOUR = 3600.0  # s


class Creep(NamedTuple):
    """Parameters of a material's creep."""

    share: Any
    """Creep strain after an hour at 23 degC, of the elastic one [1]."""
    exponent: Any
    """Power of time [1]."""
    activation_energy: Any
    """By which temperature shifts time [J/mol]."""


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
