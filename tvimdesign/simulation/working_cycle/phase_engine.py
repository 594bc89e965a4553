"""One phase of the working cycle by the engine: stepped to its events, with derivatives along directions.

A direction says how the inputs move: a column of `along`, a row an input. All values come with their derivatives along
each. The length of a step follows from the module smoothly, and the last step ends at the event, so that a value is a
smooth function of the inputs.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from tvimdesign.engine.integrator import STAGES, Motion, adapted, advance, newton_matrix, step
from tvimdesign.engine.sparse_lu import solve_many
from tvimdesign.engine.tape import Array, Tape
from tvimdesign.physics.heat_flow import heat
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions
from tvimdesign.simulation.working_cycle.symbols import symbols

TOLERANCE = 1e-4
"""Largest error of a step of the first run in the scaled state, a hundredth of a kelvin: that of the next runs is less,
as theirs are of third order."""
FIRST = 0.02
"""The first step, in times that the pads would need to heat the layer."""
MOST_STEPS, EXTRA, GROWTH = 2000, 40, 1.3
"""Steps of a phase at most; beyond those of the first run, and by how much each of these grows."""
STANDING = -1e-12
"""Share of the mass in the matrix of a state that stays, so that integrals, which do not, leave it regular."""
NEAR, MOST_TRIALS = 1e-4, 12
"""Part of a step by which the last one may miss an event: what is left, its square, is made up by slopes."""


@dataclass
class Grid:
    """The steps of a phase, by what its first run needed: each in times that the pads would need to heat the layer."""

    shares: list[float] = field(default_factory=list)
    events: dict[str, int] = field(default_factory=dict)
    """Step in which each event was due; -1 at the start."""


@dataclass
class Ended:
    """The instant of an event."""

    time: float
    of_time: Array
    state: Array
    of_state: Array
    step: int
    """The step in which it happens; -1 at the start."""


@dataclass
class Found:
    """Values of a phase by name, with their derivatives."""

    values: dict[str, float] = field(default_factory=dict)
    slopes: dict[str, Array] = field(default_factory=dict)
    end: Ended | None = None

    def without_length(self) -> Found:
        """Leave out the last direction."""
        end = self.end
        if end is not None:
            end = Ended(end.time, end.of_time[:-1], end.state, np.ascontiguousarray(end.of_state[:, :-1]), end.step)
        return Found(self.values, {name: slopes[:-1] for name, slopes in self.slopes.items()}, end)

    def add(self, name: str, value: float, slopes: Array) -> None:
        """Add one."""
        self.values[name], self.slopes[name] = float(value), np.asarray(slopes)


class PhaseEngine:
    """One phase, recorded when it is first asked for; `inputs` is a vector in the order of the model's names."""

    def __init__(self, phase: PhaseFunctions) -> None:
        """Nothing is recorded yet."""
        self.phase = phase
        self.integrals = [row.name for row in phase.paths if row.reduce == "integral"]
        self.size = phase.state_size
        self.lip = 0 if phase._stack.lip is None else 2
        """Temperatures of the lip, which has no heat capacity: unknowns beside the state."""
        self._tapes: dict[tuple[str, ...], Tape] = {}

    @cached_property
    def recorded(self) -> tuple[Motion, Tape]:
        """The equation of motion, and what it takes from the inputs: constants, length of a step, first state."""
        phase, lip = self.phase, ca.SX.sym("lip", self.lip)
        stack = phase._stack
        if self.lip:
            kelvin = heat.ZERO_CELSIUS + heat.TEMPERATURE_SCALE * symbols(lip)
            stack = stack._replace(lip_temperatures=(kelvin[0], kelvin[1]))
        state_rates, now, *integrands = phase._instant_with(
            ["state_rates", "stack_profile", *self.integrals], stack_now=stack
        )
        of_lip = [residual / heat.TEMPERATURE_SCALE for residual in now.lip.residuals] if self.lip else []
        value, constants, k = phase._parted(ca.vertcat(state_rates, *of_lip, *integrands))
        y = ca.vertcat(phase._state, lip, ca.SX.sym("integrals", len(self.integrals)))
        mass = np.ones(y.numel())
        mass[self.size : self.size + self.lip] = 0.0
        motion = Motion(y, phase._drive, k, value, ca.jacobian(value, y), mass)
        row = phase.phase
        current = row.sign * symbols(phase._inputs)[self._current_place]
        first = phase._initial(phase._stack._replace(freezing=None))
        given = Tape.of([phase._inputs], [constants, _step_length(phase._stack, current), ca.vertcat(first)])
        return motion, given

    @cached_property
    def _current_place(self) -> int:
        return self.phase.input_names.index(self.phase.phase.current_input)

    @cached_property
    def start(self) -> Tape:
        """Record the state that a phase goes on from."""
        before = ca.SX.sym("before", len(self.phase._initial(self.phase._stack._replace(freezing=None))))
        state = self.phase.begin(before, self.phase._inputs)
        return Tape.of([before, self.phase._inputs], [state])

    def tape(self, *names: str) -> Tape:
        """Record what quantities are at an instant: of state, current and inputs."""
        if names not in self._tapes:
            values = [ca.SX(self.phase._instant[name]) for name in names]
            self._tapes[names] = Tape.of(self.phase._arguments, values, inverses=True)
        return self._tapes[names]

    def _value(self, name: str, state: Array, current: float, inputs: Array) -> float:
        return float(self.tape(name).values(state[: self.size], np.array([current]), inputs)[0][0])

    def _pushed(self, name: str, at: tuple[Array, Array, float, Array], inputs: Array, along: Array) -> tuple[float, Array]:
        """A quantity at an instant (state, its tangents, current, its tangents), and its slopes."""
        state, of_state, current, of_current = at
        ((value, slopes),) = self.tape(name).tangents(
            (state[: self.size], np.array([current]), inputs), (of_state[: self.size], of_current[None], along)
        )
        return float(value[0]), slopes[0]

    def run(
        self, inputs: Array, along: Array, before: Ended | None, wanted: Collection[str] | None, horizon: float,
        grid: Grid | None,
    ) -> tuple[Found, Grid]:
        """Step until every wanted event has happened, and evaluate all that is wanted.

        Steps are those of a `grid`, or as long as the error allows. Returns the grid, too.
        """
        motion, given = self.recorded
        along = np.column_stack([along, np.zeros(len(along))])  # the length of a phase's last step
        (k, dk), (pace, dpace), (y, s) = given.tangents([inputs], [along])
        if before is not None:
            size = self.start.arguments[1]
            of_state = np.column_stack([before.of_state[:size], np.zeros(size)])
            ((y, s),) = self.start.tangents((before.state[:size], inputs), (of_state, along))
        pad = self.lip + len(self.integrals)
        y, s = np.append(y, np.zeros(pad)), np.concatenate([s, np.zeros((pad, along.shape[1]))])
        current = self.phase.phase.sign * float(inputs[self._current_place])
        of_current = self.phase.phase.sign * along[self._current_place]
        registers = motion.registers(k, dk)
        run = _Run(self, motion, registers, inputs, along, current, of_current)
        ends = self.phase.phase.ends
        sought = [row.name for row in self.phase.events if wanted is None or row.name in wanted or row.name == ends]
        found = Found()
        if grid is None:
            grid = run.first(y, float(pace[0]), sought, horizon)
        moments = run.search(y, s, float(pace[0]), dpace[0], [name for name in sought if name in grid.events], grid)
        for name in sought:
            if name in moments:
                found.add(name, moments[name].time, moments[name].of_time)
        found.end = moments.get(ends)
        if found.end is not None:
            run.add_paths(found, wanted)
            run.add_steadies(found, wanted)
        return found.without_length(), grid


