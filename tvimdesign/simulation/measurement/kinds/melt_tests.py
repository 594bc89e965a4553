"""Tests of a melt as its spectrum sees them: frequency sweeps, temperature ramps, creep with recovery, relaxation.

Sweeps and ramps: G', G'' by `polymer.maxwell_moduli`; each row of a ramp is shifted by its own temperature, and rows
below the least temperature are left out, for the polymer may be frozen there.

Creep: J(t) = t/eta + the recoverable part, which has the Laplace transform 1/(s Q(s)) - 1/(s^2 eta), Q(s) = sum G s
tau/(1 + s tau), and is inverted by Stehfest's weights (physics/motions/motion.py): to 4e-4 the retardation spectrum
(`viscoelasticity.retardation`), and with derivatives. After the stress is off J(t) - J(t - t_1) is left.

Relaxation: G(t) by `viscoelasticity.relaxation_modulus`, or as `ramped_stress` where the strain took a time to rise.
"""

from collections.abc import Callable, Sequence
from typing import Any, cast

import numpy as np
from scipy.ndimage import median_filter

from tvimdesign.base.errors import InputError
from tvimdesign.physics.motions import motion
from tvimdesign.physics.polymers import polymer, viscoelasticity
from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS, Modes
from tvimdesign.simulation.measurement.fitting.problem import Channel, Parameter, Values
from tvimdesign.simulation.measurement.kinds.melt_spectrum import MeltTest, guessed_shift
from tvimdesign.simulation.measurement.kinds.spectrum_fit import fit_spectrum
from tvimdesign.simulation.measurement.measure_files import kind_sheets
from tvimdesign.simulation.measurement.measurement import LEAST_ROWS, Measurement, Settings, required, rows_of
from tvimdesign.simulation.measurement.reading.data_file import Array, Block
from tvimdesign.simulation.working_cycle.symbols import ca

MOST_ROWS = 150  # Rows of a test in time that are used: an instrument writes thousands, which say no more
MELT = 70.0 + ZERO_CELSIUS
"""Least temperature [K] of a ramp unless set: polycaprolactone's melting ends at 62 to 70 degC."""
_SAME_SWEEP = 1.5
"""Rows within so many kelvin of the first are of one sweep, where a table holds sweeps at several temperatures."""
_CUT_OFF, _ALIKE, _IN_A_ROW = 20.0, 5e-3, 4
"""Ratio of the moduli, its largest change from row to row and the rows in which an instrument has cut a modulus off."""
_ALMOST = 0.99
_RISEN, _AFTER_RISE, _FALLS = 0.98, 10.0, 0.9
"""Share of the strain at which it has risen; times that rise from which on rows count; share of the largest modulus
below which the first one shows a rise."""
_FASTER, _RINGING = 0.15, 10.0
"""Slope of a creep beyond one, of logarithms, that only inertia makes; times its end up to which it may ring."""
_OF_SECOND_DIFFERENCES = 1.4826 / 6.0**0.5  # Deviation over the median size of second differences
_UNLOADED = 0.1  # Share of the largest stress below which the stress is off
_NO_COMPLIANCE = np.finfo(float).tiny  # Compliance [1/Pa] up to which one over it is no number


def temperature_of(block: Block, settings: Settings) -> float:
    """Return the mean temperature of a table [K]: its column's, that of the lines before it, or the one that is set.

    It is not a number where nobody gives it: tests at one temperature have a spectrum all the same.
    """
    if block.complete(["temperature"]):
        return float(np.nanmean(block.values("temperature")))
    temperature = settings.get("temperature", block.number("temperature"))
    return np.nan if temperature is None else float(temperature)


def title_of(block: Block, temperature: float) -> str:
    """Return a name for a table's channels."""
    title = block.title or block.file
    return title if np.isnan(temperature) else f"{title}, {temperature - ZERO_CELSIUS:.0f} degC"


