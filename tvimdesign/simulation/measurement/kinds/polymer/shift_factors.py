"""Shift factors of several temperatures against Arrhenius' law: the energy, and whether the law describes them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from tvimdesign.physics.polymers.polymer import GAS_CONSTANT, ZERO_CELSIUS
from tvimdesign.simulation.measurement.fitting.fit import Estimate

_FAR = 0.15
"""Shift factors may miss the law by this share of themselves and it is still of use; more, and it is not."""


class Activation(NamedTuple):
    """Arrhenius' law through shift factors."""

    energy: float
    """[J/mol]"""
    farthest: float
    """Largest share by which a factor misses the law, where that is more than its own interval."""

    @property
    def describes(self) -> bool:
        """Whether the law may stand for the factors."""
        return self.energy > 0.0 and self.farthest < _FAR


def arrhenius(shifts: Mapping[float, Estimate], reference: float) -> Activation:
    """Energy by least squares of ln a_T over 1/T - 1/T_ref, through zero, weighted by the intervals."""
    inverse = np.array([1.0 / one - 1.0 / reference for one in shifts])
    logs = np.array([np.log(one.value) for one in shifts.values()])
    halves = np.array([_half(one) for one in shifts.values()])
    weights = 1.0 / np.maximum(halves, 1e-6) ** 2
    energy = GAS_CONSTANT * float(np.sum(weights * inverse * logs) / np.sum(weights * inverse**2))
    missed = np.maximum(np.abs(logs - energy / GAS_CONSTANT * inverse) - halves, 0.0)
    return Activation(energy, float(np.expm1(np.max(missed))))


def _half(one: Estimate) -> float:
    """Half the interval of a factor's logarithm."""
    return 1.0 if one.low is None or one.high is None else 0.5 * float(np.log(one.high / one.low))


def shift_note(found: Activation, shifts: Mapping[float, Estimate], reference: float) -> list[str]:
    """The factors in a line, and whether the law describes them."""
    table = ", ".join(f"{one - ZERO_CELSIUS:.0f} degC: {shift.value:.3g}" for one, shift in shifts.items())
    law = (
        f"Arrhenius' law with {found.energy / 1e3:.1f} kJ/mol describes them."
        if found.describes
        else f"Arrhenius' law misses one by {100.0 * found.farthest:.0f} %: no activation energy is given, and the "
        "shift of the record this is based on is not that of these data."
    )
    return [f"Shift factors to {reference - ZERO_CELSIUS:.0f} degC: {table}. {law}"]