class _Run:
    """One run of a phase."""

    def __init__(
        self, phase: PhaseEngine, motion: Motion, registers: tuple[Array, Array, Array], inputs: Array, along: Array,
        current: float, of_current: Array,
    ) -> None:  # fmt: skip
        self.of, self.motion, self.registers = phase, motion, registers
        self.inputs, self.along, self.current, self.of_current = inputs, along, current, of_current
        self.lanes = along.shape[1]
        self._u, self._du = np.full(STAGES, current), np.tile(of_current, (STAGES, 1))

    def first(self, y: Array, pace: float, sought: list[str], horizon: float) -> Grid:
        """Step as far as the events that are sought, each step as long as its error allows."""
        grid = Grid(events={name: -1 for name in sought if self._gap(name, y) >= 0.0})
        y, ahead, h, time = y.copy(), np.zeros(y.size), FIRST * pace, 0.0
        while len(grid.events) < len(sought) and time < horizon and len(grid.shares) < MOST_STEPS:
            length, h = adapted(self.motion.system, self.registers[2], y, self._u, h, TOLERANCE, ahead)
            if length == 0.0:
                break
            due = [name for name in sought if name not in grid.events and self._gap(name, y) >= 0.0]
            grid.events |= dict.fromkeys(due, len(grid.shares))
            grid.shares.append(length / pace)
            time += length
        return grid

    def search(
        self, y: Array, s: Array, pace: float, dpace: Array, sought: list[str], grid: Grid
    ) -> dict[str, Ended]:
        """Step along a grid to where each event first is due."""
        shares = np.array(grid.shares)
        if len(shares):
            shares = np.append(shares, shares[-1] * GROWTH ** np.arange(1, EXTRA + 1))
        lengths, of_lengths = shares * pace, shares[:, None] * dpace
        self.times = np.concatenate([[0.0], np.cumsum(lengths)])
        self.of_times = np.concatenate([np.zeros((1, self.lanes)), np.cumsum(of_lengths, axis=0)])
        self.lengths = lengths
        self.states, self.tangents = np.empty((len(shares) + 1, y.size)), np.empty((len(shares) + 1, y.size, self.lanes))
        self.states[0], self.tangents[0] = y, s
        u, du = np.tile(self._u, (len(shares), 1)), np.tile(self._du, (len(shares), 1, 1))
        ahead, done = np.zeros(y.size), 0
        found: dict[str, Ended] = {}
        for name in sorted(sought, key=grid.events.__getitem__):
            k = grid.events[name]
            while 0 <= k < len(shares):
                if k + 1 > done:
                    reached = advance(
                        self.motion.system, *self.registers, self.states, self.tangents, done, lengths[: k + 1],
                        of_lengths[: k + 1], u, du, ahead,
                    )  # fmt: skip
                    if reached <= k:
                        return found
                    done = k + 1
                if self._gap(name, self.states[k]) >= 0.0:
                    k -= 1
                elif self._gap(name, self.states[k + 1]) < 0.0:
                    k += 1
                else:
                    found[name] = self._crossing(name, k, k + 1)
                    break
            if k < 0:
                found[name] = Ended(0.0, np.zeros(self.lanes), y, s, -1)
        return found

    def _gap(self, name: str, y: Array) -> float:
        return self.of._value(name, y, self.current, self.inputs)

    def _rates(self, y: Array) -> Array:
        (rates,) = self.motion.rates.values(y, np.array([self.current]), self._constants)
        return rates

    @cached_property
    def _constants(self) -> Array:
        first = self.motion.size + 1
        return self.registers[0][first : int(self.motion.rates.arguments[-1])]

    def _crossing(self, name: str, low: int, high: int) -> Ended:
        """The instant at which an event is due, between the ends of two steps.

        The last step ends there: its length is sought by Newton's method, whose slope is one more direction. So the
        derivatives are those of the steps as they are taken.
        """
        begin, end, whole = self.states[low], self.states[high], float(self.lengths[low])
        here, there = self._rates(begin) * whole, self._rates(end) * whole
        length = whole * _root(lambda share: self._gap(name, _hermite(share, begin, end, here, there)))
        least, most, short = 0.0, 1.05 * whole, whole
        for _ in range(MOST_TRIALS):
            guess = 0.4 * (_hermite(length / whole, begin, end, here, there) - begin)
            y, s = self._last_step(low, length, guess, self._of_length)
            gap, slopes = self._pushed(name, y, s, self._nowhere)
            least, most = (length, most) if gap < 0.0 else (least, length)
            short = -gap / slopes[0]
            if abs(short) <= NEAR * whole:
                break
            length = length + short if least < length + short < most else 0.5 * (least + most)
        y, s = self._last_step(low, length, y - begin - 0.6 * (y - begin), self.registers)
        gap, slopes = self._pushed(name, y, s, self.along)
        short, longer = -gap / slopes[-1], -slopes / slopes[-1]
        longer[-1] = 0.0
        y, by_length = y + short * s[:, -1], s[:, -1:].copy()
        s[:, -1] = 0.0
        return Ended(self.times[low] + length + short, self.of_times[low] + longer, y, s + by_length * longer, low)

    @cached_property
    def _of_length(self) -> tuple[Array, Array, Array]:
        """Registers for the length of the last step as the one direction."""
        return self.motion.registers(self._constants, np.zeros((len(self._constants), 1)))

    @cached_property
    def _nowhere(self) -> Array:
        return np.zeros((len(self.inputs), 1))

    def _last_step(
        self, low: int, length: float, guess: Array, registers: tuple[Array, Array, Array]
    ) -> tuple[Array, Array]:
        """The state after a last step, and its tangents; the last direction is its length."""
        lanes = registers[1].shape[1]
        y, s = self.states[low].copy(), self.tangents[low][:, -lanes:].copy()
        longer = np.zeros(lanes)
        longer[-1] = 1.0
        step(self.motion.system, *registers, y, s, self._u, self._du[:, -lanes:].copy(), length, longer, guess)
        return y, s

    def _pushed(self, name: str, y: Array, s: Array, along: Array) -> tuple[float, Array]:
        """A quantity and its slopes along the directions."""
        lanes = along.shape[1]
        return self.of._pushed(name, (y, s, self.current, self.of_current[-lanes:]), self.inputs, along)

    def add_paths(self, found: Found, wanted: Collection[str] | None) -> None:
        """Add what the phase adds up to, is at its end, or reaches."""
        end = found.end
        assert end is not None
        for row in self.of.phase.paths:
            if wanted is not None and row.name not in wanted:
                continue
            if row.reduce == "integral":
                place = self.of.size + self.of.lip + self.of.integrals.index(row.name)
                found.add(row.name, end.state[place], end.of_state[place])
            elif row.reduce == "end":
                at = (end.state, end.of_state, self.current, self.of_current)
                found.add(row.name, *self.of._pushed(row.name, at, self.inputs, self.along))
            else:
                found.add(row.name, *self._highest(row.name, end))

    def _highest(self, name: str, end: Ended) -> tuple[float, Array]:
        """The maximum of a quantity up to the end; between two steps it is looked for along cubics."""
        count = end.step + 1
        states = [*self.states[:count], end.state] if end.step >= 0 else [end.state]
        values = [self._gap(name, one) for one in states]
        k = int(np.argmax(values))
        if k == len(states) - 1:
            return self._at(name, end.state, end.of_state)
        best, place = values[k], (k, 0.0)
        for first in (k - 1, k):
            if first < 0 or first + 1 >= len(states):
                continue
            last = first + 1 == len(states) - 1
            length = end.time - self.times[first] if last else self.lengths[first]
            one, other = states[first], states[first + 1]
            here, there = self._rates(one) * length, self._rates(other) * length
            share, value = _peak(lambda x, c=(one, other, here, there): self._gap(name, _hermite(x, *c)))
            if value > best:
                best, place = value, (first, share)
        first, share = place
        if share == 0.0:
            return self._at(name, self.states[k], self.tangents[k])
        last = first + 1 == len(states) - 1
        length = end.time - self.times[first] if last else self.lengths[first]
        of_length = (end.of_time if last else self.of_times[first + 1]) - self.of_times[first]
        other, of_other = (end.state, end.of_state) if last else (self.states[first + 1], self.tangents[first + 1])
        rates = [self._moving(self.states[first], self.tangents[first]), self._moving(other, of_other)]
        here, there = (rate * length for rate, _ in rates)
        of_here, of_there = (of_rate * length + rate[:, None] * of_length for rate, of_rate in rates)
        y = _hermite(share, self.states[first], other, here, there)
        s = _hermite(share, self.tangents[first], of_other, of_here, of_there)
        return self._at(name, y, s)

    def _moving(self, y: Array, s: Array) -> tuple[Array, Array]:
        """Rates of a state, and their tangents."""
        dk = self.registers[1][self.motion.size + 1 : int(self.motion.rates.arguments[-1])]
        (pair,) = self.motion.rates.tangents(
            (y, np.array([self.current]), self._constants), (s, self.of_current[None], dk)
        )
        return pair

    def _at(self, name: str, y: Array, s: Array) -> tuple[float, Array]:
        return self.of._pushed(name, (y, s, self.current, self.of_current), self.inputs, self.along)

    def add_steadies(self, found: Found, wanted: Collection[str] | None) -> None:
        """Add what it takes to stay where the phase has ended."""
        rows = [row.name for row in self.of.phase.steadies if wanted is None or row.name in wanted]
        if not rows:
            return
        assert found.end is not None
        standing = self._standing(found.end.state[: self.of.size])
        if standing is None:
            return
        y, s, current, of_current = standing
        for name in rows:
            found.add(name, *self.of._pushed(name, (y, s, current, of_current), self.inputs, self.along))

    def _standing(self, state: Array) -> tuple[Array, Array, float, Array] | None:
        """State and current that stay, with their tangents; None where there are none.

        The current is sought at which the event that ends the phase stays due; at each, the state that stays.
        """
        ends, size = self.of.phase.phase.ends, self.of.size
        y, current = np.append(state, np.zeros(self.of.lip + len(self.of.integrals))), self.current
        for _ in range(30):
            settled = self._settle(y, current)
            if settled is None:
                return None
            y, s = settled
            of_current = np.append(np.zeros(self.lanes), 1.0)
            along = np.column_stack([self.along, np.zeros(len(self.along))])
            gap, slopes = self.of._pushed(ends, (y, s, current, of_current), self.inputs, along)
            if not np.isfinite(gap) or slopes[-1] == 0.0:
                return None
            change = -gap / slopes[-1]
            change = float(np.clip(change, -0.5 * abs(current) - 0.05, 0.5 * abs(current) + 0.05))
            if abs(change) < 1e-9 * max(1.0, abs(current)):
                of_current = -slopes[:-1] / slopes[-1]
                return y[:size], s[:size, :-1] + s[:size, -1:] * of_current, current, of_current
            y = y.copy()
            y[:size] += change * s[:size, -1]
            current += change
        return None

    def _settle(self, y: Array, current: float) -> tuple[Array, Array] | None:
        """The state that stays at a current, and its tangents; along the current as the last."""
        m, (_, _, v) = self.motion.system, self.registers
        entries, size = np.empty(m.pattern.size), self.of.size + self.of.lip
        y = y.copy()
        for _ in range(40):
            newton_matrix(m, v, y, current, STANDING, -1.0, entries)
            rates = v[m.slope_rates]
            b = np.ascontiguousarray(-rates[m.pattern.order][:, None])
            b[m.pattern.order >= size] = 0.0
            solve_many(m.pattern, entries, b)
            change = np.zeros(y.size)
            change[m.pattern.order] = b[:, 0]
            change[size:] = 0.0
            if not np.all(np.isfinite(change)):
                return None
            largest = float(np.max(np.abs(change)))
            y += change * min(1.0, 0.5 / largest) if largest > 0.0 else 0.0
            if largest < 1e-9:
                break
        else:
            return None
        dk = self.registers[1][m.mass.size + 1 : int(self.motion.rates.arguments[-1])]
        moved = np.column_stack([dk, np.zeros(len(dk))])
        nothing = np.zeros((y.size, self.lanes + 1))
        of_current = np.append(np.zeros(self.lanes), 1.0)[None]
        ((_, by),) = self.motion.rates.tangents(
            (y, np.array([current]), self._constants), (nothing, of_current, moved)
        )
        newton_matrix(m, v, y, current, STANDING, -1.0, entries)
        b = np.ascontiguousarray(-by[m.pattern.order])
        b[m.pattern.order >= size] = 0.0
        solve_many(m.pattern, entries, b)
        s = np.empty_like(b)
        s[m.pattern.order] = b
        return y, s


