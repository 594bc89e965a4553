"""The device, compiled: the one table turned into CasADi functions of one vector of inputs.

`inputs` is the vector of every number the table is evaluated with, in the order of `Model.names`; `switch` holds the
values of the event and path rows, which a simulation or the optimiser supplies; `state` is the thermal state.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.device import Event, Path, Table
from tvimdesign.device.rows import STATE
from tvimdesign.physics import heat
from tvimdesign.solve.backend import ca


class Model:
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
        self.events = tuple(row for row in table.outputs if isinstance(row, Event))
        self.paths = tuple(row for row in table.outputs if isinstance(row, Path))
        self.switch_names = tuple(row.name for row in (*self.events, *self.paths))

    @cached_property
    def _symbols(self) -> tuple[Any, Any, dict[str, Any]]:
        inputs = ca.SX.sym("inputs", len(self.names))
        switch = ca.SX.sym("switch", len(self.switch_names))
        known = dict(self.words)
        known.update({name: inputs[i] for i, name in enumerate(self.names)})
        # The count of cells is a shape, not a number of the model: it stays what it is.
        known["rotor_cells"] = int(self.start[self.index["rotor_cells"]])
        return inputs, switch, known

    @cached_property
    def output_names(self) -> list[str]:
        """Every output's full name in the table's order."""
        return self.table.names(self.points)

    def outputs(self, wanted: Sequence[str]) -> Any:
        """Return the function (inputs, switch) -> the wanted outputs, one vector."""
        inputs, switch, known = self._symbols
        known = {**known, **{name: switch[i] for i, name in enumerate(self.switch_names)}}
        values = self.table.evaluate(known, wanted)
        return ca.Function("outputs", [inputs, switch], [ca.vertcat(*(values[name] for name in wanted))])

    @cached_property
    def every_output(self) -> Any:
        """The function of all outputs, for evaluation and derivatives."""
        return self.outputs(self.output_names)

    @cached_property
    def _instant(self) -> dict[str, Any]:
        inputs, _, known = self._symbols
        state = ca.SX.sym("state", self.initial.size1_out(0))
        at_instant = {**known, STATE: [state[i] for i in range(state.numel())]}
        wanted = ("stack_profile", "state_rates", "impedance_now", *self.switch_names)
        return {"state": state, "inputs": inputs, **self.table.evaluate_instant(at_instant, wanted)}

    @cached_property
    def rates(self) -> Any:
        """The function (state, inputs) -> time derivative of the state."""
        now = self._instant
        return ca.Function("rates", [now["state"], now["inputs"]], [ca.vertcat(*now["state_rates"])])

    def watch(self, wanted: Sequence[str]) -> Any:
        """Return the function (state, inputs) -> what the wanted events wait for and paths reduce, one vector."""
        now = self._instant
        return ca.Function("watch", [now["state"], now["inputs"]], [ca.vertcat(*(now[name] for name in wanted))])

    def per_switch(self, function: Any) -> tuple[Any, Any]:
        """Split a function (state, inputs) in what is the same all through a switch, and what is not.

        Returns inputs -> constants, and (state, constants) -> the function's value. A collocation evaluates the first
        once and the second at every point.
        """
        now = self._instant
        value, symbols, constants = ca.extract_parametric(function(now["state"], now["inputs"]), now["inputs"])
        # Inputs that meet the state as they are stay in the expression; they are constants too.
        bare = [symbol for symbol in ca.symvar(value) if ca.which_depends(symbol, now["inputs"], 1, True)[0]]
        return (
            ca.Function("constants", [now["inputs"]], [ca.vertcat(*constants, *bare)]),
            ca.Function("varying", [now["state"], ca.vertcat(*symbols, *bare)], [value]),
        )

    @cached_property
    def instant(self) -> Any:
        """The function `watch` of all events and paths, in the order of `switch_names`."""
        return self.watch(self.switch_names)

    @cached_property
    def temperatures(self) -> Any:
        """The function (state, inputs) -> temperatures [K]: cold, hot, near face, cells, far face, plate, beside."""
        now = self._instant
        seen = now["stack_profile"]
        values = [seen.cold, seen.hot, seen.near, *seen.cells, seen.far, *seen.plate, *seen.beside]
        return ca.Function("temperatures", [now["state"], now["inputs"]], [ca.vertcat(*values)])

    @cached_property
    def impedance_now(self) -> Any:
        """The function (state, inputs) -> magnitude of the joint's dynamic stiffness [N*m/rad]."""
        now = self._instant
        return ca.Function("impedance_now", [now["state"], now["inputs"]], [now["impedance_now"]])

    @cached_property
    def initial(self) -> Any:
        """The function inputs -> state with everything at ambient temperature."""
        inputs, _, known = self._symbols
        values = self.table.evaluate(known, ["stack", "ambient_temperature"])
        state = heat.initial_state(values["stack"], self.cells, values["ambient_temperature"])
        return ca.Function("initial", [inputs], [ca.vertcat(*state)])

    def values(self, inputs: NDArray[np.float64], switch: Mapping[str, float]) -> dict[str, float]:
        """Every output in SI by full name."""
        vector = [switch[name] for name in self.switch_names]
        numbers = np.asarray(self.every_output(inputs, vector)).ravel()
        return dict(zip(self.output_names, (float(number) for number in numbers), strict=True))
