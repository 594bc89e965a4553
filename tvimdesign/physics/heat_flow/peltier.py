"""Peltier modules and their spreaders [K]. Source: Rowe (ed.), CRC Handbook of Thermoelectrics, ch. 1."""

from math import log, pi
from typing import Any, NamedTuple


class PeltierModule(NamedTuple):
    """Seebeck coefficient [V/K], resistance [ohm] and thermal conductance [W/K] of all Peltier elements in series."""

    seebeck: Any
    resistance: Any
    conductance: Any


SIDE_SHARE = 1.0 / 12.0
"""Share of a pad's thickness that each side is, which has one temperature; assumed, 0 to 0.2. The legs between them
have the rest of its heat capacity."""


def shared_capacity(whole: Any) -> tuple[Any, Any]:
    """Return the heat capacities of one side and of the legs of pads that have `whole` [J/K]."""
    return SIDE_SHARE * whole, (1.0 - 2.0 * SIDE_SHARE) * whole


def wired(pad: PeltierModule, count: Any, strings: Any) -> PeltierModule:
    """Return `count` alike modules in `strings` parallel strings, as one module that takes the whole current.

    Each takes I/p: S I T sums to (n/p) S I T, I^2 R to (n/p^2) R I^2, and heat is conducted through all n of them.
    """
    in_series = count / strings
    return PeltierModule(in_series * pad.seebeck, in_series * pad.resistance / strings, count * pad.conductance)


def max_cooling_power(module: PeltierModule, cold_temperature: Any) -> Any:
    """Return the heat that can be drawn from the cold side without a temperature difference, S^2 T_c^2/(2 R) [W].

    Compare it with a data sheet's Q_max, which the other three values do not use.
    """
    return module.seebeck**2 * cold_temperature**2 / (2.0 * module.resistance)


def hot_side_heat(module: PeltierModule, current: Any, hot: Any, cold: Any) -> Any:
    """Return the heat given off by the hot side, Q_h = S I T_h + I^2 R/2 - K (T_h - T_c) [W]; the legs between have
    settled."""
    joule = 0.5 * current**2 * module.resistance
    return module.seebeck * current * hot + joule - module.conductance * (hot - cold)


def cold_side_heat(module: PeltierModule, current: Any, hot: Any, cold: Any) -> Any:
    """Return the heat taken up by the cold side, Q_c = S I T_c - I^2 R/2 - K (T_h - T_c) [W]; the legs have settled."""
    joule = 0.5 * current**2 * module.resistance
    return module.seebeck * current * cold - joule - module.conductance * (hot - cold)


def legs_temperature(hot: Any, middle: Any, cold: Any) -> Any:
    """Return the mean temperature of legs with a parabola through both sides and the middle, (T_h + 4 T_m + T_c)/6
    [K]."""
    return (hot + 4.0 * middle + cold) / 6.0


OF_HALF = 0.25  # Rise of a half of the legs over their mean, over the rise of the side next to it over the other


def legs_temperatures(hot: Any, middle: Any, cold: Any) -> tuple[Any, Any, Any]:
    """Return the mean temperatures [K] of legs with that parabola: of all, of the half next to the hot side, of the
    other.

    What the middle is above the straight line between the sides is alike in both halves: 2/3 of it in the mean.
    """
    mean = legs_temperature(hot, middle, cold)
    return mean, mean + OF_HALF * (hot - cold), mean - OF_HALF * (hot - cold)


def settled_middle(module: PeltierModule, current: Any, hot: Any, cold: Any) -> Any:
    """Return the middle of legs that the current heats evenly, once they have settled, (T_h + T_c)/2 + I^2 R/(8 K) [K].

    Between their ends they have a parabola above the straight line; in the mean it is I^2 R/(12 K).
    """
    return 0.5 * (hot + cold) + current**2 * module.resistance / (8.0 * module.conductance)


class LegsHeat(NamedTuple):
    """Heat [W] by which legs warm both sides and their own middle."""

    hot: Any
    middle: Any
    cold: Any


