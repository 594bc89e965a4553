"""Plates that a core turns, and plates that adhesive sets in pockets of a floor, along their inner and outer rims.

Beside a core the stress of a plate is a mean over its thickness and a length outwards.

A torque leaves a plate in a pocket through its rims, which shear adhesive and floor; the plate itself is stiff. The
floor within the pockets leads what passes the inner rims out to the outer ones. The ends of the plates touch nothing.

Sources: equilibrium; [T] Timoshenko and Goodier, Theory of Elasticity, 3rd ed. What is calibrated follows FE of the
drawn parts (validation/fe_structure).
"""

from typing import Any, NamedTuple

import numpy as np

POINTS = (np.arange(64) + 0.5) / 64  # Of the length outwards, evenly
ENTERS, GOES_AROUND = 1.03, 0.75
"""Rise of a plate's highest stress beside a core as the torque enters it from its face, and with the share of the polar
moment that holes cost at the core's foot (`structure.felt_at_foot`); FE of 21 plates within 6 %."""


def shear_beside_core(torque: Any, thickness: Any, radius: Any, over: Any) -> Any:
    """Return the mean shear [Pa] of a flat plate turned by a core, from its `radius` on outwards `over` a length [m].

    By equilibrium tau(r) = T/(2 pi r^2 h); its mean is T/(2 pi h r (r + l)).
    """
    return torque / (2.0 * np.pi * thickness * radius * (radius + over))


def mean_with_bending(even: Any, bent: Any) -> Any:
    """Return the mean over a plate's thickness of (s^2 + (b u)^2)^(1/2), u from 0 in its middle to 1 on its faces [Pa].

    `even` s is the same through the thickness, `bent` b is that of bending on the faces, across it; their squares add.
    The integral is ((s^2 + b^2)^(1/2) + s^2/b arsinh(b/s))/2.
    """
    ratio = bent / even
    return 0.5 * even * (np.sqrt(1.0 + ratio**2) + np.arcsinh(ratio) / ratio)


def thicker_by_fillet(thickness: float, fillet: float, over: float) -> float:
    """Return the stress of a plate `over` a length [m] outwards from a core with a fillet over that of one with a sharp
    foot [1].

    What stands on the plate bears with it, so that the stress at x is h/(h + y) of what it was, y(x) the height of a
    fillet of the radius q, q - (q^2 - (q - x)^2)^(1/2) up to x = q; its mean. Source: equilibrium.
    """
    left = np.maximum(fillet - over * POINTS, 0.0)
    return float(np.mean(thickness / (thickness + fillet - np.sqrt(fillet**2 - left**2))))


def highest_around(felt: Any) -> Any:
    """Return the highest stress around a core over the mean shear of the plate there [1]: 1.03 (1 + 0.75 w)."""
    return ENTERS * (1.0 + GOES_AROUND * felt)


class Seat(NamedTuple):
    """Adhesive along the rims of a plate, and the floor that it is bonded to."""

    gap: Any  # Width of the adhesive [m]
    depth: Any  # Height of the adhesive, that of the plate's rim [m]
    spread: Any  # Slip of the floor beside a rim times its shear modulus, over the force on a length of it [1]
    adhesive: Any  # Shear modulus of the adhesive [Pa]
    floor: Any  # Shear modulus of the floor [Pa]


class Path(NamedTuple):
    """Two ways out of the plates side by side, and what they do under one newton metre of all plates together."""

    inward: Any  # Share of the torque that leaves through the inner rims [1]
    adhesive: Any  # Compliance of the adhesive [rad/(N*m)]
    floor: Any  # Compliance of the floor beside the rims, and between them [rad/(N*m)]
    inner_traction: Any  # Shear of the adhesive along the inner rims [Pa/(N*m)]
    outer_traction: Any  # Shear of the adhesive along the outer rims [Pa/(N*m)]


def slips(seat: Seat) -> tuple[Any, Any]:
    """Return how far adhesive and floor slip along a rim, over the force on a length of it [m^2/N].

    The floor is a slab sheared over its height from a strip of its edge. Its displacement follows Laplace's equation,
    as a temperature does: its `spread` is what such a strip constricts.
    """
    return seat.gap / (seat.adhesive * seat.depth), seat.spread / seat.floor


