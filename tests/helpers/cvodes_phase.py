"""One phase of the working cycle simulated: the heat equation through CVODES until the event that ends it."""

from collections.abc import Collection, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from per_phase import per_phase

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.errors import SimulationError
from tvimdesign.base.interrupts import raise_pending
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions
from tvimdesign.simulation.working_cycle.trajectory import Array, Trajectory

FIRST_STRETCH = 120.0  # s; each after it is twice as long
_EQUAL_STRETCHES = 64  # of a shorter one; each after them is twice as long, too, as another event may take for ever
MOST_SOLVER_STEPS = 10_000  # of CVODES in a stretch; shipped studies take 1,000, and one that takes more never ends
MOST_STEPS = 50  # of Newton; a steady state takes less than ten
_FEW = 5  # every fifth sample of a stretch is looked at first
STALLED = 1e-7  # change of the scaled state over the rest of the horizon below which nothing will happen any more


@dataclass
class _Found:
    """What the simulation of a phase has come to so far."""

    times: dict[str, float]
    """Of every event; infinite where it has not happened."""
    end: Array | None = None
    """State, integrals last, at the event that ends the phase."""


class _Given(NamedTuple):
    """What stays the same all through a phase."""

    inputs: Array
    constants: Array
    """What its rates need that follows from the inputs alone."""
    of_peaks: Array
    """What its peaks need that does."""


