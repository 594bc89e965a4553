"""The table of one kind of module: every quantity looked up by name, and evaluated from those it needs."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from graphlib import CycleError, TopologicalSorter
from typing import Any

from tvimdesign.base.errors import InputError
from tvimdesign.device.table.quantity import (
    NOT_QUANTITIES,
    Choice,
    Event,
    FirstOscillation,
    Input,
    Output,
    Path,
    Phase,
    Quantity,
    Scalar,
    Simulated,
    Steady,
    Supplied,
)

AS_DRAWN = "as_drawn"  # Name under which the inputs are given that the parts were drawn with
_DRAWN = ("Layout", "Size and weight")  # Groups of what parts are drawn with and weigh


@dataclass(frozen=True)
class Table:
    """Every quantity of one kind of module, looked up by name."""

    quantities: tuple[Quantity, ...]
    phases: tuple[Phase, ...] = ()
    by_name: dict[str, Quantity] = field(init=False, repr=False)
    mode: str = field(init=False, default="")  # The mode it was made for by the package's own equations, if it was

    def __post_init__(self) -> None:
        """Index the quantities; raise ValueError for a name that is doubled or unknown, a circle or an unread input."""
        index: dict[str, Quantity] = {}
        for quantity in self.quantities:
            if quantity.name in index:
                raise ValueError(f"two quantities are named {quantity.name!r}")
            index[quantity.name] = quantity
        object.__setattr__(self, "by_name", index)
        parents = {quantity.name: self._parents(quantity) for quantity in self.outputs}
        for name, read in parents.items():
            if unknown := read.difference(index):
                raise ValueError(f"the quantity {name!r} reads {min(unknown)!r}, which is no quantity")
        try:
            TopologicalSorter(parents).prepare()
        except CycleError as error:
            raise ValueError(f"quantities depend on one another: {' -> '.join(error.args[1])}") from error
        given: tuple[Input | Choice, ...] = (*self.inputs, *self.choices)
        records = {source[0] for quantity in given for source in (quantity.record, quantity.stock_record) if source}
        currents = {phase.current_input for phase in self.phases}
        unread = {q.name for q in given if isinstance(q, Choice) or not q.read_by} - records - currents
        if unread := unread.difference(*parents.values()):
            raise ValueError(f"nothing reads the input {min(unread)!r}")

    @cached_property
    def inputs(self) -> tuple[Input, ...]:
        """Return the numbers a study may set."""
        return tuple(quantity for quantity in self.quantities if isinstance(quantity, Input))

    @cached_property
    def choices(self) -> tuple[Choice, ...]:
        """Return the words a study may set."""
        return tuple(quantity for quantity in self.quantities if isinstance(quantity, Choice))

    @cached_property
    def outputs(self) -> tuple[Output, ...]:
        """Return what follows from the inputs."""
        return tuple(quantity for quantity in self.quantities if isinstance(quantity, Output))

    def names(self, points: Iterable[str]) -> list[str]:
        """Return the full name (`quantity` or `quantity@point`) of every output a study can limit, in the table's
        order."""
        points = list(points)
        return [
            name
            for quantity in self.outputs
            if not (quantity.instant or quantity.hidden or isinstance(quantity, Simulated))
            for name in ([f"{quantity.name}@{point}" for point in points] if quantity.per_point else [quantity.name])
        ]

    @cached_property
    def supplied(self) -> tuple[Event | Path | Steady, ...]:
        """Return the outputs that a simulation or the optimiser supplies."""
        return tuple(quantity for quantity in self.outputs if isinstance(quantity, Supplied))

    @cached_property
    def behind_supplied(self) -> frozenset[str]:
        """Return the supplied outputs and all that depends on them, by base name."""
        supplied = {quantity.name for quantity in self.supplied}
        return frozenset(
            quantity.name for quantity in self.outputs if supplied & {quantity.name, *self.ancestors(quantity.name)}
        )

    @cached_property
    def first_oscillations(self) -> tuple[FirstOscillation, ...]:
        """Return the outputs that are seen in a simulated release."""
        return tuple(quantity for quantity in self.outputs if isinstance(quantity, FirstOscillation))

    def phase(self, name: str) -> Phase:
        """Return the phase of that name."""
        return next(phase for phase in self.phases if phase.name == name)

    def quantity(self, name: str) -> Quantity:
        """Return the quantity of a full name; raises InputError where there is none."""
        base = name.partition("@")[0]
        if base not in self.by_name:
            raise InputError(f"no quantity is named {base!r}")
        return self.by_name[base]

    def output(self, name: str) -> Output:
        """Return the output quantity of a full name; raises InputError where it is not an output."""
        quantity = self.quantity(name)
        if not isinstance(quantity, Output):
            raise InputError(f"{name!r} is set by the study, not computed")
        return quantity

    def unit(self, name: str) -> str:
        """Return the unit that people read and write a quantity's numbers in; raises InputError for a choice."""
        quantity = self.quantity(name)
        if isinstance(quantity, Choice):
            raise InputError(f"{name!r} is a word, not a number")
        return quantity.unit

    def evaluate(self, given: Mapping[str, Any], wanted: Iterable[str]) -> dict[str, Scalar]:
        """Compute the wanted outputs from the given quantities, each quantity once.

        `given` holds SI numbers, arrays or symbols by full name, and the chosen records and options. Returns the wanted
        values by name. Raises InputError where a quantity is missing from `given`.
        """
        return self.resolve(self.with_drawn(given), wanted)

    def with_drawn(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """Return the given quantities with sizes and masses of parts that were drawn with other inputs, `AS_DRAWN`."""
        if not (inputs := given.get(AS_DRAWN)):
            return dict(given)
        names = [name for name in self._drawn if self.ancestors(name) & inputs.keys()]
        return {**given, **self.resolve({**given, **inputs}, names)}

    @cached_property
    def _drawn(self) -> list[str]:
        return [name for name in self._settled_names if self.by_name[name].group in _DRAWN]

    @cached_property
    def drawn_with(self) -> dict[str, Input]:
        """Return the inputs that parts are drawn with, by name."""
        behind = frozenset[str]().union(*map(self.ancestors, self._drawn))
        return {row.name: row for row in self.inputs if row.name in behind and not row.per_point}

    def resolve(self, known: dict[str, Any], wanted: Iterable[str]) -> dict[str, Scalar]:
        """Compute the wanted outputs from known quantities, and add all that is computed on the way to these."""
        return {name: self._resolve(name, known) for name in wanted}

    def _resolve(self, name: str, known: dict[str, Any]) -> Any:
        if name in known:
            return known[name]
        base, _, point = name.partition("@")
        quantity = self.quantity(base)
        if not isinstance(quantity, Output) or isinstance(quantity, (*Supplied, Simulated)):
            raise InputError(f"{name!r} has no value")
        known[name] = quantity.call([self._resolve(self._at(need, point), known) for need in quantity.needs])
        return known[name]

    def settled(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """Return the given quantities and all that follow from them alone: neither of an instant nor behind anything
        supplied."""
        known = dict(given)
        for name in self._settled_names:
            self._resolve(name, known)
        return known

    @cached_property
    def _settled_names(self) -> list[str]:
        open_quantities = {
            quantity.name
            for quantity in self.quantities
            if isinstance(quantity, (*Supplied, Simulated)) or getattr(quantity, "instant", False)
        }
        return [
            quantity.name
            for quantity in self.outputs
            if not quantity.per_point
            and quantity.name not in open_quantities
            and not open_quantities & self.ancestors(quantity.name)
        ]

    def evaluate_instant(self, given: Mapping[str, Any], wanted: Iterable[str]) -> dict[str, Scalar]:
        """Compute quantities at one instant of a phase, each once; `given` must hold the state, the current and the
        phase.

        Of an event the value is what it waits for, of a path what it reduces, of a steady quantity what it takes.
        Quantities of a first oscillation want the contact at an instant of it instead."""
        return self.resolve_instant(dict(given), wanted)

    def resolve_instant(self, known: dict[str, Any], wanted: Iterable[str]) -> dict[str, Scalar]:
        """Compute quantities at an instant as `evaluate_instant` does, and add all that is computed to `known`."""
        values: dict[str, Scalar] = {}
        for name in wanted:
            quantity = self.quantity(name)
            if isinstance(quantity, (*Supplied, Simulated)):
                values[name] = quantity.call([self._resolve(need, known) for need in quantity.needs])
            else:
                values[name] = self._resolve(name, known)
        return values

    def _at(self, need: str, point: str) -> str:
        if need in NOT_QUANTITIES or "@" in need:
            return need
        quantity = self.by_name[need]
        per_point = not isinstance(quantity, Choice) and quantity.per_point
        return f"{need}@{point}" if per_point and point else need

    def fields_of(self, choice: str) -> frozenset[str] | None:
        """Return the values and words that are taken of a choice's record; None if an output reads the record."""
        if any(choice in self._parents(quantity) for quantity in self.outputs):
            return None
        given: tuple[Input | Choice, ...] = (*self.inputs, *self.choices)
        sources = [source for row in given for source in (row.record, row.stock_record)]
        sources += [row.range_of for row in self.inputs]
        return frozenset(source[1] for source in sources if source and source[0] == choice)

    @cached_property
    def _ancestors(self) -> dict[str, frozenset[str]]:
        """Return those that were asked for."""
        return {}

    def ancestors(self, name: str) -> frozenset[str]:
        """Return every quantity, by base name, that the named one depends on; the input that is a phase's current
        included."""
        if name not in self._ancestors:
            quantity = self.by_name[name.partition("@")[0]]
            parents = self._parents(quantity) if isinstance(quantity, Output) else frozenset()
            self._ancestors[name] = parents.union(*map(self.ancestors, parents))
        return self._ancestors[name]

    def _parents(self, quantity: Output) -> frozenset[str]:
        """Return what a quantity reads, by base name, and the current of its phase."""
        needs = (*quantity.needs, *self._currents(quantity))
        return frozenset(need.partition("@")[0] for need in needs) - NOT_QUANTITIES

    def _currents(self, quantity: Output) -> Iterator[str]:
        """Return the inputs that are the current of a supplied quantity's phase, and of those before it."""
        following = quantity.phase if isinstance(quantity, Supplied) else None
        while following:
            phase = self.phase(following)
            if phase.current_input in self.by_name:
                yield phase.current_input
            following = phase.after
