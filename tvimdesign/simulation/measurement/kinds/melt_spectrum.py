"""The relaxation spectrum of a melt from any of its tests, with as few modes as the data bear, and its shift.

Modes (tau_i, G_i) are free in time and modulus. Each temperature but the reference shifts its rates by a factor a_T of
its own, and by Arrhenius' law where that describes them all; a ramp has rows at all temperatures, and goes by the law
from the start. How many modes: as long as one more betters Schwarz's criterion [Sch]. Sources: [BW] Baumgaertel and
Winter, Rheol. Acta 28 (1989) 511 (free times and moduli, as few modes as the data bear); [Sch] Schwarz, Ann. Statist. 6
(1978) 461.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.physics.polymers import polymer
from tvimdesign.physics.polymers.polymer import GAS_CONSTANT, ZERO_CELSIUS
from tvimdesign.simulation.measurement.fitting.fit import BestFit, Estimate, Fit, best_fit, fitted, with_intervals
from tvimdesign.simulation.measurement.fitting.problem import Channel, Derived, Parameter, Problem, Values
from tvimdesign.simulation.measurement.measurement import Measurement, RecordTable, Settings
from tvimdesign.simulation.measurement.reading.data_file import Array

_TOGETHER = 1.0
"""Tests within so many kelvin are of one temperature."""
BETTER = 6.0
"""By how much Schwarz's criterion has to fall for one mode more: strong evidence (Kass and Raftery, 1995)."""
_UNTOLD = (
    "The files do not say their temperature: the spectrum is that of their temperature, whichever it was. No record "
    "is written; --set temperature=... says it."
)
USUAL_ENERGY = 40e3
"""J/mol, to start from: in the middle of what polymers' melts have."""
_FAR = 0.15
"""Shift factors may miss Arrhenius' law by this share of themselves and it is still of use; more, and it is not."""
_BEYOND = 10.0
"""Factor by which a relaxation time may lie outside the times that a test sees."""
_SOLID = 1e3
"""Factor beyond that by which the time of a mode lies that stands for a solid."""
_AT_END = 0.01
"""Share of a time up to which a mode lies at the end of what is looked for."""
_SPLIT = 0.02
"""A mode that stands for two in a record is split this share above and below its time: no test could tell."""


class MeltTest(NamedTuple):
    """One test: its temperature [K], or one for each row of a ramp, its curves, and where it sees the spectrum."""

    name: str
    temperature: float
    ramp: Array | None
    curves: Sequence[Channel]
    """Values, each predicted from modes, shift factors and the parameters."""
    rates: Array
    """Angular frequencies, or one over the times [1/s]."""
    sizes: Array
    """Modulus at each of them [Pa], roughly."""
    note: str = ""
    """Parts that were left out."""
    own: Sequence[Parameter] = ()
    """Unknowns of this test alone."""
    blind: str = ""
    """`inertia` or `rise` where first rows were left out for it: what relaxes faster is not seen."""


class Melt(NamedTuple):
    """Tests of a melt with what they are fitted by."""

    tests: Sequence[MeltTest]
    temperatures: Sequence[float]
    """Of the tests that have one each [K], those within a kelvin as one."""
    reference: float
    energy: float | None = None
    """Start of the activation energy where the shift goes by Arrhenius' law; a factor each otherwise."""
    known_energy: float | None = None
    """The activation energy, where it is known."""
    fast: bool = False
    """True where what relaxes faster than the tests see is a viscosity."""
    solid: bool = False
    """True where what relaxes slower than the tests see is the modulus of a solid."""

    @property
    def rates(self) -> Array:
        """Rates that the tests see, at the reference temperature, roughly [1/s]."""
        return np.concatenate([test.rates * guessed_shift(test.temperature, self.reference) for test in self.tests])

    @property
    def window(self) -> tuple[float, float]:
        """Shortest and longest relaxation time [s] that is looked for: `_BEYOND` outside what the tests see."""
        return float(1.0 / (_BEYOND * self.rates.max())), float(_BEYOND / self.rates.min())

    def modes(self, values: Values, count: int) -> list[tuple[Any, Any]]:
        """Return the spectrum (time [s], modulus [Pa]), slowest first, with the modes of a solid and of a viscosity."""
        slow = [(_SOLID * self.window[1], values["solid_modulus"])] if self.solid else []
        fast = [(values["fast_time"], values["fast_viscosity"] / values["fast_time"])] if self.fast else []
        return [*slow, *modes_of(values, count), *fast]

    @property
    def values(self) -> int:
        """Values measured."""
        return sum(len(curve.measured) for test in self.tests for curve in test.curves)

    def factor(self, values: Values, test: MeltTest) -> Any:
        """Return the shift of the rates of a test: one, or one for each row of a ramp."""
        if self.energy is not None and (test.ramp is not None or self._near(test) != self.reference):
            at = self._near(test) if test.ramp is None else test.ramp
            return polymer.arrhenius_shift(at, self.reference, values.get("flow_activation_energy", self.energy))
        if np.isnan(self.reference) or self._near(test) == self.reference:
            return 1.0
        return values[shift_name(self._near(test))]

    def _near(self, test: MeltTest) -> float:
        return min(self.temperatures, key=lambda temperature: abs(temperature - test.temperature))

    @property
    def shifted(self) -> list[float]:
        """The temperatures whose tests are shifted."""
        return [at for at in self.temperatures if at != self.reference and not np.isnan(at)]


