"""Amplitude sweeps: storage and loss modulus over strain at one frequency, and the end of the linear range.

G' = G'_0/(1 + d/(1 - d) (gamma/gamma_L)^m), d = `polymer.LINEAR_DROP`: the share d is gone at gamma_L, whatever the
power m, which the data tell; the product takes m = 2 (`polymer.damping_function`). Rows beyond the strain at which a
fifth of G' is gone are left out, for the tail has another law. G'' has a law of its own over the rows up to gamma_L:
its plateau, and a change by a power of its own.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.ndimage import median_filter

from tvimdesign.base.errors import InputError
from tvimdesign.physics.polymers.polymer import LINEAR_DROP
from tvimdesign.simulation.measurement.fitting.fit import fitted
from tvimdesign.simulation.measurement.fitting.problem import Channel, Parameter, Problem, Values
from tvimdesign.simulation.measurement.kinds.melt_tests import temperature_of, title_of
from tvimdesign.simulation.measurement.measurement import LEAST_ROWS, Measurement, Settings, endings, rows_of
from tvimdesign.simulation.measurement.reading.data_file import Array, Block
from tvimdesign.simulation.working_cycle.symbols import ca

_GONE = 0.2  # Share of the storage modulus that is gone at the last row used
_SMOOTHED = 3  # Rows of the median by which a single row does not end the linear range
_POWERS = (0.3, 8.0)


class Sweep(NamedTuple):
    """One sweep up to where a fifth of its storage modulus is gone."""

    temperature: float
    where: str
    end: str
    strain: Array
    storage: Array
    loss: Array
    linear: int  # Count of the rows up to the limit
    limit: float  # Strain at which `LINEAR_DROP` is gone, roughly
    left: float  # Share of the storage modulus that is left at the last row used
    beyond: int  # Rows left out
    share: float  # Step of the last digit of the moduli over them

    def parameters(self) -> list[Parameter]:
        """Return the plateaus, and the change of the loss modulus up to the limit with its power."""
        first = max(self.linear // 2, 1)
        return [
            *(
                Parameter(f"{name}_modulus{self.end}", "Pa", f"Linear {name} modulus of {self.where}",
                          float(np.median(moduli[:first])))
                for name, moduli in (("storage", self.storage), ("loss", self.loss))
            ),
            Parameter(f"loss_change{self.end}", "1", "Change of the loss modulus up to the limit", 0.0, positive=False,
                      scale=LINEAR_DROP, nuisance=True),
            Parameter(f"loss_power{self.end}", "1", "Power of the strain by which it changes", 2.0, least=_POWERS[0],
                      most=_POWERS[1], nuisance=True),
        ]  # fmt: skip

    def channels(self) -> list[Channel]:
        """Return both moduli over the strain."""
        strain, linear = self.strain, self.strain[: self.linear]

        def storage(values: Values) -> Any:
            risen = (ca.DM(strain) / values["linear_strain"]) ** values["drop_power"]
            return values[f"storage_modulus{self.end}"] / (1.0 + LINEAR_DROP / (1.0 - LINEAR_DROP) * risen)

        def loss(values: Values) -> Any:
            risen = (ca.DM(linear) / linear[-1]) ** values[f"loss_power{self.end}"]
            return values[f"loss_modulus{self.end}"] * np.exp(values[f"loss_change{self.end}"] * risen)

        return [
            Channel(f"{name} modulus of {self.where}", "Pa", moduli, predicted, at, "strain", "%", relative=True,
                    step=self.share, noise_of=f"{name}_modulus")
            for name, moduli, predicted, at in (
                ("storage", self.storage, storage, strain), ("loss", self.loss[: self.linear], loss, linear))
        ]  # fmt: skip


def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit sweeps of one state of the polymer, together: one limit, moduli for each. Raises InputError."""
    sweeps = [_sweep(block, settings, end) for block, end in zip(blocks, endings(blocks), strict=True)]
    limit = min(sweep.limit for sweep in sweeps)
    parameters = [
        Parameter("linear_strain", "%", "Strain at which 5 % of the storage modulus are gone", limit),
        Parameter("drop_power", "1", "Power of the strain by which it goes", 2.0, least=_POWERS[0], most=_POWERS[1]),
        *(parameter for sweep in sweeps for parameter in sweep.parameters()),
    ]
    fit = fitted(Problem(parameters, [channel for sweep in sweeps for channel in sweep.channels()]), profiles=profiles)
    name, notes = _phase([sweep.temperature for sweep in sweeps], settings)
    beyond = sum(sweep.beyond for sweep in sweeps)
    if beyond:
        notes.append(f"{beyond} rows beyond the strain at which a fifth of the storage modulus is gone are left out.")
    if min(sweep.left for sweep in sweeps) > 1.0 - LINEAR_DROP:
        notes.append(
            f"No sweep loses {100.0 * LINEAR_DROP:g} % of its storage modulus: the limit is hardly seen, and no "
            "record's; go to larger strains."
        )
        name = ""
    return Measurement(fit, tuple(notes), {name: fit["linear_strain"]} if name else {})


def _sweep(block: Block, settings: Settings, end: str) -> Sweep:
    """Return the rows of a table up to where a fifth is gone. Raises InputError where there are too few."""
    columns = rows_of(block, ["strain", "storage_modulus", "loss_modulus"])
    good = np.all([column > 0.0 for column in columns], axis=0)
    order = np.argsort(columns[0][good], kind="stable")
    strain, storage, loss = (column[good][order] for column in columns)
    if len(strain) < LEAST_ROWS:
        raise InputError(f"{block.place}: {len(strain)} rows have strain and both moduli above zero")
    left = median_filter(storage / np.median(storage[: max(len(strain) // 5, 1)]), _SMOOTHED, mode="nearest")
    last = max(_until(left, 1.0 - _GONE), LEAST_ROWS)
    linear = max(_until(left, 1.0 - LINEAR_DROP), LEAST_ROWS)
    limit = float(strain[min(linear, len(strain) - 1)])
    temperature = temperature_of(block, settings)
    return Sweep(temperature, title_of(block, temperature), end, strain[:last], storage[:last], loss[:last],
                 min(linear, last), limit, float(np.min(left[:last])), len(strain) - last,
                 block.share("storage_modulus", "loss_modulus"))  # fmt: skip


def _until(left: Array, share: float) -> int:
    """Return the count of rows before the first at which less than a share is left."""
    less = np.flatnonzero(left < share)
    return int(less[0]) if len(less) else len(left)


def _phase(temperatures: Sequence[float], settings: Settings) -> tuple[str, list[str]]:
    """Return the record's value that the limit is, by the phase at these temperatures."""
    if np.isnan(temperatures).any():
        return "", ["A file does not say its temperature: no record is written; --set temperature=... says it."]
    if min(temperatures) >= settings["melting_end"]:
        return "linear_strain_melt", []
    if max(temperatures) <= settings["melting_start"]:
        return "linear_strain_solid", []
    return "", ["Between the ends of melting, or of both phases: the limit is of neither phase alone, and no record's."]
