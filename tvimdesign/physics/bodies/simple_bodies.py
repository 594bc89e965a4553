"""The springs and dashpots of textbooks: Kelvin-Voigt, Maxwell and standard linear solid, in the three kinds of test.

Sources: Ferry, Viscoelastic Properties of Polymers, 3rd ed., ch. 3; Findley, Lai and Onaran, Creep and Relaxation of
Nonlinear Viscoelastic Materials, ch. 5.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np


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

    stiffness: float
    """[Pa]"""
    viscosity: float
    """[Pa s]"""

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

    stiffness: float
    """[Pa]"""
    viscosity: float
    """[Pa s]"""

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

    equilibrium: float
    """Modulus that is left [Pa]."""
    stiffness: float
    """Modulus that relaxes [Pa]."""
    viscosity: float
    """[Pa s]"""

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