def fit_spectrum(tests: Sequence[MeltTest], settings: Settings, *, profiles: bool) -> Measurement:
    """Return the spectrum of tests, all together. Raises InputError for what lacks."""
    least = settings.get("least_temperature", 0.0)
    known = temperature_known([test.name for test in tests], [test.temperature for test in tests])
    molten = [test for test in tests if test.temperature >= least] if known else list(tests)
    if not molten:
        raise InputError("--set least_temperature leaves no test")
    most = round(settings["largest_modes"])
    melt = _melt(molten, settings)
    count, first = _fewest_modes(melt, most)
    melt, count, first = _without_ends(melt, count, first)
    best, notes = _best(melt, count, first, profiles=profiles)
    notes = [*_notes(tests, melt, count, most), *notes]
    if not known:
        notes.append(_UNTOLD)
        return Measurement(best, tuple(notes))
    if melt.fast or melt.solid or _blind(melt):
        return _viscosity_record(best, melt, count, notes)
    return spectrum_record(best, count, most, melt.reference, notes)


def temperature_known(names: Sequence[str], temperatures: Sequence[float]) -> bool:
    """Return whether the temperatures of tests are known. Raises InputError where those of some are."""
    unknown = np.isnan(temperatures)
    if np.any(unknown) and not np.all(unknown):
        name = names[int(np.argmax(unknown))]
        raise InputError(f"{name}: the file does not say its temperature, as others do; --set temperature=...")
    return not np.any(unknown)


def _without_ends(melt: Melt, count: int, first: BestFit) -> tuple[Melt, int, BestFit]:
    """Return the fit in which modes at the ends of what is looked for are a viscosity and the modulus of a solid."""
    shortest, longest = melt.window
    times = {parameter.name: parameter.outer(float(inner))
             for parameter, inner in zip(first.problem.parameters, first.found.inner, strict=True)}  # fmt: skip
    modes = [times[f"time_{i}"] for i in range(1, count + 1)]
    fast = sum(time < shortest * (1.0 + _AT_END) for time in modes)
    slow = sum(time > longest / (1.0 + _AT_END) for time in modes)
    if not fast + slow:
        return melt, count, first
    melt = melt._replace(fast=melt.fast or fast > 0, solid=melt.solid or slow > 0)
    count -= fast + slow
    return _without_ends(melt, count, best_fit(_problem(melt, count)))


def _blind(melt: Melt) -> str:
    """Return `rise` or `inertia` where that hides the fast modes from all tests, those by the rise first."""
    fastest = max((float(test.rates.max()) for test in melt.tests if not test.blind), default=0.0)
    hidden = [test.blind for test in melt.tests if test.blind and test.rates.max() > fastest]
    return max(hidden, default="")


