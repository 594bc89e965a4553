"""Frequency sweeps of a melt: the relaxation spectrum with as few modes as the data bear, and its shift.

Modes (tau_i, G_i) are free in time and modulus; G', G'' follow by `polymer.maxwell_moduli`; each temperature but the
reference shifts its frequencies by a factor a_T of its own, and by Arrhenius' law where that describes them all. How
many modes: as long as one more betters Schwarz's criterion [Sch]. Sources: [BW] Baumgaertel and Winter, Rheol. Acta 28
(1989) 511 (free times and moduli, as few modes as the data bear); [Sch] Schwarz, Ann. Statist. 6 (1978) 461.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.physics.polymers import polymer
from tvimdesign.simulation.measurement.fitting.fit import Fit, fitted
from tvimdesign.simulation.measurement.fitting.problem import Channel, Derived, Parameter, Problem, Values
from tvimdesign.simulation.measurement.kinds.measurement import Measurement, RecordTableFound, Settings, rows_of
from tvimdesign.simulation.measurement.kinds.shift_factors import arrhenius, shift_note
from tvimdesign.simulation.measurement.reading.data_file import Array, Block

_TOGETHER = 1.0
"""Sweeps within so many kelvin are of one temperature."""
_SPLIT = 0.02
"""A mode that stands for two in a record is split this share above and below its time: no test could tell."""
_BETTER = 6.0
"""By how much Schwarz's criterion has to fall for one mode more: strong evidence (Kass and Raftery, 1995)."""


class Sweep(NamedTuple):
    """One sweep: temperature [K], angular frequencies [rad/s], moduli [Pa]."""

    name: str
    temperature: float
    frequency: Array
    storage: Array
    loss: Array


def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit sweeps at one temperature or several. Raises InputError for what lacks."""
    sweeps = [_sweep(block, settings) for block in blocks]
    least = settings.get("least_temperature", 0.0)
    kept = [sweep for sweep in sweeps if sweep.temperature >= least]
    if not kept:
        raise InputError("--set least_temperature leaves no sweep")
    temperatures = _temperatures(kept)
    reference = _reference(temperatures, settings)
    most = round(settings["largest_modes"])
    chosen = _fewest_modes(kept, temperatures, reference, most)
    best = fitted(_problem(kept, temperatures, reference, chosen), profiles=False)
    shifts = {one: best[_shift(one)] for one in temperatures if one != reference}
    activation = arrhenius(shifts, reference) if shifts else None
    if activation is not None and activation.describes:
        best = fitted(_problem(kept, temperatures, reference, chosen, activation.energy), profiles=profiles)
    elif profiles:
        best = fitted(_problem(kept, temperatures, reference, chosen))
    notes = _notes(sweeps, kept, reference, chosen, most)
    notes += shift_note(activation, shifts, reference) if activation else []
    return _measurement(best, chosen, reference, most, notes)


def _sweep(block: Block, settings: Settings) -> Sweep:
    which = "angular_frequency" if "angular_frequency" in block.columns else "frequency"
    frequency, storage, loss = rows_of(block, [which, "storage_modulus", "loss_modulus"])
    good = (frequency > 0.0) & (storage > 0.0) & (loss > 0.0)
    omega = frequency * (1.0 if which == "angular_frequency" else 2.0 * np.pi)
    if "temperature" in block.columns:
        temperature = float(np.nanmean(block.values("temperature")))
    else:
        said = block.number("temperature")
        temperature = settings.get("temperature", said if said is not None else -1.0)
    if temperature < 0.0:
        raise InputError(f"{block.file}:{block.lines[0]}: the file does not say its temperature; --set temperature=...")
    return Sweep(block.title or block.file, temperature, omega[good], storage[good], loss[good])


def _temperatures(sweeps: Sequence[Sweep]) -> list[float]:
    """The temperatures [K], those within a kelvin as one."""
    found: list[float] = []
    for one in sorted(sweep.temperature for sweep in sweeps):
        if not found or one - found[-1] > _TOGETHER:
            found.append(one)
    return found


def _nearest(temperature: float, temperatures: Sequence[float]) -> float:
    return min(temperatures, key=lambda one: abs(one - temperature))


def _reference(temperatures: Sequence[float], settings: Settings) -> float:
    middle = temperatures[len(temperatures) // 2]
    return _nearest(settings.get("reference_temperature", middle), temperatures)


def _shift(temperature: float) -> str:
    return f"shift_{temperature - polymer.ZERO_CELSIUS:.0f}".replace("-", "minus_")


def _fewest_modes(sweeps: Sequence[Sweep], temperatures: Sequence[float], reference: float, most: int) -> int:
    """Modes up to which one more betters Schwarz's criterion, from one to `most`."""
    values = 2 * sum(len(sweep.frequency) for sweep in sweeps)
    chosen, last = 1, np.inf
    for count in range(1, most + 1):
        free = 2 * count + len(temperatures) - 1
        if free >= values:
            break
        found = fitted(_problem(sweeps, temperatures, reference, count), profiles=False)
        misfit = sum(
            float(np.sum(np.log(channel.measured / predicted) ** 2))
            for channel, predicted in zip(found.problem.channels, found.predicted, strict=True)
        )
        criterion = values * np.log(max(misfit / values, 1e-14)) + free * np.log(values)
        if criterion > last - _BETTER:
            break
        chosen, last = count, criterion
    return chosen


