"""The log of a module that is heated, and cooled after it: its contacts and losses.

Current and temperatures over time are compared with the module's own heat equation (`logged_module`) of a study or a
result; what is fitted are the values of `heat_paths` that the module has, and the temperature of the air.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.device import Input
from tvimdesign.device.table.quantity import Feature
from tvimdesign.simulation.measurement.fitting.fit import fitted
from tvimdesign.simulation.measurement.fitting.problem import Channel, Parameter, Problem, Values
from tvimdesign.simulation.measurement.kinds.heat.logged_module import Course, LoggedModule
from tvimdesign.simulation.measurement.kinds.measurement import (
    Measurement,
    Settings,
    required,
    resolve_measured,
    series_of,
)
from tvimdesign.simulation.measurement.reading.data_file import Array, Block
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule

PLACES = (
    "cold_temperature", "hot_temperature", "near_face_temperature", "far_face_temperature", "rotor_temperature",
    "link_temperature", "housing_temperature", "sink_temperature",
)  # fmt: skip
_ROWS = 25
"""Of each of the two phases, that are used."""
_ON = 0.05
"""Share of the largest current below which the module is not heated."""
_COLD = 3.0
"""K: a log begins with everything at one temperature to within this."""
_AMBIENT = "ambient_temperature"


def measure(blocks: Sequence[Block], settings: Settings, *, profiles: bool = True) -> Measurement:
    """Fit logs of one module, together. Raises InputError for what lacks."""
    source = Path(required(settings, "study", "the study, or a result's design.json, of the module that was logged"))
    resolved = resolve_measured(source)
    rows = _rows(resolved, settings)
    module = LoggedModule(resolved, [*(row.name for row in rows), _AMBIENT])
    parameters = [
        Parameter(row.name, row.unit, row.description, float(resolved.values[row.name]), least=row.lower,
                  most=row.upper, profiled=False)
        for row in rows
    ]  # fmt: skip
    channels: list[Channel] = []
    for i, block in enumerate(blocks):
        end = "" if len(blocks) == 1 else f"_{i + 1}"
        time, current, seen = _log(block)
        air = float(np.mean([temperatures[0] for temperatures in seen.values()]))
        parameters.append(
            Parameter(_AMBIENT + end, "degC", "Temperature of the air", air, positive=False, scale=1.0, profiled=False)
        )
        channels += _channels(block, module, _course(time, current, block.file), seen, _AMBIENT + end)
    fit = fitted(Problem(parameters, channels), profiles=profiles)
    known = {row.name: fit[row.name] for row in rows}
    return Measurement(fit, tuple(_notes(rows, channels, source)), known)


def _rows(resolved: ResolvedModule, settings: Settings) -> list[Input]:
    """Return the inputs that are fitted: those named, or all of `heat_paths` that count for the module."""
    there = {row.name: row for row in resolved.table.inputs if row.record and row.record[0] == "heat_paths"}
    chosen = settings.get("fitted", "").replace(",", " ").split()
    for name in chosen:
        if name not in there:
            raise InputError(f"--set fitted: {name[:40]} is no contact or loss of such a module; {', '.join(there)}")
    counting = [name for name, row in there.items() if all(_has(resolved, requirement) for requirement in row.requires)]
    return [there[name] for name in chosen or counting]


def _has(resolved: ResolvedModule, feature: Feature) -> bool:
    chosen = resolved.values[feature.choice]
    return bool(getattr(chosen, "name", chosen) != feature.without)


def _log(block: Block) -> tuple[Array, Array, dict[str, Array]]:
    """Return time from zero, current, and the temperatures that are there, at most so many rows. Raises InputError."""
    places = [name for name in PLACES if name in block.columns]
    time, current, *seen = series_of(block, ["time", "current", *places])
    where = f"{block.place}"
    first = [temperatures[0] for temperatures in seen]
    if np.ptp(first) > _COLD:
        raise InputError(
            f"{where}: the temperatures of the first row differ by {np.ptp(first):.1f} K; a log begins with a module "
            "that has stood in the air until all of it is as warm"
        )
    return time - time[0], current, dict(zip(places, seen, strict=True))


def _course(time: Array, current: Array, file: str) -> tuple[Course, Array]:
    """Return what is gone through, and the rows of the log at its moments. Raises InputError for a second heating."""
    on = current > _ON * np.max(current)
    last = int(np.flatnonzero(on)[-1]) + 1 if np.any(on) else 0
    first = int(np.argmax(on))
    if not np.all(on[first:last]) or last == 0:
        raise InputError(f"{file}: a log holds one heating, and the cooling after it where there is one; divide it")
    last = min(last, len(time) - 1)
    rows = np.unique(np.concatenate([_crowded(0, last), _crowded(last, len(time) - 1)]))
    charge = np.concatenate([[0.0], np.cumsum(current[:-1] * np.diff(time))])  # each row's current until the next
    mean = np.diff(charge[rows]) / np.diff(time[rows])
    return Course(time[rows], mean, int(np.searchsorted(rows, last))), rows


def _crowded(first: int, last: int) -> Any:
    """Return rows from one to another, the denser the nearer the first, as temperatures change most then."""
    return first + np.round(np.linspace(0.0, 1.0, _ROWS) ** 2 * (last - first)).astype(int)


def _channels(
    block: Block, module: LoggedModule, course: tuple[Course, Array], seen: Mapping[str, Array], ambient: str
) -> list[Channel]:
    moments, rows = course
    inputs_kept: list[tuple[Values, dict[str, Any]]] = []

    def all_of(values: Values) -> dict[str, Any]:
        # the same symbols ask for every column: gone through once
        if not inputs_kept or inputs_kept[0][0] is not values:
            inputs_kept[:] = [(values, module.temperatures(moments, {**values, _AMBIENT: values[ambient]}))]
        return inputs_kept[0][1]

    def predicted(place: str) -> Callable[[Values], Any]:
        return lambda values: all_of(values)[place]

    missing = [place for place in seen if place not in module.places]
    if missing:
        raise InputError(f"{block.file}: {', '.join(missing)}: the module of the study has no such place")
    return [
        Channel(f"{place.replace('_', ' ')} of {block.file}", "degC", values[rows], predicted(place), moments.time,
                "time", "s", step=block.step(place), noise_of="temperature")
        for place, values in seen.items()
    ]  # fmt: skip


def _notes(rows: Sequence[Input], channels: Sequence[Channel], source: Path) -> list[str]:
    notes = [
        f"The module is that of {source.name}: sizes, materials and pads are taken from it as they are. What they are "
        "off by counts as contact or loss here."
    ]
    if len(channels) < len(rows):
        notes.append(
            f"{len(rows)} values from {len(channels)} places: a thermocouple at another place tells more of them apart."
        )
    return notes
