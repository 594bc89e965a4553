"""A layer in columns from a strip's middle to its edge, and a block in rows: how far each is from its mean temperature.

The stack has one temperature at each depth, the mean over the strip's width. Over the width the layer settles within
seconds, so that its profile follows from what sheets and layer lose at the edge: fins below and above it (Incropera,
Fundamentals of Heat and Mass Transfer, ch. 3), and sines over its depth (Carslaw and Jaeger, ch. V).

A block's rows go from its lower face to its upper one. Both faces lose heat to what is below and above; the block's two
ends, at the pads and at the vane, are each of one temperature. By separation of variables (Carslaw and Jaeger,
Conduction of Heat in Solids, ch. V)."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.heat_flow.layer_end import cooled_end, fallen
from tvimdesign.physics.heat_flow.shape_factors import gap_end_depth
from tvimdesign.physics.heat_flow.stack import Stack

SINES = 3


class Columns(NamedTuple):
    """Columns of a strip: where they stand, and what of its width each stands for."""

    places: tuple[float, ...]  # From the middle (0) to the edge (1)
    shares: tuple[float, ...]


def _by_root(count: int, power: float) -> Columns:
    """Return a number of Gauss's nodes in a root of the way from the edge."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    root = 0.5 * (1.0 - nodes)
    return Columns(tuple(1.0 - root**power), tuple(0.5 * power * weights * root ** (power - 1.0)))


EVEN, DENSE = _by_root(4, 1.0), _by_root(8, 2.0)
"""For a layer whose end closes a gap; for one that a wall cools, whose profile is steep there: with sixteen, times of
softening in milled modules change by 1 %, with four by up to 5 %."""


def way_through(stack: Stack, heights: Any) -> Any:
    """Return the share of the way of heat from the pads to the plate that lies before places of the layer [1].

    `heights` are the places' over its depth; contacts and a liner are parts of that way.
    """
    layer = stack.thickness / (0.5 * (stack.conductivity_solid + stack.conductivity_melt))
    before, behind = 1.0 / stack.hot_contact, 1.0 / stack.plate_contact
    if stack.liner is not None:
        behind = behind + stack.liner.whole * stack.area
    return (before + heights * layer) / (before + layer + behind)


def fed_evenly(place: Any) -> Any:
    """Return how far a place of a sheet that is heated evenly is below its mean temperature, over how far its edge is
    [1]."""
    return 0.5 * (3.0 * place**2 - 1.0)


def in_sheet(place: Any, slenderness: Any) -> Any:
    """Return how far a place of a fin is below its mean temperature, over how far its edge is [1].

    The profile cosh(x p) over the place p from the middle (0) to the edge (1), x = w (h/k t)^(1/2) as in
    `shape_factors.way_in_fin`, nearly `fed_evenly` where that is small.
    """
    mean = np.sinh(slenderness) / slenderness
    return (np.cosh(slenderness * place) - mean) / (np.cosh(slenderness) - mean)


def at_end(place: Any, heights: Any, width: Any, slot: Any) -> Any:
    """Return how far a layer is below its mean over the width for the heat that its end loses, times k/k_gap [1].

    Per excess of its near face at the end of a gap (`gap_end`), at the `heights` over its depth t and the width
    w/t. The end's flux is the sum of 2 sin(n pi y/t) over t, so that the layer is below what it would be by

        sum 2/(n pi) sin(n pi y/t) cosh(n pi p w/t)/sinh(n pi w/t),

    whose mean over the width is 2/(n pi)^2 sin(n pi y/t) t/w. A slot takes its share as in `gap_end_depth`.
    """
    total = 0.0
    for n in range(1, SINES + 1):
        whole = n * np.pi * width
        falls = np.exp(-(1.0 - place) * whole) * (1.0 + np.exp(-2.0 * place * whole)) / (1.0 - np.exp(-2.0 * whole))
        total = total + 2.0 / (n * np.pi) * (falls - 1.0 / whole) * np.sin(n * np.pi * heights)
    return total * gap_end_depth(slot) / gap_end_depth(0.0)