def _problem(
    sweeps: Sequence[Sweep], temperatures: Sequence[float], reference: float, count: int, energy: float | None = None
) -> Problem:
    """Spectrum of `count` modes and shifts: free ones, or by Arrhenius from the start of an activation energy."""
    parameters = _modes(sweeps, count, reference)
    if energy is not None:
        parameters.append(Parameter("flow_activation_energy", "kJ/mol", "Of the shift with temperature", energy))
    else:
        parameters += [
            Parameter(_shift(one), "1", "Shift of the frequencies to those of the reference", _guess(one, reference))
            for one in temperatures
            if one != reference
        ]

    def factor(values: Values, temperature: float) -> Any:
        if temperature == reference:
            return 1.0
        if energy is None:
            return values[_shift(temperature)]
        return polymer.arrhenius_shift(temperature, reference, values["flow_activation_energy"])

    def predicted(sweep: Sweep, which: int) -> Callable[[Values], Any]:
        near = _nearest(sweep.temperature, temperatures)
        return lambda values: polymer.maxwell_moduli(sweep.frequency * factor(values, near), modes_of(values, count))[
            which
        ]

    channels = [
        Channel(f"{name} of {sweep.name}, {sweep.temperature - polymer.ZERO_CELSIUS:.0f} degC", "Pa", moduli,
                predicted(sweep, which), sweep.frequency, "angular frequency", "rad/s", relative=True, noise_of=name)
        for sweep in sweeps
        for which, (name, moduli) in enumerate((("storage modulus", sweep.storage), ("loss modulus", sweep.loss)))
    ]  # fmt: skip
    return Problem(parameters, channels, [
        Derived("zero_shear_viscosity", "Pa*s", "Viscosity of slow flow: sum of modulus times time",
                lambda values: sum(time * modulus for time, modulus in modes_of(values, count))),
        Derived("plateau_modulus", "MPa", "Sum of the moduli: the modulus at the highest frequencies measured",
                lambda values: sum(modulus for _, modulus in modes_of(values, count))),
    ])  # fmt: skip


def modes_of(values: Values, count: int) -> list[tuple[Any, Any]]:
    """The spectrum (time [s], modulus [Pa]), slowest mode first."""
    return [(values[f"time_{i}"], values[f"modulus_{i}"]) for i in range(1, count + 1)]


def _modes(sweeps: Sequence[Sweep], count: int, reference: float) -> list[Parameter]:
    """Starts: times evenly over the range of the frequencies, moduli from those nearest to one over each."""
    omega = np.concatenate([sweep.frequency * _guess(sweep.temperature, reference) for sweep in sweeps])
    size = np.concatenate([np.hypot(sweep.storage, sweep.loss) for sweep in sweeps])
    order = np.argsort(omega)
    edges = np.log([omega.max(), omega.min()])
    logs = np.linspace(edges[1], edges[0], 2 * count + 1)[1::2]
    parameters = []
    for i, log in enumerate(logs, start=1):
        modulus = float(np.exp(np.interp(log, np.log(omega[order]), np.log(size[order]))))
        parameters.append(Parameter(f"time_{i}", "s", "Relaxation time of a mode", float(np.exp(-log)), profiled=False))
        parameters.append(Parameter(f"modulus_{i}", "Pa", "Modulus of that mode", modulus, profiled=False))
    return parameters


def _guess(temperature: float, reference: float) -> float:
    """Shift factor to start from: that of an energy in the middle of what polymers' melts have."""
    return float(polymer.arrhenius_shift(temperature, reference, 40e3))


def _measurement(best: Fit, count: int, reference: float, most: int, notes: Sequence[str]) -> Measurement:
    values = {name: best[name] for name in ("zero_shear_viscosity", "plateau_modulus")}
    if any(one.name == "flow_activation_energy" for one in best.parameters):
        values["flow_activation_energy"] = best["flow_activation_energy"]
    modes = sorted(((best.value(f"time_{i}"), best.value(f"modulus_{i}")) for i in range(1, count + 1)), reverse=True)
    table = RecordTableFound({"relaxation_time": "s", "modulus": "Pa"}, split_to(modes, most))
    return Measurement(
        best, tuple(notes), values, {"melt_spectrum": table}, {"melt_reference_temperature": (reference, "degC")}
    )


def split_to(modes: Sequence[tuple[float, float]], count: int) -> list[tuple[float, float]]:
    """The same spectrum in `count` rows: the strongest modes split in two of half the modulus, times falling."""
    rows = list(modes)
    while len(rows) < count:
        at = max(range(len(rows)), key=lambda i: rows[i][0] * rows[i][1])
        time, modulus = rows[at]
        near = min([abs(np.log(time / other)) for i, (other, _) in enumerate(rows) if i != at], default=1.0)
        step = 1.0 + min(_SPLIT, 0.3 * float(near))
        rows[at : at + 1] = [(time * step, 0.5 * modulus), (time / step, 0.5 * modulus)]
    return sorted(rows, reverse=True)


def _notes(sweeps: Sequence[Sweep], kept: Sequence[Sweep], reference: float, count: int, most: int) -> list[str]:
    notes = [
        f"{count} {'mode' if count == 1 else 'modes'} at {reference - polymer.ZERO_CELSIUS:.1f} degC: one more would "
        "not better the fit by what it costs."
        if count < most
        else f"{count} modes, the most that were allowed; the data may bear more (--set largest_modes=...)."
    ]
    if len(kept) < len(sweeps):
        notes.append(f"{len(sweeps) - len(kept)} of {len(sweeps)} sweeps lie below the least temperature: left out.")
    left = sum(len(sweep.frequency) for sweep in kept)
    low = min(float(sweep.frequency.min()) for sweep in kept)
    notes.append(f"{left} frequencies from {low:.3g} rad/s on; what is slower than that is not seen.")
    return notes