def sweeps_in(block: Block, settings: Settings) -> list[MeltTest]:
    """Return the frequency sweeps of a table: one for each temperature that it holds."""
    (frequency, storage, loss, *at), note = _oscillation(block)
    if not at:
        return [_oscillated(block, temperature_of(block, settings), frequency, storage, loss)._replace(note=note)]
    changes = np.flatnonzero(np.abs(np.diff(at[0])) > _SAME_SWEEP) + 1
    sweeps = [
        _oscillated(block, float(np.mean(at[0][part])), frequency[part], storage[part], loss[part])
        for part in np.split(np.arange(len(frequency)), changes)
    ]
    return [sweeps[0]._replace(note=note), *sweeps[1:]]


def ramps_in(block: Block, settings: Settings) -> list[MeltTest]:
    """Return the temperature ramp of a table, the rows of the melt. Raises InputError where there are too few."""
    least = settings.get("least_temperature", MELT)
    columns, note = _oscillation(block)
    molten = columns[3] >= least
    if np.sum(molten) < LEAST_ROWS:
        raise InputError(
            f"{block.place}: {np.sum(molten)} rows of the melt, from {least - ZERO_CELSIUS:.0f} degC on; "
            "--set least_temperature=... says otherwise"
        )
    omega, storage, loss, at = (column[molten] for column in columns)
    return [_oscillated(block, float(np.median(at)), omega, storage, loss, at)._replace(note=note)]


def _oscillation(block: Block) -> tuple[list[Array], str]:
    """Return angular frequency [rad/s], G', G'' [Pa] and, where there is one, temperature [K], and a note.

    Rows are above zero, and none has a modulus that the instrument has cut off. Raises InputError for too few.
    """
    which = "angular_frequency" if "angular_frequency" in block.columns else "frequency"
    extra = ["temperature"] if block.complete(["temperature"]) else []
    frequency, storage, loss, *others = rows_of(block, [which, "storage_modulus", "loss_modulus", *extra])
    good = (frequency > 0.0) & (storage > 0.0) & (loss > 0.0)
    omega = frequency * (1.0 if which == "angular_frequency" else 2.0 * np.pi)
    columns = [column[good] for column in (omega, storage, loss, *others)]
    cut = _cut_off(columns[2] / columns[1])
    if not np.any(cut):
        return columns, ""
    ratio, viscosity = (float(np.median(series[cut])) for series in (columns[2] / columns[1], columns[2] / columns[0]))
    note = (
        f"{block.place}: G''/G' stays at {ratio:.3g} in {np.sum(cut)} of {len(cut)} rows, which are left out: the "
        "instrument has cut the smaller modulus off."
    )
    if np.sum(~cut) < LEAST_ROWS:
        raise InputError(
            f"{note} Too few rows remain. "
            + (f"G''/omega is {viscosity:.3g} Pa.s there: the viscosity of a melt that only flows" if ratio > 1.0
               else "Measure at larger strains or lower frequencies")
        )  # fmt: skip
    return [column[~cut] for column in columns], note


def _cut_off(ratio: Array) -> Any:
    """Return the rows of a run in which a large ratio of moduli, or a small one, does not change."""
    same = (np.abs(np.diff(np.log(ratio))) < _ALIKE) & (np.abs(np.log(ratio[1:])) > np.log(_CUT_OFF))
    cut = np.zeros(len(ratio), bool)
    for first in range(len(ratio) - _IN_A_ROW + 1):
        if np.all(same[first : first + _IN_A_ROW - 1]):
            cut[first : first + _IN_A_ROW] = True
    return cut


def _oscillated(
    block: Block, temperature: float, omega: Array, storage: Array, loss: Array, ramp: Array | None = None
) -> MeltTest:
    def predicted(which: int) -> Callable[..., Any]:
        return lambda modes, shift, _: polymer.maxwell_moduli(omega * shift, modes)[which]

    where = title_of(block, temperature)
    at = (omega, "angular frequency", "rad/s") if ramp is None else (ramp, "temperature", "degC")
    curves = [
        Channel(f"{name} of {where}", "Pa", moduli, predicted(which), *at, relative=True,
                step=block.share(name.replace(" ", "_")), noise_of=name)
        for which, (name, moduli) in enumerate((("storage modulus", storage), ("loss modulus", loss)))
    ]  # fmt: skip
    rates = omega if ramp is None else omega * guessed_shift(ramp, temperature)
    return MeltTest(where, temperature, ramp, curves, rates, np.hypot(storage, loss))