class EndPlaces(NamedTuple):
    """Positions of a layer's slices, seen from its end, and the kind of that end."""

    of_all: tuple[Any, ...]  # Numbers of the end
    of_columns: list[Any]  # A number of each column
    of_slices: Any  # An array, a number of each slice of a column


def gap_places(heights: Any, width: Any, slot: Any) -> EndPlaces:
    """Return the places of slices at the `heights` over the layer's depth at the end of a gap, for `at_end`."""
    return EndPlaces((width, slot), list(EVEN.places), heights)


def gap_profile(places: EndPlaces) -> tuple[list[Any], ...]:
    """Return what the gap does to each column: `at_end` there."""
    return ([at_end(place, places.of_slices, *places.of_all) for place in places.of_columns],)


def wall_places(heights: Any, width: Any, contact: Any, layer: Any, free: Any) -> EndPlaces:
    """Return the beside a wall that leaves the share `free` of the layer's height open: away from it, and above the
    pads.

    The slices are at the `heights` over the layer's depth t, its width is w/t. Lengths are over the thickness from pads
    to plate: contacts are as much more layer at its faces and its end, here each a share `contact` of the whole, and so
    is a sheet on it: `layer` is its own share.
    """
    away = [contact + layer * (1.0 - place) * width for place in DENSE.places]
    return EndPlaces((free,), away, contact + layer * heights)


def wall_profile(places: EndPlaces) -> tuple[list[Any], ...]:
    """Return what the wall and the gap below it do to each column: `walled_end.fallen` and `walled_end.cooled_end`
    there."""
    (free,), above = places.of_all, places.of_slices
    return (
        [fallen(free, away, above) for away in places.of_columns],
        [cooled_end(free, away, above) for away in places.of_columns],
    )


def beside_wall(lost: Sequence[Any]) -> list[Any]:
    """Return how warm a layer is in each column over its mean over the width, both above the wall at its end [1].

    By what of an even fall from face to face each column has `lost` (`walled_end.fallen`). Any other profile is taken
    to fall towards the wall by the same share at each height.
    """
    left = [1.0 - share for share in lost]
    mean = _mean(left)
    return [share / mean for share in left]


def below_wall(cooled: Sequence[Any]) -> list[Any]:
    """Return how far a layer is below its mean over the width for heat that leaves its end below that wall, in each
    column.

    Times k, over what of that heat the near face gives: by how far each column is `cooled` (`walled_end.cooled_end`).
    """
    mean = _mean(cooled)
    return [drop - mean for drop in cooled]


def _mean(values: Sequence[Any]) -> Any:
    """Return the mean over the width of what dense columns have."""
    return sum(share * value for share, value in zip(DENSE.shares, values, strict=True))


ROW_TERMS = 6


def row_below_mean(place: float, depths: Any, slenderness: Any, lost: Sequence[Any]) -> Any:
    """Return how far a row of a block is below the mean of its height there, over half its height and conductivity
    [W/m^2].

    `place` goes from -1 at the lower face to 1 at the upper one, `depths` from 0 to 1 from end to end, D over half the
    height is the `slenderness`. What both faces lose is cosines over the height, what one of them loses more is sines:

        q (2 (-1)^n/(n pi)^2 cos(n pi p)),  dq (4 (-1)^n/((2 n + 1) pi)^2 sin((n + 1/2) pi p)),

    each less by cosh(a (x - D/2))/cosh(a D/2) next to the ends, a its wave number.
    """
    both, more = 0.5 * (lost[0] + lost[1]), lost[1] - lost[0]
    total = 0.0
    for n in range(ROW_TERMS):
        even, odd = (n + 1.0) * np.pi, (n + 0.5) * np.pi
        total = total - both * 2.0 * (-1.0) ** n / even**2 * np.cos(even * place) * _share_inside(
            even * slenderness, depths
        )
        total = total + more * (-1.0) ** n / odd**2 * np.sin(odd * place) * _share_inside(odd * slenderness, depths)
    return total


def _share_inside(waves: Any, depths: Any) -> Any:
    """Return the share [1] of what is far from both ends."""
    near = np.exp(-waves * depths) + np.exp(-waves * (1.0 - depths))
    return 1.0 - near / (1.0 + np.exp(-waves))
