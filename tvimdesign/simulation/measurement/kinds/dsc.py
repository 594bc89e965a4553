"""Calorimetry of a polymer: heat, melting window and freezing kinetics from runs cooled, held and heated.

Freezing is Nakamura's integral of Hoffman and Lauritzen's rate (physics/polymers/transitions.py) along each run's
own temperatures; what is given off is (h_m - h_s) dX/dt beside the heat of the specific heats and a straight baseline.
Melting is the equilibrium curve over its window, straight as the product has it, but with both flanks blurred: crystals
of many sizes and the sample's lag make them so. A blurred flank has the heat of the sharp one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.physics.polymers import polymer, transitions
from tvimdesign.simulation.measurement.fitting.fit import fitted
from tvimdesign.simulation.measurement.fitting.problem import Channel, Derived, Parameter, Problem, Values
from tvimdesign.simulation.measurement.measurement import Measurement, Settings, rows_of
from tvimdesign.simulation.measurement.reading.data_file import Array, Block
from tvimdesign.simulation.working_cycle.symbols import ca

_RECORD = ("latent_heat", "melting_start", "melting_end", "crystallization_half_time", "nucleation_constant",
           "avrami_exponent")  # fmt: skip
_HALF_TIMES = np.geomspace(3.0, 3000.0, 13)  # s
_CONSTANTS = np.geomspace(3e4, 6e5, 11)  # K^2
_EXPONENTS = (0.5, 6.0)  # Range of Avrami's exponent, as of the setting
_STEPS = (0.2, 4.0)  # Range of the step of the specific heat where no mass is known
_NO_MASS = (
    "The heat flow is not per mass, and no file says the sample's: the heat of melting does not follow, all else does. "
    "--set sample_mass='5.2 mg' gives it."
)
_SHARP, _BLURRED = 0.1, 10.0  # K, least and largest width of the logistic that blurs a flank
_SMOOTHING = 500.0  # J/kg, of `Melting`; the equations used here do not depend on it


def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit runs of calorimetry, all together. Raises InputError for what lacks."""
    runs, upwards = runs_of(blocks, settings)
    freezing, melting = [run for run in runs if run.way != "heated"], [run for run in runs if run.way == "heated"]
    per_mass = mass_known(blocks, settings)
    parameters = [
        Parameter("latent_heat", "kJ/kg", "Heat of melting, of the whole sample's mass", TYPICAL_HEAT,
                  nuisance=not per_mass)
    ]  # fmt: skip
    if not per_mass:
        parameters.append(
            Parameter("capacity_step", "1", "Step of the specific heat over what the mass that is taken gives", 1.0,
                      positive=False, least=_STEPS[0], most=_STEPS[1], nuisance=True)
        )  # fmt: skip
    if melting:
        parameters += _window_start(melting)
    if freezing:
        half_time, constant = _freezing_start(freezing, settings)
        parameters += [
            Parameter("crystallization_half_time", "s", "Half-time of freezing at the reference", half_time),
            Parameter("nucleation_constant", "K^2", "K_g of Hoffman and Lauritzen", constant),
        ]
        if "avrami_exponent" not in settings:
            parameters.append(
                Parameter("avrami_exponent", "1", "n of Avrami's law", 3.0, least=_EXPONENTS[0], most=_EXPONENTS[1])
            )
    channels = []
    for i, run in enumerate(runs):
        size = float(np.ptp(run.heat)) or 1.0
        parameters += [
            Parameter(f"base_{i}", "W/kg", "Baseline of a run", float(run.heat[-1]), positive=False, scale=size,
                      nuisance=True),
            Parameter(f"slope_{i}", "W/kg", "Its rise over the run", 0.0, positive=False, scale=size, nuisance=True),
        ]  # fmt: skip
        predicted = (melted if run.way == "heated" else frozen)(run, i, settings)
        channels.append(
            Channel(f"heat of {run.name}", "W/kg", run.heat, predicted, run.temperature,
                    "temperature", "degC", step=run.step)
        )  # fmt: skip
    end = Derived("melting_end", "degC", "Temperature at which melting ends",
                  lambda values: values["melting_start"] + values["melting_width"])  # fmt: skip
    fit = fitted(Problem(parameters, channels, [end] if melting else []), profiles=profiles)
    reported = {estimate.name: estimate for estimate in (*fit.parameters, *fit.derived)}
    values = {name: reported[name] for name in _RECORD if name in reported}
    chosen = {
        "crystallization_reference": (settings["reference_temperature"], "degC"),
        **{name: (settings[name], unit) for name, unit in (
            ("equilibrium_melting_temperature", "degC"), ("glass_transition", "degC"), ("transport_energy", "kJ/mol"),
        )},
    }  # fmt: skip
    notes = [*_notes(runs, upwards), *([] if per_mass else [_NO_MASS])]
    return Measurement(fit, tuple(notes), values, {}, chosen if freezing else {})


