"""The fit of a melt's spectrum and its shift, and the record that follows: modes, its viscosity alone, or none."""

from collections.abc import Mapping, Sequence

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.physics.polymers.polymer import GAS_CONSTANT, ZERO_CELSIUS
from tvimdesign.simulation.measurement.fitting.fit import BestFit, Estimate, Fit, best_fit, fitted, with_intervals
from tvimdesign.simulation.measurement.kinds import melt_spectrum
from tvimdesign.simulation.measurement.kinds.melt_spectrum import Melt, MeltTest
from tvimdesign.simulation.measurement.measurement import Measurement, RecordTable, Settings

_UNTOLD = (
    "The files do not say their temperature: the spectrum is that of their temperature, whichever it was. No record "
    "is written; --set temperature=... says it."
)
_FAR = 0.15
"""Shift factors may miss Arrhenius' law by this share of themselves and it is still of use; more, and it is not."""
_AT_END = 0.01  # Share of a time up to which a mode lies at the end of what is looked for
_SPLIT = 0.02  # A mode that stands for two in a record is split this share above and below its time: no test could tell


def fit_spectrum(tests: Sequence[MeltTest], settings: Settings, *, profiles: bool) -> Measurement:
    """Return the spectrum of tests, all together. Raises InputError for what lacks."""
    least = settings.get("least_temperature", 0.0)
    known = melt_spectrum.temperature_known([test.name for test in tests], [test.temperature for test in tests])
    molten = [test for test in tests if test.temperature >= least] if known else list(tests)
    if not molten:
        raise InputError("--set least_temperature leaves no test")
    most = round(settings["largest_modes"])
    melt = melt_spectrum.melt_of(molten, settings)
    count, first = melt_spectrum.fewest_modes(melt, most)
    melt, count, first = _without_ends(melt, count, first)
    best, notes = _best(melt, count, first, profiles=profiles)
    notes = [*_notes(tests, melt, count, most), *notes]
    if not known:
        notes.append(_UNTOLD)
        return Measurement(best, tuple(notes))
    if melt.fast or melt.solid or _blind(melt):
        return _viscosity_record(best, melt, count, notes)
    return spectrum_record(best, count, most, melt.reference, notes)


def _without_ends(melt: Melt, count: int, first: BestFit) -> tuple[Melt, int, BestFit]:
    """Return the fit in which modes at the ends of what is looked for are a viscosity and the modulus of a solid."""
    shortest, longest = melt.window
    times = {parameter.name: parameter.outer(float(inner))
             for parameter, inner in zip(first.problem.parameters, first.fit.inner, strict=True)}  # fmt: skip
    modes = [times[f"time_{i}"] for i in range(1, count + 1)]
    fast = sum(time < shortest * (1.0 + _AT_END) for time in modes)
    slow = sum(time > longest / (1.0 + _AT_END) for time in modes)
    if not fast + slow:
        return melt, count, first
    melt = melt._replace(fast=melt.fast or fast > 0, solid=melt.solid or slow > 0)
    count -= fast + slow
    return _without_ends(melt, count, best_fit(melt_spectrum.spectrum_problem(melt, count)))


def _best(melt: Melt, count: int, first: BestFit, *, profiles: bool) -> tuple[Fit, list[str]]:
    """Return the fit with so many modes, by Arrhenius' law where that describes the shifts, and notes on them.

    `first` is the fit with so many modes and free shifts, or with the melt's own energy.
    """
    if melt.energy is not None or len(melt.temperatures) == 1:
        return with_intervals(first, profiles=profiles), []
    free = with_intervals(first, profiles=False)
    shifts = {temperature: free[melt_spectrum.shift_name(temperature)] for temperature in melt.shifted}
    energy, note = arrhenius(shifts, melt.reference)
    if energy is not None:
        return fitted(melt_spectrum.spectrum_problem(melt._replace(energy=energy), count), profiles=profiles), [note]
    return (with_intervals(first) if profiles else free), [note]