def _viscosity_record(best: Fit, melt: Melt, count: int, notes: Sequence[str]) -> Measurement:
    """Return the measurement of a melt whose spectrum goes on outside the tests: its viscosity, if it flows."""
    conditions = {"melt_reference_temperature": (melt.reference, "degC")}
    if melt.solid:
        solid = best["solid_modulus"]
        why = (
            f"The data do not flow: {solid.value:.3g} Pa are left at the longest times, as of a solid. No viscosity "
            "follows, and no record is written. Measure at lower frequencies or for longer, or hotter."
        )
        return Measurement(best, (*notes, why))
    if _blind(melt) == "rise":
        why = (
            "What relaxes while the strain rises is not seen, and the viscosity is its sum with the rest: no record is "
            "written. Set rise_time, or fit a frequency sweep together with it (--as melt)."
        )
        return Measurement(best, (*notes, why))
    slowest = max((best.value(f"time_{i}") for i in range(1, count + 1)), default=0.0)
    if slowest > melt.window[1] / _BEYOND:
        return Measurement(best, (*notes, _extrapolated(slowest, melt.window[1] / _BEYOND)))
    viscosity = best["zero_shear_viscosity"]
    there = f", {best['fast_viscosity'].value:.3g} Pa.s" if melt.fast else " or what the inertia hides"
    why = f"Faster than the tests see there is only a viscosity{there}: the plateau modulus does not follow. "
    if viscosity.low is None or viscosity.high is None:
        return Measurement(best, (*notes, why + "The data leave the viscosity open: no record is written."))
    values = {each.name: each for each in (*best.parameters, *best.derived)
              if each.name in {"zero_shear_viscosity", "flow_activation_energy"}}  # fmt: skip
    why += "The record has the viscosity alone, with the plateau modulus of the record it is based on."
    return Measurement(best, (*notes, why), values, {}, conditions)


