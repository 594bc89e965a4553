"""A vane: a short cantilever of rectangular section, pressed on one of its faces.

Sources: [T] Timoshenko, Strength of Materials, part I, 3rd ed., ch. 5 (cantilevers under an even load, deflection by
bending and by shear, beams); [M] Mises' criterion of yield.
"""

from typing import Any, NamedTuple

import numpy as np

SHEAR_COEFFICIENT = 5.0 / 6.0  # rectangular section [T]


class Footing(NamedTuple):
    """Support of a vane, and its difference from a rigid root; calibrated to validation/fe_structure."""

    thickness: Any  # Thickness of the plate or floor [m]
    strip: Any  # Length of plate or floor from the vane's face to halfway to the next vane [m]
    spread: float  # The vane's own compliance over that of an evenly pressed cantilever, with nothing bonded to it
    give: float  # Sideways compliance of the root, times E w and over the vane's thickness by the plate's
    bend: float  # Turn of the root as both strips bend, over half of what strips as wide as vane and rim would
    rim: Any = 0.0  # Reach of plate or floor beyond the vane's outer end, and bends with its strips [m]


ROTOR_SPREAD = 0.787  # `Footing.spread` of the rotor's vanes, across their faces and along them


def on_plate(thickness: Any, strip: Any, rim: Any) -> Footing:
    """Return a vane that hangs from the rotor's plate, its rim beyond it; with the plate and `wedge`, FE of 25 random
    modules 0.73 to 1.31."""
    return Footing(thickness, strip, ROTOR_SPREAD, 2.6, 2.31, rim)


def on_floor(thickness: Any, strip: Any) -> Footing:
    """Return a vane that stands on the floor, slotted, its pad beside it; with the floor, FE of 25 random modules
    0.72 to 1.15."""
    return Footing(thickness, strip, 1.31, 0.409, 2.94)


def strip_beside(radius: Any, count: Any, thickness: Any) -> Any:
    """Return the length [m] from a vane's face to halfway to the next one, pi r/n - t/2, of evenly spaced vanes on a
    circle."""
    return np.pi * radius / count - 0.5 * thickness


SHEARED, TILTED = 0.0655, 6.43
"""Share of a block that resists as its vanes shear it, whose upper and lower faces are free, and as they squeeze it
more at one end than at the other, over a row of free bars, whose sides are not; calibrated likewise."""


class BlockBetween(NamedTuple):
    """A block between the vanes of rotor and housing, and the pad that it presses on."""

    moduli: tuple[Any, Any]  # Shear moduli of block and pad [Pa]
    depths: tuple[Any, Any, Any]  # Depth of block, pad, and of a spreader between them [m]
    face: tuple[Any, Any]  # Width and height [m]
    free: Any  # Distance of its start from the vanes' roots [m]

    @property
    def arm(self) -> Any:
        """Return the distance of its middle from the roots [m]."""
        return self.free + 0.5 * self.face[1]

    @property
    def depth(self) -> Any:
        """Return how far the vanes' faces are apart [m]."""
        return sum(self.depths)

    @property
    def softness(self) -> Any:
        """Return what block and pad give per shear stress, one behind the other [m/Pa]."""
        return self.depths[0] / self.moduli[0] + self.depths[1] / self.moduli[1]

    @property
    def sheared(self) -> Any:
        """Return twice the energy [N*m] of block and pad at an even shear of one: G V of one material."""
        return SHEARED * self.face[0] * self.face[1] * self.depth**2 / self.softness

    @property
    def tilted(self) -> Any:
        """Return the moment [N*m/rad] between vanes that lean unlike: 3 G w b^3/(12 d) of one material."""
        return TILTED * 3.0 * self.face[0] * self.face[1] ** 3 / 12.0 / self.softness


class Vane(NamedTuple):
    """Compliance of one vane at the middle of its block [m/N]."""

    leaning: Any  # As it leans: it bends, and its root turns
    aside: Any  # As its root is pushed aside
    thickness: Any  # Thickness [m]


def stiffness(youngs_modulus: Any, shear_modulus: Any, width: Any, thickness: Any, height: Any, free: Any = 0.0) -> Any:
    """Return the force over the face's mean deflection of an evenly pressed cantilever [N/m] on a rigid root, 1/C.

    The pressure acts over the `height` b beyond a length g at the root that is `free` of it:
    C = (g^3/3 + b g^2/2 + b^2 g/4 + b^3/20)/(E I) + (g + b/3)/(kappa G A), I = w t^3/12, A = w t, kappa = 5/6 [T].
    """
    reach = free**3 / 3.0 + height * free**2 / 2.0 + height**2 * free / 4.0 + height**3 / 20.0
    bending = reach / (youngs_modulus * width * thickness**3 / 12.0)
    shearing = (free + height / 3.0) / (SHEAR_COEFFICIENT * shear_modulus * width * thickness)
    return 1.0 / (bending + shearing)


def on_footing(moduli: tuple[Any, Any], section: tuple[Any, Any], block: BlockBetween, footing: Footing) -> Vane:
    """Return how a vane on a plate of the thickness h gives: leaning c C + q a^2 l/(E (w + m) h^3 (1 + t/2l)^2), aside
    r t/(h E w).

    C is that of `stiffness`, `moduli` are E and G [Pa], `section` is its width w and thickness t [m]; c, r, q, l and
    the rim m are those of its `Footing`. The moment at its root bends the plate to both sides, out to where it does not
    bend, halfway to the next vane: strips of the width w + m turn by M l/(6 E (w + m) h^3/12) [T]. As the vane turns,
    it lifts the ends of both by its half thickness too, which makes them (1 + t/2l)^2 times as stiff.
    """
    (youngs, shear), (width, thickness) = moduli, section
    evenly = 1.0 / stiffness(youngs, shear, width, thickness, block.face[1], block.free)
    strips = youngs * (width + footing.rim) * footing.thickness**3 / footing.strip
    turning = footing.bend * block.arm**2 / strips / (1.0 + 0.5 * thickness / footing.strip) ** 2
    aside = footing.give * thickness / footing.thickness / (youngs * width)
    return Vane(footing.spread * evenly + turning, aside, thickness)


def compliance(vane: Vane, other: Vane, block: BlockBetween) -> Any:
    """Return what a vane gives under its block [m/N]: a^2 (k_22 - k_12)/(k_11 k_22 - k_12^2) + its `aside`.

    Rotor's and housing's vanes have their roots at opposite ends, so a force between them leans both to the same side.
    A block that is bonded to both keeps them from that. As they lean by f_1 and f_2, their faces move along them as
    well, half a vane's thickness from its middle, so that it is sheared by g_1 f_1 + g_2 f_2, g_i = (1 + t_i/d)/2 with
    its depth d, and squeezed more at one end by f_1 - f_2: k_ii = a^2/A_i + g_i^2 S + M and k_12 = g_1 g_2 S - M with
    its `sheared` S and `tilted` M, A how a vane leans. Source: equilibrium of both vanes' moments.
    """
    shares = [0.5 * (1.0 + side.thickness / block.depth) for side in (vane, other)]
    own, beyond = (
        block.arm**2 / side.leaning + share**2 * block.sheared + block.tilted
        for side, share in zip((vane, other), shares, strict=True)
    )
    between = shares[0] * shares[1] * block.sheared - block.tilted
    return block.arm**2 * (beyond - between) / (own * beyond - between**2) + vane.aside
