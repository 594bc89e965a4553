"""Amplitude sweeps: storage and loss modulus over strain at one frequency, and the end of the linear range.

Strain takes the same share of both, `polymer.damping_function`, as the virtual rheometer has it; its limit is the
strain at which the storage modulus has fallen by `polymer.LINEAR_DROP`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tvimdesign.physics.polymers import polymer
from tvimdesign.simulation.measurement.fitting.fit import fitted
from tvimdesign.simulation.measurement.fitting.problem import Channel, Parameter, Problem, Values
from tvimdesign.simulation.measurement.kinds.measurement import Measurement, Settings, rows_of
from tvimdesign.simulation.measurement.kinds.polymer.melt_tests import temperature_of, title_of
from tvimdesign.simulation.measurement.reading.data_file import Array, Block
from tvimdesign.simulation.working_cycle.casadi_setup import ca

_SEEN = 0.9
"""Share of the linear modulus that must be left at the largest strain, or less, for the limit to be seen."""


def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit sweeps of one state of the polymer, together: one limit, moduli for each. Raises InputError."""
    parameters: list[Parameter] = []
    channels: list[Channel] = []
    left = 1.0
    temperatures, limits = [], []
    for i, block in enumerate(blocks, start=1):
        strain, storage, loss = _sweep(block)
        temperatures.append(temperature_of(block, settings))
        where = title_of(block, temperatures[-1])
        end = "" if len(blocks) == 1 else f"_{i}"
        first = max(len(strain) // 5, 1)
        for name, moduli in (("storage_modulus", storage), ("loss_modulus", loss)):
            start = float(np.median(moduli[:first]))
            words = name.replace("_", " ")
            parameters.append(Parameter(name + end, "Pa", f"Linear {words} of {where}", start))
            channels.append(
                Channel(f"{words} of {where}", "Pa", moduli, _predicted(name + end, strain), strain, "strain", "%",
                        relative=True, noise_of=name)
            )  # fmt: skip
        fallen = storage / np.median(storage[:first])
        left = min(left, float(np.min(fallen)))
        limits.append(_limit(strain, fallen))
    limit = Parameter("linear_strain", "%", "Strain at which 5 % of the storage modulus are gone", min(limits))
    found = fitted(Problem([limit, *parameters], channels), profiles=profiles)
    name, notes = _phase(temperatures, settings)
    if left > _SEEN:
        notes.append("No sweep leaves the linear range by a tenth: the limit is hardly seen; go to larger strains.")
    return Measurement(found, tuple(notes), {name: found["linear_strain"]} if name else {})


def _predicted(name: str, strain: Array) -> Callable[[Values], Any]:
    return lambda values: values[name] * polymer.damping_function(ca.DM(strain), values["linear_strain"])


def _sweep(block: Block) -> tuple[Array, Array, Array]:
    strain, storage, loss = rows_of(block, ["strain", "storage_modulus", "loss_modulus"])
    good = (strain > 0.0) & (storage > 0.0) & (loss > 0.0)
    order = np.argsort(strain[good], kind="stable")
    return strain[good][order], storage[good][order], loss[good][order]


def _limit(strain: Array, fallen: Array) -> float:
    """Return a start: by the first row that has lost a tenth, or the largest strain."""
    gone = np.flatnonzero(fallen < _SEEN)
    return float(0.7 * strain[gone[0]]) if len(gone) else float(strain[-1])


def _phase(temperatures: Sequence[float], settings: Settings) -> tuple[str, list[str]]:
    """Return the record's value that the limit is, by the phase at these temperatures."""
    if np.isnan(temperatures).any():
        return "", ["A file does not say its temperature: no record is written; --set temperature=... says it."]
    if min(temperatures) >= settings["melting_end"]:
        return "linear_strain_melt", []
    if max(temperatures) <= settings["melting_start"]:
        return "linear_strain_solid", []
    return "", ["Between the ends of melting, or of both phases: the limit is of neither phase alone, and no record's."]
