"""The optimisation problem of a study in the space of its free numbers: objective and named constraints.

The table's quantities and the working cycle are evaluated with exact derivatives at any point of that space; nothing
of what happens in time is an unknown. Unknowns that are positive throughout are logarithms of their ratio to the
study's start. Where a current follows a profile, the time that its pieces take is an unknown, too, and the event at its
end an equation.
"""

import math
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.errors import InputError, SimulationError
from tvimdesign.device import Event, Path, Steady
from tvimdesign.engine.tape import Tape
from tvimdesign.simulation.working_cycle.current_profile import Array, ramp_time
from tvimdesign.simulation.working_cycle.cycle import CycleEngine, Supplied
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.phase_instants import Drive, Grid, PhaseOutputs
from tvimdesign.solve.nlp.constraints import Constraint
from tvimdesign.solve.nlp.mixture import Mixture
from tvimdesign.solve.nlp.problem_parts import CycleModel, Free, FreeCurrent, Parameters, Peak, Places, Point

STEPS, FREEZING_STEPS, LEAST_STEPS = 40, 60, 3
"""Steps of a phase whose current follows a profile, of one in which the layer freezes, and of a piece at least."""
LATEST = 0.98
"""Share of the horizon at which an event must have come: times of the problem are some thousandths off those simulated.
"""
REMEMBERED = 3
"""Points that are remembered, of the cycle and of its model: where a step begins and ends, and with steps placed anew.
"""
UNIT = 1.0  # Unit of the time that a profile takes [s]; its unknown is the logarithm


