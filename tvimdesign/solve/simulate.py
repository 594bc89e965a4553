"""The working cycle simulated, stage after stage: the heat equation through CVODES until every event is found."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.errors import SimulationError
from tvimdesign.solve.backend import ca
from tvimdesign.solve.drive import Drive
from tvimdesign.solve.model import Model
from tvimdesign.solve.stage_model import StageModel

STEPS = 200  # samples of one stretch of time
TOLERANCE = 1e-9
STALLED = 1e-7  # change of the scaled state over the rest of the horizon below which nothing will happen any more

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Trajectory:
    """A stage over time, sampled: `times` [s], `states` one column a time, `currents` [A]."""

    times: Array
    states: Array
    currents: Array

    def at(self, fractions: Array) -> Array:
        """States at fractions of the last time, linearly between the samples."""
        wanted = fractions * self.times[-1]
        return np.array([np.interp(wanted, self.times, row) for row in self.states])


@dataclass(frozen=True)
class Switch:
    """What the cycle came to: event, path and steady values by name (infinite where something never happens)."""

    values: dict[str, float]
    trajectories: dict[str, Trajectory]
    """By stage, each from its start to the event that ends it, or as far as it goes if that never happens."""
    balances: dict[str, Array]
    """By stage, state and current that stay where the stage ended; none where there is no such state."""

    @property
    def trajectory(self) -> Trajectory:
        """The first stage."""
        return next(iter(self.trajectories.values()))


class Simulator:
    """Simulates the working cycle of one model; each stage's integrator is built once, when it is first needed."""

    def __init__(self, model: Model) -> None:
        """Nothing is built yet."""
        self.model = model
        self._stages: dict[str, _StageSimulator] = {}

    def run(
        self, inputs: Array, drives: Mapping[str, Drive] | None = None, stages: Collection[str] | None = None
    ) -> Switch:
        """Simulate the named stages (all unless given) and those they start from; the rest has infinite values.

        `drives` are currents by stage where they are not the constant ones of the inputs.
        """
        values = dict.fromkeys(self.model.switch_names, np.inf)
        trajectories: dict[str, Trajectory] = {}
        balances: dict[str, Array] = {}
        for name, stage_model in self.model.stages.items():
            stage = stage_model.stage
            if stages is not None and name not in self._with_earlier(stages):
                continue
            before = trajectories.get(stage.after) if stage.after else None
            if stage.after and (before is None or not np.isfinite(values[self.model.stages[stage.after].stage.ends])):
                continue
            drive = (drives or {}).get(name) or self.constant_drive(name, inputs)
            simulator = self._stage(name)
            found, trajectories[name] = simulator.run(inputs, drive, before.states[:, -1] if before else None)
            values |= found
            balance = simulator.balance(inputs, trajectories[name]) if np.isfinite(found[stage.ends]) else None
            if balance is not None:
                balances[name] = balance
                values |= simulator.steady_values(inputs, balance)
        return Switch(values, trajectories, balances)

    def constant_drive(self, stage: str, inputs: Array) -> Drive:
        """The constant current the inputs ask for in a stage."""
        row = self.model.stages[stage].stage
        return Drive.constant(row.sign * float(inputs[self.model.index[row.drive]]))

    def _with_earlier(self, stages: Collection[str]) -> set[str]:
        wanted = set(stages)
        for name in reversed(self.model.stages):
            after = self.model.stages[name].stage.after
            if name in wanted and after:
                wanted.add(after)
        return wanted

    def _stage(self, name: str) -> _StageSimulator:
        if name not in self._stages:
            self._stages[name] = _StageSimulator(self.model, self.model.stages[name])
        return self._stages[name]