def creeps_in(block: Block, settings: Settings) -> list[MeltTest]:
    """Return the creep of a table, and the recovery in it where there is one: compliance above zero."""
    if block.settings.get("recovery", "0").strip() not in {"", "0"}:
        raise InputError(
            f"{block.place}: the file says that this is a recovery (rec); it can be fitted only in one table with the "
            "creep before it, with the stress in a column"
        )
    time, measured, loaded = _compliance(block, settings)
    good = (time > 0.0) & ((measured > _NO_COMPLIANCE) | ~loaded)
    time, measured, loaded = time[good], measured[good], loaded[good]
    if np.sum(loaded) < LEAST_ROWS:
        raise InputError(f"{block.place}: no three rows under load with a compliance above zero")
    temperature = temperature_of(block, settings)
    where = title_of(block, temperature)
    last = float(time[loaded][-1])
    first = _inert_rows(time[loaded], measured[loaded])
    if np.sum(loaded) - first < LEAST_ROWS:
        raise InputError(f"{block.place}: the compliance rises as the instrument's inertia has it; log for longer")
    note = first and (
        f"{block.place}: up to {time[loaded][first]:.3g} s the compliance rises faster than any melt's, as the "
        f"instrument's inertia makes it: the first {first} rows are left out."
    )
    share = block.share("compliance" if "compliance" in block.columns else "strain")
    creep = _under_load(where, time[loaded][first:], measured[loaded][first:], share)
    curves, own = [creep], []
    if np.sum(~loaded) >= LEAST_ROWS:
        recovery, release = _recovery(where, last, time[~loaded], measured[~loaded])
        curves, own = [creep, recovery], [release]
    blind = "inertia" if first else ""
    return [MeltTest(where, temperature, None, curves, 1.0 / creep.at, 1.0 / creep.measured, note or "", own, blind)]


def _inert_rows(time: Array, compliance: Array) -> int:
    """Return how many first rows rise faster than time, or ring: an instrument's inertia makes that, no melt does.

    A slope counts over a doubling of the time, and where it is more than the scatter of the rows explains.
    """
    x, y = np.log(time), np.log(compliance)
    scatter = float(np.median(np.abs(np.diff(y, 2)))) * _OF_SECOND_DIFFERENCES if len(y) > 4 else 0.0
    first = 0
    for i in range(len(x) - 1):
        later = int(np.searchsorted(x, x[i] + np.log(2.0)))
        if later >= len(x):
            break
        run = x[later] - x[i]
        if y[later] - y[i] > run * (1.0 + _FASTER) + 4.0 * scatter:
            first = later
        elif i > first:
            break
    reach = int(np.searchsorted(x, x[first] + np.log(_RINGING))) if first else 0
    rings = np.flatnonzero(np.diff(y[: reach + 1]) < -5.0 * scatter - _FASTER * _FASTER)
    return max(first, int(rings[-1]) + 2) if len(rings) else first


def _time_of(block: Block) -> str:
    """Return the column of the time: that of the step, where the file has it."""
    return "step_time" if block.complete(["step_time"]) else "time"


def compliance(time: Any, modes: Modes) -> Any:
    """Return strain over stress [1/Pa], a column of expressions, at times [s] after the stress came on."""
    rate = np.log(2.0) / ca.MX(time)
    s = ca.mtimes(rate, ca.DM(np.arange(1.0, motion.TERMS + 1.0)).T)
    viscosity = viscoelasticity.zero_shear_viscosity(modes)
    # 1/(s Q) - 1/(s^2 eta) as one fraction, for the difference cancels at small s
    flow, elastic = 0.0, 0.0
    for tau, modulus in modes:
        part = modulus * tau / (1.0 + s * tau)
        flow, elastic = flow + part, elastic + tau * part
    return rate * ca.mtimes(elastic / (s * flow * viscosity), ca.DM(motion.weights())) + time / viscosity


