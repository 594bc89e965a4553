"""A vane: a short cantilever of rectangular section, pressed on one of its faces.

Sources: [T] Timoshenko, Strength of Materials, part I, 3rd ed., ch. 5 (cantilevers under an even load, deflection by
bending and by shear); [M] Mises' criterion of yield.
"""

from __future__ import annotations

from typing import Any, NamedTuple

SHEAR_COEFFICIENT = 5.0 / 6.0  # rectangular section [T]


class Footing(NamedTuple):
    """How a vane differs from an evenly pressed cantilever with a rigid root; calibrated to validation/fe_structure."""

    spread: float
    """Its own compliance over that: below one, as a stiff block leans on the root."""
    root: float
    """Compliance of what it stands on, times E w."""


RIGID = Footing(1.0, 0.0)
"""A cantilever that is pressed evenly and stands on what does not give."""
ON_PLATE = Footing(0.85, 4.0)
"""A vane that hangs from the rotor's plate; with the plate, FE of three modules within 8 %."""
ON_FLOOR = Footing(0.68, 0.75)
"""A vane that stands on the floor, slotted, its pad beside it; with the floor, FE of three modules within 18 %."""


def stiffness(
    youngs_modulus: Any, shear_modulus: Any, width: Any, thickness: Any, height: Any, footing: Footing = RIGID
) -> Any:
    """Force, spread evenly over the face, over the face's mean deflection [N/m] [T].

    1/k = c (h^3/(20 E I) + h/(3 kappa G A)) + r/(E w), I = w t^3/12, A = w t, kappa = 5/6; c and r of the `Footing`.
    """
    bending = height**3 / (20.0 * youngs_modulus * width * thickness**3 / 12.0)
    shearing = height / (3.0 * SHEAR_COEFFICIENT * shear_modulus * width * thickness)
    return 1.0 / (footing.spread * (bending + shearing) + footing.root / (youngs_modulus * width))


def force_at_yield(strength: Any, width: Any, thickness: Any, arm: Any) -> Any:
    """Force [N] at a distance from the root at which the root yields, F = sigma w t/sqrt((6 a/t)^2 + 3) [T, M].

    Bending stress 6 F a/(w t^2) at the surface and mean shear stress F/(w t) taken at one point, which is safe.
    """
    return strength * width * thickness / ((6.0 * arm / thickness) ** 2 + 3.0) ** 0.5