class _StageSimulator:
    """Simulates one stage. Time is scaled by the length of a stretch; integrals ride along as states."""

    def __init__(self, model: Model, stage: StageModel) -> None:
        self.model = model
        self.stage = stage
        self._integrals = [row.name for row in stage.paths if row.reduce == "integral"]
        state = ca.SX.sym("state", stage.state_size)
        extra = ca.SX.sym("integrals", len(self._integrals))
        inputs = ca.SX.sym("inputs", len(model.names))
        length, first, last, time = (ca.SX.sym(name) for name in ("length", "first", "last", "time"))
        drive = first + (last - first) * time
        paths = stage.watch(self._integrals)(state, drive, inputs)
        self._integrator = ca.integrator(
            stage.stage.name,
            "cvodes",
            {
                "x": ca.vertcat(state, extra),
                "p": ca.vertcat(inputs, length, first, last),
                "t": time,
                "ode": length * ca.vertcat(stage.rates(state, drive, inputs), paths),
            },
            0.0,
            np.linspace(0.0, 1.0, STEPS + 1)[1:],
            {
                "reltol": TOLERANCE,
                "abstol": TOLERANCE * 1e-2,
                "max_num_steps": 100_000,
                # A stage that cannot be simulated raises; what CVODES and CasADi say meanwhile is not for people.
                "show_eval_warnings": False,
                "disable_internal_warnings": True,
            },
        )
        self._events = [row.name for row in stage.events]
        self._watched = stage.watch([row.name for row in (*stage.events, *stage.paths)])
        self._of_stretch = self._watched.map(STEPS + 1)

    def run(self, inputs: Array, drive: Drive, before: Array | None) -> tuple[dict[str, float], Trajectory]:
        """Simulate until every event has happened, nothing changes any more, or the horizon is over."""
        found = dict.fromkeys(self._events, np.inf)
        horizon = float(inputs[self.model.index["horizon"]])
        start = self.stage.initial(inputs) if before is None else self.stage.begin(before, inputs)
        begin = np.append(np.asarray(start).ravel(), np.zeros(len(self._integrals)))
        time, length = 0.0, min(60.0, horizon)
        times, states = [np.array([0.0])], [begin[:, None]]
        while time < horizon and not all(np.isfinite(found[name]) for name in self._events):
            length = min(length, drive.next_corner(time) - time, horizon - time)
            currents = drive.at(time + length * np.linspace(0.0, 1.0, STEPS + 1))
            stretch = self._stretch(begin, inputs, length, currents)
            gaps = self._gaps(stretch, inputs, currents)
            for name, gap in zip(self._events, gaps, strict=True):
                if not np.isfinite(found[name]) and np.any(gap >= 0.0):
                    found[name] = time + self._crossing(
                        stretch, inputs, length, currents, self._events.index(name), gap
                    )
            times.append(time + length * np.linspace(0.0, 1.0, STEPS + 1)[1:])
            states.append(stretch[:, 1:])
            begin, time = stretch[:, -1], time + length
            rate = np.asarray(self.stage.rates(begin[: self.stage.state_size], currents[-1], inputs)).ravel()
            constant = np.isinf(drive.next_corner(time))
            if constant and np.max(np.abs(rate)) * (horizon - time) < STALLED:
                break
            length = 2.0 * length if constant else np.inf
        return self._summary(found, np.concatenate(times), np.concatenate(states, axis=1), inputs, drive)

    def _stretch(self, begin: Array, inputs: Array, length: float, currents: Array) -> Array:
        """States at STEPS + 1 equally spaced times from `begin` over `length` seconds; the current runs straight."""
        parameters = np.append(inputs, [length, currents[0], currents[-1]])
        try:
            after = np.asarray(self._integrator(x0=begin, p=parameters)["xf"])
        except RuntimeError as error:
            reason = str(error).strip().splitlines()[-1]
            raise SimulationError(
                f"the {self.stage.stage.name} of this design cannot be simulated; check its inputs ({reason})"
            ) from error
        return np.column_stack([begin, after])

    def _gaps(self, stretch: Array, inputs: Array, currents: Array) -> Array:
        columns = np.repeat(inputs[:, None], stretch.shape[1], axis=1)
        watched = np.asarray(self._of_stretch(stretch[: self.stage.state_size], currents[None, :], columns))
        return watched[: len(self._events)]

    def _crossing(self, stretch: Array, inputs: Array, length: float, currents: Array, event: int, gap: Array) -> float:
        """Time within the stretch at which an event's gap passes zero; looked at closely once, then linear."""
        if gap[0] >= 0.0:
            return 0.0
        first = int(np.argmax(gap >= 0.0))
        step = length / STEPS
        within = np.linspace(currents[first - 1], currents[first], STEPS + 1)
        close = self._gaps(self._stretch(stretch[:, first - 1], inputs, step, within), inputs, within)[event]
        last = max(int(np.argmax(close >= 0.0)), 1)
        share = last - 1 + close[last - 1] / (close[last - 1] - close[last])
        return float((first - 1) * step + share * step / STEPS)

    def _summary(
        self, found: dict[str, float], times: Array, states: Array, inputs: Array, drive: Drive
    ) -> tuple[dict[str, float], Trajectory]:
        end = min(found[self.stage.stage.ends], times[-1])
        keep = times < end
        last = np.array([[np.interp(end, times, row)] for row in states])
        times, states = np.append(times[keep], end), np.column_stack([states[:, keep], last])
        size = self.stage.state_size
        trajectory = Trajectory(times=times, states=states[:size], currents=drive.at(times))
        values: dict[str, Any] = {name: float(time) for name, time in found.items()}
        columns = np.repeat(inputs[:, None], len(times), axis=1)
        watched = np.asarray(self._watched.map(len(times))(trajectory.states, trajectory.currents[None, :], columns))[
            len(self._events) :
        ]
        integrals = dict(zip(self._integrals, states[size:, -1], strict=True))
        for row, sampled in zip(self.stage.paths, watched, strict=True):
            values[row.name] = float(integrals.get(row.name, np.max(sampled)))
        return values, trajectory

    @cached_property
    def _balance(self) -> Any:
        """The function (state and current, inputs) -> zero where everything stays with the ending event at zero."""
        size = self.stage.state_size
        unknowns = ca.SX.sym("unknowns", size + 1)
        inputs = ca.SX.sym("inputs", len(self.model.names))
        state, drive = unknowns[:size], unknowns[size]
        gap = self.stage.watch([self.stage.stage.ends])(state, drive, inputs)
        equations = ca.vertcat(self.stage.rates(state, drive, inputs), gap)
        return ca.rootfinder("balance", "newton", ca.Function("balance", [unknowns, inputs], [equations]))

    def balance(self, inputs: Array, trajectory: Trajectory) -> Array | None:
        """State and current that stay where the stage ended; None where the stage has no use of it or none exists."""
        if not self.stage.steadies:
            return None
        begin = np.append(trajectory.states[:, -1], trajectory.currents[-1])
        try:
            return np.asarray(self._balance(begin, inputs)).ravel()
        except RuntimeError:  # Newton finds none: with such a cold side there is none
            return None

    def steady_values(self, inputs: Array, balance: Array) -> dict[str, float]:
        """Values of the steady rows."""
        names = [row.name for row in self.stage.steadies]
        numbers = np.asarray(self.stage.watch(names)(balance[:-1], balance[-1], inputs)).ravel()
        return dict(zip(names, (float(number) for number in numbers), strict=True))
