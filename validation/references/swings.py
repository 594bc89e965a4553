"""Swings of a link: closed solutions, and the equations of motion stepped in time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

Values = Mapping[str, Any]


def with_a_dashpot(inputs: Values) -> Values:
    """I theta'' + b theta' + K theta = 0 from rest, by its two roots."""
    roots = np.roots([inputs["inertia"], inputs["damping"], inputs["springs"]]).astype(complex)
    time = np.array(inputs["time"], float)
    fast, slow = roots
    angle = inputs["start"] * (fast * np.exp(slow * time) - slow * np.exp(fast * time)) / (fast - slow)
    return {"angle": angle.real}


def with_maxwell_modes(inputs: Values) -> Values:
    """Step the link, the angle behind the structure and every dashpot by scipy (Radau)."""
    tau, k = (np.array(column, float) for column in zip(*inputs["modes"], strict=True))
    springs, behind, inertia = inputs["springs"], inputs["structure"], inputs["inertia"]

    def rates(_: float, state: Any) -> Any:
        angle, speed, inner = state[0], state[1], state[2:]
        layer = (behind * angle + np.sum(k * inner)) / (behind + np.sum(k))
        torque = -springs * angle - behind * (angle - layer)
        return np.concatenate([[speed, torque / inertia], (layer - inner) / tau])

    begin = np.concatenate([[inputs["start"], 0.0], np.full(len(k), inputs["start"])])
    results = solve_ivp(
        rates, (0.0, inputs["time"][-1]), begin, method="Radau", t_eval=inputs["time"], rtol=1e-9, atol=1e-12
    )
    return {"angle": results.y[0]}


def rubbed(inputs: Values) -> Values:
    """Amplitudes fall by 2 T_f/K each half swing until the springs no longer overcome the friction."""
    band, last, results = inputs["friction"] / inputs["springs"], float(inputs["start"]), []
    while last > band:
        last = abs(last - 2.0 * band)
        results.append(last)
    return {"amplitude": results[: inputs["count"]], "rest": last}
