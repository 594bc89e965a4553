"""One phase of the working cycle, compiled: heat equation and instants as functions of (state, current, inputs)."""

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import Any

from tvimdesign.device import Event, Path, Phase, Steady, Table
from tvimdesign.device.table.quantity import DRIVE, PHASE, STATE
from tvimdesign.physics.heat_flow import heat
from tvimdesign.physics.heat_flow.shape_factors import AMBIENT
from tvimdesign.simulation.working_cycle.symbols import ca, symbols

SHOWN = {"joint_stiffness": "stiffness_now", "joint_damping": "damping_now", "electrical_power": "electrical_power"}
"""Quantities of an instant that a phase is drawn with, by the name of their column."""
TEMPERATURES, FRACTIONS = "temperatures", "fractions"
"""Names of all temperatures of an instant [K], and of the solid fraction of each cell of the polymer."""


class PhaseFunctions:
    """One phase of a device with its records chosen. Functions are built when first asked for and kept."""

    def __init__(
        self, table: Table, phase: Phase, inputs: Any, given: Callable[[], dict[str, Any]], cells: int,
        input_names: Sequence[str],
    ) -> None:  # fmt: skip
        """Write nothing yet. `given` returns every given quantity, numbers as entries of the symbol `inputs`.

        `cells` divides the polymer.
        """
        self.table = table
        self.input_names = input_names
        self.phase = phase
        self.events = tuple(row for row in table.supplied if isinstance(row, Event) and row.phase == phase.name)
        self.paths = tuple(row for row in table.supplied if isinstance(row, Path) and row.phase == phase.name)
        self.steadies = tuple(row for row in table.supplied if isinstance(row, Steady) and row.phase == phase.name)
        self._inputs = inputs
        self._drive = ca.SX.sym("drive_current")
        self._given = given
        self._cells = cells
        self._watched: dict[tuple[str, ...], Any] = {}  # Functions of what is wanted (`watch`)

    @property
    def quantities(self) -> list[str]:
        """Names of all that is written of an instant."""
        rows = [row.name for row in (*self.events, *self.paths, *self.steadies)]
        helpers = (
            "stack_profile", "layer_surroundings", "end_places", "layer_temperatures", "state_rates", "impedance_now",
        )  # fmt: skip
        return [*(name for name in helpers if name in self.table.by_name), *SHOWN.values(), *rows]

    @cached_property
    def _known(self) -> dict[str, Any]:
        return {**self._given(), PHASE: self.phase, DRIVE: symbols(self._drive)[0]}

    @cached_property
    def _stack(self) -> heat.Stack:
        stack: heat.Stack = self.table.evaluate_instant(self._known, ["stack_now"])["stack_now"]
        return stack

    @cached_property
    def _state(self) -> Any:
        return ca.SX.sym("state", self.state_size)

    @cached_property
    def _written(self) -> dict[str, Any]:
        """All that is written of an instant so far; what is asked for is added."""
        return {**self._known, "stack_now": self._stack, STATE: symbols(self._state)}

    @cached_property
    def _instant(self) -> dict[str, Any]:
        instant = self.table.resolve_instant(self._written, self.quantities)
        seen = instant["stack_profile"]
        temperatures = [seen.cold, seen.hot, seen.near, seen.cells, seen.far, seen.plate, seen.beside, seen.sink]
        return instant | {TEMPERATURES: ca.vertcat(*temperatures, seen.around), FRACTIONS: seen.fractions}

    @property
    def _arguments(self) -> list[Any]:
        """State, current and inputs."""
        return [self._state, self._drive, self._inputs]

    def _function(self, name: str, values: Iterable[Any]) -> Any:
        return ca.Function(name, self._arguments, [ca.vertcat(*values)])

    @property
    def network(self) -> tuple[Any, Any]:
        """Expressions for bodies and links.

        First conductance [W/K] and capacity [J/K] of every body around the layer, sink included. One that is not above
        zero belongs to no module, as where the core is wider than the layer's inner edge; its temperature runs away.
        Then the conductance [W/K] of every link between them; one that corrects another may be below zero. Those to
        the air only correct what surfaces lose.
        """
        sink = (self._stack.sink,) if self._stack.sink else ()
        chained = (*self._stack.beside, *sink)
        numbers = [part.conductance for part in chained]
        numbers += [body.capacity for body in (*chained, *self._stack.around)]
        links = [link.conductance for link in self._stack.links if link.second != AMBIENT]
        return ca.vertcat(*numbers), ca.vertcat(*links)

    @cached_property
    def initial(self) -> Any:
        """The function inputs -> state with everything at ambient temperature."""
        return ca.Function("initial", [self._inputs], [ca.vertcat(self._initial(self._stack))])

    def _initial(self, stack: heat.Stack) -> Any:
        return heat.initial_state(stack, self._cells, self._known["ambient_temperature"])

    @cached_property
    def state_size(self) -> int:
        """Count of the state's entries."""
        return len(self._initial(self._stack))

    @cached_property
    def begin(self) -> Any:
        """The function (state at the end of the phase before, inputs) -> state this one starts from."""
        before = ca.SX.sym("before", len(self._initial(self._stack._replace(freezing=None))))
        state = heat.with_history(symbols(before), self._stack) if self._stack.freezing else before
        return ca.Function("begin", [before, self._inputs], [ca.vertcat(state)])

    @cached_property
    def rates(self) -> Any:
        """The function (state, current, inputs) -> time derivative of the state."""
        return self._function("rates", [self._instant["state_rates"]])

    def watch(self, wanted: Sequence[str]) -> Any:
        """Return the function (state, current, inputs) -> what the wanted quantities of this phase are at an
        instant."""
        key = tuple(wanted)
        if key not in self._watched:
            self._watched[key] = self._function("watch", [self._instant[name] for name in wanted])
        return self._watched[key]

    def _instant_with(self, wanted: Sequence[str], **held: Any) -> list[Any]:
        """Return quantities of an instant with some others held at symbols of their own."""
        changed = held.keys()
        known = {name: value for name, value in self._written.items() if not changed & self._behind(name)}
        return list(self.table.resolve_instant({**known, **held}, wanted).values())

    def _behind(self, name: str) -> frozenset[str]:
        """Return what a quantity follows from; nothing for what a phase and its instant are given by."""
        return self.table.ancestors(name) if name.partition("@")[0] in self.table.by_name else frozenset()

    def evaluated(self, wanted: Sequence[str], value: Callable[..., Any]) -> Any:
        """Return the function (state, current, inputs) -> `value` of quantities at an instant, hidden ones too.

        `value` takes the wanted quantities in their order and returns an iterable of columns.
        """
        return self._function("evaluated", value(*self._instant_with(wanted)))

    @cached_property
    def temperatures(self) -> Any:
        """The function -> temperatures [K]: cold, hot, near face, cells, far face, plate, beside, sink, around."""
        return self._function(TEMPERATURES, [self._instant[TEMPERATURES]])

    def _parted(self, expression: Any) -> tuple[Any, Any, Any]:
        """Replace subexpressions of the inputs alone by symbols; return the expression and these symbols."""
        # What is written twice must be one constant, or what follows from it is computed twice as well.
        value, symbols, constants = ca.extract_parametric(ca.cse(expression), self._inputs)
        # Inputs that meet the state as they are stay in the expression; they are constants too.
        left = ca.symvar(value)
        moved = ca.which_depends(ca.vertcat(*left), self._inputs, 1, True) if left else []
        bare = [symbol for symbol, depends in zip(left, moved, strict=True) if depends]
        return value, ca.vertcat(*constants, *bare), ca.vertcat(*symbols, *bare)
