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
    bent: float  # The vane's compliance in bending over that of an evenly pressed cantilever, with nothing bonded to it
    sheared: float  # The same in shear
    give: float  # Sideways compliance of the root, times E w
    root: float = 0.0  # Turn of the root within its plate or floor under a moment, times E w h^2
    bend: float = 0.0  # Turn of the root as both strips bend, over half of what strips as wide as vane and rim would
    strip: Any = 1.0  # Length of plate or floor from the vane's face to halfway to the next vane [m]
    rim: Any = 0.0  # Reach of plate or floor beyond the vane's outer end, and bends with its strips [m]


def on_plate(thickness: Any, strip: Any, rim: Any) -> Footing:
    """Return a vane that hangs from the rotor's plate, its rim beyond it; with the plate and `wedge`, FE of 39 random
    modules 0.93 to 1.31."""
    return Footing(thickness, 0.399, 1.79, 1.53, bend=3.12, strip=strip, rim=rim)


def on_floor(thickness: Any) -> Footing:
    """Return a vane that stands on the floor, slotted, its pad beside it; with the floor, FE of 39 random modules
    0.78 to 1.15."""
    return Footing(thickness, 1.25, 2.13, 2.26, root=0.864)


def strip_beside(radius: Any, count: Any, thickness: Any) -> Any:
    """Return the length [m] from a vane's face to halfway to the next one, pi r/n - t/2, of evenly spaced vanes on a
    circle."""
    return np.pi * radius / count - 0.5 * thickness


SHEARED, TILTED = 0.147, 3.86
"""A pad's stiffness in shear over G w b/d, and its stiffness as it is squeezed more at one end than at the other, over
that of its press spread evenly along the height; calibrated likewise."""


class BlockBetween(NamedTuple):
    """A block between the vanes of rotor and housing, and the pad that it presses on."""

    moduli: tuple[Any, Any]  # Shear moduli of block and pad [Pa]
    depths: tuple[Any, Any, Any]  # Depth of block, pad, and of a spreader between them [m]
    face: tuple[Any, Any]  # Width and height [m]
    free: Any  # Distance of its start from the vanes' roots [m]
    pressed: Any  # Stiffness of the pad as it is pressed [N/m]

    @property
    def arm(self) -> Any:
        """Return the distance of its middle from the roots [m]."""
        return self.free + 0.5 * self.face[1]

    @property
    def resistance(self) -> tuple[Any, Any, Any]:
        """Return the moments K_11, K_22 and K_12 [N*m/rad] with which it resists vanes that lean.

        The block is a beam of the depth d from the rotor's vane, E = 3 G, with free faces above and below, and the pad
        a spring in shear and in turning at its end. Vanes that lean by f_1 and f_2 to the same side move its ends
        across by d f_1 + e f_2, e of pad and spreader, and turn one against the other by f_1 - f_2 [T].
        """
        (shear, pad_shear), (depth, pad, spreader), (width, height) = self.moduli, self.depths, self.face
        bending = 3.0 * shear * width * height**3 / 12.0
        pad_across = SHEARED * pad_shear * width * height / pad
        pad_turned = TILTED * self.pressed * height**2 / 12.0
        across = depth**3 / (3.0 * bending) + depth / (SHEAR_COEFFICIENT * shear * width * height) + 1.0 / pad_across
        turned, both = depth / bending + 1.0 / pad_turned, depth**2 / (2.0 * bending)
        flexible = across * turned - both**2
        force, moment, mixed = turned / flexible, across / flexible, -both / flexible
        beyond = pad + spreader
        return (
            depth**2 * force + 2.0 * depth * mixed + moment,
            beyond**2 * force - 2.0 * beyond * mixed + moment,
            depth * beyond * force + (beyond - depth) * mixed - moment,
        )


class Vane(NamedTuple):
    """Compliance of one vane at the middle of its block [m/N]."""

    leaning: Any  # As it leans: it bends, and its root turns
    aside: Any  # As it shears, and its root is pushed aside


class Shares(NamedTuple):
    """Twice the energy of vanes and block under a force of one [m/N]; their sum is what all give."""

    vane: Any
    other: Any
    block: Any  # As the block resists the vanes' leaning


