"""A block between vanes is a wedge: the force it hands on leans out along one of them, bends it that way and twists it.

A block's two faces lie on radii, `span` apart. What is soft in shear, as a pad of rubber, hands on what stands across
its own face only; the other vane, turned by the span and half of its own angle, gets a part along its width, and a
moment about its height, as the force acts a radius from the axis and the vane's middle is not where it points.
Sources: [T] Timoshenko, Strength of Materials, part I, 3rd ed., ch. 5 (cantilevers, strips of a plate) and part II, 3rd
ed., ch. 8 (torsion of rectangular bars); [R] Roark's Formulas for Stress and Strain, 7th ed., table 10.1, case 4;
[TG] Timoshenko and Goodier, Theory of Elasticity, 3rd ed., art. 33 (a sheet turned at a hole).
"""

from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.solids import vane


class PlateAround(NamedTuple):
    """The rotor's plate, from the core out to the middle of its vanes."""

    thickness: Any  # [m]
    core_radius: Any  # [m]
    radius: Any  # Of the vanes' middle [m]
    count: Any  # Number of vanes that hang from it


class Sideways(NamedTuple):
    """Compliance of a vane, with its plate, to loads that do not press on its face."""

    along: Any  # To a force along its width [m/N]
    twisted: Any  # To a moment about its height [rad/(N*m)]


def torsion_constant(width: Any, thickness: Any) -> Any:
    """Return J [m^4] of a rectangular section, a b^3 (1/3 - 0.21 (b/a) (1 - b^4/(12 a^4))), a >= b: within 5 in 1000
    [R]."""
    long, short = np.fmax(width, thickness), np.fmin(width, thickness)
    return long * short**3 * (1.0 / 3.0 - 0.21 * short / long * (1.0 - short**4 / (12.0 * long**4)))


def sideways(
    moduli: tuple[Any, Any], section: tuple[Any, Any], block: vane.BlockBetween, plate: PlateAround
) -> Sideways:
    """Return how a vane gives to a force along its width w and to a moment about its height.

    Along: C' + a^2 12 n ln(r/R)/(2 pi E h^3), C' that of `vane.stiffness` with width and thickness in each other's
    place. The n vanes bend the plate evenly around, a moment n M/(2 pi r) on each length, from R to r [T]. Twisted:
    (g + b/3)/(G J) [T], the moment handed over evenly along the height, and 1/(4 pi G h s^2), a spot of the area of
    the root turned within the plate, pi s^2 = w t [TG]. `moduli` are E and G [Pa].
    """
    (youngs, shear), (width, thickness) = moduli, section
    evenly = 1.0 / vane.stiffness(youngs, shear, thickness, width, block.face[1], block.free)
    reach = plate.count * np.log(plate.radius / plate.core_radius) / (2.0 * np.pi)
    cupped = 12.0 * block.arm**2 * reach / (youngs * plate.thickness**3)
    twisted = (block.free + block.face[1] / 3.0) / (shear * torsion_constant(width, thickness))
    spot = 1.0 / (4.0 * shear * plate.thickness * width * thickness)
    return Sideways(evenly + cupped, twisted + spot)


def lean_out(block: vane.BlockBetween, side: Sideways, thickness: Any, radius: Any) -> Any:
    """Return the angle [rad] between a vane's face and what a block's force stands across, at the vane's middle.

    A force F that stands across the radius at the angle x from the vane's middle pushes the vane along its width by
    F x. The block's span s begins half the vane's angle v = t/(2 r) away: its middle is sheared by F (x - v - s/2), the
    pad at its far face by F (x - v - s). The force takes the x that costs least energy, so that it stands across what
    is softest of the three. Block and pad give by depth over modulus and area. Source: the least complementary energy
    of springs in series [T].
    """
    span, half = block.depths[0] / radius, 0.5 * thickness / radius
    area = block.face[0] * block.face[1]
    wedge, pad = (depth / modulus / area for depth, modulus in zip(block.depths[:2], block.moduli, strict=True))
    return (wedge * (0.5 * span + half) + pad * (span + half)) / (wedge + pad + side.along)


def compliance(across: Any, side: Sideways, angle: Any, radius: Any) -> Any:
    """Return what a vane gives at the mean radius under a force that leans out [m/N].

    cos^2 x of what it gives across, sin^2 x of what it does along, and (r (1 - cos x))^2 of what it does twisted: the
    force is a radius r from the axis, its part across the vane's middle bears r cos x of that. Source: the work of the
    parts of one force.
    """
    lever = radius * (1.0 - np.cos(angle))
    return np.cos(angle) ** 2 * across + np.sin(angle) ** 2 * side.along + lever**2 * side.twisted


def foot_bending(angle: Any, arm: Any, core_radius: Any, plate: PlateAround) -> Any:
    """Return what cupping the plate adds to a core's stress at its foot, over that of the plain core in torsion [1].

    The plate bears n M/(2 pi R) on each length around the core, M = F a sin x under F = T/(n r): a stress of
    6 T a sin x/(2 pi r R h^2) [T]. Over sqrt(3) 2 T/(pi R^3), of the plain core by Mises: (sqrt(3)/2) (a/r) sin x
    (R/h)^2. It stands across the shear, so the two add as squares.
    """
    return 0.5 * np.sqrt(3.0) * arm / plate.radius * np.sin(angle) * (core_radius / plate.thickness) ** 2


def stress_of_twist(width: Any, thickness: Any) -> Any:
    """Return the highest shear stress in a rectangular section over the moment that twists it [1/m^3]: amid a long
    side.

    3/(8 a b^2) (1 + 0.6095 q + 0.8865 q^2 - 1.8023 q^3 + 0.91 q^4), a >= b half of its sides, q = b/a [R].
    """
    long, short = 0.5 * np.fmax(width, thickness), 0.5 * np.fmin(width, thickness)
    q = short / long
    return 3.0 / (8.0 * long * short**2) * (1.0 + 0.6095 * q + 0.8865 * q**2 - 1.8023 * q**3 + 0.91 * q**4)


def force_at_yield(strength: Any, section: tuple[Any, Any], arm: Any, angle: Any = 0.0, radius: Any = 0.0) -> Any:
    """Return the force [N] at a distance from a vane's root at which the root yields, leaning out by an angle [rad].

    It bends the root both ways, 6 F a (cos x/(w t^2) + sin x/(w^2 t)), shears it by F/(w t) on the mean and twists it
    by F r (1 - cos x) (`stress_of_twist`): all taken at one point, which is safe, by Mises [T]. `section` is w and t.
    """
    width, thickness = section
    bent = 6.0 * arm * (np.cos(angle) / thickness + np.sin(angle) / width) / (width * thickness)
    twisted = radius * (1.0 - np.cos(angle)) * stress_of_twist(width, thickness)
    sheared = 1.0 / (width * thickness) + twisted
    return strength / (bent**2 + 3.0 * sheared**2) ** 0.5
