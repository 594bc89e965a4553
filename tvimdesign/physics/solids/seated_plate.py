"""Annular plates that adhesive sets in pockets of a floor, along their inner and outer rims.

A torque leaves a plate through its rims, which shear adhesive and floor; the plate itself is stiff. The floor within
the pockets leads what passes the inner rims out to the outer ones. The ends of the plates touch nothing.
"""

from __future__ import annotations

from typing import Any, NamedTuple


class Seat(NamedTuple):
    """Adhesive along the rims of a plate, and the floor that it is bonded to."""

    gap: Any
    """Width of the adhesive [m]."""
    depth: Any
    """Height of the adhesive, that of the plate's rim [m]."""
    spread: Any
    """Slip of the floor beside a rim times its shear modulus, over the force on a length of it [1]."""
    adhesive: Any
    """Shear modulus of the adhesive [Pa]."""
    floor: Any
    """Shear modulus of the floor [Pa]."""


class Path(NamedTuple):
    """Two ways out of the plates side by side, and what they do under one newton metre of all plates together."""

    inward: Any
    """Share of the torque that leaves through the inner rims [1]."""
    adhesive: Any
    """Compliance of the adhesive [rad/(N*m)]."""
    floor: Any
    """Compliance of the floor beside the rims, and between them [rad/(N*m)]."""
    inner_traction: Any
    """Shear of the adhesive along the inner rims [Pa/(N*m)]."""
    outer_traction: Any
    """Shear of the adhesive along the outer rims [Pa/(N*m)]."""


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
