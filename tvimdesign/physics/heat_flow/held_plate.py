"""Temperatures of the plate, and of what it is part of, while the polymer before it is kept at one temperature.

The steady state of `heat` behind the polymer: a fin that gives heat off sideways to the lumps beside it, and from its
outer face to the air (Incropera, Fundamentals of Heat and Mass Transfer, ch. 3, fins). Contact resistance between
polymer and plate is left out; a liner between the two stands in series.
"""

from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.heat_flow.lumps import Lump, Surface, surface_coefficient
from tvimdesign.physics.heat_flow.stack import Liner

SLICES = (0.125, 0.375, 0.625, 0.875)
"""Where the plate's temperatures are taken, as shares of its depth: the middles of four slices."""
PASSES = 3  # Passes in which radiation is taken again at the temperatures of the last one


class BehindPolymer(NamedTuple):
    """Bodies that the polymer heats, as in `heat.Stack`."""

    area: Any  # [m^2]
    plate_thickness: Any
    plate_conductivity: Any
    plate_surface: Surface  # The plate's outer face; its area is that of the polymer
    ambient: Any  # [K]
    beside: tuple[Lump, ...]
    """Bodies that the plate belongs to: the first takes heat from all of its depth, each next from the one before."""
    uneven_conductance: Any = None
    """Conductance [W/K] sideways for what the plate differs from its mean; as for the mean where not given."""
    liner: Liner | None = None  # A sheet between polymer and plate


class HeldPlate(NamedTuple):
    """Temperatures [K] of a plate behind a polymer that is kept warm."""

    plate: tuple[Any, ...]  # In the middle of slices of equal depth, from the polymer on
    beside: tuple[Any, ...]  # Of the lumps beside the plate, in their order


def held_plate(behind: BehindPolymer, temperature: Any) -> HeldPlate:
    """Return the steady temperatures behind a polymer that is everywhere at one temperature [K].

    theta'' = m^2 theta/d^2 with theta = T - T_f, m^2 = G_u d/(k A), between theta(0) of the polymer and
    -k theta'(d) = h (T(d) - T_a) at the outer face. The mean gives heat to the lump beside by G_b and what differs from
    it by G_u, which is a fin in surroundings of T_f = T_mean - (G_b/G_u)(T_mean - T_beside).
    """
    face = outer = temperature
    beside = tuple(temperature for _ in behind.beside)
    plate: tuple[Any, ...] = ()
    for _ in range(PASSES):
        fin = _Fin(behind, surface_coefficient(behind.plate_surface, outer, behind.ambient))
        if behind.liner is not None:
            lost = behind.liner.whole * _conductance(behind, fin, beside)
            face = behind.ambient + (temperature - behind.ambient) / (1.0 + lost)
        beside = _beside(behind, fin, face, beside)
        foot = beside[0] if beside else behind.ambient
        plate = tuple(fin.at(depth, face, foot, behind.ambient) for depth in SLICES)
        outer = fin.at(1.0, face, foot, behind.ambient)
    return HeldPlate(plate, beside)


class _Fin:
    """The plate's steady profile, linear in the temperatures of polymer, lump beside and air."""

    def __init__(self, behind: BehindPolymer, coefficient: Any) -> None:
        self.across = across = behind.plate_conductivity * behind.area / behind.plate_thickness
        sideways = behind.beside[0].conductance if behind.beside else 0.0 * across
        uneven = sideways if behind.uneven_conductance is None else behind.uneven_conductance
        self.even_share = 1.0 if behind.uneven_conductance is None else sideways / uneven
        # Without lumps the profile is straight, which a thousandth in m leaves as it is.
        self.m = np.sqrt(uneven / across + 1e-6)
        self.biot = coefficient * behind.area / across
        # Hyperbolic functions over e^m/2, as is all else below: they stay finite where the plate conducts badly.
        fall = np.exp(-self.m)
        self.sinh, self.cosh, self.bent = 1.0 - fall**2, 1.0 + fall**2, (1.0 - fall) ** 2
        self.whole = self.m * self.cosh + self.biot * self.sinh

    def at(self, depth: Any, polymer: Any, beside: Any, ambient: Any) -> Any:
        """Return the temperature [K] at a share of the depth."""
        of_polymer, of_air = self.mean_shares
        mean = beside + of_polymer * (polymer - beside) + of_air * (ambient - beside)
        foot = mean - self.even_share * (mean - beside)
        falls, rises = (np.exp(-self.m * share) - np.exp(-self.m * (2.0 - share)) for share in (depth, 1.0 - depth))
        near = self.biot * falls + self.m * (np.exp(-self.m * depth) + np.exp(-self.m * (2.0 - depth)))
        return foot + (near * (polymer - foot) + self.biot * rises * (ambient - foot)) / self.whole

    @property
    def mean_shares(self) -> tuple[Any, Any]:
        """Return what the mean rises above the lump beside for each kelvin of polymer and of air above it [1]."""
        of_air = self.biot * self.bent / (self.m * self.whole)
        of_polymer = self.sinh / self.whole + of_air
        # These are above T_f, which is above the lump by (1 - G_b/G_u) of what the mean is.
        over = self.even_share + (1.0 - self.even_share) * (of_polymer + of_air)
        return of_polymer / over, of_air / over


def _conductance(behind: BehindPolymer, fin: _Fin, last: tuple[Any, ...]) -> Any:
    """Return the heat [W] that the plate takes through its face for each kelvin of that above the air."""
    warm = behind.ambient + 1.0
    beside = _beside(behind, fin, warm, last)
    foot = beside[0] if beside else behind.ambient
    outside = fin.biot * fin.across * (fin.at(1.0, warm, foot, behind.ambient) - behind.ambient)
    if not beside:
        return outside
    of_polymer, of_air = fin.mean_shares
    mean = of_polymer * (warm - foot) + of_air * (behind.ambient - foot)
    return outside + behind.beside[0].conductance * mean


def _beside(behind: BehindPolymer, fin: _Fin, polymer: Any, last: tuple[Any, ...]) -> tuple[Any, ...]:
    """Return the temperatures of the chain of lumps, each losing heat as at the temperature `last` found for it."""
    if not behind.beside:
        return ()
    losses = [
        lump.surface.area * surface_coefficient(lump.surface, temperature, behind.ambient)
        for lump, temperature in zip(behind.beside, last, strict=True)
    ]
    onward = _onward(behind.beside, losses)
    of_polymer, of_air = (behind.beside[0].conductance * share for share in fin.mean_shares)
    lost = losses[0] + onward[0]
    temperatures = [behind.ambient + of_polymer * (polymer - behind.ambient) / (of_polymer + of_air + lost)]
    for lump, loss, beyond in zip(behind.beside[1:], losses[1:], onward[1:], strict=True):
        share = lump.conductance / (lump.conductance + loss + beyond)
        temperatures.append(behind.ambient + share * (temperatures[-1] - behind.ambient))
    return tuple(temperatures)


def _onward(lumps: tuple[Lump, ...], losses: list[Any]) -> list[Any]:
    """Return the conductance to the air through the lumps beyond each [W/K]."""
    onward: list[Any] = [0.0]
    for lump, loss in zip(reversed(lumps[1:]), reversed(losses[1:]), strict=True):
        beyond = loss + onward[0]
        onward.insert(0, lump.conductance * beyond / (lump.conductance + beyond))
    return onward