class Problem:
    """A nonlinear programme in x, as a solver takes it.

    x: the free numbers; for each free current its nodes and the logarithm of the time its pieces take; the peaks of
    driven phases, over their scales. Along a profile many instants are as high as the highest, which has kinks there.
    Rows: equations, zero: what ends each driven phase, and the sums of mixtures' shares less one; the limits'
    residuals, in their order, satisfied where <= 0; sums of what is traded, below what the caller says; then the
    problem's own, satisfied where <= 0: the currents' slopes, that events come within the horizon which no limit has
    come earlier, and that no sample of a driven phase is above its peak. Beyond the horizon nothing is simulated, and
    an event that never comes has no derivatives.
    """

    def __init__(
        self,
        model: DeviceFunctions,
        free: Sequence[Free],
        limits: Sequence[Constraint],
        minimize: Sequence[str],
        currents: Sequence[FreeCurrent] = (),
        objectives: Sequence[str] = (),
        mixtures: Sequence[Mixture] = (),
        fineness: float = 1.0,
    ) -> None:
        """Start with nothing recorded; twice the `fineness` divides errors of the steps in time by eight.

        `minimize` names the outputs whose weighted sum is least. Those among the `objectives` get a row each that
        bounds a sum of them. The shares of records in a mixture are free numbers that add up to one.
        """
        self.model = model
        self.free = tuple(free)
        self.limits = tuple(limits)
        self.objectives = tuple(objectives)
        self.minimize = tuple(dict.fromkeys([*minimize, *objectives]))
        self.free_currents = tuple(currents)
        self.mixtures = tuple(mixtures)
        self.wanted = list(dict.fromkeys([*(limit.output for limit in self.limits), *self.minimize]))
        self._check()
        self.engine, self._fineness = CycleEngine(model, fineness), fineness
        self.grids: dict[str, Grid] = {}  # The steps of each phase; see `place_grids`
        self.unknown_count = len(self.free) + sum(current.nodes + 1 for current in self.free_currents) + len(self.peaks)
        self.equation_count = len(self.free_currents) + len(self.mixtures)
        self.slope_count = sum(2 * current.pieces for current in self.free_currents)
        self.sample_count = sum(self.samples(peak) for peak in self.peaks)
        self.own_count = self.slope_count + len(self.unlimited) + self.sample_count
        self.row_count = self.equation_count + len(self.limits) + len(self.objectives) + self.own_count
        self._cycle_model: CycleModel | None = None
        self._last: deque[tuple[bytes, dict[str, Grid], Point]] = deque(maxlen=REMEMBERED)
        self._placed: deque[tuple[bytes, dict[str, Grid]]] = deque(maxlen=REMEMBERED)
        self._last_modelled: deque[tuple[bytes, dict[str, Grid], Point]] = deque(maxlen=REMEMBERED)

    @cached_property
    def outputs(self) -> Tape:
        """The wanted outputs, recorded: of inputs and of what the cycle supplies."""
        return self.model.tape(self.wanted)

    @cached_property
    def _limit_rows(self) -> tuple[NDArray[np.int64], Array, Array]:
        """Place of each limit's output among the wanted, the slope of its residual, and where it stands."""
        places = np.array([self.wanted.index(limit.output) for limit in self.limits], dtype=np.int64)
        factors = np.array([(1.0 if limit.sense == "<=" else -1.0) / limit.scale for limit in self.limits])
        return places, factors, np.array([limit.limit for limit in self.limits])

    def place_grids(self, x: Array, parameters: Parameters) -> None:
        """Choose the steps of each phase by their errors at a point; they stay until they are placed again.

        Those of the last points are remembered; of a point beside, they would make results depend on what came before.
        """
        key = x.tobytes() + parameters.inputs.tobytes()
        for known, grids in self._placed:
            if known == key:
                self.grids = grids
                return
        self.grids = {}
        if np.any(np.isnan(self.at(x, parameters).cycle)):  # no steps lead through it
            self.grids = {}
        else:
            self._placed.append((key, self.grids))

    def forget(self) -> None:
        """Forget the last points."""
        self._last.clear()

    def at(self, x: Array, parameters: Parameters) -> Point:
        """Evaluate the problem at a point; NaN where the cycle has no end. The last points are remembered."""
        key = x.tobytes() + b"".join(part.tobytes() for part in vars(parameters).values())
        memory = self._last if self._cycle_model is None else self._last_modelled
        for known, grids, point in memory:
            if known == key and grids is self.grids:
                return point
        point = self._evaluated(x, parameters)
        memory.append((key, self.grids, point))
        return point

    @contextmanager
    def modelled(self, cycle_model: CycleModel) -> Iterator[None]:
        """Evaluate with a model in place of the cycle, as long as the context lasts."""
        self._cycle_model = cycle_model
        self._last_modelled.clear()
        try:
            yield
        finally:
            self._cycle_model = None

    def _evaluated(self, x: Array, parameters: Parameters) -> Point:
        inputs, along = self.inputs_at(x, parameters.inputs)
        cycle, of_cycle, driven = self._supplied(x, inputs, along)
        sampled, of_sampled = self._peaks(x, cycle, of_cycle, driven)
        values, slopes = np.zeros(0), np.zeros((0, len(x)))
        if self.wanted:
            numbers = np.where(np.isfinite(cycle), cycle, np.nan)
            ((values, slopes),) = self.outputs.tangents([inputs, numbers], [along, of_cycle])
        rows, jacobian = [], []
        for current in self.free_currents:
            phase = driven.get(current.phase)
            rows.append(phase.short if phase else np.nan)
            jacobian.append(phase.of_short if phase else np.full(len(x), np.nan))
        for mixture in self.mixtures:
            shares = [self.model.index[name] for name in mixture.shares]
            rows.append(float(np.sum(inputs[shares])) - 1.0)
            jacobian.append(np.sum(along[shares], axis=0))
        equations, of_equations = np.array(rows), np.array(jacobian).reshape(len(rows), len(x))
        places, factors, at_limits = self._limit_rows
        beyond, of_beyond = factors * (values[places] - at_limits), factors[:, None] * slopes[places]
        sums, of_sums = (parameters.factors @ part[self._places.traded] for part in (values, slopes))
        steep, of_steep = self._slopes(x)
        latest, late = self._latest(inputs), self._places.late  # lateness is a share of the allowed time
        minimized, weights = self._places.minimized, parameters.weights
        return Point(
            float(weights @ values[minimized]), weights @ slopes[minimized],
            np.concatenate([equations, beyond, sums, steep, cycle[late] / latest - 1.0, sampled]),
            np.concatenate([of_equations, of_beyond, of_sums, of_steep, of_cycle[late] / latest, of_sampled]),
            self._places, values, slopes, cycle, of_cycle,
        )  # fmt: skip

    @cached_property
    def _places(self) -> Places:
        outputs, supplied = (
            {name: i for i, name in enumerate(group)} for group in (self.wanted, self.model.switch_names)
        )
        minimized, traded = (
            np.array([outputs[name] for name in group], dtype=np.int64) for group in (self.minimize, self.objectives)
        )
        late = np.array([supplied[name] for name in self.unlimited], dtype=np.int64)
        return Places(outputs, {name: supplied[name] for name in self.events}, minimized, traded, late)

    def _supplied(self, x: Array, inputs: Array, along: Array) -> Supplied:
        if self._cycle_model is not None:
            return Supplied(*self._cycle_model(x), {})
        if not self.events and not self._needed & set(self.model.switch_names):
            count = len(self.model.switch_names)
            return Supplied(np.full(count, np.inf), np.zeros((count, along.shape[1])), {})
        try:
            return self.engine.run(inputs, along, self._needed, self.grids, self._drives(x, len(x)))
        except SimulationError:
            count = len(self.model.switch_names)
            return Supplied(np.full(count, np.nan), np.zeros((count, along.shape[1])), {})

    @cached_property
    def _free_numbers(self) -> tuple[NDArray[np.int64], Array, NDArray[np.bool_]]:
        """Return the place of each free number among the inputs, its reference, whether its unknown is a logarithm."""
        places = np.array([self.model.index[free.name] for free in self.free], dtype=np.int64)
        return places, np.array([f.reference for f in self.free]), np.array([f.logarithmic for f in self.free], bool)

    def inputs_at(self, x: Array, inputs: Array) -> tuple[Array, Array]:
        """Return inputs with the free numbers in their places, and their derivatives by the unknowns."""
        values, along = inputs.copy(), np.zeros((len(inputs), len(x)))
        places, references, logarithmic = self._free_numbers
        unknowns = x[: len(places)]
        factors = np.where(logarithmic, np.exp(np.where(logarithmic, unknowns, 0.0)), unknowns)
        values[places] = references * factors
        along[places, np.arange(len(places))] = references * np.where(logarithmic, factors, 1.0)
        for i, current in enumerate(self.free_currents):
            row, nodes = self.model.index[current.row], self.nodes_place(i)
            weights = np.full(current.nodes, 1.0 / current.pieces)
            weights[[0, -1]] *= 0.5  # the mean over the pieces, which sets the unit of the steps alone
            values[row] = current.upper * float(weights @ x[nodes])
            along[row, nodes] = current.upper * weights
        return values, along

    def nodes_place(self, i: int) -> slice:
        """Return the places of a free current's nodes among the unknowns; the logarithm of its time follows them."""
        first = len(self.free) + sum(current.nodes + 1 for current in self.free_currents[:i])
        return slice(first, first + self.free_currents[i].nodes)

    def pieces_time(self, x: Array, i: int) -> float:
        """Time [s] that the pieces of a free current take, after its ramp."""
        return float(UNIT * np.exp(x[self.nodes_place(i).stop]))

    def _drives(self, x: Array, lanes: int) -> dict[str, Drive]:
        """Return the free currents by phase, with or without their derivatives by the unknowns."""
        drives = {}
        for i, current in enumerate(self.free_currents):
            phase, nodes = self.model.phases[current.phase].phase, self.nodes_place(i)
            directions = np.eye(lanes) if lanes else np.zeros((len(x), 0))
            values, of_values = current.upper * x[nodes], current.upper * directions[nodes]
            time = self.pieces_time(x, i)
            shares = np.linspace(0.0, 1.0, current.nodes)
            ramp = ramp_time(values[0], current.slew) if np.isfinite(current.slew) else 0.0
            moments, of_moments = ramp + shares * time, shares[:, None] * time * directions[nodes.stop]
            if ramp > 0.0:
                of_moments = of_moments + of_values[0] / current.slew
                moments, of_moments = np.append(0.0, moments), np.vstack([np.zeros((1, lanes)), of_moments])
                values, of_values = np.append(0.0, values), np.vstack([np.zeros((1, lanes)), of_values])
            signed, of_signed = phase.sign * values, phase.sign * of_values
            drives[current.phase] = Drive(moments, of_moments, signed, of_signed, self._steps(current))
        return drives

    def _slopes(self, x: Array) -> tuple[Array, Array]:
        """Return the slopes of the free currents beyond the allowed ones, either way, as a share of those."""
        rows, jacobian = [], []
        for i, current in enumerate(self.free_currents):
            nodes, over = self.nodes_place(i), current.upper * current.pieces / (self.pieces_time(x, i) * current.slew)
            steep = np.diff(x[nodes]) * over
            by = np.zeros((current.pieces, len(x)))
            for k in range(current.pieces):
                by[k, nodes.start + k], by[k, nodes.start + k + 1], by[k, nodes.stop] = -over, over, -steep[k]
            rows += [steep - 1.0, -steep - 1.0]
            jacobian += [by, -by]
        return (np.concatenate(rows), np.concatenate(jacobian)) if rows else (np.zeros(0), np.zeros((0, len(x))))

    def _peaks(self, x: Array, cycle: Array, of_cycle: Array, driven: dict[str, PhaseOutputs]) -> tuple[Array, Array]:
        """Put the peaks of driven phases in their places, and return how far the samples are above them."""
        rows, jacobian = [], []
        for column, peak in enumerate(self.peaks, start=len(x) - len(self.peaks)):
            place, scale, count = self.model.switch_names.index(peak.row.name), peak.scale, self.samples(peak)
            cycle[place], of_cycle[place], of_cycle[place, column] = scale * x[column], 0.0, scale
            values, slopes = np.full(count, np.nan), np.full((count, len(x)), np.nan)
            if peak.current.phase in driven:
                samples, of_samples = driven[peak.current.phase].samples[peak.row.name]
                # Without a ramp there are fewer: the last stands for what is missing.
                those = np.minimum(np.arange(count), len(samples) - 1)
                values, slopes = samples[those] / scale - x[column], of_samples[those] / scale
                slopes[:, column] -= 1.0
            rows.append(values)
            jacobian.append(slopes)
        return (np.concatenate(rows), np.concatenate(jacobian)) if rows else (np.zeros(0), np.zeros((0, len(x))))

    @cached_property
    def peaks(self) -> list[Peak]:
        """Return the peaks of the driven phases that the problem needs."""
        return [
            Peak(row, current)
            for current in self.free_currents
            for row in self.model.phases[current.phase].paths
            if row.reduce == "maximum" and row.name in self._needed
        ]

    def samples(self, peak: Peak) -> int:
        """Return the number of samples that a peak stays above."""
        return (peak.current.pieces + 1) * self._steps(peak.current) + 1

    def _steps(self, current: FreeCurrent) -> int:
        """Steps of each piece of a current, and of its ramp."""
        every = FREEZING_STEPS if self.model.phases[current.phase].phase.history else STEPS
        return max(math.ceil(self._fineness * every / current.pieces), LEAST_STEPS)

    def tied(self, presses: Array, rows: Array) -> list[int]:
        """For each peak the row of the sample it is: the one that presses most, the highest where none does."""
        first, tied_rows = self.row_count - self.sample_count, []
        for peak in self.peaks:
            those = slice(first, first + self.samples(peak))
            weights = presses[those] if np.any(presses[those] > 0.0) else rows[those]
            tied_rows.append(first + int(np.argmax(weights)))
            first = those.stop
        return tied_rows

    def _latest(self, inputs: Array) -> float:
        return LATEST * float(inputs[self.model.index["horizon"]])

    @cached_property
    def unlimited(self) -> list[str]:
        """The events the problem needs that no limit has come within the horizon."""
        latest = self._latest(self.model.start)
        limited = {limit.output for limit in self.limits if limit.sense == "<=" and limit.limit <= latest}
        return [name for name in self.events if name not in limited]

    @cached_property
    def events(self) -> list[str]:
        """The events whose times the problem needs, each after those it starts from."""
        needed = self._needed
        phases = self.model.phases
        ending: set[str] = {
            phases[row.phase].phase.ends
            for row in self.model.table.supplied
            if isinstance(row, Path) and row.name in needed
        }
        ordered: list[str] = []
        for phase in reversed(phases.values()):
            mine = [row.name for row in phase.events if row.name in needed | ending]
            if mine and phase.phase.after:
                ending.add(phases[phase.phase.after].phase.ends)
            ordered = mine + ordered
        return ordered

    def simulated(self, inputs: Array) -> dict[str, float]:
        """Return the outputs of a cycle at some inputs that the problem needs, with constant currents.

        Raises SimulationError.
        """
        if not self.events:
            return dict.fromkeys(self.model.switch_names, np.inf)
        result = self.engine.run(inputs, np.zeros((len(inputs), 0)), self._needed)
        return dict(zip(self.model.switch_names, result.values.tolist(), strict=True))

    @cached_property
    def known(self) -> list[str]:
        """The outputs, by full name, that are known once that is simulated."""
        table, needed = self.model.table, {*self.events, *self._needed}
        unknown = {row.name for row in table.supplied if row.name not in needed}
        return [
            name for name in self.model.output_names if not unknown & {name.partition("@")[0], *table.ancestors(name)}
        ]

    @cached_property
    def phases(self) -> list[str]:
        """The phases the problem needs."""
        rows = [self.model.table.quantity(name) for name in (*self.events, *self._needed)]
        return [
            name
            for name in self.model.phases
            if any(isinstance(row, Event | Path | Steady) and row.phase == name for row in rows)
        ]

    @cached_property
    def _needed(self) -> set[str]:
        table = self.model.table
        return {base for name in self.wanted for base in (name.partition("@")[0], *table.ancestors(name))}

    def _check(self) -> None:
        """Raise InputError for what cannot be put to the solver, with what can be said instead."""
        peaks = {peak.row.name for peak in self.peaks}
        for limit in self.limits:
            if limit.output in peaks and limit.sense == ">=":
                raise InputError(f"require.{limit.output}: a peak can be kept below a limit, not above one")
        for current in self.free_currents:
            ends = self.model.phases[current.phase].phase.ends
            mine = [row.name for row in self.model.phases[current.phase].events if row.name != ends]
            others = [name for name in self.events if name in mine]
            if others:
                raise InputError(
                    f"profile.{current.phase}: the pieces of the current divide the time to {ends}; "
                    f"{', '.join(others)} cannot be limited or minimised beside it; "
                    "choose what ends the phase with `response_criterion`"
                )
            if ends not in self.events:
                raise InputError(
                    f"profile.{current.phase}: nothing that is required or minimised depends on this phase; "
                    f"minimise {ends}, or leave the profile out"
                )