def kinetics_of(values: Values, settings: Settings) -> transitions.Kinetics:
    """Return the kinetics with the values that are fitted; the melting time has no part in freezing."""
    return transitions.Kinetics(
        values.get("avrami_exponent", settings.get("avrami_exponent", 3.0)), values["crystallization_half_time"],
        settings["reference_temperature"], values["nucleation_constant"],
        settings["equilibrium_melting_temperature"], settings["glass_transition"], settings["transport_energy"], 0.5,
    )  # fmt: skip


def melting_of(values: Values, settings: Settings) -> polymer.Melting:
    """Return the melting with the values that are fitted."""
    solid, molten = settings["specific_heat_solid"], settings["specific_heat_melt"]
    return polymer.Melting(
        solid, solid + values.get("capacity_step", 1.0) * (molten - solid), values["latent_heat"],
        values.get("melting_start", settings["melting_start"]),
        values["melting_start"] + values["melting_width"] if "melting_width" in values else settings["melting_end"],
        _SMOOTHING,
    )  # fmt: skip


def frozen(run: Run, which: int, settings: Settings) -> Callable[[Values], Any]:
    """Return the heat given off [W/kg] by a run that freezes."""
    steps, temperature = ca.DM(np.diff(run.time)), ca.DM(run.temperature)
    time = ca.DM((run.time - run.time[0]) / (run.time[-1] - run.time[0]))
    rate = 0.0 if run.way == "held" else run.rate

    def predicted(values: Values) -> Any:
        kinetics, melting = kinetics_of(values, settings), melting_of(values, settings)
        constants = transitions.rate_constant(temperature, kinetics)
        psi = ca.vertcat(0.0, ca.cumsum(0.5 * (constants[1:] + constants[:-1]) * steps))
        fraction, slope = _fraction_and_slope(psi, kinetics)
        heat = transitions.enthalpy(temperature, 0.0, melting) - transitions.enthalpy(temperature, 1.0, melting)
        capacity = fraction * melting.specific_heat_solid + (1.0 - fraction) * melting.specific_heat_melt
        base = values[f"base_{which}"] + values[f"slope_{which}"] * time
        return base - (capacity - melting.specific_heat_solid) * rate + heat * slope * constants

    return predicted


def melted(run: Run, which: int, settings: Settings) -> Callable[[Values], Any]:
    """Return the heat given off [W/kg] by a run that melts: negative."""
    time = ca.DM((run.time - run.time[0]) / (run.time[-1] - run.time[0]))

    temperature = ca.DM(run.temperature)

    def predicted(values: Values) -> Any:
        melting = melting_of(values, settings)
        molten, rises = 0.0, 0.0
        for sign, edge, blur in ((1.0, melting.start, "blur_start"), (-1.0, melting.end, "blur_end")):
            width = values.get(blur, _SHARP)
            away = (temperature - edge) / width
            molten += sign * width * (np.fmax(away, 0.0) + np.log1p(np.exp(-np.fabs(away))))
            rises += sign * 0.5 * (1.0 + np.tanh(0.5 * away))
        width = melting.end - melting.start
        melts = molten / width * (melting.specific_heat_melt - melting.specific_heat_solid) * run.rate
        base = values[f"base_{which}"] + values[f"slope_{which}"] * time
        return base - melts - melting.latent_heat * rises / width * run.rate

    return predicted


