"""A screw's thread and head: torque by friction, part by part."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def by_parts(inputs: Mapping[str, Any]) -> Mapping[str, Any]:
    """Torque per force [m] of metric screws: thread of 60 degrees on its pitch diameter, and a head at 1.25 d.

    Shigley, 10th ed., eq. 8-26; pitch diameter d - 0.6495 p (ISO 724).
    """
    friction, flank = inputs["friction"], 1.0 / np.cos(np.radians(30.0))
    torques = []
    for text, pitch in zip(inputs["diameter"], inputs["pitch_mm"], strict=True):
        diameter = float(text.removesuffix(" mm"))
        at = diameter - 0.6495 * pitch
        slope = pitch / (np.pi * at)
        thread = 0.5 * at * (slope + friction * flank) / (1.0 - friction * slope * flank)
        torques.append(1e-3 * (thread + 0.625 * friction * diameter))
    return {"torque_per_force": torques}


def tolerance_units(inputs: Mapping[str, Any]) -> Mapping[str, Any]:
    """Standard tolerances [um] by ISO 286-1: units i = 0.45 D^(1/3) + 0.001 D at the range's geometric mean."""
    units = {5: 7, 6: 10, 7: 16, 8: 25, 9: 40}[inputs["grade"]]
    means = [(low * high) ** 0.5 for low, high in inputs["range"]]
    return {"tolerance": [units * (0.45 * mean ** (1.0 / 3.0) + 0.001 * mean) for mean in means]}
