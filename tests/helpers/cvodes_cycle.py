"""Another simulator of the working cycle, which judges the product's: CVODES over each phase, scipy for its events."""

import contextlib
from collections.abc import Collection, Mapping
from functools import cached_property
from typing import Any

import numpy as np
from scipy.optimize import brentq, root

from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.cycle import Array, Cycle, Trajectory
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions
from tvimdesign.simulation.working_cycle.symbols import ca

FIRST_STRETCH = 120.0  # s; each after it is twice as long


class CvodesSimulator:
    """Simulates the working cycle of one model, phase after phase."""

    def __init__(self, model: DeviceFunctions, tolerance: float, steps: int) -> None:
        self.model, self._tolerance, self._steps = model, tolerance, steps
        self._phases: dict[str, _Phase] = {}

    def run(
        self, inputs: Array, profiles: Mapping[str, CurrentProfile] | None = None, phases: Collection[str] | None = None
    ) -> Cycle:
        """Simulate the named phases, or all."""
        values, trajectories = dict.fromkeys(self.model.switch_names, np.inf), dict[str, Trajectory]()
        balances: dict[str, Array] = {}
        for name, functions in self.model.phases.items():
            row = functions.phase
            if phases is not None and name not in phases:
                continue
            if row.after and not np.isfinite(values[self.model.phases[row.after].phase.ends]):
                continue
            phase = self._phase(name)
            before = trajectories[row.after].states[:, -1] if row.after else None
            profile = (profiles or {}).get(row.like or name) or self._constant(name, inputs)
            ends, trajectories[name] = phase.run(inputs, profile, before, float(inputs[self.model.index["horizon"]]))
            values |= ends
            if np.isfinite(ends[row.ends]) and functions.steadies:
                balance = phase.balance(inputs, trajectories[name])
                if balance is not None:
                    balances[name] = balance
                    steady = [function.name for function in functions.steadies]
                    values |= zip(steady, phase.seen(steady, balance[:-1], balance[-1:], inputs)[:, 0], strict=True)
        return Cycle(values, trajectories, balances)

    def trace(
        self, name: str, inputs: Array, before: Array | None, end: float, current: float | None = None
    ) -> Trajectory:
        """Return a phase at a constant current for `end` seconds, whatever happens in it."""
        profile = self._constant(name, inputs) if current is None else CurrentProfile.constant(current)
        phase = self._phase(name)
        times = end * phase.shares
        states = phase.stretch(phase.start(inputs, before), inputs, end, profile.at(times))
        return Trajectory(times, states[: phase.size], profile.at(times))

    def _constant(self, name: str, inputs: Array) -> CurrentProfile:
        row = self.model.phases[name].phase
        return CurrentProfile.constant(row.sign * float(inputs[self.model.index[row.current_input]]))

    def _phase(self, name: str) -> "_Phase":
        if name not in self._phases:
            self._phases[name] = _Phase(self.model.phases[name], self._tolerance, self._steps)
        return self._phases[name]


