"""The log of a module that is heated, and cooled after it: its contacts and losses.

Current and temperatures over time are compared with the heat equation of a study's or a result's module
(`PhaseFunctions`): heating along the equilibrium curve, cooling with the polymer's history. Fitted are the values of
`heat_paths` that the module has, and the temperature of the air. Each interval is gone through in equal steps of
Alexander's method of second order, stiffly stable in two implicit stages; Newton's method solves each, and its
derivatives are those of the implicit function. Source: Alexander, SIAM J. Numer. Anal. 14 (1977) 1006.
"""

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.device import Input
from tvimdesign.device.table import Feature
from tvimdesign.simulation.measurement.fitting.fit import fitted
from tvimdesign.simulation.measurement.fitting.problem import Channel, Parameter, Problem, Values
from tvimdesign.simulation.measurement.measurement import Measurement, Settings, required, resolve_measured, series_of
from tvimdesign.simulation.measurement.reading.data_file import Array, Block
from tvimdesign.simulation.working_cycle.curves import temperature_names
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions
from tvimdesign.simulation.working_cycle.symbols import ca

PLACES = (
    "cold_temperature", "hot_temperature", "near_face_temperature", "far_face_temperature", "rotor_temperature",
    "link_temperature", "housing_temperature", "sink_temperature",
)  # fmt: skip
_ROWS = 25  # Of each of the two phases, that are used
_ON = 0.05  # Share of the largest current below which the module is not heated
_COLD = 3.0  # K: a log begins with everything at one temperature to within this
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
    return [there[name] for name in chosen or heat_inputs(resolved)]


def heat_inputs(resolved: ResolvedModule) -> tuple[str, ...]:
    """Return the contacts and losses that a module has."""

    def has(feature: Feature) -> bool:
        chosen = resolved.values[feature.choice]
        return bool(getattr(chosen, "name", chosen) != feature.without)

    return tuple(row.name for row in resolved.table.inputs
                 if row.record and row.record[0] == "heat_paths" and all(map(has, row.requires)))  # fmt: skip


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


def _course(time: Array, current: Array, file: str) -> "tuple[Course, Array]":
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
    block: Block, module: "LoggedModule", course: "tuple[Course, Array]", seen: Mapping[str, Array], ambient: str
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


_GAMMA = 1.0 - np.sqrt(0.5)
_LONGEST_STEP = 8.0  # s; temperatures are within 0.1 K of CVODES at 1e-8 (test)
_LONGEST_SHARE = 0.15  # Share of the time since the current changed that a step takes at most
_NEWTON: dict[str, Any] = {"linear_solver": "qr", "abstol": 1e-9, "max_iter": 40, "error_on_fail": False}


class Course(NamedTuple):
    """Moments [s] at which the temperatures are wanted, and the current [A] over each interval between two."""

    time: Array
    current: Array
    cooled_from: int  # Interval from which on it cools; as many as there are where it only heats


class LoggedModule:
    """One module with some of its inputs left to be fitted."""

    def __init__(self, resolved: ResolvedModule, names: Sequence[str]) -> None:
        """Take the names of the inputs that are fitted; all others stay what the module has."""
        self._model = resolved.functions
        self._names = list(names)
        self._fitted = ca.SX.sym("fitted", len(names))
        inputs = ca.SX(self._model.start)
        for i, name in enumerate(names):
            inputs[self._model.index[name]] = self._fitted[i]
        self._inputs = ca.Function("inputs", [self._fitted], [inputs])

    def temperatures(self, course: Course, values: Mapping[str, Any]) -> dict[str, Any]:
        """Return temperature [K] by place, a column for the moments of a course; all begins at the ambient one."""
        given = ca.vertcat(*(values[name] for name in self._names))
        heating, cooling = self._model.phases["softening"], self._model.phases["stiffening"]
        inputs, at = self._inputs(given), course.cooled_from
        states = heating.initial(inputs)
        seen = [self._seen(heating, states, course.current[:1], inputs)]
        if at > 0:
            warmed = self._march(heating, states, course.time[: at + 1], course.current[:at], given)
            seen.append(self._seen(heating, warmed, course.current[:at], inputs))
            states = warmed[:, -1]
        if at < len(course.current):
            begin = cooling.begin(states, inputs)
            cooled = self._march(cooling, begin, course.time[at:], course.current[at:], given)
            seen.append(self._seen(cooling, cooled, course.current[at:], inputs))
        every = ca.horzcat(*seen)
        return {place: every[row, :].T for place, row in self.places.items()}

    def _seen(self, phase: PhaseFunctions, states: Any, current: Array, inputs: Any) -> Any:
        count = len(current)
        return phase.temperatures.map(count)(states, ca.DM(current).T, ca.repmat(inputs, 1, count))

    def _march(self, phase: PhaseFunctions, begin: Any, time: Array, current: Array, given: Any) -> Any:
        """Return the states at the end of every interval."""
        lengths = np.diff(time)
        longest = np.minimum(_LONGEST_STEP, _LONGEST_SHARE * (time[1:] - time[0]))
        steps = np.ceil(lengths / longest - 1e-9).astype(int)
        solve = self._stage(phase)
        ends = [0, *(np.flatnonzero(np.diff(steps)) + 1), len(steps)]
        parts = []
        for first, end in pairwise(ends):  # intervals of as many steps together
            interval, part = self._interval(solve, phase.state_size, int(steps[first])), slice(first, end)
            given_there = ca.repmat(given, 1, end - first)
            marched = interval.mapaccum(end - first)(begin, ca.DM(current[part]).T, ca.DM(lengths[part]).T, given_there)
            parts.append(marched)
            begin = marched[:, -1]
        return ca.horzcat(*parts)

    def _stage(self, phase: PhaseFunctions) -> Any:
        """Return the function that solves an implicit stage."""
        size = phase.state_size
        unknown, base = ca.SX.sym("unknown", size), ca.SX.sym("base", size)
        current, step = ca.SX.sym("current"), ca.SX.sym("step")
        rates = phase.rates(unknown, current, self._inputs(self._fitted))
        given = ca.vertcat(base, current, step, self._fitted)
        left = ca.Function("left", [unknown, given], [unknown - base - _GAMMA * step * rates])
        return ca.rootfinder("solve", "fast_newton", left, _NEWTON)

    def _interval(self, solve: Any, size: int, steps: int) -> Any:
        state, now, length = ca.MX.sym("state", size), ca.MX.sym("now"), ca.MX.sym("length")
        fitted = ca.MX.sym("fitted", len(self._names))
        after, part = state, length / steps
        for _ in range(steps):
            first = solve(after, ca.vertcat(after, now, part, fitted))
            base_2 = after + (1.0 - _GAMMA) / _GAMMA * (first - after)
            after = solve(first, ca.vertcat(base_2, now, part, fitted))
        return ca.Function("interval", [state, now, length, fitted], [after])

    @property
    def places(self) -> dict[str, int]:
        """Row of `PhaseFunctions.temperatures` of each place a thermocouple may be at."""
        model, plate = self._model, int(self._model.start[self._model.index["rotor_cells"]])
        names = temperature_names(model, model.start, "softening")
        measured = {
            "cold_temperature": "cold_side", "hot_temperature": "hot_side", "near_face_temperature": "near_face",
            "far_face_temperature": "far_face", "rotor_temperature": f"rotor_{plate}",
            "link_temperature": "core_and_link", "sink_temperature": "sink", "housing_temperature": "housing",
        }  # fmt: skip
        return {name: names.index(place) for name, place in measured.items() if place in names}
