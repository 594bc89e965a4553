"""Thermoelectric coolers: Ioffe's best coefficient of performance."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def best_performance(inputs: Mapping[str, Any]) -> Mapping[str, Any]:
    """T_c/dT (m - T_h/T_c)/(m + 1), m = sqrt(1 + Z T_mean) (Rowe, CRC Handbook of Thermoelectrics)."""
    figure = inputs["seebeck"] ** 2 / (inputs["resistance"] * inputs["conductance"])
    hot, results = inputs["hot"], []
    for difference in inputs["difference"]:
        cold = hot - difference
        m = np.sqrt(1.0 + figure * 0.5 * (hot + cold))
        results.append(cold / difference * (m - hot / cold) / (m + 1.0))
    return {"performance": results}
