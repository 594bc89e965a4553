"""A layer in columns from the middle of a strip to its edge: how much colder or warmer than its mean each of them is.

The stack has one temperature at each depth, the mean over the strip's width. Over the width the layer settles within
seconds, so that its profile follows from what sheets and layer lose at the edge: fins below and above it (Incropera,
Fundamentals of Heat and Mass Transfer, ch. 3), and sines over its depth (Carslaw and Jaeger, ch. V).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tvimdesign.physics.heat_flow.lumps import gap_end_depth
from tvimdesign.physics.heat_flow.stack import Stack

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)
PLACES, SHARES = tuple(0.5 * (1.0 + _NODES)), tuple(0.5 * _WEIGHTS)
"""Columns, from the middle (0) to the edge (1) of the strip, and what of its width each stands for (Gauss)."""
SINES = 3


def way_through(stack: Stack, heights: Any) -> Any:
    """Share of the way of heat from the pads to the plate that lies before places of the layer [1].

    `heights` are the places' over its depth; contacts and a liner are parts of that way.
    """
    layer = stack.thickness / (0.5 * (stack.conductivity_solid + stack.conductivity_melt))
    before, behind = 1.0 / stack.hot_contact, 1.0 / stack.plate_contact
    if stack.liner is not None:
        behind = behind + stack.liner.whole * stack.area
    return (before + heights * layer) / (before + layer + behind)


def fed_evenly(place: float) -> float:
    """How far a place of a sheet that is heated evenly is below its mean temperature, over how far its edge is [1]."""
    return 0.5 * (3.0 * place**2 - 1.0)


def in_sheet(place: float, slenderness: Any) -> Any:
    """How far a place of a fin is below its mean temperature, over how far its edge is [1].

    The profile cosh(x p) over the place p from the middle (0) to the edge (1), x = w (h/k t)^(1/2) as in
    `lumps.way_in_fin`, nearly `fed_evenly` where that is small.
    """
    mean = np.sinh(slenderness) / slenderness
    return (np.cosh(slenderness * place) - mean) / (np.cosh(slenderness) - mean)


def at_end(place: float, heights: Any, width: Any, slot: Any) -> Any:
    """How far a layer is below its mean over the width for the heat that its end loses, times k/k_gap [1].

    Per excess of its near face at the end of a gap (`lumps.gap_end`), at the `heights` over its depth t and the width
    w/t. The end's flux is the sum of 2 sin(n pi y/t) over t, so that the layer is below what it would be by

        sum 2/(n pi) sin(n pi y/t) cosh(n pi p w/t)/sinh(n pi w/t),

    of which the mean over the width is 2/(n pi)^2 sin(n pi y/t) t/w. A slot takes its share as in `gap_end_depth`.
    """
    found = 0.0
    for n in range(1, SINES + 1):
        whole = n * np.pi * width
        falls = np.exp(-(1.0 - place) * whole) * (1.0 + np.exp(-2.0 * place * whole)) / (1.0 - np.exp(-2.0 * whole))
        found = found + 2.0 / (n * np.pi) * (falls - 1.0 / whole) * np.sin(n * np.pi * heights)
    return found * gap_end_depth(slot) / gap_end_depth(0.0)
