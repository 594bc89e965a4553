"""Calorimeter data as runs: cooled, held or heated, heat flow per mass, exothermic positive."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.kinds.measurement import Settings, rows_of
from tvimdesign.simulation.measurement.reading.data_file import Array, Block

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
    way: str
    """`cooled`, `held` or `heated`."""
    time: Array
    """From the run's start [s]."""
    temperature: Array
    """[K]"""
    heat: Array
    """Heat that the sample gives off [W/kg]; as the file has it until `turned`."""
    step: float = 0.0
    """Step of its last digit [W/kg]."""

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
    sign = _exothermic(runs)
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
        part = slice(begin, end, every)
        name = f"{block.title or block.file}, {way}"
        runs.append(Run(name, way, time[part] - time[begin], temperature[part], heat[part], step))
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


def _exothermic(runs: Sequence[Run]) -> float:
    """Return +1 where the files count heat given off as positive: freezing gives it off, melting takes it up."""
    votes = 0.0
    for run in runs:
        bent = _bent(run)
        peak = float(bent[np.argmax(np.abs(bent))])
        votes += peak if run.way != "heated" else -peak
    return 1.0 if votes >= 0.0 else -1.0