def _fraction_and_slope(psi: Any, kinetics: transitions.Kinetics) -> tuple[Any, Any]:
    """Return X(psi) and dX/dpsi, the exact derivative of the product's equation."""
    reduced, exponent = ca.MX.sym("psi", psi.shape[0]), ca.MX.sym("n")
    fraction = transitions.solid_fraction(reduced, kinetics._replace(avrami_exponent=exponent))
    slope = ca.jtimes(fraction, reduced, ca.DM.ones(psi.shape[0]))
    return tuple(ca.Function("both", [reduced, exponent], [fraction, slope])(psi, kinetics.avrami_exponent))


def _window_start(runs: Sequence[Run]) -> list[Parameter]:
    """Return start and width of the window, from the half-height of the melting peak, and the blur of its flanks."""
    run = max(runs, key=lambda candidate: float(np.ptp(candidate.heat)))
    down = np.interp(run.time, run.time[[0, -1]], run.heat[[0, -1]]) - run.heat
    inside = run.temperature[down > 0.4 * np.max(down)]
    width = max(float(inside[-1] - inside[0]), 1.0)
    return [
        Parameter("melting_start", "degC", "Temperature at which melting begins", float(inside[0]), positive=False,
                  scale=width),
        Parameter("melting_width", "K", "Width of the melting window", width),
        *(Parameter(name, "K", "Blur of a flank of the peak", 0.1 * width, least=_SHARP, most=_BLURRED, nuisance=True)
          for name in ("blur_start", "blur_end")),
    ]  # fmt: skip


def _freezing_start(runs: Sequence[Run], settings: Settings) -> tuple[float, float]:
    """Return half-time [s] and K_g [K^2] of least misfit, baseline and heat of each run being whatever suits it best.

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
            kinetics = kinetics_of({"crystallization_half_time": half_time, "nucleation_constant": constant}, settings)
            best = min(best, (sum(_misfit(run, kinetics) for run in runs), float(half_time), float(constant)))
    return best[1], best[2]


def _misfit(run: Run, kinetics: transitions.Kinetics) -> float:
    """Return the squares left of a run's heat, over what they are about their mean."""
    constants = transitions.rate_constant(run.temperature, kinetics)
    psi = np.concatenate([[0.0], np.cumsum(0.5 * (constants[1:] + constants[:-1]) * np.diff(run.time))])
    freezing: Array = np.gradient(transitions.solid_fraction(psi, kinetics), run.time)
    table = np.column_stack([np.ones_like(freezing), run.time / run.time[-1], freezing])
    weights = np.linalg.lstsq(table, run.heat, rcond=None)[0]
    if weights[2] <= 0.0:
        table, weights = table[:, :2], np.linalg.lstsq(table[:, :2], run.heat, rcond=None)[0]
    return float(np.sum((run.heat - table @ weights) ** 2) / np.sum((run.heat - np.mean(run.heat)) ** 2))


def _notes(runs: Sequence[Run], upwards: bool) -> list[str]:
    ways = ", ".join(
        f"held at {np.mean(run.temperature) - polymer.ZERO_CELSIUS:.1f} degC"
        if run.way == "held"
        else f"{run.way} at {abs(run.rate) * 60.0:.1f} K/min"
        for run in runs
    )
    cooled = {round(abs(run.rate) * 60.0, 1) for run in runs if run.way == "cooled"}
    held = [run for run in runs if run.way == "held"]
    notes = [f"Runs: {ways}. Heat that is given off is taken as {'positive' if upwards else 'negative'} in the files."]
    if len(cooled) + len(held) == 1:
        notes.append("One rate of cooling hardly tells half-time and nucleation constant apart; measure a second one.")
    return notes


_LEAST_RATE = 0.2 / 60.0  # K/s; slower is held
_LEAST_SPAN = 10.0  # K; what changes less while it is heated or cooled is on its way to a hold
_LEAST_ROWS = 20
_MOST_ROWS = 300
_WINDOW = 9
TYPICAL_HEAT = 70e3  # J/kg


@dataclass(frozen=True)
class Run:
    """A part of a measurement at one rate of the temperature."""

    name: str
    way: str  # `cooled`, `held` or `heated`
    time: Array  # From the run's start [s]
    temperature: Array  # [K]
    heat: Array  # Heat that the sample gives off [W/kg]; as the file has it until `turned`
    step: float = 0.0  # Step of its last digit [W/kg]

    @property
    def rate(self) -> float:
        """Rate of the temperature [K/s]."""
        return float((self.temperature[-1] - self.temperature[0]) / (self.time[-1] - self.time[0]))