def _under_load(where: str, time: Array, measured: Array, share: float) -> Channel:
    used = _thinned(time)

    def predicted(modes: Modes, shift: Any, _: Values) -> Any:
        return compliance(ca.DM(time[used]) / shift, modes)

    return Channel(f"compliance of {where}", "1/Pa", measured[used], cast(Any, predicted), time[used], "time", "s",
                   relative=True, step=share, noise_of="compliance", zero_drifts=True)  # fmt: skip


def _recovery(where: str, last: float, time: Array, measured: Array) -> tuple[Channel, Parameter]:
    """Return the rows after the last one under load; the moment of the release lies between, and is an unknown."""
    used = _thinned(time - last)
    time, measured = time[used], measured[used]
    gap = float(time[0]) - last
    release = Parameter(
        f"release of {where}", "s", "Moment at which the stress goes", last + 0.5 * gap, positive=False, scale=gap,
        least=last, most=last + _ALMOST * gap, nuisance=True,
    )  # fmt: skip

    def predicted(modes: Modes, shift: Any, values: Values) -> Any:
        return compliance(ca.DM(time) / shift, modes) - compliance((ca.DM(time) - values[release.name]) / shift, modes)

    return Channel(f"recovery of {where}", "1/Pa", measured, cast(Any, predicted), time, "time", "s",
                   noise_of="recovery"), release  # fmt: skip


def _compliance(block: Block, settings: Settings) -> tuple[Array, Array, Any]:
    """Return time, compliance and whether the stress is on: by columns, or by a stress that is set."""
    value = "compliance" if "compliance" in block.columns else "strain"
    if "stress" in block.columns:
        time, measured, stress = rows_of(block, [_time_of(block), value, "stress"])
        most = float(np.median(np.abs(stress[np.abs(stress) > 0.5 * np.max(np.abs(stress))])))
        loaded = np.abs(stress) > _UNLOADED * most
        last = int(np.flatnonzero(loaded)[-1])
        loaded[: last + 1] = True  # a sample or two while the stress comes on
        return time, measured if value == "compliance" else np.abs(measured) / most, loaded
    time, measured = rows_of(block, [_time_of(block), value])
    if value == "strain":
        of_file = None if "stress" in settings else block.number("stress")
        why = f"as {block.file} has a strain and neither stress nor compliance"
        measured = measured / (of_file or required(settings, "stress", why))
    return time, measured, np.ones(len(time), bool)


def relaxations_in(block: Block, settings: Settings) -> list[MeltTest]:
    """Return the relaxation of a table: rows after the rise, with a modulus above zero."""
    time, modulus, strain = _modulus(block, settings)
    rise, note = settings["rise_time"], ""
    seen = 0.0 if rise else _rise_seen(time, modulus, strain)
    good = (time > rise) & (modulus > 0.0) & (time >= _AFTER_RISE * seen)
    if seen:
        note = (
            f"{block.place}: the strain rises for {seen:.3g} s; rows up to {_AFTER_RISE:g} times that are left out. "
            f"If its rate was constant, --set rise_time='{seen:.3g} s' uses those after the rise."
        )
    if np.sum(good) < (LEAST_ROWS if seen else 1):
        raise InputError(note or f"{block.place}: no row has a time after the rise and a modulus above zero")
    time, modulus = time[good], modulus[good]
    used = _thinned(time)
    time, modulus = time[used], modulus[used]
    temperature = temperature_of(block, settings)
    where = title_of(block, temperature)

    def predicted(modes: Modes, shift: Any, _: Values) -> Any:
        reduced = ca.MX(ca.DM(time)) / shift
        if rise == 0.0:
            return viscoelasticity.relaxation_modulus(reduced, modes)
        # `ramped_stress` at a strain of one, after the rise
        return sum(
            viscoelasticity.relaxation_modulus(reduced - rise / shift, [mode])
            * viscoelasticity.start_up_viscosity(rise / shift, [mode]) / (mode[1] * rise / shift)
            for mode in modes
        )  # fmt: skip

    share = block.share("relaxation_modulus" if "relaxation_modulus" in block.columns else "stress")
    curve = Channel(f"relaxation modulus of {where}", "Pa", modulus, cast(Any, predicted), time, "time", "s",
                    relative=True, step=share, noise_of="relaxation modulus")  # fmt: skip
    return [MeltTest(where, temperature, None, [curve], 1.0 / time, modulus, note, blind="rise" if seen else "")]


