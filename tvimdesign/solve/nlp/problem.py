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

from tvimdesign.base.errors import InputError
from tvimdesign.device import Event, Path, Steady
from tvimdesign.simulation.casadi_setup import ca
from tvimdesign.simulation.current_profile import Drive, ramp_time
from tvimdesign.simulation.cycle import Simulator, Switch
from tvimdesign.simulation.device_functions import Model
from tvimdesign.solve.nlp.constraints import Limit
from tvimdesign.solve.nlp.transcription import Block, at_each, stage_block

Array = NDArray[np.float64]


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
    """The current of one stage, free at the nodes of its pieces, between `lower` and `upper` [A] in size."""

    stage: str
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
    """A steady state that is unknown: everything stays, with the event that ends the stage at zero."""

    stage: str
    unknowns: Any
    """MX, the state and the current [A]."""
    equations: Any


class Problem:
    """A nonlinear programme, `function` = {x, p, f, g} as CasADi's nlpsol takes it.

    x: the free numbers; for each block its states, column by column, and its log time; the free currents at their
    nodes; the balances' states and currents; the peaks.
    p: every input of the device, then the weights of what is minimised, then the factors of the sums, column by column.
    g: equations, zero; the limits' residuals, in their order, kept where <= 0; sums of what is traded, below what the
    caller says; the currents' slopes; samples less peaks, all <= 0.
    """

    def __init__(
        self,
        model: Model,
        free: Sequence[Free],
        limits: Sequence[Limit],
        minimize: Sequence[str],
        elements: int,
        currents: Sequence[FreeCurrent] = (),
        traded: Sequence[str] = (),
        reserves: Callable[[Any], dict[str, Any]] | None = None,
    ) -> None:
        """Write objective and constraints. `minimize` names the outputs whose weighted sum is least.

        Those that are `traded` get a row each that bounds a sum of them, with factors that are parameters.
        `reserves` gives, for the device's inputs, what is added to the residuals of some limits, by name.
        """
        self.model = model
        self.free = tuple(free)
        self.limits = tuple(limits)
        self.traded = tuple(traded)
        self.minimize = tuple(dict.fromkeys([*minimize, *traded]))
        self._elements = elements
        self.free_currents = tuple(currents)
        self._reserves = reserves
        self.wanted = list(dict.fromkeys([*(limit.output for limit in self.limits), *self.minimize]))
        self._check()
        self._build()

    def _build(self) -> None:
        unknowns = ca.MX.sym("free", len(self.free))
        inputs = ca.MX.sym("inputs", len(self.model.names))
        weights = ca.MX.sym("weights", len(self.minimize))
        factors = ca.MX.sym("factors", len(self.traded), len(self.traded))
        device_inputs = self._device_inputs = self.with_unknowns(inputs, unknowns)
        self._nodes = {c.stage: ca.MX.sym(f"current_{c.stage}", c.nodes) for c in self.free_currents}
        self.blocks = self._write_blocks(device_inputs)
        self.balances = self._write_balances(device_inputs)
        switch, self.peaks, peak_rows = self._switch_values()
        self.switch = switch
        wanted = self.wanted
        values = self.model.outputs(wanted)(device_inputs, switch) if wanted else ca.MX(0, 1)
        objective = sum(weights[i] * values[wanted.index(name)] for i, name in enumerate(self.minimize))
        reserves = self._reserves(device_inputs) if self._reserves else {}
        rows = [
            limit.residual(values[wanted.index(limit.output)]) + reserves.get(limit.name, 0.0) for limit in self.limits
        ]
        traded = ca.vertcat(*(values[wanted.index(name)] for name in self.traded))
        sums = ca.mtimes(factors, traded) if self.traded else ca.MX(0, 1)
        equations = ca.vertcat(*(block.equations for block in self.blocks), *(b.equations for b in self.balances))
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

    # --- what is simulated elsewhere, as equations ---

    @cached_property
    def events(self) -> list[str]:
        """The events whose times the problem needs, each after those it starts from."""
        needed = self._needed
        stages = self.model.stages
        ending: set[str] = {
            stages[row.stage].stage.ends
            for row in self.model.table.supplied
            if isinstance(row, Path) and row.name in needed
        }
        found: list[str] = []
        for stage in reversed(stages.values()):
            mine = [row.name for row in stage.events if row.name in needed | ending]
            if mine and stage.stage.after:
                ending.add(stages[stage.stage.after].stage.ends)
            found = mine + found
        return found

    def simulated(self, simulator: Simulator, inputs: Array, drives: Mapping[str, Drive] | None = None) -> Switch:
        """The working cycle at some inputs, as far as the problem needs it."""
        return simulator.run(inputs, drives, stages=self._stages, wanted=self._needed)

    @cached_property
    def known(self) -> list[str]:
        """The outputs, by full name, that are known once that is simulated."""
        table, needed = self.model.table, {*self.events, *self._needed}
        unknown = {row.name for row in table.supplied if row.name not in needed}
        return [
            name for name in self.model.output_names if not unknown & {name.partition("@")[0], *table.ancestors(name)}
        ]

    @cached_property
    def _stages(self) -> set[str]:
        rows = [self.model.table.row(name) for name in (*self.events, *self._needed)]
        return {row.stage for row in rows if isinstance(row, Event | Path | Steady)}

    @cached_property
    def _needed(self) -> set[str]:
        table = self.model.table
        return {base for name in self.wanted for base in (name.partition("@")[0], *table.ancestors(name))}

    def elements(self, stage: str) -> int:
        """Count of a stage's elements: no less than asked for, and the corners of its current lie between them.

        A freezing layer whose edge runs through the cells wants twice as many.
        """
        asked = self._elements * (2 if self.model.stages[stage].stage.history else 1)
        pieces = next((current.pieces for current in self.free_currents if current.stage == stage), 1)
        return pieces * math.ceil(asked / pieces)

    def currents_at_nodes(self, stage: str, inputs: Any) -> Any:
        """Current [A] of a stage at its nodes: one where it is constant."""
        row = self.model.stages[stage].stage
        for current in self.free_currents:
            if current.stage == stage:
                return row.sign * current.upper * self._nodes[stage]
        return row.sign * inputs[self.model.index[row.drive]]

    def _write_blocks(self, inputs: Any) -> list[Block]:
        blocks: dict[str, Block] = {}
        for event in self.events:
            row = self.model.table.row(event)
            assert isinstance(row, Event)
            stage = self.model.stages[row.stage]
            after = stage.stage.after
            if after is None:
                start = stage.initial(inputs)
            else:
                start = stage.begin(blocks[self.model.stages[after].stage.ends].states[:, -1], inputs)
            nodes = self.currents_at_nodes(row.stage, inputs)
            ramp = self._ramp(row.stage, inputs)
            blocks[event] = stage_block(stage, event, self.elements(row.stage), inputs, start, nodes, ramp)
        return list(blocks.values())

    def _ramp(self, stage: str, inputs: Any) -> tuple[int, Any]:
        """Elements and time [s] a free current takes to its first node; a constant one is there from the start."""
        for current in self.free_currents:
            if current.stage == stage:
                first = current.upper * self._nodes[stage][0]
                return current.ramp_elements, ramp_time(first, inputs[self.model.index["current_slew"]])
        return 0, 0.0

    def _write_balances(self, inputs: Any) -> list[Balance]:
        needed = self._needed
        balances = []
        for name, stage in self.model.stages.items():
            if any(row.name in needed for row in stage.steadies):
                unknowns = ca.MX.sym(f"balance_{name}", stage.state_size + 1)
                state, drive = unknowns[:-1], unknowns[-1]
                gap = stage.watch([stage.stage.ends])(state, drive, inputs)
                equations = ca.vertcat(stage.rates(state, drive, inputs), gap)
                balances.append(Balance(stage=name, unknowns=unknowns, equations=equations))
        return balances

    def _slopes(self, inputs: Any) -> Any:
        """How much steeper than allowed the free currents are, either way, as a share of what is allowed."""
        rows = []
        allowed = inputs[self.model.index["current_slew"]] if self.free_currents else None
        for block in self.blocks:
            for current in self.free_currents:
                if block.event == self.model.stages[current.stage].stage.ends:
                    step = current.upper * ca.diff(self._nodes[current.stage])
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
        for stage in self.model.stages.values():
            paths = [row for row in stage.paths if row.name in needed]
            if not paths:
                continue
            block, watch = by_event[stage.stage.ends], stage.watch([row.name for row in paths])
            samples = ca.vertsplit(at_each(stage, watch, block.every, block.currents, self._device_inputs))
            for row, sampled in zip(paths, samples, strict=True):
                if row.reduce == "integral":
                    values[row.name] = ca.mtimes(sampled[1:], block.weights)
                else:
                    scale = self.peak_scale(row)
                    peaks[row.name] = ca.MX.sym(row.name)
                    values[row.name] = scale * peaks[row.name]
                    rows.append(sampled.T / scale - peaks[row.name])
        for balance in self.balances:
            stage = self.model.stages[balance.stage]
            for steady in stage.steadies:
                state, drive = balance.unknowns[:-1], balance.unknowns[-1]
                values[steady.name] = stage.watch([steady.name])(state, drive, self._device_inputs)
        # What no wanted row needs is never read; NaN would show it if it were.
        switch = ca.vertcat(*(values.get(name, np.nan) for name in self.model.switch_names))
        return switch, peaks, ca.vertcat(*rows)

    @staticmethod
    def peak_scale(row: Path) -> float:
        """Order of magnitude of a peak: kelvins are hundreds, watts and volts tens."""
        return 100.0 if row.unit == "degC" else 10.0

    def _check(self) -> None:
        """Raise InputError for what cannot be put to the solver, with what can be said instead."""
        table = self.model.table
        for limit in self.limits:
            row = table.row(limit.output)
            if isinstance(row, Path) and row.reduce == "maximum" and limit.sense == ">=":
                raise InputError(f"require.{limit.output}: a peak can be kept below a limit, not above one")
        for current in self.free_currents:
            ends = self.model.stages[current.stage].stage.ends
            mine = [row.name for row in self.model.stages[current.stage].events if row.name != ends]
            others = [name for name in self.events if name in mine]
            if others:
                raise InputError(
                    f"profile.{current.stage}: the pieces of the current divide the time to {ends}; "
                    f"{', '.join(others)} cannot be limited or minimised beside it; "
                    "choose what ends the stage with `response_criterion`"
                )
            if ends not in self.events:
                raise InputError(
                    f"profile.{current.stage}: nothing that is required or minimised depends on this stage; "
                    f"minimise {ends}, or leave the profile out"
                )
