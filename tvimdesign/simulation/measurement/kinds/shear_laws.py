"""Sheared melts and solids with a law of their own: amplitude sweeps and flow curves.

Amplitude sweeps: storage and loss modulus over strain at one frequency, and the end of the linear range.

G' = G'_0/(1 + d/(1 - d) (gamma/gamma_L)^m), d = `polymer.LINEAR_DROP`: the share d is gone at gamma_L, whatever the
power m, which the data tell; the product takes m = 2 (`polymer.damping_function`). Rows beyond the strain at which a
fifth of G' is gone are left out, for the tail has another law. G'' has a law of its own over the rows up to gamma_L:
its plateau, and a change by a power of its own.

Flow curves: steady viscosity over shear rate, and its plateau at low rates.

eta = eta_0 a_T (1 + (lambda a_T rate)^a)^((n - 1)/a): the law of Carreau and Yasuda [BAH], a = 2 Carreau's own. A melt
that does not thin has eta_0 alone. Parameters are added while Schwarz's criterion falls as for a spectrum's modes. Each
temperature but the reference has a shift a_T, by Arrhenius' law where there are several. Source: [BAH] Bird, Armstrong
and Hassager, Dynamics of Polymeric Liquids 1, 2nd ed., eq. 4.1-9 and table 4.5-1.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.ndimage import median_filter

from tvimdesign.base.errors import InputError
from tvimdesign.physics.polymers import polymer
from tvimdesign.physics.polymers.polymer import LINEAR_DROP, ZERO_CELSIUS
from tvimdesign.simulation.measurement.fitting.fit import fitted, simplest_fit, with_intervals
from tvimdesign.simulation.measurement.fitting.problem import Channel, Parameter, Problem, Values
from tvimdesign.simulation.measurement.kinds.melt_spectrum import USUAL_ENERGY, temperature_known
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


def amplitude_sweep(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
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


_CARREAU = 2.0
_TOGETHER = 1.0  # Curves within so many kelvin are of one temperature
_SEEN = 0.9  # Share of the plateau that a row must reach for the plateau not to be extrapolated
_LAWS = ("no thinning", "Carreau's law", "the law of Carreau and Yasuda")


class _Curves:
    """Flow curves of one melt, each at a temperature of its own."""

    def __init__(self, blocks: Sequence[Block], settings: Settings) -> None:
        self.temperatures = [temperature_of(block, settings) for block in blocks]
        self.where = [title_of(block, at) for block, at in zip(blocks, self.temperatures, strict=True)]
        self.rates, self.viscosities, self.shares = zip(*map(_curve, blocks), strict=True)
        temperature_known(self.where, self.temperatures)
        middle = sorted(self.temperatures)[len(self.temperatures) // 2]
        self.reference = settings.get("reference_temperature", middle)
        self.energy = settings.get("flow_activation_energy")
        self.several = bool(np.ptp(self.temperatures) > _TOGETHER) if len(blocks) > 1 else False

    def shift(self, temperature: float, values: Values) -> Any:
        """Return the factor a_T of a curve."""
        if np.isnan(temperature) or abs(temperature - self.reference) < _TOGETHER:
            return 1.0
        energy = values.get("flow_activation_energy", self.energy)
        if energy is None:
            raise InputError(
                f"reference_temperature is not the {temperature - ZERO_CELSIUS:.0f} degC of the curve: "
                "--set flow_activation_energy=... shifts it, or leave the reference out"
            )
        return polymer.arrhenius_shift(temperature, self.reference, energy)

    def problem(self, law: int) -> Problem:
        """Return the problem of a law of `_LAWS`."""
        most, rates = max(float(np.max(eta)) for eta in self.viscosities), np.concatenate(self.rates)
        thinned = min(float(np.min(eta)) for eta in self.viscosities) / most
        parameters = [Parameter("zero_shear_viscosity", "Pa*s", "Viscosity of slow flow", most)]
        if law:
            middle = float(1.0 / np.sqrt(rates.min() * rates.max()))
            parameters += [
                Parameter("thinning_time", "s", "One over the rate from which on it thins", middle),
                Parameter("thinning_power", "1", "Power n: viscosity goes with the rate to n - 1",
                          float(np.clip(thinned, 0.3, 0.7)), positive=False, least=-0.5, most=1.0),
            ]  # fmt: skip
        if law > 1:
            parameters.append(Parameter("corner", "1", "Yasuda's a: sharpness of the bend", 1.0, least=0.1, most=10.0))
        if self.several and self.energy is None:
            parameters.append(
                Parameter("flow_activation_energy", "kJ/mol", "Of the shift with temperature", USUAL_ENERGY)
            )
        return Problem(parameters, [self._channel(i) for i in range(len(self.rates))])

    def _channel(self, i: int) -> Channel:
        rate = ca.DM(self.rates[i])

        def predicted(values: Values) -> Any:
            shift = self.shift(self.temperatures[i], values)
            return shift * carreau(rate * shift, values)

        return Channel(f"viscosity of {self.where[i]}", "Pa*s", self.viscosities[i], predicted, self.rates[i],
                       "shear rate", "1/s", relative=True, step=self.shares[i], noise_of="viscosity")  # fmt: skip


def carreau(rate: Any, values: Values) -> Any:
    """Return the viscosity [Pa s] at shear rates [1/s]."""
    if "thinning_time" not in values:
        return values["zero_shear_viscosity"] * (1.0 + 0.0 * rate)
    corner = values.get("corner", _CARREAU)
    bend = 1.0 + (values["thinning_time"] * rate) ** corner
    return values["zero_shear_viscosity"] * bend ** ((values["thinning_power"] - 1.0) / corner)


def flow_curve(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit flow curves of one melt, together. Raises InputError for what lacks."""
    curves = _Curves(blocks, settings)
    first, *others = map(curves.problem, range(len(_LAWS)))
    law, best = simplest_fit([first, *(each for each in others if each.count > len(each.parameters) + 1)])
    fit = with_intervals(best, profiles=profiles)
    zero = fit["zero_shear_viscosity"]
    notes = [f"{_LAWS[law][0].upper()}{_LAWS[law][1:]}: one parameter more would not better the fit by what it costs."]
    seen = max(
        float(np.max(eta)) / (zero.value * float(curves.shift(at, {e.name: e.value for e in fit.parameters})))
        for at, eta in zip(curves.temperatures, curves.viscosities, strict=True)
    )
    if seen < _SEEN:
        notes.append(
            f"The slowest row has {100.0 * seen:.0f} % of the plateau: zero_shear_viscosity is extrapolated, and no "
            "record is written. Measure at lower rates."
        )
        return Measurement(fit, tuple(notes))
    if np.isnan(curves.temperatures).any():
        notes.append("The file does not say its temperature: no record is written; --set temperature=... says it.")
        return Measurement(fit, tuple(notes))
    if not fit.misfit:
        notes.append("The record has the viscosity; its plateau modulus stays that of the record it is based on.")
    values = {"zero_shear_viscosity": zero}
    values |= {e.name: e for e in fit.parameters if e.name == "flow_activation_energy"}
    return Measurement(fit, tuple(notes), values, {}, {"melt_reference_temperature": (curves.reference, "degC")})


def _curve(block: Block) -> tuple[Array, Array, float]:
    """Return rising shear rates [1/s], viscosities [Pa s] and their step. Raises InputError for too few above zero."""
    which = "viscosity" if block.complete(["viscosity"]) else "stress"
    rate, other = (np.abs(column) for column in rows_of(block, ["shear_rate", which]))
    good = (rate > 0.0) & (other > 0.0)
    rate, other = rate[good], other[good]
    if len(rate) == 0:
        raise InputError(f"{block.place}: no row has a shear rate and a {which} that are not zero")
    order = np.argsort(rate, kind="stable")
    return rate[order], (other if which == "viscosity" else other / rate)[order], block.share(which)