def _rise_seen(time: Array, modulus: Array, strain: Array | None) -> float:
    """Return the time [s] in which the strain rises: by its column, or to the largest modulus; 0 where none is seen."""
    if strain is not None:
        size = np.abs(strain)
        risen = int(np.argmax(size > _RISEN * float(np.median(size[len(size) // 2 :]))))
        return float(time[risen]) if risen else 0.0
    smooth = median_filter(modulus, 3, mode="nearest")
    top = int(np.argmax(smooth))
    return float(time[top]) if smooth[0] < _FALLS * smooth[top] else 0.0


def _modulus(block: Block, settings: Settings) -> tuple[Array, Array, Array | None]:
    """Return time, modulus and any strain: the file's modulus, or stress over strain, which may be set."""
    at = _time_of(block)
    if block.complete([at, "strain"]):
        which = "relaxation_modulus" if "relaxation_modulus" in block.columns else "stress"
        time, stress, strain = rows_of(block, [at, which, "strain"])
        most = float(np.median(np.abs(strain[len(strain) // 2 :])))
        return time, stress if which == "relaxation_modulus" else np.abs(stress) / most, strain
    if "relaxation_modulus" in block.columns:
        time, modulus = rows_of(block, [at, "relaxation_modulus"])
        return time, modulus, None
    time, stress = rows_of(block, [at, "stress"])
    why = f"as {block.file} has a stress and neither strain nor modulus"
    return time, stress / required(settings, "strain", why), None


def _thinned(time: Array) -> Any:
    """Return which rows to use: at most `MOST_ROWS`, evenly over the logarithm of time as a melt forgets."""
    if len(time) <= MOST_ROWS:
        return np.arange(len(time))
    wanted = np.geomspace(time[0], time[-1], MOST_ROWS)
    return np.unique(np.searchsorted(time, wanted).clip(0, len(time) - 1))


_TESTS_IN: dict[str, Callable[[Block, Settings], list[MeltTest]]] = {
    "frequency_sweep": sweeps_in,
    "temperature_ramp": ramps_in,
    "creep": creeps_in,
    "relaxation": relaxations_in,
}


def _fit_of(kind: str) -> Callable[..., Measurement]:
    """Return the function that fits tables of one kind together."""

    def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
        tests = [test for block in blocks for test in _TESTS_IN[kind](block, settings)]
        return fit_spectrum(tests, settings, profiles=profiles)

    return measure


frequency_sweep, temperature_ramp, creep, relaxation = map(_fit_of, _TESTS_IN)


def melt(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit any tests of one melt together, each table by its columns. Raises InputError for a table of no kind."""
    tests: list[MeltTest] = []
    kinds = []
    for block in blocks:
        kind = next((name for name in _TESTS_IN if kind_sheets()[name].fits(block)), None)
        if kind is None:
            raise InputError(f"{block.place}: this table is none of {', '.join(_TESTS_IN)}")
        tests += _TESTS_IN[kind](block, {**kind_sheets()[kind].values({}), **settings})
        kinds.append(f"{block.title or block.file} as {kind}")
    return fit_spectrum(tests, settings, profiles=profiles).with_note(f"Fitted together: {'; '.join(kinds)}.")
