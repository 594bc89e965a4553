"""Friction by integrals: clamped rings, and the energy that friction takes in a cycle."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.integrate import quad

Values = Mapping[str, Any]


def clamped_disc(inputs: Values) -> Values:
    """Torque of an evenly pressed ring: integral of mu p r 2 pi r dr, lengths in mm."""
    outer = float(inputs["outer_radius"].removesuffix(" mm")) * 1e-3
    force = float(inputs["force"].removesuffix(" N"))
    torques = []
    for inner in (float(text.removesuffix(" mm")) * 1e-3 for text in inputs["inner_radius"]):
        pressure = force / (np.pi * (outer**2 - inner**2))
        torques.append(quad(lambda r, p=pressure: inputs["friction"] * p * 2.0 * np.pi * r**2, inner, outer)[0])
    return {"torque": torques}


def damping(inputs: Values) -> Values:
    """Energy that friction takes in a cycle over pi omega theta^2, summed over the cycle."""
    omega, amplitude, share = inputs["angular_frequency"], inputs["amplitude"], inputs["share"]
    phase = np.linspace(0.0, 2.0 * np.pi, 400_001)
    way = np.abs(amplitude * np.cos(phase))

    def lost(torque: Any) -> float:
        return float(np.trapezoid(torque * way, phase)) / (np.pi * omega * amplitude**2)

    loads = [
        inputs["stiffness"] * amplitude * np.abs(np.sin(phase) + tangent * np.cos(phase))
        for tangent in inputs["loss_factor"]
    ]
    return {"constant": lost(inputs["torque"]), "with_the_load": [lost(share * load) for load in loads]}