def arrhenius(shifts: Mapping[float, Estimate], reference: float) -> tuple[float | None, str]:
    """Return the energy [J/mol] of Arrhenius' law through shift factors, none where it misses one, and a note.

    By least squares of ln a_T over 1/T - 1/T_ref, through zero, weighted by the intervals; a miss is what is more than
    a factor's own interval.
    """
    inverse = np.array([1.0 / shift - 1.0 / reference for shift in shifts])
    logs = np.array([np.log(shift.value) for shift in shifts.values()])
    halves = np.array([
        1.0 if each.low is None or each.high is None else 0.5 * np.log(each.high / each.low) for each in shifts.values()
    ])  # fmt: skip
    weights = 1.0 / np.maximum(halves, 1e-6) ** 2
    energy = GAS_CONSTANT * float(np.sum(weights * inverse * logs) / np.sum(weights * inverse**2))
    missed = np.maximum(np.abs(logs - energy / GAS_CONSTANT * inverse) - halves, 0.0)
    farthest = float(np.expm1(np.max(missed)))
    table = ", ".join(f"{at - ZERO_CELSIUS:.0f} degC: {shift.value:.3g}" for at, shift in shifts.items())
    note = f"Shift factors to {reference - ZERO_CELSIUS:.0f} degC: {table}. Arrhenius' law "
    if energy > 0.0 and farthest < _FAR:
        return energy, f"{note}describes them."
    return None, (
        f"{note}misses one by {100.0 * farthest:.0f} %: no activation energy is given, and the shift of the record "
        "this is based on is not that of these data."
    )


def _notes(tests: Sequence[MeltTest], melt: Melt, count: int, most: int) -> list[str]:
    at = "" if np.isnan(melt.reference) else f" at {melt.reference - ZERO_CELSIUS:.1f} degC"
    notes = [
        f"{count} {'mode' if count == 1 else 'modes'}{at}: one more would follow the noise."
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


def _blind(melt: Melt) -> str:
    """Return `rise` or `inertia` where that hides the fast modes from all tests, those by the rise first."""
    fastest = max((float(test.rates.max()) for test in melt.tests if not test.blind), default=0.0)
    hidden = [test.blind for test in melt.tests if test.blind and test.rates.max() > fastest]
    return max(hidden, default="")


def _viscosity_record(best: Fit, melt: Melt, count: int, notes: Sequence[str]) -> Measurement:
    """Return the measurement of a melt whose spectrum goes on outside the tests: its viscosity, if it flows."""
    values: dict[str, Estimate] = {}
    slowest = max((best.value(f"time_{i}") for i in range(1, count + 1)), default=0.0)
    if melt.solid:
        why = (
            f"The data do not flow: {best.value('solid_modulus'):.3g} Pa are left at the longest times, as of a solid. "
            "No viscosity follows, and no record is written. Measure at lower frequencies or for longer, or hotter."
        )
    elif _blind(melt) == "rise":
        why = (
            "What relaxes while the strain rises is not seen, and the viscosity is its sum with the rest: no record is "
            "written. Set rise_time, or fit a frequency sweep together with it (--as melt)."
        )
    elif slowest > melt.window[1] / melt_spectrum.BEYOND:
        why = _extrapolated(slowest, melt.window[1] / melt_spectrum.BEYOND)
    else:
        there = f", {best.value('fast_viscosity'):.3g} Pa.s" if melt.fast else " or what the inertia hides"
        why = f"Faster than the tests see there is only a viscosity{there}: the plateau modulus does not follow. "
        if best["zero_shear_viscosity"].low is None:
            why += "The data leave the viscosity open: no record is written."
        else:
            why += "The record has the viscosity alone, with the plateau modulus of the record it is based on."
            values = _reported(best, "zero_shear_viscosity", "flow_activation_energy")
    conditions = {"melt_reference_temperature": (melt.reference, "degC")} if values else {}
    return Measurement(best, (*notes, why), values, {}, conditions)


def _reported(best: Fit, *names: str) -> dict[str, Estimate]:
    return {each.name: each for each in (*best.parameters, *best.derived) if each.name in names}


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
    seen = (
        next(parameter.most for parameter in best.problem.parameters if parameter.name == "time_1")
        / melt_spectrum.BEYOND
    )
    if modes[0][0] > seen:
        return Measurement(best, (*notes, _extrapolated(modes[0][0], seen)))
    values = _reported(best, "zero_shear_viscosity", "plateau_modulus", "flow_activation_energy")
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
