"""The optimisation problem of a study, built once: CasADi unknowns, objective and named constraints for IPOPT.

Every number that is not an unknown is a parameter, so starts, weights, catalogue sizes and bounds change nothing that
was built. Unknowns that are positive throughout are logarithms of their ratio to the study's start.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.device import Path
from tvimdesign.errors import InputError
from tvimdesign.solve.backend import ca
from tvimdesign.solve.limits import Limit
from tvimdesign.solve.model import Model
from tvimdesign.solve.transcription import Block, at_each, switch_block

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


class Problem:
    """A nonlinear programme, `function` = {x, p, f, g} as CasADi's nlpsol takes it.

    x: the free numbers; for each block its states, column by column, and its log time; the peaks.
    p: every input of the device, then the weights of what is minimised.
    g: the blocks' equations, zero; the limits' residuals, in their order, kept where <= 0; samples less peaks, <= 0.
    """

    def __init__(
        self, model: Model, free: Sequence[Free], limits: Sequence[Limit], minimize: Sequence[str], elements: int
    ) -> None:
        """Write objective and constraints. `minimize` names the outputs whose weighted sum is least."""
        self.model = model
        self.free = tuple(free)
        self.limits = tuple(limits)
        self.minimize = tuple(minimize)
        self.elements = elements
        self._build()

    def _build(self) -> None:
        unknowns = ca.MX.sym("free", len(self.free))
        inputs = ca.MX.sym("inputs", len(self.model.names))
        weights = ca.MX.sym("weights", len(self.minimize))
        device_inputs = self._device_inputs = self._with_unknowns(inputs, unknowns)
        wanted = list(dict.fromkeys([*(limit.output for limit in self.limits), *self.minimize]))
        self.blocks = self._write_blocks(wanted, device_inputs)
        switch, self.peaks, peak_rows = self._switch_values()
        values = self.model.outputs(wanted)(device_inputs, switch) if wanted else ca.MX(0, 1)
        objective = sum(weights[i] * values[wanted.index(name)] for i, name in enumerate(self.minimize))
        rows = [limit.residual(values[wanted.index(limit.output)]) for limit in self.limits]
        equations = ca.vertcat(*(block.equations for block in self.blocks))
        everything = ca.vertcat(unknowns, *(self._block_unknowns(b) for b in self.blocks), *self.peaks.values())
        self.equation_count = equations.numel()
        self.peak_count = peak_rows.numel()
        self.function = {
            "x": everything,
            "p": ca.vertcat(inputs, weights),
            "f": objective,
            "g": ca.vertcat(equations, *rows, peak_rows),
        }
        self.unknown_count = everything.numel()

    def _with_unknowns(self, inputs: Any, unknowns: Any) -> Any:
        """Inputs with the free numbers in their places."""
        entries = ca.vertsplit(inputs)
        for i, free in enumerate(self.free):
            entries[self.model.index[free.name]] = free.to_value(unknowns[i])
        return ca.vertcat(*entries)

    def _write_blocks(self, wanted: Sequence[str], inputs: Any) -> list[Block]:
        needed = self._needed(wanted)
        events = [row.name for row in self.model.events if row.name in needed]
        if "response_time" not in events and any(row.name in needed for row in self.model.paths):
            events.append("response_time")
        return [switch_block(self.model, event, self.elements, inputs) for event in events]

    def _needed(self, wanted: Sequence[str]) -> set[str]:
        table = self.model.table
        return {base for name in wanted for base in (name.partition("@")[0], *table.ancestors(name))}

    def _switch_values(self) -> tuple[Any, dict[str, Any], Any]:
        """Values of event and path rows as unknowns see them, the peaks' unknowns, and their constraints (<= 0).

        A path's maximum is an unknown that no sample exceeds: exact wherever the study bounds or minimises it.
        """
        by_event = {block.event: block for block in self.blocks}
        values: dict[str, Any] = {name: block.final_time for name, block in by_event.items()}
        peaks: dict[str, Any] = {}
        rows = []
        needed = self._needed([*(limit.output for limit in self.limits), *self.minimize])
        for row in self.model.paths:
            if row.name not in needed:
                continue
            block = by_event["response_time"]
            samples = at_each(self.model, self.model.watch([row.name]), block.every, self._device_inputs)
            if row.reduce == "integral":
                values[row.name] = block.final_time * ca.mtimes(samples[1:], block.weights)
            else:
                scale = self.peak_scale(row)
                peaks[row.name] = ca.MX.sym(row.name)
                values[row.name] = scale * peaks[row.name]
                rows.append(ca.vec(samples) / scale - peaks[row.name])
        # What no wanted row needs is never read; NaN would show it if it were.
        switch = ca.vertcat(*(values.get(name, np.nan) for name in self.model.switch_names))
        return switch, peaks, ca.vertcat(*rows)

    @staticmethod
    def peak_scale(row: Path) -> float:
        """Order of magnitude of a peak: kelvins are hundreds, watts and volts tens."""
        return 100.0 if row.unit == "degC" else 10.0

    @staticmethod
    def _block_unknowns(block: Block) -> Any:
        return ca.vertcat(ca.vec(block.states), block.log_time)

    def check(self) -> None:
        """Raise InputError where a requirement asks a peak to be high, which has no meaning."""
        for limit in self.limits:
            row = self.model.table.row(limit.output)
            if isinstance(row, Path) and row.reduce == "maximum" and limit.sense == ">=":
                raise InputError(f"require.{limit.output}: a peak can be kept below a limit, not above one")