class _Phase:
    """One phase; integrals ride along as states, and time is scaled by the length of a stretch."""

    def __init__(self, phase: PhaseFunctions, tolerance: float, steps: int) -> None:
        self.phase, self.size, self.shares = phase, phase.state_size, np.linspace(0.0, 1.0, steps + 1)
        self._integrals, self._peaks, self._last = (
            [row.name for row in phase.paths if row.reduce == kind] for kind in ("integral", "maximum", "end")
        )
        self._events = [row.name for row in phase.events]
        names = ("length", "first", "last", "time")
        state, inputs = ca.SX.sym("state", self.size), ca.SX.sym("inputs", phase.rates.size1_in(2))
        length, first, last, time = (ca.SX.sym(name) for name in names)
        at = (state, first + (last - first) * time, inputs)
        ode = ca.vertcat(phase.rates(*at), phase.watch(self._integrals)(*at))
        value, changing, constants = ca.extract_parametric(ca.cse(ode), inputs)
        self._constants = ca.Function("constants", [inputs], [ca.vertcat(*constants)])
        p = ca.vertcat(inputs, *changing, length, first, last)
        x = ca.vertcat(state, ca.SX.sym("integrals", len(self._integrals)))
        self._integrator = ca.integrator(
            "phase", "cvodes", {"x": x, "p": p, "t": time, "ode": length * value}, 0.0, self.shares[1:],
            {"reltol": tolerance, "abstol": 1e-2 * tolerance, "max_num_steps": 10_000},
        )  # fmt: skip

    def run(
        self, inputs: Array, profile: CurrentProfile, before: Array | None, horizon: float
    ) -> tuple[dict[str, float], Trajectory]:
        """Values of the phase and its trajectory, until every event has happened or the horizon is over."""
        time, length, begin = 0.0, FIRST_STRETCH, self.start(inputs, before)
        times, states, watched = (
            [np.zeros(1)],
            [begin[:, None]],
            [self._watch(begin[:, None], profile.at(np.zeros(1)), inputs)],
        )
        happened = np.zeros(len(self._events), bool)
        while time < horizon and not all(happened):
            length = min(length, profile.next_corner(time) - time, horizon - time)
            moments = time + length * self.shares
            piece = self.stretch(begin, inputs, length, profile.at(moments))
            times.append(moments[1:])
            states.append(piece[:, 1:])
            watched.append(self._watch(piece[:, 1:], profile.at(moments[1:]), inputs))
            happened |= np.any(watched[-1][: len(happened)] >= 0.0, axis=1)
            begin, time, length = piece[:, -1], moments[-1], max(2.0 * length, FIRST_STRETCH)
        return self._summary(inputs, profile, np.concatenate(times), np.hstack(states), np.hstack(watched))

    def _summary(
        self, inputs: Array, profile: CurrentProfile, times: Array, states: Array, watched: Array
    ) -> tuple[dict[str, float], Trajectory]:
        values = dict.fromkeys((*self._events, *self._integrals, *self._last), np.inf)
        reached: Array | None = None
        for i, name in enumerate(self._events):
            if np.any(watched[i] >= 0.0):
                k = int(np.argmax(watched[i] >= 0.0))
                values[name], state = self._crossing(inputs, profile, times, states, k, i) if k else (0.0, states[:, 0])
                if name == self.phase.phase.ends:
                    end, reached = values[name], state
        if reached is not None:
            keep = times < end
            times, states = np.append(times[keep], end), np.column_stack([states[:, keep], reached])
            watched = np.column_stack([watched[:, keep], self._watch(reached[:, None], profile.at(times[-1:]), inputs)])
            values |= zip(self._integrals, states[self.size :, -1], strict=True)
            values |= zip(self._last, self.seen(self._last, reached, profile.at(times[-1:]), inputs)[:, 0], strict=True)
        for i, name in enumerate(self._peaks, start=len(self._events)):
            k = int(np.argmax(watched[i]))
            values[name] = watched[i, k]
            for first in (k - 1, k) if 0 < k < len(times) - 1 else ():  # a cold side peaks within seconds
                moments = times[first] + (times[first + 1] - times[first]) * self.shares
                close = self.stretch(states[:, first], inputs, moments[-1] - moments[0], profile.at(moments))
                values[name] = max(values[name], *self._watch(close, profile.at(moments), inputs)[i])
        return {name: float(value) for name, value in values.items()}, Trajectory(
            times, states[: self.size], profile.at(times)
        )

    def _crossing(
        self, inputs: Array, profile: CurrentProfile, times: Array, states: Array, k: int, event: int
    ) -> tuple[float, Array]:
        """When an event happens before sample `k`, and the state there."""

        def at(share: float) -> Array:
            moments = times[k - 1] + share * (times[k] - times[k - 1]) * self.shares
            return self.stretch(states[:, k - 1], inputs, moments[-1] - moments[0], profile.at(moments))[:, -1]

        def gap(share: float) -> float:
            current = profile.at(times[k - 1 : k] + share * (times[k] - times[k - 1]))
            return float(self._watch(at(share)[:, None], current, inputs)[event, 0])

        share = 1e-9 if gap(1e-9) >= 0.0 else 1.0 if gap(1.0) <= 0.0 else float(brentq(gap, 1e-9, 1.0, xtol=1e-8))
        return float(times[k - 1] + share * (times[k] - times[k - 1])), at(share)

    def _watch(self, states: Array, currents: Array, inputs: Array) -> Array:
        """Return what events wait for, zero or more once they happen, and what has its peak, a row each."""
        return self.seen([*self._events, *self._peaks], states, currents, inputs)

    def seen(self, names: list[str], states: Array, currents: Array, inputs: Array) -> Array:
        """Some quantities at states, a column each."""
        watch, columns = self.phase.watch(names), states[: self.size].reshape(self.size, -1)
        return np.asarray(
            watch.map(len(currents))(columns, currents[None, :], np.repeat(inputs[:, None], len(currents), 1))
        )

    def start(self, inputs: Array, before: Array | None) -> Array:
        """State at the start, integrals last."""
        state = self.phase.initial(inputs) if before is None else self.phase.begin(before, inputs)
        return np.append(np.asarray(state).ravel(), np.zeros(len(self._integrals)))

    def stretch(self, begin: Array, inputs: Array, length: float, currents: Array) -> Array:
        """States at equally spaced times from `begin` over `length` seconds; the current runs straight."""
        p = np.concatenate([inputs, np.asarray(self._constants(inputs)).ravel(), [length, currents[0], currents[-1]]])
        return np.column_stack([begin, np.asarray(self._integrator(x0=begin, p=p)["xf"])])

    @cached_property
    def _standing(self) -> Any:
        """Return a function that is zero where all stays and the ending event is due, and its Jacobian."""
        unknowns, inputs = ca.MX.sym("unknowns", self.size + 1), ca.MX.sym("inputs", self.phase.rates.size1_in(2))
        at = (unknowns[:-1], unknowns[-1], inputs)
        parts = [self.phase.rates(*at), self.phase.watch([self.phase.phase.ends])(*at)]
        slopes = ca.vertcat(*(ca.jacobian(part, unknowns) for part in parts))
        return ca.Function("standing", [unknowns, inputs], [ca.vertcat(*parts), slopes])

    def balance(self, inputs: Array, trajectory: Trajectory) -> Array | None:
        """State and current that stay where the phase ended; None where none exists."""

        def standing(x: Array) -> tuple[Array, Array]:
            gap, slopes = self._standing(x, inputs)
            return np.asarray(gap).ravel(), np.asarray(slopes)

        x = begin = np.append(trajectory.states[:, -1], trajectory.currents[-1])
        with contextlib.suppress(np.linalg.LinAlgError):  # a step too long
            for _ in range(50):  # Newton's full steps: shorter ones may stop dead where half of the layer has molten
                gap, slopes = standing(x)
                change = np.linalg.solve(slopes, gap)
                x = x - change
                if np.max(np.abs(change)) < 1e-10:
                    return x
        solution = root(standing, begin, jac=True)
        return np.asarray(solution.x) if solution.success else None
