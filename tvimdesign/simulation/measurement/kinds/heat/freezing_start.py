"""Where the fit of freezing kinetics starts: the best of a grid of half-times and nucleation constants."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.physics.polymers import crystallization
from tvimdesign.simulation.measurement.kinds.heat.calorimeter_runs import Run
from tvimdesign.simulation.measurement.kinds.measurement import Settings
from tvimdesign.simulation.measurement.reading.data_file import Array

_HALF_TIMES = np.geomspace(3.0, 3000.0, 13)  # s
_CONSTANTS = np.geomspace(3e4, 6e5, 11)  # K^2


def freezing_start(runs: Sequence[Run], settings: Settings) -> tuple[float, float]:
    """Half-time [s] and K_g [K^2] of least misfit, baseline and heat of each run being whatever suits it best.

    Raises InputError where a polymer would be glass at the reference temperature, and not freeze.
    """
    glass, reference = settings["glass_transition"], settings["reference_temperature"]
    if glass >= reference:
        raise InputError(
            f"glass_transition is {glass:.6g} K, reference_temperature {reference:.6g} K: a glass does not freeze; "
            "the first must be below the second"
        )
    best = (np.inf, 60.0, 1e5)
    for half_time in _HALF_TIMES:
        for constant in _CONSTANTS:
            kinetics = crystallization.Kinetics(
                settings.get("avrami_exponent", 3.0), half_time, settings["reference_temperature"], constant,
                settings["equilibrium_melting_temperature"], settings["glass_transition"],
                settings["transport_energy"], 0.5,
            )  # fmt: skip
            best = min(best, (sum(_misfit(run, kinetics) for run in runs), float(half_time), float(constant)))
    return best[1], best[2]


def _misfit(run: Run, kinetics: crystallization.Kinetics) -> float:
    """Squares left of a run's heat, over what they are about their mean."""
    constants = crystallization.rate_constant(run.temperature, kinetics)
    psi = np.concatenate([[0.0], np.cumsum(0.5 * (constants[1:] + constants[:-1]) * np.diff(run.time))])
    freezing: Array = np.gradient(crystallization.solid_fraction(psi, kinetics), run.time)
    table = np.column_stack([np.ones_like(freezing), run.time / run.time[-1], freezing])
    weights = np.linalg.lstsq(table, run.heat, rcond=None)[0]
    if weights[2] <= 0.0:
        table, weights = table[:, :2], np.linalg.lstsq(table[:, :2], run.heat, rcond=None)[0]
    return float(np.sum((run.heat - table @ weights) ** 2) / np.sum((run.heat - np.mean(run.heat)) ** 2))
