"""A spreader in its own plane: an arc with its rectangles, finite volumes in polar cells.

The plate is thin and gives off heat evenly; rectangles hold their part of it at one temperature.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

ACROSS = 80
"""Cells along the radius; around the axis as many as make them square at the mean radius."""


def mean_rise(v: Mapping[str, Any], tile_pitch: float, tile_radius: float) -> float:
    """Return the mean rise over the rectangles, times conductance k t of the plate and over flux [m^2].

    `tile_pitch` [rad] is that of the arc's rectangles about the axis, `tile_radius` [m] that of their middles.
    """
    inner, outer, half = v["pcl_inner_radius"], v["pcl_outer_radius"], 0.5 * v["arc_span"]
    around = round(ACROSS * half * (inner + outer) / (outer - inner))
    dr, dp = (outer - inner) / ACROSS, 2.0 * half / around
    r, p = inner + (np.arange(ACROSS) + 0.5) * dr, -half + (np.arange(around) + 0.5) * dp
    rr, pp = np.meshgrid(r, p, indexing="ij")
    fed = np.zeros(rr.shape, dtype=bool)
    for tile in range(round(v["tiles_per_arc"])):
        turned = pp - tile_pitch * (tile - 0.5 * (v["tiles_per_arc"] - 1.0))
        deep, long = np.abs(rr * np.cos(turned) - tile_radius), np.abs(rr * np.sin(turned))
        fed |= (deep < 0.5 * v["heater_width"]) & (long < 0.5 * v["heater_length"])
    number, area = np.arange(rr.size).reshape(rr.shape), (rr * dr * dp).ravel()
    outwards = np.broadcast_to((0.5 * (r[:-1] + r[1:]) * dp / dr)[:, None], (ACROSS - 1, around))
    sideways = np.broadcast_to((dr / (r * dp))[:, None], (ACROSS, around - 1))
    here = np.concatenate([number[:-1].ravel(), number[:, :-1].ravel()])
    there = np.concatenate([number[1:].ravel(), number[:, 1:].ravel()])
    link = np.concatenate([outwards.ravel(), sideways.ravel()])
    places = (np.concatenate([here, there, here, there]), np.concatenate([here, there, there, here]))
    matrix = coo_matrix((np.concatenate([link, link, -link, -link]), places)).tocsr()
    beside, rise = ~fed.ravel(), np.zeros(rr.size)
    rise[beside] = spsolve(matrix[beside][:, beside].tocsc(), area[beside])
    return float(rise @ area / np.sum(area))