def evenly_pressed(moduli: tuple[Any, Any], section: tuple[Any, Any], height: Any, free: Any = 0.0) -> tuple[Any, Any]:
    """Return what an evenly pressed cantilever on a rigid root gives on the mean over its face [m/N], bent and sheared.

    The pressure acts over the `height` b beyond a length g at the root that is `free` of it:
    (g^3/3 + b g^2/2 + b^2 g/4 + b^3/20)/(E I) and (g + b/3)/(kappa G A), I = w t^3/12, A = w t, kappa = 5/6 [T].
    `moduli` are E and G [Pa], `section` is the width w and the thickness t [m].
    """
    (youngs, shear), (width, thickness) = moduli, section
    reach = free**3 / 3.0 + height * free**2 / 2.0 + height**2 * free / 4.0 + height**3 / 20.0
    bending = reach / (youngs * width * thickness**3 / 12.0)
    shearing = (free + height / 3.0) / (SHEAR_COEFFICIENT * shear * width * thickness)
    return bending, shearing


def stiffness(youngs_modulus: Any, shear_modulus: Any, width: Any, thickness: Any, height: Any, free: Any = 0.0) -> Any:
    """Return the force over the face's mean deflection of an evenly pressed cantilever [N/m] on a rigid root, of
    `evenly_pressed`."""
    return 1.0 / sum(evenly_pressed((youngs_modulus, shear_modulus), (width, thickness), height, free))


def on_footing(moduli: tuple[Any, Any], section: tuple[Any, Any], block: BlockBetween, footing: Footing) -> Vane:
    """Return how a vane on a plate of the thickness h gives: leaning c B + s a^2/(E w h^2) + q a^2 l/(E (w + m) h^3
    (1 + t/2l)^2), aside k S + r/(E w).

    B and S are those of `evenly_pressed`, `moduli` are E and G [Pa], `section` is its width w and thickness t [m]; c,
    k, r, s, q, l and the rim m are those of its `Footing`. A force pushes the root aside, a moment turns it within the
    thickness of what it stands on. The moment also bends the plate to both sides, out to where it does not bend,
    halfway to the next vane: strips of the width w + m turn by M l/(6 E (w + m) h^3/12) [T]. As the vane turns, it
    lifts the ends of both by its half thickness too, which makes them (1 + t/2l)^2 times as stiff.
    """
    (youngs, _), (width, thickness) = moduli, section
    bending, shearing = evenly_pressed(moduli, section, block.face[1], block.free)
    strips = youngs * (width + footing.rim) * footing.thickness**3 / footing.strip
    plate = footing.bend / strips / (1.0 + 0.5 * thickness / footing.strip) ** 2
    within = footing.root / (youngs * width * footing.thickness**2)
    aside = footing.sheared * shearing + footing.give / (youngs * width)
    return Vane(footing.bent * bending + block.arm**2 * (plate + within), aside)


def compliances(vane: Vane, other: Vane, block: BlockBetween) -> Shares:
    """Return what vanes and block give under the block's force: a^2 f^2/A + its `aside` of each, f K f of the block.

    Rotor's and housing's vanes have their roots at opposite ends, so a force between them leans both to the same side.
    A block that is bonded to both keeps them from that: (a^2/A + K) f = a with its `resistance` K, the leaning A and
    the arm a. Shear of a vane turns no section of it, so no block resists it. Source: equilibrium of both vanes'
    moments.
    """
    own, beyond = (block.arm**2 / side.leaning for side in (vane, other))
    first, second, between = block.resistance
    whole = (own + first) * (beyond + second) - between**2
    lean, opposite = (block.arm * (side - between) / whole for side in (beyond + second, own + first))
    resisted = first * lean**2 + second * opposite**2 + 2.0 * between * lean * opposite
    return Shares(own * lean**2 + vane.aside, beyond * opposite**2 + other.aside, resisted)


def along_axis(vane: Vane, other: Vane, block: BlockBetween, thicknesses: tuple[Any, Any]) -> Any:
    """Return what vanes and block give more than shear as a force pulls them along the axis [m/N]: d^3/(3 E I) + sum
    e^2 A/a^2.

    The pad hands no moment on. So the block is a cantilever on the rotor's vane, and each vane leans by A/a^2 under the
    force times its distance e from the vane's middle, half the thickness and what lies between [T].
    """
    (shear, _), (depth, pad, spreader), (width, height) = block.moduli, block.depths, block.face
    bent = depth**3 / (9.0 * shear * width * height**3 / 12.0)
    levers = depth + 0.5 * thicknesses[0], pad + spreader + 0.5 * thicknesses[1]
    leaning = zip(levers, (vane.leaning, other.leaning), strict=True)
    return bent + sum((lever / block.arm) ** 2 * lean for lever, lean in leaning)