def runs_of(blocks: Sequence[Block], settings: Settings) -> tuple[list[Run], bool]:
    """Return all runs, exothermic positive, and whether the files have it so. Raises InputError.

    Where no mass is known, heat is per the mass that would have `TYPICAL_HEAT`.
    """
    runs = [run for block in blocks for run in _runs(block, settings)]
    if runs and not mass_known(blocks, settings):
        mass = max(float(np.trapezoid(np.abs(_bent(run)), run.time)) for run in runs) / TYPICAL_HEAT
        runs = [replace(run, heat=run.heat / (mass or 1.0), step=run.step / (mass or 1.0)) for run in runs]
    if not runs:
        raise InputError("no part of the data is cooled, held or heated for long enough to be fitted")
    peaks = [float(bent[np.argmax(np.abs(bent))]) for bent in map(_bent, runs)]
    votes = sum(-peak if run.way == "heated" else peak for run, peak in zip(runs, peaks, strict=True))
    sign = 1.0 if votes >= 0.0 else -1.0  # freezing gives heat off, melting takes it up
    return [replace(run, heat=sign * run.heat) for run in runs], sign > 0.0


def _runs(block: Block, settings: Settings) -> list[Run]:
    which = "specific_heat_flow" if "specific_heat_flow" in block.columns else "heat_flow"
    time, temperature, heat = _at_new_times(block, which)
    if len(time) < _LEAST_ROWS:
        return []
    mass = (_mass(block, settings) or 1.0) if which == "heat_flow" else 1.0
    heat, step = heat / mass, block.step(which) / mass
    rates = np.gradient(temperature, time)
    smooth = np.convolve(np.pad(rates, _WINDOW // 2, mode="edge"), np.ones(_WINDOW) / _WINDOW, mode="valid")
    threshold = max(_LEAST_RATE, 0.2 * float(np.median(np.abs(smooth))))
    kinds = np.where(smooth < -threshold, -1, np.where(smooth > threshold, 1, 0))
    edges = [0, *(np.flatnonzero(np.diff(kinds)) + 1), len(kinds)]
    runs = []
    for begin, end in pairwise(edges):
        way = {-1: "cooled", 0: "held", 1: "heated"}[int(kinds[begin])]
        span = float(np.ptp(temperature[begin:end]))
        if end - begin < _LEAST_ROWS or (way != "held" and span < _LEAST_SPAN):
            continue
        every = -(-(end - begin) // _MOST_ROWS)
        rows = [column[begin : end - (end - begin) % every] for column in (time - time[begin], temperature, heat)]
        seconds, kelvins, heats = (column.reshape(-1, every).mean(axis=1) for column in rows)
        runs.append(Run(f"{block.title or block.file}, {way}", way, seconds, kelvins, heats, step))
    return runs


def _at_new_times(block: Block, which: str) -> list[Array]:
    """Return time, temperature and heat; of rows whose rounded times are the same the first. Raises InputError."""
    columns = rows_of(block, ["time", "temperature", which])
    steps = np.diff(columns[0])
    if np.any(steps < 0.0):
        raise InputError(f"{block.place}: time falls from one row to the next")
    new = np.append(True, steps > 0.0)
    return [column[new] for column in columns]


def _mass(block: Block, settings: Settings) -> float | None:
    mass = settings.get("sample_mass", block.number("sample_mass"))
    return None if mass is None else float(mass)


def mass_known(blocks: Sequence[Block], settings: Settings) -> bool:
    """Return whether the heat of tables is per mass. Raises InputError where that of some is."""
    known = ["specific_heat_flow" in block.columns or _mass(block, settings) is not None for block in blocks]
    if any(known) and not all(known):
        place = blocks[known.index(False)].place
        raise InputError(f"{place}: the heat flow is not per mass, as in the others; say --set sample_mass='5.2 mg'")
    return all(known)


def _bent(run: Run) -> Array:
    """Return the heat above the line between its ends."""
    return np.asarray(run.heat - np.interp(run.time, run.time[[0, -1]], run.heat[[0, -1]]))