def path(seat: Seat, around: Any, radii: tuple[Any, Any], between: Any) -> Path:
    """Return how a torque leaves plates that cover the angle `around` [rad] together.

    `between` is the compliance of the floor from the inner to the outer radius of the plates [rad/(N*m)].
    """
    adhesive, floor = slips(seat)
    rims = [(adhesive + floor) / (around * radius**3) for radius in radii]
    inward = rims[1] / (rims[0] + rims[1] + between)
    shares = inward, 1.0 - inward
    both = sum(share**2 * rim for share, rim in zip(shares, rims, strict=True))
    of_adhesive = both * adhesive / (adhesive + floor)
    inner, outer = (share / (around * radius**2 * seat.depth) for share, radius in zip(shares, radii, strict=True))
    return Path(inward, of_adhesive, both - of_adhesive + inward**2 * between, inner, outer)


SHAPES = 4  # Of a leaning plate, and of the floor below: a rigid one, and three that bend
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)


class Leaning(NamedTuple):
    """A plate that leans with its core over a floor on feet, a layer between them; lengths [m]."""

    core: Any  # Radius of the core
    plate: Any  # Thickness of the plate
    inner: Any  # Inner and outer radius of the layer, to which the plate reaches
    outer: Any
    layer: Any  # Stiffness of the layer between rigid faces that lean [N*m/rad]
    bore: Any  # Radius of the floor's bore
    floor: Any  # Thickness of the floor
    feet: Any  # Radius of the circle of feet, to which the floor reaches
    upright: Any  # Stiffness of all feet along the axis [N/m]
    turning: Any  # Stiffness of all feet, built in, against turning on their circle [N*m/rad]


def leaning_compliance(modulus: Any, poissons_ratio: Any, at: Leaning) -> Any:
    """Return by how much a core leans under a moment across it [rad/(N*m)], plate and floor of one material.

    Ritz: both are thin plates that move by f(r) cos t along the axis, f = r, x^2, x^3, x^4 with x from 0 at the core
    (at the bore) to 1 at the layer's outer rim (at the feet), and bend with

        pi D int (f'' + a)^2 - 2 (1 - nu) (f'' a - a^2) r dr,  a = f'/r - f/r^2,  D = E h^3/(12 (1 - nu^2)).

    The layer is a foundation between them, even over its ring; feet hold the floor's rim evenly. All shapes but the
    core's lean are eliminated. Source: [TW] Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells, ch. 9.
    """
    count = 2 * SHAPES
    energy: list[list[Any]] = [[0.0] * count for _ in range(count)]
    for first, thickness, start, end in ((0, at.plate, at.core, at.outer), (SHAPES, at.floor, at.bore, at.feet)):
        rigidity = modulus * thickness**3 / (12.0 * (1.0 - poissons_ratio**2))
        for r, weight in _between(start, end):
            bent = [(second, slope / r - way / r**2) for way, slope, second in _shapes(r, start, end)]
            across = 1.0 - poissons_ratio
            for i, (f, a) in enumerate(bent):
                for j, (g, b) in enumerate(bent):
                    work = (f + a) * (g + b) - across * (f * b + g * a - 2.0 * a * b)
                    energy[first + i][first + j] += np.pi * rigidity * weight * r * work
    press = 4.0 * at.layer / (at.outer**4 - at.inner**4)
    for r, weight in _between(at.inner, at.outer):
        plate, floor = (_shapes(r, *ends) for ends in ((at.core, at.outer), (at.bore, at.feet)))
        _add(energy, press * weight * r, [way for way, *_ in plate] + [-way for way, *_ in floor])
    ways, slopes, _ = zip(*_shapes(at.feet, at.bore, at.feet), strict=True)
    for stiffness, held in ((0.5 * at.upright, ways), (0.5 * at.turning, slopes)):
        _add(energy, stiffness, [0.0] * SHAPES + list(held))
    for last in range(count - 1, 0, -1):
        for i in range(last):
            for j in range(last):
                energy[i][j] = energy[i][j] - energy[i][last] * energy[last][j] / energy[last][last]
    return 1.0 / energy[0][0]


def _between(start: Any, end: Any) -> list[tuple[Any, Any]]:
    """Return radii between two, and their weights in an integral over the radius."""
    half = 0.5 * (end - start)
    return [(start + half * (1.0 + node), half * weight) for node, weight in zip(_NODES, _WEIGHTS, strict=True)]


def _shapes(r: Any, start: Any, end: Any) -> list[tuple[Any, Any, Any]]:
    """Return f, f' and f'' of the shapes of a plate that is clamped to what leans with it at its start."""
    length = end - start
    x = (r - start) / length
    bends = [(length * x**k, k * x ** (k - 1), k * (k - 1) * x ** (k - 2) / length) for k in range(2, SHAPES + 1)]
    return [(r, 1.0, 0.0), *bends]


def _add(energy: list[list[Any]], stiffness: Any, shares: list[Any]) -> None:
    for i, first in enumerate(shares):
        for j, second in enumerate(shares):
            energy[i][j] = energy[i][j] + stiffness * first * second
