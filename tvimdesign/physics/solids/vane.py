"""A vane: a short cantilever of rectangular section, pressed on one of its faces.

Sources: [T] Timoshenko, Strength of Materials, part I, 3rd ed., ch. 5 (cantilevers under an even load, deflection by
bending and by shear, beams); [M] Mises' criterion of yield.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

SHEAR_COEFFICIENT = 5.0 / 6.0  # rectangular section [T]


class Footing(NamedTuple):
    """What a vane stands on, and how that differs from a rigid root; calibrated to validation/fe_structure."""

    thickness: Any
    """Thickness of the plate or floor [m]."""
    strip: Any
    """Length of plate or floor from the vane's face to halfway to the next vane [m]."""
    spread: float
    """The vane's own compliance over that of an evenly pressed cantilever."""
    give: float
    """How much the root gives sideways, times E w and over the vane's thickness by the plate's."""
    bend: float
    """How much it turns as both strips bend, over what strips of the vane's width would: 2 where all are as wide."""


def on_plate(thickness: Any, strip: Any) -> Footing:
    """A vane that hangs from the rotor's plate; with the plate, FE of 15 modules within 4 %."""
    return Footing(thickness, strip, 0.79, 0.86, 2.45)


def on_floor(thickness: Any, strip: Any) -> Footing:
    """A vane that stands on the floor, slotted, its pad beside it; with the floor, FE of 15 modules within 6.5 %."""
    return Footing(thickness, strip, 0.535, 0.14, 1.64)


def strip_beside(radius: Any, count: Any, thickness: Any) -> Any:
    """Length [m] from a vane's face to halfway to the next one, pi r/n - t/2, of evenly spaced vanes on a circle."""
    return np.pi * radius / count - 0.5 * thickness


LEAN = 0.2
"""How much a block that is stiffer than its vane leans on the root, 0 where it presses evenly; calibrated likewise."""


def stiffness(
    youngs_modulus: Any,
    shear_modulus: Any,
    width: Any,
    thickness: Any,
    height: Any,
    free: Any = 0.0,
    block: Any = 0.0,
    footing: Footing | None = None,
) -> Any:
    """Force on the face over the face's mean deflection [N/m], pressed by a block of a stiffness of its own [N/m].

    1/k = c C/(1 + 0.2 k_b C) + (r t/h + q a^2 l/h^3)/(E w) on a plate of thickness h, c, r, q and the strip's length
    l of its `Footing`; 1/C on what is rigid. The block presses over the `height` b beyond a length g at the root that
    is `free` of it, at the arm a = g + b/2. Pressed evenly, a cantilever has there
    C = (g^3/3 + b g^2/2 + b^2 g/4 + b^3/20)/(E I) + (g + b/3)/(kappa G A), I = w t^3/12, A = w t, kappa = 5/6 [T].
    The moment at its root bends the plate to both sides, out to where it does not bend, halfway to the next vane:
    strips of the width w turn by M l/(6 E w h^3/12) [T].
    """
    reach = free**3 / 3.0 + height * free**2 / 2.0 + height**2 * free / 4.0 + height**3 / 20.0
    bending = reach / (youngs_modulus * width * thickness**3 / 12.0)
    shearing = (free + height / 3.0) / (SHEAR_COEFFICIENT * shear_modulus * width * thickness)
    evenly = bending + shearing
    if footing is None:
        return 1.0 / evenly
    arm = free + 0.5 * height
    turning = footing.bend * arm**2 * footing.strip / footing.thickness**3
    root = footing.give * thickness / footing.thickness + turning
    return 1.0 / (footing.spread * evenly / (1.0 + LEAN * block * evenly) + root / (youngs_modulus * width))


def force_at_yield(strength: Any, width: Any, thickness: Any, arm: Any) -> Any:
    """Force [N] at a distance from the root at which the root yields, F = sigma w t/sqrt((6 a/t)^2 + 3) [T, M].

    Bending stress 6 F a/(w t^2) at the surface and mean shear stress F/(w t) taken at one point, which is safe.
    """
    return strength * width * thickness / ((6.0 * arm / thickness) ** 2 + 3.0) ** 0.5
