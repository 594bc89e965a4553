"""Whether a layer softens while it hardly warms any more: then a little less heat takes much longer."""

from __future__ import annotations

import math

import numpy as np

from tvimdesign.simulation.working_cycle.curves import Curves

STALLS = 3.5
"""Per cent of time for one per cent of the temperature's rise: 1 where a layer warms evenly, 2 as the root of time."""


def time_over_rise(softening: Curves, time: float) -> float:
    """Per cent of the softening time [s] that one per cent of the layer's rise takes; infinite where none is left."""
    times = np.asarray(softening["time"])
    cells = [column for name, column in softening.items() if name.startswith("cell_")]
    mean = np.mean(np.asarray(cells), axis=0)
    slope = float(np.interp(time, times, np.gradient(mean, times)))
    rise = float(np.interp(time, times, mean)) - mean[0]
    return rise / (time * slope) if slope > 0.0 else math.inf


def stalling_in_words(softening: Curves | None, time: float) -> str:
    """What to say of a layer that hardly warms any more when it is soft; empty where it does, or always or never is."""
    if not softening or not 0.0 < time < math.inf:
        return ""
    steep = time_over_rise(softening, time)
    if steep < STALLS:
        return ""
    if math.isinf(steep):
        return "it stalls: a little less heat and it is never soft"
    return f"it stalls: 1 % less heat takes {steep:.0f} % longer"
