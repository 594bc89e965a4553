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
    """Its own compliance over that."""
    root: float
    """Compliance of what it stands on, times E w."""


RIGID = Footing(1.0, 0.0)
"""A cantilever that stands on what does not give."""
ON_PLATE = Footing(0.93, 4.3)
"""A vane that hangs from the rotor's plate; with the plate, FE of three modules within 1 %."""
ON_FLOOR = Footing(0.855, 0.966)
"""A vane that stands on the floor, slotted, its pad beside it; with the floor, FE of three modules within 1 %."""
LEAN = 0.03
"""How much a block that is stiffer than its vane leans on the root, 0 where it presses evenly; calibrated likewise."""


def stiffness(
    youngs_modulus: Any,
    shear_modulus: Any,
    width: Any,
    thickness: Any,
    height: Any,
    block: Any = 0.0,
    footing: Footing = RIGID,
) -> Any:
    """Force on the face over the face's mean deflection [N/m], pressed by a block of a stiffness of its own [N/m].

    1/k = c C/(1 + 0.03 k_b C) + r/(E w), c and r of the `Footing`. Pressed evenly, a cantilever has the compliance
    C = h^3/(20 E I) + h/(3 kappa G A), I = w t^3/12, A = w t, kappa = 5/6 [T].
    """
    bending = height**3 / (20.0 * youngs_modulus * width * thickness**3 / 12.0)
    shearing = height / (3.0 * SHEAR_COEFFICIENT * shear_modulus * width * thickness)
    evenly = bending + shearing
    return 1.0 / (footing.spread * evenly / (1.0 + LEAN * block * evenly) + footing.root / (youngs_modulus * width))


def force_at_yield(strength: Any, width: Any, thickness: Any, arm: Any) -> Any:
    """Force [N] at a distance from the root at which the root yields, F = sigma w t/sqrt((6 a/t)^2 + 3) [T, M].

    Bending stress 6 F a/(w t^2) at the surface and mean shear stress F/(w t) taken at one point, which is safe.
    """
    return strength * width * thickness / ((6.0 * arm / thickness) ** 2 + 3.0) ** 0.5
