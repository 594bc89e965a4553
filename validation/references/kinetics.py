"""Avrami, Ozawa and Hoffman and Lauritzen, written from the handbook."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.integrate import quad

Values = Mapping[str, Any]


def _slowness(kelvin: float, kinetics: Values) -> float:
    """Logarithm of the half-time but for a constant: U 1500 cal/mol, T_inf 30 K below -60 degC."""
    melting = kinetics["equilibrium_melting"]
    nucleation = kinetics["nucleation_constant"] * (kelvin + melting) / (2.0 * kelvin**2 * (melting - kelvin))
    return float(1500.0 * 4.18 / (8.314462618 * (kelvin - 183.15)) + nucleation)


def avrami(inputs: Values) -> Values:
    """X = 1 - exp(-ln 2 (t/t_half)^n) at the reference temperature (Avrami, J. Chem. Phys. 8 (1940) 212)."""
    kinetics = inputs["instead"]
    share = np.array(inputs["time"], float) / kinetics["reference_half_time"]
    return {"fraction": 1.0 - np.exp(-np.log(2.0) * share ** kinetics["avrami_exponent"])}


def ozawa(inputs: Values) -> Values:
    """Solid fraction on cooling, 1 - exp(-(integral of K dT/rate)^n) (Ozawa, Polymer 12 (1971) 150), by quadrature."""
    kinetics, rate = inputs["instead"], inputs["rate"] / 60.0
    n, reference = kinetics["avrami_exponent"], kinetics["reference"]

    def constant(kelvin: float) -> float:
        at_reference = np.log(2.0) ** (1.0 / n) / kinetics["reference_half_time"]
        return float(at_reference * np.exp(_slowness(reference, kinetics) - _slowness(kelvin, kinetics)))

    results = []
    for celsius in inputs["celsius"]:
        psi, _ = quad(constant, 273.15 + celsius, 273.15 + 50.0, epsabs=1e-12, limit=200)
        results.append(1.0 - np.exp(-((psi / rate) ** n)))
    return {"fraction": results}
