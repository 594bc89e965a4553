"""The shift of a melt's rates with temperature: a factor for each temperature, and Arrhenius' law through them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.physics.polymers import polymer
from tvimdesign.physics.polymers.polymer import GAS_CONSTANT, ZERO_CELSIUS
from tvimdesign.simulation.measurement.fitting.fit import Estimate

USUAL_ENERGY = 40e3
"""J/mol, to start from: in the middle of what polymers' melts have."""
_FAR = 0.15
"""Shift factors may miss Arrhenius' law by this share of themselves and it is still of use; more, and it is not."""


def temperature_known(names: Sequence[str], temperatures: Sequence[float]) -> bool:
    """Return whether the temperatures of tests are known. Raises InputError where those of some are."""
    unknown = np.isnan(temperatures)
    if np.any(unknown) and not np.all(unknown):
        name = names[int(np.argmax(unknown))]
        raise InputError(f"{name}: the file does not say its temperature, as others do; --set temperature=...")
    return not np.any(unknown)


def shift_name(temperature: float) -> str:
    """Return the name of a temperature's factor."""
    return f"shift_{temperature - ZERO_CELSIUS:.0f}".replace("-", "minus_")


def guessed_shift(temperature: Any, reference: float) -> Any:
    """Return the shift factor to start from."""
    return 1.0 if np.isnan(reference) else polymer.arrhenius_shift(temperature, reference, USUAL_ENERGY)


class Activation(NamedTuple):
    """Arrhenius' law through shift factors."""

    energy: float
    """[J/mol]"""
    farthest: float
    """Largest share by which a factor misses the law, where that is more than its own interval."""

    @property
    def describes(self) -> bool:
        """True where the law describes the factors."""
        return self.energy > 0.0 and self.farthest < _FAR


def arrhenius(shifts: Mapping[float, Estimate], reference: float) -> Activation:
    """Return the energy by least squares of ln a_T over 1/T - 1/T_ref, through zero, weighted by the intervals."""
    inverse = np.array([1.0 / shift - 1.0 / reference for shift in shifts])
    logs = np.array([np.log(shift.value) for shift in shifts.values()])
    halves = np.array([_half(shift) for shift in shifts.values()])
    weights = 1.0 / np.maximum(halves, 1e-6) ** 2
    energy = GAS_CONSTANT * float(np.sum(weights * inverse * logs) / np.sum(weights * inverse**2))
    missed = np.maximum(np.abs(logs - energy / GAS_CONSTANT * inverse) - halves, 0.0)
    return Activation(energy, float(np.expm1(np.max(missed))))


def _half(estimate: Estimate) -> float:
    """Return half the interval of a factor's logarithm."""
    return 1.0 if estimate.low is None or estimate.high is None else 0.5 * float(np.log(estimate.high / estimate.low))


def shift_note(activation: Activation, shifts: Mapping[float, Estimate], reference: float) -> list[str]:
    """Return the factors in a line, and whether the law describes them."""
    table = ", ".join(
        f"{temperature - ZERO_CELSIUS:.0f} degC: {shift.value:.3g}" for temperature, shift in shifts.items()
    )
    law = (
        "Arrhenius' law describes them."
        if activation.describes
        else f"Arrhenius' law misses one by {100.0 * activation.farthest:.0f} %: no activation energy is given, and "
        "the shift of the record this is based on is not that of these data."
    )
    return [f"Shift factors to {reference - ZERO_CELSIUS:.0f} degC: {table}. {law}"]
