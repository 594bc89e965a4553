"""Equations that only tests need, to compare the product with."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from tvimdesign.base.record import Record
from tvimdesign.physics.heat_flow.peltier import PeltierModule
from tvimdesign.physics.motions import motion
from tvimdesign.physics.polymers import transitions


def half_time(temperature_kelvin: Any, kinetics: transitions.Kinetics) -> Any:
    """Time in which half of a melt freezes at a constant temperature [s]: (ln 2)^(1/n)/K (Avrami)."""
    return np.log(2.0) ** (1.0 / kinetics.avrami_exponent) / transitions.rate_constant(temperature_kelvin, kinetics)


def kinetics_of(record: Record) -> transitions.Kinetics:
    """Freezing of a polymer of the catalogue."""
    names = ("avrami_exponent", "crystallization_half_time", "crystallization_reference", "nucleation_constant",
             "equilibrium_melting_temperature", "glass_transition", "transport_energy")  # fmt: skip
    return transitions.Kinetics(*(record.value(name) for name in names), 0.5)


def dissipation(angle: Any, internal: Sequence[Any], joint: motion.Joint, modes: motion.Modes) -> Any:
    """Heat made in a layer's dashpots [W], sum k_m (phi - q_m)^2/tau_m; never negative."""
    phi = motion.layer_angle(angle, internal, joint, modes)
    return sum(k * (phi - inner) ** 2 / time for (time, k), inner in zip(modes, internal, strict=True))


def from_data_sheet(
    max_current: float, max_voltage: float, max_difference: float, hot_side_temperature: float
) -> PeltierModule:
    """Return a Peltier module's parameters from I_max, V_max, dT_max at the sheet's hot-side temperature [K].

    S = V_max/T_h, R = V_max (T_h - dT_max)/(I_max T_h), K = V_max I_max (T_h - dT_max)/(2 T_h dT_max).
    """
    cold = hot_side_temperature - max_difference
    return PeltierModule(
        seebeck=max_voltage / hot_side_temperature,
        resistance=max_voltage * cold / (max_current * hot_side_temperature),
        conductance=max_voltage * max_current * cold / (2.0 * hot_side_temperature * max_difference),
    )
