"""Results of a run of a phase: its integrals, extremes and end, and what it takes to stay there."""

from collections.abc import Callable, Collection
from itertools import pairwise

import numpy as np

from tvimdesign.engine.integrator import newton_matrix
from tvimdesign.engine.interpreter import Array
from tvimdesign.engine.sparse_lu import solve_many
from tvimdesign.simulation.working_cycle.phase_instants import Instant, PhaseOutputs, hermite
from tvimdesign.simulation.working_cycle.phase_run import PhaseRun

STANDING = -1e-12
"""Share of the mass in the matrix of a state that stays, so that integrals, which do not, leave it regular."""
NARROW, MOST_PARABOLAS = 0.003, 5
"""Share of a step between the samples of a peak's second parabola, by which the last one moves it at most."""


class PhaseResults:
    """The results of one run of a phase."""

    def __init__(self, run: PhaseRun) -> None:
        self.run, self.of = run, run.of
        self._seen: dict[tuple[str, ...], Array] = {}
        """Quantities at the ends of the steps, by those that are recorded together."""

    def add_paths(self, outputs: PhaseOutputs, wanted: Collection[str] | None) -> None:
        """Add what the phase adds up to, is at its end, or reaches; of a phase without an end, what it reaches.

        Maxima are those of samples where there are any, else they are looked for between the steps, too.
        """
        end = outputs.end or self.run.instants[-1]
        passed = self.passed(end)
        self._seen = {}
        for row in self.of.phase.paths:
            if (wanted is not None and row.name not in wanted) or (row.reduce != "maximum" and outputs.end is None):
                continue
            if row.reduce == "integral":
                place = self.of.size + self.of.lip + self.of.integrals.index(row.name)
                outputs.add(row.name, end.state[place], end.of_state[place])
            elif row.reduce == "end":
                outputs.add(row.name, *self.run.slopes(row.name, end))
            elif row.name in outputs.samples:
                values, slopes = outputs.samples[row.name]
                outputs.add(row.name, values[np.argmax(values)], slopes[np.argmax(values)])
            else:
                outputs.add(row.name, *self._highest(row.name, passed))

    def add_samples(self, outputs: PhaseOutputs, wanted: Collection[str] | None) -> None:
        """Add every quantity whose highest value is asked of, at the end of every step."""
        names = [row.name for row in self.of.phase.paths if row.reduce == "maximum"]
        groups = {name: self.of.together[name] for name in names if wanted is None or name in wanted}
        seen = {
            group: [self.run.slopes_together(group, instant) for instant in self.run.instants]
            for group in {group for group, _ in groups.values()}
        }
        for name, (group, place) in groups.items():
            values, slopes = zip(*((values[place], slopes[place]) for values, slopes in seen[group]), strict=True)
            outputs.samples[name] = np.array(values), np.array(slopes)

    def _highest(self, name: str, passed: list[Instant]) -> tuple[float, Array]:
        """Return the maximum of a quantity up to the end; between two steps it is looked for along cubics."""
        group, place = self.of.together[name]
        if group not in self._seen:
            self._seen[group] = self.run.values(group, passed)
        values = self._seen[group][:, place].copy()
        k = int(np.argmax(values))
        best = passed[k]
        if k < len(passed) - 1:
            for first in range(max(k - 1, 0), k + 1):
                before, after = passed[first], passed[first + 1]
                share, value = _peak(self._along_cubic(name, before, after))
                if value > values[k]:
                    best, values[k] = self._between(before, after, share), value
        return self.run.slopes(name, best)

    def passed(self, end: Instant) -> list[Instant]:
        """Return the ends of the steps up to an instant."""
        return [*self.run.instants[: end.step + 1], end] if end.step >= 0 else [end]

    def sampled(self, end: Instant, least: int) -> tuple[Array, Array, Array]:
        """Return times, states (columns) and currents up to an instant, at least so many: cubics between steps."""
        passed = self.passed(end)
        each = max(-(-least // max(len(passed) - 1, 1)), 1)
        shares = np.arange(each) / each
        times, states, currents = [], [], []
        for before, after in pairwise(passed):
            length = after.time - before.time
            here, there = self.run.rates(before) * length, self.run.rates(after) * length
            for share in shares:
                times.append(before.time + share * length)
                states.append(hermite(share, before.state, after.state, here, there))
                currents.append(before.current + share * (after.current - before.current))
        times, states, currents = [*times, end.time], [*states, end.state], [*currents, end.current]
        return np.array(times), np.array(states).T[: self.of.size], np.array(currents)

    def _along_cubic(self, name: str, before: Instant, after: Instant) -> Callable[[float], float]:
        """Return a quantity as a function of the share of a step."""
        length, rise = after.time - before.time, after.current - before.current
        here, there = self.run.rates(before) * length, self.run.rates(after) * length
        return lambda share: self.run.value(
            name, hermite(share, before.state, after.state, here, there), before.current + share * rise
        )

    def _between(self, before: Instant, after: Instant, share: float) -> Instant:
        """Return the instant at a share of a step, along cubics."""
        length, of_length = after.time - before.time, after.of_time - before.of_time
        rates = [self._moving(now) for now in (before, after)]
        here, there = (rate * length for rate, _ in rates)
        of_here, of_there = (of_rate * length + rate[:, None] * of_length for rate, of_rate in rates)
        return Instant(
            before.time + share * length, before.of_time + share * of_length,
            hermite(share, before.state, after.state, here, there),
            hermite(share, before.of_state, after.of_state, of_here, of_there),
            before.current + share * (after.current - before.current),
            before.of_current + share * (after.of_current - before.of_current), before.step,
        )  # fmt: skip

    def _moving(self, now: Instant) -> tuple[Array, Array]:
        (pair,) = self.run.motion.rates.tangents(
            (now.state, np.array([now.current]), self.run.constants),
            (now.of_state, now.of_current[None], self._of_constants),
        )
        return pair

    @property
    def _of_constants(self) -> Array:
        first, last = self.run.motion.size + 1, int(self.run.motion.rates.arguments[-1])
        return self.run.registers[1][first:last, : self.run.lanes]

    def add_steadies(self, outputs: PhaseOutputs, wanted: Collection[str] | None) -> None:
        """Add what it takes to stay where the phase has ended."""
        rows = [row.name for row in self.of.phase.steadies if wanted is None or row.name in wanted]
        standing = self.standing(outputs.end) if rows and outputs.end is not None else None
        if standing is None:
            return
        for name in rows:
            outputs.add(name, *self.run.slopes(name, standing))

    def standing(self, end: Instant) -> Instant | None:
        """Return state and current that stay, with their tangents; None where there are none.

        The current is sought at which the event that ends the phase stays due; at each, the state that stays. Newton's
        method is kept between currents that are too small and too large, and their middle is taken where it gains
        little: what stays may change steeply where a part of the layer melts.
        """
        ends, size = self.of.phase.phase.ends, self.of.size
        y, current = end.state.copy(), end.current
        of_current = np.append(np.zeros(self.run.lanes), 1.0)
        too_small, too_large, before = np.nan, np.nan, np.inf
        for _ in range(60):
            settled = self._settle(y, current)
            if settled is None:  # with so much current it never stops heating up
                least = 0.0 if np.isnan(too_small) else too_small
                if abs(current - least) < 1e-3:
                    return None
                too_large, current = current, 0.5 * (least + current)
                continue
            y, s = settled
            now = Instant(0.0, of_current, y, s, current, of_current)
            gap, slopes = self.run.slopes(ends, now)
            if not np.isfinite(gap) or slopes[-1] == 0.0:
                return None
            room = 0.5 * abs(current) + 0.05
            change = float(np.clip(-gap / slopes[-1], -room, room))
            if abs(change) < 1e-9 * max(1.0, abs(current)):
                moved = -slopes[:-1] / slopes[-1]
                return Instant(0.0, moved, y, s[:, :-1] + s[:, -1:] * moved, current, moved)
            too_small, too_large = (current, too_large) if gap < 0.0 else (too_small, current)
            inside = min(too_small, too_large) < current + change < max(too_small, too_large)
            if abs(change) > 0.5 * before or not inside:
                middle = 0.5 * (too_small + too_large) - current
                change = change if np.isnan(middle) else middle
            y[:size] += change * s[:size, -1]
            current, before = current + change, abs(change)
        return None

    def _settle(self, y: Array, current: float) -> tuple[Array, Array] | None:
        """Return the state that stays at a current, and its tangents; along the current as the last."""
        m, (_, _, v) = self.run.motion.system, self.run.registers
        entries, size = np.empty(m.pattern.size), self.of.size + self.of.lip
        order = m.pattern.order
        y = y.copy()

        def solved(right: Array) -> Array:
            b = np.ascontiguousarray(right[order])
            b[order >= size] = 0.0
            solve_many(m.pattern, entries, b)
            solution = np.empty_like(b)
            solution[order] = b
            solution[size:] = 0.0
            return solution

        for _ in range(40):
            newton_matrix(m, v, y, current, STANDING, -1.0, entries)
            change = solved(-v[m.slope_rates][:, None])[:, 0]
            if not np.all(np.isfinite(change)):
                return None
            largest = float(np.max(np.abs(change)))
            y += change * min(1.0, 0.5 / max(largest, 1e-12))
            if largest < 1e-9:
                break
        else:
            return None
        nothing, of_current = np.zeros((y.size, self.run.lanes + 1)), np.append(np.zeros(self.run.lanes), 1.0)[None]
        of_constants = np.column_stack([self._of_constants, np.zeros(len(self._of_constants))])
        ((_, by),) = self.run.motion.rates.tangents(
            (y, np.array([current]), self.run.constants), (nothing, of_current, of_constants)
        )
        newton_matrix(m, v, y, current, STANDING, -1.0, entries)
        return y, solved(-by)


def _peak(function: Callable[[float], float]) -> tuple[float, float]:
    """Find where a function of a share of a step is highest, and how high: by samples, then by ever narrower parabolas.

    There the function hardly changes with the share, so that its slope at a share that stays is that of the peak.
    """
    shares = np.linspace(0.0, 1.0, 9)
    values = np.array([function(trial) for trial in shares])
    k = int(np.argmax(values))
    share, value, width = float(shares[k]), float(values[k]), 0.125
    if 0 < k < 8:
        below, above = float(values[k - 1]), float(values[k + 1])
        for _ in range(MOST_PARABOLAS):
            bend = 2.0 * value - below - above
            if not bend > 0.0:
                break
            moved = 0.5 * width * (above - below) / bend
            share, width = share + moved, NARROW
            value = function(share)
            if not abs(moved) > NARROW:
                break
            below, above = function(share - width), function(share + width)
        if value > values[k]:
            return share, value
    return float(shares[k]), float(values[k])