OF_SIDE, OF_MIDDLE = 1.0 / 6.0, 2.0 / 3.0
"""Shares of an even quantity over a length that belong to either end and to the middle, by Simpson's rule."""


def legs_heat(module: PeltierModule, current: Any, hot: Any, middle: Any, cold: Any) -> LegsHeat:
    """Return the heat that legs of their own heat capacity give to both sides and keep in the middle, Peltier's heat
    aside.

    Three places, T_h, T_m, T_c, on a parabola (the quadratic finite element with what is even lumped by Simpson's
    rule): of I^2 R and of the legs' heat capacity C a sixth belongs to either
    side and two thirds to the middle. With v = T_m - (T_h + T_c)/2 conduction brings 8 K v/3 -+ K (T_h - T_c) to the
    sides. Exact of a slab: its steady state, the heat C I^2 R/(12 K) that it keeps in it, and how far its inside is
    behind sides that warm up evenly.
    """
    joule, above = current**2 * module.resistance, 8.0 / 3.0 * module.conductance * (middle - 0.5 * (hot + cold))
    through = module.conductance * (hot - cold)
    to_side = OF_SIDE * joule + above
    return LegsHeat(to_side - through, OF_MIDDLE * joule - 2.0 * above, to_side + through)


def voltage(module: PeltierModule, current: Any, hot: Any, cold: Any) -> Any:
    """Return the terminal voltage, V = S (T_h - T_c) + I R [V]."""
    return module.seebeck * (hot - cold) + current * module.resistance


AROUND_CORNER = 2.0 * log(2.0) / pi
"""Length over the thickness by which a fin seems longer that is fed through one face: conformal mapping of a strip."""


def spreading_resistance(area: Any, fed_area: Any, fed_edge: Any, conductivity: Any, thickness: Any) -> Any:
    """Return the mean rise of the fed part over the whole plate, per heat flux that leaves its face evenly [m^2 K/W].

    The part beside the modules is a fin, fed along their edge and as wide as it has area for that edge's length: under
    an even flux q its mean lies q w^2/(3 k t) below its root (Incropera, ch. 3, a fin of efficiency tanh(mw)/(mw) where
    mw is small), and its root by the way around the corner, q w 2 ln 2/(pi k), below the fed face. `area` and
    `fed_area` in m^2, `fed_edge` [m] the length of the modules' outlines, `conductivity` [W/m K], `thickness` [m]. The
    fed face is taken to have one temperature.
    """
    beside = area - fed_area
    width = beside / fed_edge
    return beside / area * width / conductivity * (width / (3.0 * thickness) + AROUND_CORNER)


def row_spreading_resistance(
    area: Any,
    width: Any,
    count: Any,
    tile: tuple[Any, Any],
    sides: int,
    conductivity: Any,
    thickness: Any,
    offset: Any = 0.0,
) -> Any:
    """Return `spreading_resistance` of a plate that a row of rectangles feeds [m^2 K/W].

    Heat goes across the row first, out of each rectangle over its length, and then along the row, from both ends of the
    stretch beside each. `width` [m] is that of the plate across the row, `tile` length and width of a rectangle [m];
    `sides` is 2, or 1 where the row stands along the plate's edge; `offset` [m] is that of a row from the plate's
    middle, which makes the fin to one side wider. Of thin plates in two dimensions below 160 random arcs it is 0.75 to
    1.25, 0.95 in the mean, least where tiles crowd in the middle; along an edge 1.05 to 1.3.
    """
    length, depth = tile
    stretch, row = count * length * width, count * length
    across = spreading_resistance(stretch, row * depth, sides * row, conductivity, thickness)
    # Of fins s + e and s - e wide: the sums of their cubes and squares grow by 6 s e^2 and 2 e^2.
    unequal = sides / width * offset**2 / conductivity * ((width - depth) / sides / thickness + AROUND_CORNER)
    along = spreading_resistance(area, stretch, 2.0 * count * width, conductivity, thickness)
    return (across + unequal) * area / stretch + along
