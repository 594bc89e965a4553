"""The device, compiled: the one table turned into CasADi functions of one vector of inputs.

`inputs` is the vector of every number the table is evaluated with, in the order of `Model.names`; `switch` holds the
values of the quantities that a simulation or the optimiser supplies, in the order of `Model.switch_names`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.device import Table
from tvimdesign.simulation.working_cycle.casadi_setup import ca, lean_function
from tvimdesign.simulation.working_cycle.phase_engine import PhaseEngine
from tvimdesign.simulation.working_cycle.phase_functions import PhaseFunctions
from tvimdesign.simulation.working_cycle.symbols import symbols


class DeviceFunctions:
    """One device with its records chosen. Functions are built when first asked for and kept."""

    def __init__(self, table: Table, given: Mapping[str, Any], points: Sequence[str], cells: int) -> None:
        """Index the numbers of `given`; records and options stay constants. `cells` divides the polymer layer."""
        self.table = table
        self.points = tuple(points)
        self.cells = cells
        self.names = [name for name, value in given.items() if isinstance(value, int | float)]
        self.start = np.array([float(given[name]) for name in self.names])
        self.index = {name: i for i, name in enumerate(self.names)}
        self.words = {name: value for name, value in given.items() if name not in self.index}
        self.switch_names = tuple(row.name for row in table.supplied)
        self._some: dict[tuple[str, ...], Any] = {}
        """Functions of outputs that were wanted together: to build one takes longer than a hundred values of it."""

    @cached_property
    def _symbols(self) -> tuple[Any, Any, dict[str, Any]]:
        inputs = ca.SX.sym("inputs", len(self.names))
        cycle = ca.SX.sym("cycle", len(self.switch_names))
        known = dict(self.words)
        entries = symbols(inputs)
        known.update({name: entries[i] for i, name in enumerate(self.names)})
        # The count of cells is a shape, not a number of the model: it stays what it is.
        known["rotor_cells"] = int(self.start[self.index["rotor_cells"]])
        return inputs, cycle, known

    @cached_property
    def _settled(self) -> dict[str, Any]:
        """All that follows from the inputs alone, written once for the outputs and every phase."""
        return self.table.settled(self._symbols[2])

    @cached_property
    def _known(self) -> dict[str, Any]:
        """All that is written so far, with the cycle's values as symbols; outputs that are asked for are added."""
        return {**self._settled, **self._cycle}

    @property
    def _cycle(self) -> dict[str, Any]:
        return dict(zip(self.switch_names, symbols(self._symbols[1]), strict=True))

    @cached_property
    def phases(self) -> dict[str, PhaseFunctions]:
        """Every phase of the working cycle by name, in the order they are gone through."""
        inputs, known = self._symbols[0], self._settled
        return {
            phase.name: PhaseFunctions(self.table, phase, inputs, known, self.cells, self.names)
            for phase in self.table.phases
        }

    @cached_property
    def engines(self) -> dict[str, PhaseEngine]:
        """The engine of every phase by name; what one records serves all who step this device."""
        return {name: PhaseEngine(phase) for name, phase in self.phases.items()}

    @cached_property
    def either_way(self) -> PhaseFunctions:
        """The first phase with a layer that has its history from the start: it melts and freezes at any current.

        It melts `melting_time` behind the equilibrium curve, which the first phase follows.
        """
        phase = replace(self.table.phases[0], history=True)
        return PhaseFunctions(self.table, phase, self._symbols[0], self._settled, self.cells, self.names)

    @cached_property
    def output_names(self) -> list[str]:
        """Every output's full name in the table's order."""
        return self.table.names(self.points)

    def outputs(self, wanted: Sequence[str], instead: Mapping[str, float] | None = None) -> Any:
        """Return the function (inputs, switch) -> the wanted outputs, one vector.

        `instead` fixes quantities, by full name, that would otherwise be computed.
        """
        inputs, cycle, given = self._symbols
        known = {**given, **self._cycle, **instead} if instead else self._known
        values = self.table.resolve(known, wanted)
        return lean_function("outputs", [inputs, cycle], ca.vertcat(*(values[name] for name in wanted)))

    @cached_property
    def every_output(self) -> Any:
        """The function of all outputs, for evaluation and derivatives."""
        return self.outputs(self.output_names)

    def values(self, inputs: NDArray[np.float64], cycle: Mapping[str, float]) -> dict[str, float]:
        """Return every output in SI by full name."""
        return self._evaluated(self.every_output, self.output_names, inputs, cycle)

    def some_values(
        self, wanted: Sequence[str], inputs: NDArray[np.float64], cycle: Mapping[str, float]
    ) -> dict[str, float]:
        """Return the wanted outputs in SI: quicker than all of them on a first call."""
        if not wanted:
            return {}
        key = tuple(wanted)
        if key not in self._some:
            self._some[key] = self.outputs(wanted)
        return self._evaluated(self._some[key], wanted, inputs, cycle)

    def _evaluated(
        self, function: Any, names: Sequence[str], inputs: NDArray[np.float64], cycle: Mapping[str, float]
    ) -> dict[str, float]:
        vector = [cycle[name] for name in self.switch_names]
        numbers = np.asarray(function(inputs, vector)).ravel()
        return dict(zip(names, (float(number) for number in numbers), strict=True))
