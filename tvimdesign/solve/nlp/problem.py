"""The optimisation problem of a study, built once: CasADi unknowns, objective and named constraints for IPOPT.

Every number that is not an unknown is a parameter, so starts, weights, catalogue sizes and bounds change nothing that
was built. Unknowns that are positive throughout are logarithms of their ratio to the study's start.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.deadline import NEVER, Deadline
from tvimdesign.base.errors import InputError
from tvimdesign.device import Event, Path, Steady
from tvimdesign.simulation.working_cycle.casadi_setup import ca
from tvimdesign.simulation.working_cycle.current_profile import CurrentProfile, ramp_time
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.trajectory import Cycle
from tvimdesign.solve.nlp.constraints import Constraint
from tvimdesign.solve.nlp.mixture import Mixture
from tvimdesign.solve.nlp.transcription import ORDER, Block, at_each, phase_block

Array = NDArray[np.float64]


FREEZING = 3.0
"""Elements of a freezing layer, whose edge runs through the cells, over those of a melting one."""


@dataclass(frozen=True)
class Free:
    """One number that may change: its name, bounds (SI), and whether its unknown is a logarithm."""

    name: str
    lower: float
    upper: float
    reference: float

    @property
    def logarithmic(self) -> bool:
        """Whether the unknown is log(value/reference) rather than value/reference."""
        return self.lower > 0.0

    def to_unknown(self, value: float) -> float:
        """Unknown of a value."""
        return float(np.log(value / self.reference)) if self.logarithmic else value / self.reference

    def to_value(self, unknown: Any) -> Any:
        """Value of an unknown; floats and symbols."""
        return self.reference * (np.exp(unknown) if self.logarithmic else unknown)


@dataclass(frozen=True)
class FreeCurrent:
    """The current of one phase, free at the nodes of its pieces, between `lower` and `upper` [A] in size."""

    phase: str
    row: str
    pieces: int
    lower: float
    upper: float
    ramp_elements: int
    """Count of elements for its rise from zero to the first node."""

    @property
    def nodes(self) -> int:
        """Count of its unknowns, currents over `upper`."""
        return self.pieces + 1


@dataclass(frozen=True)
class Balance:
    """A steady state that is unknown: everything stays, with the event that ends the phase at zero."""

    phase: str
    unknowns: Any
    """MX, the state and the current [A]."""
    equations: Any


class Problem:
    """A nonlinear programme, `function` = {x, p, f, g} as CasADi's nlpsol takes it.

    x: the free numbers; for each block its states, column by column, and its log time; the free currents at their
    nodes; the balances' states and currents; the peaks.
    p: every input of the device, then the weights of what is minimised, then the factors of the sums, column by column.
    g: equations, zero, the sums of mixtures' shares last; the limits' residuals, in their order, kept where <= 0; sums
    of what is traded, below what the caller says; the currents' slopes; samples less peaks, all <= 0.
    """

    def __init__(
        self,
        model: DeviceFunctions,
        free: Sequence[Free],
        limits: Sequence[Constraint],
        minimize: Sequence[str],
        elements: int,
        currents: Sequence[FreeCurrent] = (),
        objectives: Sequence[str] = (),
        back_offs: Callable[[Any], dict[str, Any]] | None = None,
        mixtures: Sequence[Mixture] = (),
        order: int = ORDER,
    ) -> None:
        """Write objective and constraints on so many `elements` of time of an `order`.

        `minimize` names the outputs whose weighted sum is least. Those that are `traded` get a row each that bounds a
        sum of them, with factors that are parameters. `reserves` gives, for the device's inputs, what is added to the
        residuals of some limits, by name. The shares of records in a mixture are free numbers that add up to one.
        """
        self.model = model
        self.free = tuple(free)
        self.limits = tuple(limits)
        self.objectives = tuple(objectives)
        self.minimize = tuple(dict.fromkeys([*minimize, *objectives]))
        self._elements, self.order = elements, order
        self.free_currents = tuple(currents)
        self._reserves = back_offs
        self.mixtures = tuple(mixtures)
        self.wanted = list(dict.fromkeys([*(limit.output for limit in self.limits), *self.minimize]))
        self._check()
        self._build()

    def _build(self) -> None:
        unknowns = ca.MX.sym("free", len(self.free))
        inputs = ca.MX.sym("inputs", len(self.model.names))
        weights = ca.MX.sym("weights", len(self.minimize))
        factors = ca.MX.sym("factors", len(self.objectives), len(self.objectives))
        device_inputs = self._device_inputs = self.with_unknowns(inputs, unknowns)
        self._nodes = {c.phase: ca.MX.sym(f"current_{c.phase}", c.nodes) for c in self.free_currents}
        self.blocks = self._write_blocks(device_inputs)
        self.balances = self._write_balances(device_inputs)
        cycle, self.peaks, peak_rows = self._switch_values()
        self.cycle = cycle
        wanted = self.wanted
        values = self.model.outputs(wanted)(device_inputs, cycle) if wanted else ca.MX(0, 1)
        parts = (weights[i] * values[wanted.index(name)] for i, name in enumerate(self.minimize))
        objective = sum(parts, ca.MX(0.0))
        back_offs = self._reserves(device_inputs) if self._reserves else {}
        rows = [
            limit.residual(values[wanted.index(limit.output)]) + back_offs.get(limit.name, 0.0) for limit in self.limits
        ]
        objectives = ca.vertcat(*(values[wanted.index(name)] for name in self.objectives))
        sums = ca.mtimes(factors, objectives) if self.objectives else ca.MX(0, 1)
        equations = ca.vertcat(
            *(block.equations for block in self.blocks), *(b.equations for b in self.balances),
            self.shares_less_one(device_inputs),
        )  # fmt: skip
        slopes = self._slopes(device_inputs)
        everything = ca.vertcat(
            unknowns, *(block.unknowns for block in self.blocks), *self._nodes.values(),
            *(balance.unknowns for balance in self.balances), *self.peaks.values(),
        )  # fmt: skip
        self.equation_count = equations.numel()
        self.slope_count = slopes.numel()
        self.peak_count = peak_rows.numel()
        self.function: dict[str, Any] = {
            "x": everything,
            "p": ca.vertcat(inputs, weights, ca.vec(factors)),
            "f": objective,
            "g": ca.vertcat(equations, *rows, sums, slopes, peak_rows),
        }
        self.unknown_count = everything.numel()

    def with_unknowns(self, inputs: Any, unknowns: Any) -> Any:
        """Inputs with the free numbers in their places."""
        entries = ca.vertsplit(inputs)
        for i, free in enumerate(self.free):
            entries[self.model.index[free.name]] = free.to_value(unknowns[i])
        return ca.vertcat(*entries)

    def shares_less_one(self, inputs: Any) -> Any:
        """What the shares of each mixture add up to beyond one."""
        places = ([self.model.index[name] for name in mixture.shares] for mixture in self.mixtures)
        return ca.vertcat(*(ca.sum1(ca.vertcat(*(inputs[place] for place in one))) - 1.0 for one in places))

    # --- what is simulated elsewhere, as equations ---

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
        found: list[str] = []
        for phase in reversed(phases.values()):
            mine = [row.name for row in phase.events if row.name in needed | ending]
            if mine and phase.phase.after:
                ending.add(phases[phase.phase.after].phase.ends)
            found = mine + found
        return found

    def simulated(
        self,
        simulator: Simulator,
        inputs: Array,
        current_profiles: Mapping[str, CurrentProfile] | None = None,
        deadline: Deadline = NEVER,
    ) -> Cycle:
        """The working cycle at some inputs, as far as the problem needs it. Raises SimulationError, TimeOverError."""
        return simulator.run(
            inputs, current_profiles, phases=self._phases, wanted=self._needed, deadline=deadline
        )  # fmt: skip

    @cached_property
    def known(self) -> list[str]:
        """The outputs, by full name, that are known once that is simulated."""
        table, needed = self.model.table, {*self.events, *self._needed}
        unknown = {row.name for row in table.supplied if row.name not in needed}
        return [
            name for name in self.model.output_names if not unknown & {name.partition("@")[0], *table.ancestors(name)}
        ]

    @cached_property
    def _phases(self) -> set[str]:
        rows = [self.model.table.quantity(name) for name in (*self.events, *self._needed)]
        return {row.phase for row in rows if isinstance(row, Event | Path | Steady)}

    @cached_property
    def _needed(self) -> set[str]:
        table = self.model.table
        return {base for name in self.wanted for base in (name.partition("@")[0], *table.ancestors(name))}

    def elements(self, phase: str, asked: int | None = None) -> int:
        """Count of a phase's elements: no less than `asked` for, and the corners of its current lie between them.

        A freezing layer whose edge runs through the cells wants more; twice as many where its current is free, as the
        current's corners divide its time already.
        """
        pieces = next((current.pieces for current in self.free_currents if current.phase == phase), 1)
        more = (FREEZING if pieces == 1 else 2.0) if self.model.phases[phase].phase.history else 1.0
        return pieces * math.ceil((asked or self._elements) * more / pieces)

    def currents_at_nodes(self, phase: str, inputs: Any) -> Any:
        """Current [A] of a phase at its nodes: one where it is constant."""
        row = self.model.phases[phase].phase
        for current in self.free_currents:
            if current.phase == phase:
                return row.sign * current.upper * self._nodes[phase]
        return row.sign * inputs[self.model.index[row.current_input]]

    def _write_blocks(self, inputs: Any) -> list[Block]:
        blocks: dict[str, Block] = {}
        for event in self.events:
            row = self.model.table.quantity(event)
            assert isinstance(row, Event)
            phase = self.model.phases[row.phase]
            after = phase.phase.after
            if after is None:
                start = phase.initial(inputs)
            else:
                start = phase.begin(blocks[self.model.phases[after].phase.ends].states[:, -1], inputs)
            nodes = self.currents_at_nodes(row.phase, inputs)
            ramp = self._ramp(row.phase, inputs)
            blocks[event] = phase_block(phase, event, self.elements(row.phase), inputs, start, nodes, ramp, self.order)
        return list(blocks.values())

    def _ramp(self, phase: str, inputs: Any) -> tuple[int, Any]:
        """Elements and time [s] a free current takes to its first node; a constant one is there from the start."""
        for current in self.free_currents:
            if current.phase == phase:
                first = current.upper * self._nodes[phase][0]
                return current.ramp_elements, ramp_time(first, inputs[self.model.index["current_slew"]])
        return 0, 0.0

    def _write_balances(self, inputs: Any) -> list[Balance]:
        needed = self._needed
        balances = []
        for name, phase in self.model.phases.items():
            if any(row.name in needed for row in phase.steadies):
                unknowns = ca.MX.sym(f"balance_{name}", phase.state_size + 1)
                state, profile = unknowns[:-1], unknowns[-1]
                gap = phase.watch_in_parts([phase.phase.ends])(state, profile, inputs)
                equations = ca.vertcat(phase.rates(state, profile, inputs), gap)
                balances.append(Balance(phase=name, unknowns=unknowns, equations=equations))
        return balances

    def _slopes(self, inputs: Any) -> Any:
        """How much steeper than allowed the free currents are, either way, as a share of what is allowed."""
        rows = []
        allowed = inputs[self.model.index["current_slew"]] if self.free_currents else None
        for block in self.blocks:
            for current in self.free_currents:
                if block.event == self.model.phases[current.phase].phase.ends:
                    step = current.upper * ca.diff(self._nodes[current.phase])
                    slope = step * current.pieces / (block.pieces_time * allowed)
                    rows += [slope - 1.0, -slope - 1.0]
        return ca.vertcat(*rows)

    def _switch_values(self) -> tuple[Any, dict[str, Any], Any]:
        """Values of the supplied rows as unknowns see them, the peaks' unknowns, and their constraints (<= 0).

        A path's maximum is an unknown that no sample exceeds: exact wherever the study bounds or minimises it.
        """
        by_event = {block.event: block for block in self.blocks}
        values: dict[str, Any] = {name: block.final_time for name, block in by_event.items()}
        peaks: dict[str, Any] = {}
        rows = []
        needed = self._needed
        for phase in self.model.phases.values():
            paths = [row for row in phase.paths if row.name in needed]
            if not paths:
                continue
            block, watch = by_event[phase.phase.ends], phase.watch([row.name for row in paths])
            samples = ca.vertsplit(at_each(phase, watch, block.every, block.currents, self._device_inputs))
            for row, sampled in zip(paths, samples, strict=True):
                if row.reduce == "integral":
                    values[row.name] = ca.mtimes(sampled[1:], block.weights)
                elif row.reduce == "end":
                    values[row.name] = sampled[-1]
                else:
                    scale = self.peak_scale(row)
                    peaks[row.name] = ca.MX.sym(row.name)
                    values[row.name] = scale * peaks[row.name]
                    rows.append(sampled.T / scale - peaks[row.name])
        for balance in self.balances:
            phase = self.model.phases[balance.phase]
            for steady in phase.steadies:
                state, profile = balance.unknowns[:-1], balance.unknowns[-1]
                values[steady.name] = phase.watch([steady.name])(state, profile, self._device_inputs)
        # What no wanted row needs is never read; NaN would show it if it were.
        cycle = ca.vertcat(*(values.get(name, np.nan) for name in self.model.switch_names))
        return cycle, peaks, ca.vertcat(*rows)

    @staticmethod
    def peak_scale(row: Path) -> float:
        """Order of magnitude of a peak: kelvins are hundreds, watts and volts tens."""
        return 100.0 if row.unit == "degC" else 10.0

    def _check(self) -> None:
        """Raise InputError for what cannot be put to the solver, with what can be said instead."""
        table = self.model.table
        for limit in self.limits:
            row = table.quantity(limit.output)
            if isinstance(row, Path) and row.reduce == "maximum" and limit.sense == ">=":
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