def _hermite(share: float, one: Array, other: Array, here: Array, there: Array) -> Array:
    """A cubic between two states, whose slopes over the step are given."""
    left = 1.0 - share
    whole = one * left**2 * (1.0 + 2.0 * share) + other * share**2 * (3.0 - 2.0 * share)
    return np.asarray(whole + share * left * (here * left - there * share))


def _root(function: Any) -> float:
    """Where a function of a share of a step passes zero, about: by regula falsi (Illinois)."""
    low, high, below, above = 0.0, 1.0, function(0.0), function(1.0)
    if above <= 0.0:
        return 1.0
    side = 0
    for _ in range(12):
        share = (low * above - high * below) / (above - below)
        value = function(share)
        if abs(value) < 1e-6 * (above - below) or high - low < 1e-6:
            return share
        if value < 0.0:
            low, below, above = share, value, above * (0.5 if side == -1 else 1.0)
            side = -1
        else:
            high, above, below = share, value, below * (0.5 if side == 1 else 1.0)
            side = 1
    return share


def _peak(function: Any) -> tuple[float, float]:
    """Where a function of a share of a step is highest, and how high: by samples and a parabola."""
    shares = np.linspace(0.0, 1.0, 9)
    values = np.array([function(one) for one in shares])
    k = int(np.argmax(values))
    if 0 < k < 8:
        less, more = values[k] - values[k - 1], values[k + 1] - values[k]
        share = float(shares[k] + 0.125 * 0.5 * (less + more) / (less - more))
        value = function(share)
        if value > values[k]:
            return share, value
    return float(shares[k]), float(values[k])


def _step_length(stack: heat.Stack, current: Any) -> Any:
    """About the time [s] in which the pads at their power would heat the layer."""
    melting = stack.melting
    heated = melting.latent_heat + melting.specific_heat_melt * (melting.end - stack.ambient)
    power = current * stack.peltier.seebeck * 330.0 + 0.5 * current**2 * stack.peltier.resistance
    return ca.vertcat(stack.density * stack.area * stack.thickness * heated / np.sqrt(power**2 + 0.01))
