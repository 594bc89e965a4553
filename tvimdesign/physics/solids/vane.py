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
    """The vane's own compliance over that of an evenly pressed cantilever, with nothing bonded to it."""
    backed: float
    """What a block bonded to it takes of that compliance, were nothing soft between them."""
    give: float
    """How much the root gives sideways, times E w and over the vane's thickness by the plate's."""
    bend: float
    """How much it turns as both strips bend, over what strips of the vane's width would: 2 where all are as wide."""


def on_plate(thickness: Any, strip: Any) -> Footing:
    """A vane that hangs from the rotor's plate; with the plate, FE of 19 modules within 9 %."""
    return Footing(thickness, strip, 0.90, 0.0, 2.69, 1.13)


def on_floor(thickness: Any, strip: Any) -> Footing:
    """A vane that stands on the floor, slotted, its pad beside it; with the floor, FE of 19 modules within 8 %."""
    return Footing(thickness, strip, 1.175, 0.863, 0.13, 2.40)


def strip_beside(radius: Any, count: Any, thickness: Any) -> Any:
    """Length [m] from a vane's face to halfway to the next one, pi r/n - t/2, of evenly spaced vanes on a circle."""
    return np.pi * radius / count - 0.5 * thickness


UPRIGHT = 0.57
"""How much of a block resists as both its vanes lean, whose upper and lower faces are free; calibrated likewise."""


class BlockBetween(NamedTuple):
    """A block between the vanes of rotor and housing, and the pad that it presses on."""

    moduli: tuple[Any, Any]
    """Shear moduli of block and pad [Pa]."""
    depths: tuple[Any, Any, Any]
    """Depth of block, pad, and of a spreader between them [m]."""
    face: tuple[Any, Any]
    """Width and height [m]."""
    free: Any
    """How far from the vanes' roots it begins [m]."""

    @property
    def arm(self) -> Any:
        """Distance of its middle from the roots [m]."""
        return self.free + 0.5 * self.face[1]

    @property
    def bonding(self) -> Any:
        """How much of the block's stretch its vane meets through the pad [1]: 1/(1 + G t_p/(G_p L))."""
        return 1.0 / (1.0 + self.moduli[0] * self.depths[1] / (self.moduli[1] * self.depths[0]))

    @property
    def uprightness(self) -> Any:
        """Force over way [N/m] with which it keeps two vanes that lean alike upright, V G/(4 a^2) of one material.

        Both faces lean to the same side, so it is sheared by that angle: energy G V/2 times the angle squared.
        """
        whole = sum(self.depths)
        softness = self.depths[0] / self.moduli[0] + self.depths[1] / self.moduli[1]
        return UPRIGHT * self.face[0] * self.face[1] * whole**2 / softness / (2.0 * self.arm) ** 2


class Vane(NamedTuple):
    """How one vane gives at the middle of its block [m/N]."""

    leaning: Any
    """As it leans: it bends, and its root turns."""
    aside: Any
    """As its root is pushed aside."""


def stiffness(youngs_modulus: Any, shear_modulus: Any, width: Any, thickness: Any, height: Any, free: Any = 0.0) -> Any:
    """Force over the face's mean deflection of an evenly pressed cantilever [N/m] on a rigid root, 1/C.

    The pressure acts over the `height` b beyond a length g at the root that is `free` of it:
    C = (g^3/3 + b g^2/2 + b^2 g/4 + b^3/20)/(E I) + (g + b/3)/(kappa G A), I = w t^3/12, A = w t, kappa = 5/6 [T].
    """
    reach = free**3 / 3.0 + height * free**2 / 2.0 + height**2 * free / 4.0 + height**3 / 20.0
    bending = reach / (youngs_modulus * width * thickness**3 / 12.0)
    shearing = (free + height / 3.0) / (SHEAR_COEFFICIENT * shear_modulus * width * thickness)
    return 1.0 / (bending + shearing)


def on_footing(moduli: tuple[Any, Any], section: tuple[Any, Any], block: BlockBetween, footing: Footing) -> Vane:
    """How a vane on a plate of the thickness h gives: leaning c (1 - d beta) C + q a^2 l/(E w h^3), aside r t/(h E w).

    C is that of `stiffness`, `moduli` are E and G [Pa], `section` is its width w and thickness t [m]; c, d, r, q and l
    are those of its `Footing`, beta is the block's `bonding`. The moment at its root bends the plate to both sides, out
    to where it does not bend, halfway to the next vane: strips of the width w turn by M l/(6 E w h^3/12) [T].
    """
    (youngs, shear), (width, thickness) = moduli, section
    evenly = 1.0 / stiffness(youngs, shear, width, thickness, block.face[1], block.free)
    turning = footing.bend * block.arm**2 * footing.strip / footing.thickness**3 / (youngs * width)
    backed = footing.spread * (1.0 - footing.backed * block.bonding)
    return Vane(backed * evenly + turning, footing.give * thickness / footing.thickness / (youngs * width))


def compliance(vane: Vane, other: Vane, block: BlockBetween) -> Any:
    """What a vane gives under its block [m/N], A/(1 + s (A + B)) + its `aside`.

    A and B are how it and the `other` vane lean. Rotor's and housing's vanes have their roots at opposite ends, so a
    force between them leans both to the same side; a block that is bonded to both is sheared by that and keeps them
    upright by its `uprightness` s. From A and B with the moment that it bears, in equilibrium.
    """
    return vane.leaning / (1.0 + block.uprightness * (vane.leaning + other.leaning)) + vane.aside


def force_at_yield(strength: Any, width: Any, thickness: Any, arm: Any) -> Any:
    """Force [N] at a distance from the root at which the root yields, F = sigma w t/sqrt((6 a/t)^2 + 3) [T, M].

    Bending stress 6 F a/(w t^2) at the surface and mean shear stress F/(w t) taken at one point, which is safe.
    """
    return strength * width * thickness / ((6.0 * arm / thickness) ** 2 + 3.0) ** 0.5
