"""A test of the melt as the fit of its spectrum sees it: temperatures, curves, and where they see the spectrum."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS
from tvimdesign.simulation.measurement.fitting.problem import Parameter
from tvimdesign.simulation.measurement.kinds.measurement import Settings
from tvimdesign.simulation.measurement.reading.data_file import Array, Block

MOST_ROWS = 150
"""Rows of a test in time that are used: an instrument writes thousands, which say no more."""


class Curve(NamedTuple):
    """Values of a test, and what predicts them from a spectrum whose rates are shifted by factors."""

    name: str
    unit: str
    measured: Array
    predicted: Callable[..., Any]
    """From modes and factors, and from the value of `own` where there is one."""
    at: Array
    at_name: str
    at_unit: str
    relative: bool = True
    own: Parameter | None = None
    """An unknown of this curve alone."""


class MeltTest(NamedTuple):
    """One test: its temperature [K], or one for each row of a ramp, its curves, and where it sees the spectrum."""

    name: str
    temperature: float
    ramp: Array | None
    curves: Sequence[Curve]
    rates: Array
    """Angular frequencies, or one over the times [1/s]."""
    sizes: Array
    """Modulus at each of them [Pa], roughly."""


def temperature_of(block: Block, settings: Settings) -> float:
    """Mean temperature of a table [K]: its column's, that of the lines before it, or the one that is set.

    Not a number where nobody says it: tests at one temperature have a spectrum all the same.
    """
    if block.complete(["temperature"]):
        return float(np.nanmean(block.values("temperature")))
    said = block.number("temperature")
    temperature = settings.get("temperature", said)
    return np.nan if temperature is None else float(temperature)


def title_of(block: Block, temperature: float) -> str:
    """A name for a table's channels."""
    title = block.title or block.file
    return title if np.isnan(temperature) else f"{title}, {temperature - ZERO_CELSIUS:.0f} degC"


def thinned(time: Array) -> Any:
    """Which rows to use: at most `MOST_ROWS`, evenly over the logarithm of time as a melt forgets."""
    if len(time) <= MOST_ROWS:
        return np.arange(len(time))
    wanted = np.geomspace(time[0], time[-1], MOST_ROWS)
    return np.unique(np.searchsorted(time, wanted).clip(0, len(time) - 1))
