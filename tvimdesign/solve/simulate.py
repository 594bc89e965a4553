"""One switch simulated: the stack's heat equation through CVODES, until each event has happened or nothing moves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.errors import SimulationError
from tvimdesign.solve.backend import ca
from tvimdesign.solve.model import Model

STEPS = 200  # samples of one stretch of time
TOLERANCE = 1e-9
STALLED = 1e-7  # change of the scaled state over the rest of the horizon below which nothing will happen any more

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Trajectory:
    """The state over time, sampled: `times` [s], `states` one column a time."""

    times: Array
    states: Array

    def at(self, fractions: Array) -> Array:
        """States at fractions of the last time, linearly between the samples."""
        wanted = fractions * self.times[-1]
        return np.array([np.interp(wanted, self.times, row) for row in self.states])


@dataclass(frozen=True)
class Switch:
    """What one switch came to: event and path values by name (infinite where an event never happens)."""

    values: dict[str, float]
    trajectory: Trajectory
    """From the start to `response_time`, or to the end of the simulation if that never happens."""


class Simulator:
    """Simulates switches of one model; the integrator is built once."""

    def __init__(self, model: Model) -> None:
        """Build the integrator: time is scaled by the length of the stretch, integrals ride along as states."""
        self.model = model
        self._integrals = [i for i, row in enumerate(model.paths) if row.reduce == "integral"]
        state = ca.SX.sym("state", model.rates.size1_in(0))
        extra = ca.SX.sym("integrals", len(self._integrals))
        inputs = ca.SX.sym("inputs", len(model.names))
        length = ca.SX.sym("length")
        instant = model.instant(state, inputs)
        paths = [instant[len(model.events) + i] for i in self._integrals]
        rate = length * ca.vertcat(model.rates(state, inputs), *paths)
        self._integrator = ca.integrator(
            "switch",
            "cvodes",
            {"x": ca.vertcat(state, extra), "p": ca.vertcat(inputs, length), "ode": rate},
            0.0,
            np.linspace(0.0, 1.0, STEPS + 1)[1:],
            {"reltol": TOLERANCE, "abstol": TOLERANCE * 1e-2, "max_num_steps": 100_000},
        )
        self._instants = model.instant.map(STEPS + 1)
        self._state_size = state.numel()

    def run(self, inputs: Array) -> Switch:
        """Simulate from the start until every event has happened, nothing changes any more, or the horizon is over."""
        names = [row.name for row in self.model.events]
        found = dict.fromkeys(names, np.inf)
        horizon = float(inputs[self.model.index["horizon"]])
        begin = np.append(np.asarray(self.model.initial(inputs)).ravel(), np.zeros(len(self._integrals)))
        time, length = 0.0, min(60.0, horizon)
        times, states = [np.array([0.0])], [begin[:, None]]
        while time < horizon and not all(np.isfinite(found[name]) for name in names):
            stretch = self._stretch(begin, inputs, length)
            gaps = self._watch(stretch, inputs)[: len(names)]
            for name, gap in zip(names, gaps, strict=True):
                if not np.isfinite(found[name]) and np.any(gap >= 0.0):
                    found[name] = time + self._crossing(stretch, inputs, length, names.index(name), gap)
            times.append(time + length * np.linspace(0.0, 1.0, STEPS + 1)[1:])
            states.append(stretch[:, 1:])
            begin, time = stretch[:, -1], time + length
            rate = np.asarray(self.model.rates(begin[: self._state_size], inputs)).ravel()
            if np.max(np.abs(rate)) * (horizon - time) < STALLED:
                break
            length = min(2.0 * length, horizon - time)
        return self._summary(found, np.concatenate(times), np.concatenate(states, axis=1), inputs)

    def _stretch(self, begin: Array, inputs: Array, length: float) -> Array:
        """States at STEPS + 1 equally spaced times from `begin` over `length` seconds."""
        try:
            after = np.asarray(self._integrator(x0=begin, p=np.append(inputs, length))["xf"])
        except RuntimeError as error:
            reason = str(error).strip().splitlines()[-1]
            raise SimulationError(f"this design's switch cannot be simulated; check its inputs ({reason})") from error
        return np.column_stack([begin, after])

    def _watch(self, stretch: Array, inputs: Array) -> Array:
        count = stretch.shape[1]
        columns = np.repeat(inputs[:, None], count, axis=1)
        return np.asarray(self._instants(stretch[: self._state_size], columns))

    def _crossing(self, stretch: Array, inputs: Array, length: float, event: int, gap: Array) -> float:
        """Time within the stretch at which an event's gap passes zero; looked at closely once, then linear."""
        if gap[0] >= 0.0:
            return 0.0
        first = int(np.argmax(gap >= 0.0))
        step = length / STEPS
        close = self._watch(self._stretch(stretch[:, first - 1], inputs, step), inputs)[event]
        last = max(int(np.argmax(close >= 0.0)), 1)
        share = last - 1 + close[last - 1] / (close[last - 1] - close[last])
        return float((first - 1) * step + share * step / STEPS)

    def _summary(self, found: dict[str, float], times: Array, states: Array, inputs: Array) -> Switch:
        end = min(found["response_time"], times[-1])
        keep = times < end
        last = np.array([[np.interp(end, times, row)] for row in states])
        times, states = np.append(times[keep], end), np.column_stack([states[:, keep], last])
        integrals = iter(states[self._state_size :, -1])
        values: dict[str, Any] = {name: float(time) for name, time in found.items()}
        watched = np.asarray(self.model.instant.map(len(times))(
            states[: self._state_size], np.repeat(inputs[:, None], len(times), axis=1)
        ))  # fmt: skip
        for i, row in enumerate(self.model.paths):
            sampled = watched[len(self.model.events) + i]
            values[row.name] = float(next(integrals) if row.reduce == "integral" else np.max(sampled))
        return Switch(values=values, trajectory=Trajectory(times=times, states=states[: self._state_size]))
