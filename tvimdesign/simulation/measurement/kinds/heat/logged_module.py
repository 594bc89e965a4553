"""A module's own heat equation along the current of a log: temperatures at each moment, with exact derivatives.

The rates are the product's (`PhaseFunctions`): heating along the equilibrium curve, cooling with the polymer's history.
Each interval of the log is gone through in equal steps of Alexander's method of second order, stiffly stable in two
implicit stages; Newton's method solves each, and its derivatives are those of the implicit function. Source: Alexander,
SIAM J. Numer. Anal. 14 (1977) 1006.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tvimdesign.simulation.measurement.reading.data_file import Array
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule

_GAMMA = 1.0 - np.sqrt(0.5)
_LONGEST_STEP = 12.0
"""s; temperatures are within 0.1 K of CVODES at 1e-8 (test)."""
_NEWTON: dict[str, Any] = {"linear_solver": "csparse", "abstol": 1e-9, "max_iter": 40, "error_on_fail": False}


class Course(NamedTuple):
    """Moments [s] at which the temperatures are wanted, and the current [A] over each interval between two."""

    time: Array
    current: Array
    cooled_from: int
    """Interval from which on it cools; as many as there are where it only heats."""


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
        steps = int(np.ceil(float(np.max(lengths)) / _LONGEST_STEP))
        interval = self._interval(phase, steps)
        count = len(lengths)
        return interval.mapaccum(count)(begin, ca.DM(current).T, ca.DM(lengths).T, ca.repmat(given, 1, count))

    def _interval(self, phase: PhaseFunctions, steps: int) -> Any:
        size = phase.state_size
        unknown, base = ca.SX.sym("unknown", size), ca.SX.sym("base", size)
        current, step = ca.SX.sym("current"), ca.SX.sym("step")
        rates = phase.rates(unknown, current, self._inputs(self._fitted))
        given = ca.vertcat(base, current, step, self._fitted)
        left = ca.Function("left", [unknown, given], [unknown - base - _GAMMA * step * rates])
        solve = ca.rootfinder("solve", "fast_newton", left, _NEWTON)
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
        phase, cells = self._model.phases["softening"], self._model.cells
        plate = int(self._model.start[self._model.index["rotor_cells"]])
        beside, around = phase.bodies
        far = 3 + cells
        link = far + plate + beside
        size = phase.temperatures.size1_out(0)
        places = {
            "cold_temperature": 0, "hot_temperature": 1, "near_face_temperature": 2, "far_face_temperature": far,
            "rotor_temperature": far + plate, "link_temperature": link, "housing_temperature": size - 1,
        }  # fmt: skip
        return places | ({"sink_temperature": link + 1} if size - around > link + 1 else {})