class PhaseSimulator:
    """Simulates one phase. Time is scaled by the length of a stretch; integrals ride along as states."""

    def __init__(self, model: DeviceFunctions, phase: PhaseFunctions, tolerance: float, steps: int) -> None:
        """Nothing is integrated yet; `tolerance` is CVODES's, `steps` divides each stretch of time."""
        self.model = model
        self.phase = phase
        self._shares = np.linspace(0.0, 1.0, steps + 1)
        self._integrals = [row.name for row in phase.paths if row.reduce == "integral"]
        self._events = [row.name for row in phase.events]
        self._peaks = [row.name for row in phase.paths if row.reduce == "maximum"]
        self._last = [row.name for row in phase.paths if row.reduce == "end"]
        state = ca.SX.sym("state", phase.state_size)
        integrals = ca.SX.sym("integrals", len(self._integrals))
        length, first, last, time = (ca.SX.sym(name) for name in ("length", "first", "last", "time"))
        profile = first + (last - first) * time
        self._constants, varying = per_phase(phase, self._changes)
        constants = ca.SX.sym("constants", self._constants.size1_out(0))
        self._waiting = phase.watch(self._events)
        self._of_peaks, follow = per_phase(phase, phase.watch(self._peaks))
        self._followed, self._followed_once = follow.map(steps + 1), follow
        self._at_end = phase.watch(self._last)
        self._few = np.unique(np.append(np.arange(0, steps, _FEW), steps))
        self._waiting_at_few = self._waiting.map(len(self._few))
        self._integrator = ca.integrator(
            phase.phase.name,
            "cvodes",
            {
                "x": ca.vertcat(state, integrals),
                "p": ca.vertcat(constants, length, first, last),
                "t": time,
                "ode": length * varying(state, profile, constants),
            },
            0.0,
            self._shares[1:],
            {
                "reltol": tolerance,
                "abstol": tolerance * 1e-2,
                "max_num_steps": MOST_SOLVER_STEPS,
                # A phase that cannot be simulated raises; what CVODES and CasADi say meanwhile is not for people.
                "show_eval_warnings": False,
                "disable_internal_warnings": True,
            },
        )

    def _changes(self, state: Any, profile: Any, inputs: Any) -> Any:
        """Rates of the state and of the integrals."""
        at = (state, profile, inputs)
        return ca.vertcat(self.phase.rates(*at), self.phase.watch(self._integrals)(*at))

    def run(
        self,
        inputs: Array,
        profile: CurrentProfile,
        before: Array | None,
        stretch: float,
        wanted: Collection[str] | None,
        deadline: Deadline = NEVER,
    ) -> tuple[dict[str, float], Trajectory]:
        """Simulate until every event that is wanted has happened, nothing changes any more, or the horizon is over."""
        ends = self.phase.phase.ends
        sought = [name for name in self._events if wanted is None or name in wanted or name == ends]
        found = _Found(dict.fromkeys(sought, np.inf))
        horizon = float(inputs[self.model.index["horizon"]])
        begin, given = self._begin(inputs, before)
        time, length = 0.0, stretch
        pieces: list[tuple[Array, Array, Array]] = []
        while time < horizon and not all(np.isfinite(moment) for moment in found.times.values()):
            deadline.check("the working cycle of a design was simulated")
            length = min(length, profile.next_corner(time) - time, horizon - time)
            currents = profile.at(time + length * self._shares)
            states = self._stretch(begin, given, length, currents)
            self._look(found, (time, length, currents), states, given)
            pieces.append((time + length * self._shares, states, self._follow(states, given, currents)))
            begin, time = states[:, -1], time + length
            rate = np.asarray(self.phase.rates(begin[: self.phase.state_size], currents[-1], inputs)).ravel()
            constant = np.isinf(profile.next_corner(time))
            if constant and np.max(np.abs(rate)) * (horizon - time) < STALLED:
                break
            doubles = length >= FIRST_STRETCH or len(pieces) >= _EQUAL_STRETCHES
            length = 2.0 * length if doubles else stretch
        return self._summary(found, pieces, given, profile)

    def trace(self, inputs: Array, profile: CurrentProfile, before: Array | None, end: float) -> Trajectory:
        """Simulate one stretch of a constant current, whatever happens in it."""
        times = end * self._shares
        begin, given = self._begin(inputs, before)
        currents = profile.at(times)
        states = self._stretch(begin, given, end, currents)
        return Trajectory(times, states[: self.phase.state_size], currents)

    def _begin(self, inputs: Array, before: Array | None) -> tuple[Array, _Given]:
        """State at the start, integrals last, and what stays the same all through the phase."""
        start = self.phase.initial(inputs) if before is None else self.phase.begin(before, inputs)
        begin = np.append(np.asarray(start).ravel(), np.zeros(len(self._integrals)))
        constants, of_peaks = (np.asarray(one(inputs)).ravel() for one in (self._constants, self._of_peaks))
        return begin, _Given(inputs, constants, of_peaks)

    def _stretch(self, begin: Array, given: _Given, length: float, currents: Array) -> Array:
        """States at equally spaced times from `begin` over `length` seconds; the current runs straight."""
        parameters = np.append(given.constants, [length, currents[0], currents[-1]])
        try:
            after = np.asarray(self._integrator(x0=begin, p=parameters)["xf"])
        except RuntimeError as error:
            raise_pending()
            reason = str(error).strip().splitlines()[-1]
            raise SimulationError(
                f"the {self.phase.phase.name} of this design cannot be simulated; check its inputs ({reason})"
            ) from error
        return np.column_stack([begin, after])

    def _follow(self, stretch: Array, given: _Given, currents: Array) -> Array:
        """What has its peak in the phase, at every sample, a row each."""
        constants = np.repeat(given.of_peaks[:, None], stretch.shape[1], axis=1)
        function = self._followed if stretch.shape[1] > 1 else self._followed_once
        return np.asarray(function(stretch[: self.phase.state_size], currents[None, :], constants))

    def _waits(self, stretch: Array, given: _Given, currents: Array, sought: Sequence[bool]) -> Array:
        """What the events wait for, zero or more once they happen, a row each; NaN at samples that need no look.

        Few are looked at, all where one of what is `sought` may have happened between them, and what lies between two
        where it has: the moduli of a layer's slices are most of a simulation's work.
        """
        states, few, sought_rows = stretch[: self.phase.state_size], self._few, np.array(sought)
        found = np.full((len(self._events), stretch.shape[1]), np.nan)
        inputs = np.repeat(given.inputs[:, None], len(few), axis=1)
        found[:, few] = some = np.asarray(self._waiting_at_few(states[:, few], currents[None, few], inputs))
        happened = np.any(some >= 0.0, axis=1) & sought_rows
        near = np.max(some, axis=1) > -np.max(np.abs(np.diff(some, axis=1)), axis=1)
        between: set[int] = set()
        if np.any(near & ~happened & sought_rows):
            between = set(range(stretch.shape[1]))
        for row in some[happened]:
            first = int(np.argmax(row >= 0.0))
            between |= set(range(few[first - 1], few[first])) if first else set()
        for k in between - set(few.tolist()):
            found[:, k] = np.asarray(self._waiting(states[:, k], currents[k], given.inputs)).ravel()
        return found

    def _look(self, found: _Found, when: tuple[float, float, Array], stretch: Array, given: _Given) -> None:
        """Note the events that happen within a stretch. Those that wait for the same thing are looked at once."""
        time, _, currents = when
        sought = [not np.isfinite(found.times.get(name, 0.0)) for name in self._events]
        waits = self._waits(stretch, given, currents, sought)
        seen: list[tuple[Array, float, Array]] = []
        for i, name in enumerate(self._events):
            if not (sought[i] and np.any(waits[i] >= 0.0)):
                continue
            same = [known[1:] for known in seen if np.array_equal(known[0], waits[i], equal_nan=True)]
            share, state = same[0] if same else self._crossing(stretch, given, when, i, waits[i])
            seen.append((waits[i], share, state))
            found.times[name] = time + share
            if name == self.phase.phase.ends:
                found.end = state

    def _crossing(
        self, stretch: Array, given: _Given, when: tuple[float, float, Array], event: int, gap: Array
    ) -> tuple[float, Array]:
        """Time within a stretch at which a gap passes zero, and the state there: looked at once more, then linear."""
        _, length, currents = when
        if gap[0] >= 0.0:
            return 0.0, stretch[:, 0]
        first = int(np.argmax(gap >= 0.0))
        steps = len(self._shares) - 1
        within = np.linspace(currents[first - 1], currents[first], steps + 1)
        close = self._stretch(stretch[:, first - 1], given, length / steps, within)

        def near(place: int) -> float:
            return float(self._waiting(close[: self.phase.state_size, place], within[place], given.inputs)[event])

        # Looking at a sample costs as much as integrating up to it, so few are looked at: by halves.
        low, high = (0, near(0)), (steps, near(steps))
        while high[0] - low[0] > 1:
            middle = (low[0] + high[0]) // 2
            value = near(middle)
            low, high = (low, (middle, value)) if value >= 0.0 else ((middle, value), high)
        part = low[1] / (low[1] - high[1])
        share = (first - 1 + (low[0] + part) / steps) / steps
        return float(share * length), close[:, low[0]] + part * (close[:, high[0]] - close[:, low[0]])

    def _summary(
        self, found: _Found, pieces: list[tuple[Array, Array, Array]], given: _Given, profile: CurrentProfile
    ) -> tuple[dict[str, float], Trajectory]:
        """Values of the phase's events and paths, and its trajectory up to the event that ends it."""
        # The last sample of a stretch is the first of the next.
        times = np.concatenate([pieces[0][0][:1], *(piece[0][1:] for piece in pieces)])
        states, followed = (
            np.concatenate([pieces[0][k][:, :1], *(piece[k][:, 1:] for piece in pieces)], axis=1) for k in (1, 2)
        )
        if found.end is not None:
            end = found.times[self.phase.phase.ends]
            keep = times < end
            now = self._follow(found.end[:, None], given, profile.at(np.array([end])))
            times = np.append(times[keep], end)
            states = np.column_stack([states[:, keep], found.end])
            followed = np.column_stack([followed[:, keep], now])
        size = self.phase.state_size
        values = dict.fromkeys((*self._events, *self._integrals, *self._last), np.inf) | found.times
        values |= self._highest(times, states, followed, given, profile)
        # Of a phase that never ends there is a maximum; what it adds up to, or is at its end, there is not.
        if found.end is not None:
            last = self._at_end(found.end[:size], profile.at(times[-1:]), given.inputs)
            numbers = zip((*self._integrals, *self._last), (*states[size:, -1], *np.asarray(last).ravel()), strict=True)
            values |= {name: float(number) for name, number in numbers}
        return values, Trajectory(times=times, states=states[:size], currents=profile.at(times))

    def _highest(
        self, times: Array, states: Array, followed: Array, given: _Given, profile: CurrentProfile
    ) -> dict[str, float]:
        """The maxima of the phase's peaks; where one is at a sample between others, what lies around it is looked at
        once more: a cold side peaks within seconds of a current's reversal."""
        found: dict[str, float] = {}
        near: dict[int, Array] = {}
        for i, name in enumerate(self._peaks):
            place = int(np.argmax(followed[i]))
            found[name] = float(followed[i, place])
            if 0 < place < len(times) - 1:
                if place not in near:
                    both = [self._between(times, states, given, profile, first) for first in (place - 1, place)]
                    near[place] = np.concatenate(both, axis=1)
                found[name] = max(found[name], float(np.max(near[place][i])))
        return found

    def _between(self, times: Array, states: Array, given: _Given, profile: CurrentProfile, first: int) -> Array:
        """What has its peak between a sample and the next."""
        length = times[first + 1] - times[first]
        currents = profile.at(times[first] + length * self._shares)
        return self._follow(self._stretch(states[:, first], given, length, currents), given, currents)

    @cached_property
    def _standing(self) -> tuple[Any, Any]:
        """The function (state and current, inputs) that is zero where everything stays and the ending event is due,
        and its Jacobian with it.

        What the event waits for is most of the arithmetic, and one row: with the rates in one Jacobian it would be gone
        through once for each of the unknowns, which takes 1.5 s to build where a layer softens beside lips.
        """
        size = self.phase.state_size
        unknowns = ca.MX.sym("unknowns", size + 1)
        inputs = ca.MX.sym("inputs", len(self.model.names))
        state, profile = unknowns[:size], unknowns[size]
        gap = self.phase.watch([self.phase.phase.ends])(state, profile, inputs)
        rates = self.phase.rates(state, profile, inputs)
        equations = ca.vertcat(rates, gap)
        slopes = ca.vertcat(ca.jacobian(rates, unknowns), ca.jacobian(gap, unknowns))
        arguments = [unknowns, inputs]
        return ca.Function("standing", arguments, [equations]), ca.Function("slopes", arguments, [slopes, equations])

    def _newton(self, options: dict[str, Any]) -> Any:
        equations, slopes = self._standing
        return ca.rootfinder("balance", "newton", equations, {"jacobian_function": slopes, **options})

    @cached_property
    def _by_full_steps(self) -> Any:
        """Newton's method as it is: with shorter steps it may stop dead where half of the layer has molten."""
        return self._newton({"line_search": False, "max_iter": MOST_STEPS})

    @cached_property
    def _by_shorter_steps(self) -> Any:
        return self._newton({})

    def stays(self, wanted: Collection[str] | None) -> bool:
        """Whether a steady state at the phase's end is of use."""
        return any(wanted is None or row.name in wanted for row in self.phase.steadies)

    def balance(self, inputs: Array, trajectory: Trajectory) -> Array | None:
        """State and current that stay where the phase ended; None where none exists."""
        begin = np.append(trajectory.states[:, -1], trajectory.currents[-1])
        with suppress(RuntimeError):
            return np.asarray(self._by_full_steps(begin, inputs)).ravel()
        with suppress(RuntimeError):  # Newton finds none: with such a cold side there is none
            return np.asarray(self._by_shorter_steps(begin, inputs)).ravel()
        return None

    def steady_values(self, inputs: Array, balance: Array) -> dict[str, float]:
        """Values of the steady quantities."""
        names = [row.name for row in self.phase.steadies]
        numbers = np.asarray(self.phase.watch(names)(balance[:-1], balance[-1], inputs)).ravel()
        return dict(zip(names, (float(number) for number in numbers), strict=True))
