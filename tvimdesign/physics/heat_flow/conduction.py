"""Conduction in a polymer that conducts otherwise frozen than molten.

A cell that melts stays at the melting temperature while the front passes it, so heat comes to the front through melt
alone and leaves it through solid alone. With the potential theta = integral k dT (Kirchhoff's transform; Carslaw and
Jaeger, Conduction of Heat in Solids, 2nd ed., section 1.6) the flux between two cells is the difference of their
potentials over their distance, which is that, and of second order. Half-cell resistances in series at the
conductivity of a half molten cell are of first order: a conductivity ratio of four misplaces the front by several per
cent at 28 cells.
"""

from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.polymers.polymer import Melting, ramp

_WINDOW_SHARE = 0.1  # Width of the rounded corners of k(T), as a share of the melting window
_SAME = 0.5  # Difference of temperature [K] below which two places are taken to conduct alike


class Conductivities(NamedTuple):
    """Thermal conductivity of the two phases [W/m K]."""

    solid: Any
    melt: Any

    def mixed(self, fraction: Any) -> Any:
        """Return the conductivity at a solid fraction [W/m K], in proportion."""
        return self.melt + fraction * (self.solid - self.melt)


def potential(temperature: Any, conductivities: Conductivities, melting: Melting) -> Any:
    """Return the integral of the conductivity over temperature [W/m], zero where melting starts.

    k is that of the solid below the melting window, that of the melt above it, and straight within.
    """
    window = melting.end - melting.start
    width = _WINDOW_SHARE * window
    above_start, above_end = temperature - melting.start, temperature - melting.end
    molten = (ramp(above_start, width) ** 2 - ramp(above_end, width) ** 2) / (2.0 * window)
    return conductivities.solid * above_start + (conductivities.melt - conductivities.solid) * molten


def mean_conductivity(temperature: Any, at: Any, wall: Any, conductivities: Conductivities, melting: Melting) -> Any:
    """Return the mean conductivity [W/m K] between a place and a wall [K], from the potential.

    `at` is the conductivity of the place itself, taken where the two are at one temperature.
    """
    apart = wall - temperature
    risen = potential(wall, conductivities, melting) - potential(temperature, conductivities, melting)
    return (risen * apart + _SAME**2 * at) / (apart**2 + _SAME**2)


def shared(share: Any, place: Any, wall: Any, conductivities: Conductivities, melting: Melting) -> Any:
    """Return the temperature [K] where the potential above that of a wall is a `share` of what it is at a place [K].

    One step of Newton's from the share of the temperatures, with the mean of both conductivities for the slope.
    """
    even = wall + share * (place - wall)
    at_wall, at_place, at_even = (
        potential(temperature, conductivities, melting) for temperature in (wall, place, even)
    )
    beyond = at_even - at_wall - share * (at_place - at_wall)
    return even - beyond / conductivities.mixed(0.5)


def between(cells: Any, conductivities: Conductivities, melting: Melting, depth: Any) -> Any:
    """Return the flux [W/m^2] from each cell to the next, cells of one depth [m] at temperatures [K] of the equilibrium
    curve."""
    return -np.diff(potential(cells, conductivities, melting)) / depth