def _melt(tests: Sequence[MeltTest], settings: Settings) -> Melt:
    if np.isnan(tests[0].temperature):
        return Melt(tests, [np.nan], np.nan)
    temperatures: list[float] = []
    for temperature in sorted(test.temperature for test in tests):
        if not temperatures or temperature - temperatures[-1] > _TOGETHER:
            temperatures.append(temperature)
    wanted = settings.get("reference_temperature", temperatures[len(temperatures) // 2])
    known = settings.get("flow_activation_energy")
    ramps = any(test.ramp is not None for test in tests)
    if known is None and not ramps:
        return Melt(tests, temperatures, min(temperatures, key=lambda temperature: abs(temperature - wanted)))
    return Melt(tests, temperatures, wanted, USUAL_ENERGY if known is None else known, known)


def _best(melt: Melt, count: int, first: BestFit, *, profiles: bool) -> tuple[Fit, list[str]]:
    """Return the fit with so many modes, by Arrhenius' law where that describes the shifts, and notes on them.

    `first` is the fit with so many modes and free shifts, or with the melt's own energy.
    """
    if melt.energy is not None or len(melt.temperatures) == 1:
        return with_intervals(first, profiles=profiles), []
    free = with_intervals(first, profiles=False)
    shifts = {temperature: free[shift_name(temperature)] for temperature in melt.shifted}
    activation = arrhenius(shifts, melt.reference)
    note = shift_note(activation, shifts, melt.reference)
    if activation.describes:
        return fitted(_problem(melt._replace(energy=activation.energy), count), profiles=profiles), note
    return (with_intervals(first) if profiles else free), note


def shift_name(temperature: float) -> str:
    """Return the name of a temperature's factor."""
    return f"shift_{temperature - ZERO_CELSIUS:.0f}".replace("-", "minus_")


def guessed_shift(temperature: Any, reference: float) -> Any:
    """Return the shift factor to start from."""
    return 1.0 if np.isnan(reference) else polymer.arrhenius_shift(temperature, reference, USUAL_ENERGY)


def _fewest_modes(melt: Melt, most: int) -> tuple[int, BestFit]:
    """Return modes up to which one more betters Schwarz's criterion, from one to `most`, and the fit with them.

    Raises InputError where there are fewer values than one mode has parameters.
    """
    chosen, best = 1, best_fit(_problem(melt, 1))
    least = criterion(best, melt.values)
    for count in range(2, most + 1):
        problem = _problem(melt, count)
        if len(problem.parameters) >= melt.values:
            break
        candidate = best_fit(problem)
        candidate_criterion = criterion(candidate, melt.values)
        if candidate_criterion > least - BETTER:
            break
        chosen, best, least = count, candidate, candidate_criterion
    return chosen, best


def criterion(fit: BestFit, values: int) -> float:
    """Return Schwarz's criterion, less is better [Sch]."""
    return _misfit(fit) + len(fit.problem.parameters) * float(np.log(values))


def _misfit(fit: BestFit) -> float:
    """Return the sum of n ln(mean square of the residuals) over what errs alike."""
    squares: dict[str, list[Any]] = {}
    for channel, predicted in zip(fit.problem.channels, fit.predicted(), strict=True):
        left = np.log(channel.measured / predicted) if channel.relative else channel.measured - predicted
        squares.setdefault(channel.noise_of, []).append(left if channel.relative else left / np.ptp(channel.measured))
    groups = [np.concatenate(group) for group in squares.values()]
    return sum(len(group) * float(np.log(max(np.mean(group**2), 1e-14))) for group in groups)


def _problem(melt: Melt, count: int) -> Problem:
    """Return the spectrum of `count` modes and shifts."""
    parameters = _modes(melt, count)
    parameters += [parameter for test in melt.tests for parameter in test.own]
    if melt.energy is None:
        parameters += [
            Parameter(shift_name(temperature), "1", "Shift of the rates to those of the reference",
                      float(guessed_shift(temperature, melt.reference)))
            for temperature in melt.shifted
        ]  # fmt: skip
    elif melt.known_energy is None:
        parameters.append(Parameter("flow_activation_energy", "kJ/mol", "Of the shift with temperature", melt.energy))

    if melt.solid:
        parameters.append(Parameter("solid_modulus", "Pa", "Modulus left at the longest times, as of a solid",
                                    float(min(np.min(test.sizes) for test in melt.tests))))  # fmt: skip
    if melt.fast:
        shortest = melt.window[0]
        largest = float(max(np.max(test.sizes) for test in melt.tests)) * shortest * _BEYOND
        parameters += [
            Parameter("fast_time", "s", "Time of it", 0.1 * shortest, least=shortest / _SOLID, most=shortest,
                      nuisance=True),
            Parameter("fast_viscosity", "Pa*s", "Viscosity of all that relaxes faster than is seen", largest),
        ]  # fmt: skip

    def predicted(test: MeltTest, channel: Channel) -> Callable[[Values], Any]:
        by_spectrum: Callable[..., Any] = channel.predicted
        return lambda values: by_spectrum(melt.modes(values, count), melt.factor(values, test), values)

    channels = [replace(channel, predicted=predicted(test, channel)) for test in melt.tests for channel in test.curves]
    derived = [] if melt.solid else [
        Derived("zero_shear_viscosity", "Pa*s", "Viscosity of slow flow: sum of modulus times time",
                lambda values: sum(time * modulus for time, modulus in melt.modes(values, count)))
    ]  # fmt: skip
    if count:
        derived.append(
            Derived("plateau_modulus", "MPa", "Sum of the moduli: the modulus at the highest rates measured",
                    lambda values: sum(modulus for _, modulus in modes_of(values, count)))
        )  # fmt: skip
    return Problem(parameters, channels, derived)


def modes_of(values: Values, count: int) -> list[tuple[Any, Any]]:
    """Return the spectrum (time [s], modulus [Pa]), slowest mode first."""
    return [(values[f"time_{i}"], values[f"modulus_{i}"]) for i in range(1, count + 1)]


def _modes(melt: Melt, count: int) -> list[Parameter]:
    """Return starts: times evenly over the range of the rates, moduli from those nearest to one over each."""
    rates, size = melt.rates, np.concatenate([test.sizes for test in melt.tests])
    order = np.argsort(rates)
    logs = np.linspace(np.log(rates.min()), np.log(rates.max()), 2 * count + 1)[1::2]
    shortest, longest = melt.window
    parameters = []
    for i, log in enumerate(logs, start=1):
        modulus = float(np.exp(np.interp(log, np.log(rates[order]), np.log(size[order]))))
        parameters += [
            Parameter(f"time_{i}", "s", "Relaxation time of a mode", float(np.exp(-log)), profiled=False,
                      least=shortest, most=longest),
            Parameter(f"modulus_{i}", "Pa", "Modulus of that mode", modulus, profiled=False),
        ]  # fmt: skip
    return parameters


def _notes(tests: Sequence[MeltTest], melt: Melt, count: int, most: int) -> list[str]:
    at = "" if np.isnan(melt.reference) else f" at {melt.reference - ZERO_CELSIUS:.1f} degC"
    notes = [
        f"{count} {'mode' if count == 1 else 'modes'}{at}: one more would not better the fit by what it costs."
        if count < most
        else f"{count} modes, the most that were allowed; the data may bear more (--set largest_modes=...)."
    ]
    if len(melt.tests) < len(tests):
        notes.append(f"{len(tests) - len(melt.tests)} of {len(tests)} tests lie below the least temperature: left out.")
    notes += [test.note for test in melt.tests if test.note]
    rows = sum(len(test.rates) for test in melt.tests)
    low = min(float(test.rates.min()) for test in melt.tests)
    notes.append(f"{rows} rows from {low:.3g} rad/s on (one over the time, of tests in time); slower is not seen.")
    return notes


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
        f"Arrhenius' law with {activation.energy / 1e3:.1f} kJ/mol describes them."
        if activation.describes
        else f"Arrhenius' law misses one by {100.0 * activation.farthest:.0f} %: no activation energy is given, and "
        "the shift of the record this is based on is not that of these data."
    )
    return [f"Shift factors to {reference - ZERO_CELSIUS:.0f} degC: {table}. {law}"]


def spectrum_record(best: Fit, count: int, most: int, reference: float, notes: Sequence[str]) -> Measurement:
    """Return the measurement of a spectrum of `count` modes, in a record of `most`.

    No record follows of modes that the data leave open, or of a viscosity beyond the times that they see.
    """
    modes = sorted(((best.value(f"time_{i}"), best.value(f"modulus_{i}")) for i in range(1, count + 1)), reverse=True)
    own = [best[f"{name}_{i}"] for i in range(1, count + 1) for name in ("time", "modulus")]
    own += [best["zero_shear_viscosity"], best["plateau_modulus"]]
    left_open = [parameter.name for parameter in own if parameter.low is None or parameter.high is None]
    if left_open:
        viscosity = best["zero_shear_viscosity"]
        known = "" if viscosity.low is None else (
            f" The viscosity is known: give {viscosity.value:.3g} Pa.s as pcl_zero_shear_viscosity in a study's module."
        )  # fmt: skip
        return Measurement(best, (*notes, f"The data leave {', '.join(left_open)} open: no record is written.{known}"))
    seen = next(parameter.most for parameter in best.problem.parameters if parameter.name == "time_1") / _BEYOND
    if modes[0][0] > seen:
        return Measurement(best, (*notes, _extrapolated(modes[0][0], seen)))
    values = {name: best[name] for name in ("zero_shear_viscosity", "plateau_modulus")}
    if any(parameter.name == "flow_activation_energy" for parameter in best.parameters):
        values["flow_activation_energy"] = best["flow_activation_energy"]
    table = RecordTable({"relaxation_time": "s", "modulus": "Pa"}, split_to(modes, most))
    return Measurement(
        best, tuple(notes), values, {"melt_spectrum": table}, {"melt_reference_temperature": (reference, "degC")}
    )


def _extrapolated(slowest: float, seen: float) -> str:
    return (
        f"The slowest mode takes {slowest:.3g} s, and the tests see {seen:.3g} s: the viscosity is extrapolated, and "
        "no record is written. Measure at lower frequencies, or for longer."
    )


def split_to(modes: Sequence[tuple[float, float]], count: int) -> list[tuple[float, float]]:
    """Return the same spectrum in `count` rows: the strongest modes split in two of half the modulus, times falling."""
    rows = list(modes)
    while len(rows) < count:
        at = max(range(len(rows)), key=lambda i: rows[i][0] * rows[i][1])
        time, modulus = rows[at]
        near = min([abs(np.log(time / other)) for i, (other, _) in enumerate(rows) if i != at], default=1.0)
        step = 1.0 + min(_SPLIT, 0.3 * float(near))
        rows[at : at + 1] = [(time * step, 0.5 * modulus), (time / step, 0.5 * modulus)]
    return sorted(rows, reverse=True)
