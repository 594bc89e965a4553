"""Yield of a frozen polymer: a relaxation spectrum whose times all shorten with the stress.

Each Maxwell mode keeps its modulus; its time is multiplied by a(tau) = x/sinh(x) with x = tau/tau_0 of the whole stress
tau. Small stresses relax as in the linear spectrum. At a constant rate the stress rises to a plateau, the yield stress.
Sources: [E] Eyring, J. Chem. Phys. 4 (1936) 283; [T] Tervoort, Klompen and Govaert, J. Rheol. 40 (1996) 779.
"""

import math

import numpy as np
from numpy.typing import NDArray

from tvimdesign.physics.polymers.polymer import Modes
from tvimdesign.physics.polymers.viscoelasticity import zero_shear_viscosity

Array = NDArray[np.float64]

SHEET_RATE = 0.01
"""Shear rate [1/s] of the test that a yield strength comes from, in order of magnitude: a tensile bar in minutes."""
_LARGEST = 300.0
"""Largest stress over tau_0 that is looked at; sinh stays finite."""
_ERROR = 1e-7
"""Relative error of the integration."""


def yield_stress(rate: float, activation_stress: float, modes: Modes) -> float:
    """Return the stress of flow at a shear rate, tau_0 asinh(eta rate/tau_0) with eta = sum G tau [T].

    Parameters
    ----------
    rate : shear rate [1/s]
    activation_stress : tau_0 [Pa]
    modes : relaxation spectrum, (time [s], modulus [Pa])
    """
    viscosity = float(zero_shear_viscosity(modes))
    return activation_stress * math.asinh(viscosity * rate / activation_stress)


def activation_stress(strength: float, modes: Modes, rate: float = SHEET_RATE) -> float:
    """Return the tau_0 [Pa] with which the spectrum yields at a strength [Pa] at a shear rate [1/s].

    Raises ValueError where the spectrum flows at a lower stress than that without any yield.
    """
    from scipy.optimize import brentq

    viscosity = float(zero_shear_viscosity(modes))
    flow = viscosity * rate
    if flow <= strength:
        raise ValueError(f"the spectrum flows at {flow:.3g} Pa, below its yield strength of {strength:.3g} Pa")
    return float(brentq(lambda stress: yield_stress(rate, stress, modes) - strength, 1e-3 * strength, 1e6 * strength))


def stress_of_a_ramp(time: Array, strain: float, rise: float, modes: Modes, activation_stress: float) -> Array:
    """Return the stress [Pa] while and after a strain [1] is reached at a constant rate within `rise` [s].

    Parameters
    ----------
    time : instants [s], rising
    strain, rise : shear strain and the time in which it is reached
    modes : relaxation spectrum, (time [s], modulus [Pa])
    activation_stress : tau_0 [Pa]
    """
    from scipy.integrate import solve_ivp

    times, moduli = (np.array([float(value) for value in column]) for column in zip(*modes, strict=True))

    def rates(stresses: Array, rate: float) -> Array:
        x = min(abs(float(np.sum(stresses))) / activation_stress, _LARGEST)
        slowing = x / math.sinh(x) if x > 1e-6 else 1.0
        result: Array = moduli * rate - stresses / (times * slowing)
        return result

    stress, stresses = np.zeros(len(time)), np.zeros(len(times))
    for first, last, rate in ((0.0, rise, strain / rise), (rise, float(time[-1]), 0.0)):
        here = (time > first) & (time <= last)
        if last <= first:
            continue
        ends = np.append(time[here], last) if not np.any(time[here] == last) else time[here]
        solved = solve_ivp(
            lambda _, y, rate=rate: rates(y, rate), (first, last), stresses, "BDF", ends, rtol=_ERROR,
            atol=_ERROR * 1e-3 * activation_stress,
        )  # fmt: skip
        stress[here] = solved.y.sum(axis=0)[: np.count_nonzero(here)]
        stresses = solved.y[:, -1]
    return stress
