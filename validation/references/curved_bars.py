"""Bars and beams: curved ones by Winkler and Bach, wires straightened, waves between supports, legs by vectors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

Values = Mapping[str, Any]


def inner_fibre(inputs: Values) -> Values:
    """Stress at the inner fibre of a round curved bar over that of a straight one (Winkler and Bach).

    In diameters: neutral radius r_n = r^2/(2 (R - sqrt(R^2 - r^2))), sigma = M c_i/(A e r_i).
    """
    mean, radius = 0.5 * np.array(inputs["index"], float), 0.5
    neutral = radius**2 / (2.0 * (mean - np.sqrt(mean**2 - radius**2)))
    inner = mean - radius
    stress = (neutral - inner) / (np.pi * radius**2 * (mean - neutral) * inner)
    factor = stress * np.pi / 32.0
    return {"smi": factor, "en": factor}


def leg_by_vectors(inputs: Values) -> Values:
    """Turn of a straight leg that is tangent to its coil's circle and touches a pin, and its derivatives.

    The direction of the tangent from the pin to a circle, by vectors; derivatives by central differences of the
    fourth order. Lengths in millimetres.
    """
    pin, place, offset = (float(str(inputs[name]).removesuffix(" mm")) for name in
                          ("pin_radius", "placement_radius", "offset"))  # fmt: skip

    def direction(angle: float) -> float:
        to_pin = pin * np.array([np.cos(angle), np.sin(angle)]) - np.array([place, 0.0])
        distance = np.hypot(*to_pin)
        return float(np.arctan2(to_pin[1], to_pin[0]) % (2.0 * np.pi) + np.arcsin(offset / distance))

    angles, h = [float(angle) for angle in inputs["angle"]], 2e-3
    slopes, bends = [], []
    for angle in angles:
        far, near, mid, on, beyond = (direction(angle + i * h) for i in (-2, -1, 0, 1, 2))
        slopes.append((far - 8.0 * near + 8.0 * on - beyond) / (12.0 * h))
        bends.append((-far + 16.0 * near - 30.0 * mid + 16.0 * on - beyond) / (12.0 * h**2))
    return {"turned": [direction(angle) - direction(0.0) for angle in angles], "ratio": slopes, "curvature": bends}
