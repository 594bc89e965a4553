"""The machinery of the one table: what a row is, and how a table of rows is evaluated.

A table says what a module is. `Input` rows are numbers that a study may set, `Choice` rows are words (a catalogue
record or an option), `Output` rows are what follows. An output's function names what it needs by its parameters: the
parameter `wire_diameter` is the row `wire_diameter`. So the table is also the dependency graph, and floats, arrays and
CasADi symbols go through the same functions.

A row with `per_point=True` has one value at each operating point and is written `name@point`; another row asks for it
at a certain point with a parameter `name_at_point`. A row with `instant=True` has a value at each instant of a stage
(heating until the joint is soft is one, cooling until it is stiff again another). `Event` rows are the times at which
something that rises passes zero; `Path` rows reduce an instant's value over a stage; `Steady` rows are what it takes to
stay where a stage ends. The solver, or a simulation, supplies those three; everything else is arithmetic. `Swing` rows
are seen in a simulated release of the link, after a design is found.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, TypeAlias

from tvimdesign.base.errors import InputError

Scalar: TypeAlias = Any
"""A float, a numpy array or a CasADi expression."""


@dataclass(frozen=True, kw_only=True)
class Rule:
    """A limit that belongs to the machine, in SI, with the reason people are told."""

    sense: Literal["<=", ">="]
    value: float
    reason: str
    exists_above: float | None = None
    """The value at and below which there is no such geometry, and the equations mean nothing."""


def at_least(value: float, reason: str, exists_above: float | None = None) -> Rule:
    """A lower limit that belongs to the machine."""
    return Rule(sense=">=", value=value, reason=reason, exists_above=exists_above)


@dataclass(frozen=True)
class Extra:
    """Something a module has only where a study asks for it."""

    choice: str
    """The row it is chosen by."""
    without: str
    """The word of that choice for a module that lacks it."""


@dataclass(frozen=True, kw_only=True)
class Input:
    """A number the study may set. Values are SI; `unit` is what people read and write."""

    name: str
    unit: str
    description: str
    group: str
    default: float | None = None
    lower: float = float("-inf")
    upper: float = float("inf")
    variable: bool = False
    integer: bool = False
    per_point: bool = False
    source: str = ""
    """Where the default comes from: `status: source`."""
    record: tuple[str, str] | None = None
    """(choice, field): where the default comes from when the study does not set it."""
    mode: str | None = None
    """The one mode that has it, where not all have."""
    extras: tuple[Extra, ...] = ()
    """What a module must have for it to be of any effect."""


@dataclass(frozen=True, kw_only=True)
class Choice:
    """A word the study may set: the name of a record on a catalogue shelf, or one of a few options."""

    name: str
    description: str
    group: str
    default: str = ""
    shelf: str | None = None
    options: tuple[str, ...] = ()
    """The words there are; of a shelf, those beside its records."""
    record: tuple[str, str] | None = None
    """(choice, word): where the default comes from, of a choice that stands before this one."""
    only: tuple[str, str, str] | None = None
    """(word, value, reason): a record fits only if its word has that value."""
    extras: tuple[Extra, ...] = ()
    """What a module must have for it to be of any effect."""


def its_name(name: str, of: str) -> str:
    """Name of a row that several things have alike, of one of them: `its_screw` of `link` is `link_screw`."""
    return f"{of}_{name.removeprefix('its_')}" if of and name.startswith("its_") else name


@dataclass(frozen=True, kw_only=True)
class Output:
    """A named result. `function` takes the rows it names as parameters and returns SI."""

    name: str
    unit: str
    description: str
    group: str
    function: Callable[..., Scalar]
    per_point: bool = False
    instant: bool = False
    hidden: bool = False
    """An intermediate result, of any type, that other rows use and nobody asks for."""
    headline: bool = False
    """Whether the row stands in a summary."""
    least_of: tuple[str, ...] = ()
    """The rows this one is the least of; a lower limit on it is put on each of them, which have no kinks."""
    rules: tuple[Rule, ...] = ()
    """Limits that hold in every study whose module has the row's extras, unless it sets its own in the same sense."""
    advice: tuple[Rule, ...] = ()
    """Limits that are reported where they are broken, and enforced only where a study requires them."""
    better: Literal["less", "more"] | None = None
    """Which way it is better whatever the module is for; None where that depends."""
    of: str = ""
    """What has the row, where several things have it alike: `its_` in the parameters' names stands for that."""
    extras: tuple[Extra, ...] = ()
    """What a module must have for the row to be of anything; in one that lacks it the row is `otherwise`."""
    otherwise: Any = 0.0

    @cached_property
    def needs(self) -> tuple[str, ...]:
        """The rows this one is computed from, `name@point` where the parameter says `name_at_point`.

        First those that say whether the module has the row's extras.
        """
        parameters = inspect.signature(self.function).parameters
        named = (its_name(name, self.of).replace("_at_", "@") for name in parameters)
        return (*(extra.choice for extra in self.extras), *named)

    def call(self, arguments: Sequence[Any]) -> Scalar:
        """Apply the function to the values of `needs`, in order; `otherwise` where the module lacks an extra."""
        chosen, given = arguments[: len(self.extras)], arguments[len(self.extras) :]
        if any(word == extra.without for word, extra in zip(chosen, self.extras, strict=True)):
            return self.otherwise
        return self.function(*given)

    def exists(self, chosen: Mapping[str, Any]) -> bool:
        """Whether there is anything to limit with some options chosen, by name; an option left open may be any."""
        return all(chosen.get(extra.choice) != extra.without for extra in self.extras)


@dataclass(frozen=True, kw_only=True)
class Event(Output):
    """A time in seconds: the first instant of a stage at which `function`, which rises, passes zero."""

    stage: str


@dataclass(frozen=True, kw_only=True)
class Path(Output):
    """What `function` adds up to, or reaches, from the start of a stage to the event that ends it."""

    stage: str
    reduce: Literal["integral", "maximum"]


@dataclass(frozen=True, kw_only=True)
class Steady(Output):
    """What `function` is in the steady state in which the event that ends a stage stays at zero."""

    stage: str


@dataclass(frozen=True, kw_only=True)
class Swing(Output):
    """What `function` is on average over the first swing of a released link.

    Simulated once a design is found: it is reported, and can be neither required nor minimised.
    """


Row: TypeAlias = Input | Choice | Output
Supplied = (Event, Path, Steady)
"""The kinds of output that a simulation or the optimiser supplies."""

STATE = "state"
"""The thermal state of the stack at an instant, one array. This and the next two are names that are no rows."""
DRIVE = "drive_current"
"""The current [A] at an instant, positive where it heats."""
STAGE = "stage"
"""The `Stage` an instant belongs to."""
TOUCHING = "touching"
"""Which sides of the PCL are in contact at an instant of a swing (`one_sided.Touching`). No row either."""
_NO_ROWS = frozenset({STATE, DRIVE, STAGE, TOUCHING})


@dataclass(frozen=True, kw_only=True)
class Stage:
    """A part of the device's working cycle that is simulated in one go."""

    name: str
    description: str
    after: str | None
    """The stage whose end it starts from; None starts with everything at ambient temperature."""
    ends: str
    """The event that ends it."""
    drive: str
    """The input that is its current where that is constant."""
    sign: float
    """1 where the current heats the layer, -1 where it cools."""
    like: str | None = None
    """The stage whose current it has, where it is that stage under another assumption."""
    history: bool
    """Whether the polymer's solid fraction has a history of its own, by the kinetics of freezing."""


@dataclass(frozen=True)
class Table:
    """Every row of one kind of module, looked up by name."""

    rows: tuple[Row, ...]
    stages: tuple[Stage, ...] = ()
    by_name: dict[str, Row] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Index the rows and refuse a name said twice or a parameter that is no row."""
        index: dict[str, Row] = {}
        for row in self.rows:
            if row.name in index:
                raise ValueError(f"the table has two rows named {row.name!r}")
            index[row.name] = row
        object.__setattr__(self, "by_name", index)
        for row in self.outputs:
            for need in row.needs:
                if need.partition("@")[0] not in index and need not in _NO_ROWS:
                    raise ValueError(f"row {row.name!r} needs {need!r}, which is no row")

    @cached_property
    def inputs(self) -> tuple[Input, ...]:
        """The numbers a study may set."""
        return tuple(row for row in self.rows if isinstance(row, Input))

    @cached_property
    def choices(self) -> tuple[Choice, ...]:
        """The words a study may set."""
        return tuple(row for row in self.rows if isinstance(row, Choice))

    @cached_property
    def outputs(self) -> tuple[Output, ...]:
        """What follows from the inputs."""
        return tuple(row for row in self.rows if isinstance(row, Output))

    def names(self, points: Iterable[str]) -> list[str]:
        """Full name (`row` or `row@point`) of every output a study can limit, in the table's order."""
        points = list(points)
        return [
            name
            for row in self.outputs
            if not (row.instant or row.hidden or isinstance(row, Swing))
            for name in ([f"{row.name}@{point}" for point in points] if row.per_point else [row.name])
        ]

    @cached_property
    def supplied(self) -> tuple[Event | Path | Steady, ...]:
        """The outputs that a simulation or the optimiser supplies."""
        return tuple(row for row in self.outputs if isinstance(row, Supplied))

    @cached_property
    def behind_supplied(self) -> frozenset[str]:
        """The supplied outputs and all that depends on them, by base name."""
        supplied = {row.name for row in self.supplied}
        return frozenset(row.name for row in self.outputs if supplied & {row.name, *self.ancestors(row.name)})

    @cached_property
    def swings(self) -> tuple[Swing, ...]:
        """The outputs that are seen in a simulated release."""
        return tuple(row for row in self.outputs if isinstance(row, Swing))

    def stage(self, name: str) -> Stage:
        """The stage of that name."""
        return next(stage for stage in self.stages if stage.name == name)

    def row(self, name: str) -> Row:
        """Return the row of a full name; raises InputError where there is none."""
        base = name.partition("@")[0]
        if base not in self.by_name:
            raise InputError(f"no row is named {base!r}")
        return self.by_name[base]

    def output(self, name: str) -> Output:
        """Return the output row of a full name; raises InputError where it is not an output."""
        row = self.row(name)
        if not isinstance(row, Output):
            raise InputError(f"{name!r} is set by the study, not computed")
        return row

    def unit(self, name: str) -> str:
        """Unit that people read and write a row's numbers in; raises InputError for a choice."""
        row = self.row(name)
        if isinstance(row, Choice):
            raise InputError(f"{name!r} is a word, not a number")
        return row.unit

    def evaluate(self, given: Mapping[str, Any], wanted: Iterable[str]) -> dict[str, Scalar]:
        """Compute the wanted outputs from the given rows, each row once.

        `given` holds SI numbers, arrays or symbols by full name, and the chosen records and options. Returns the wanted
        values by name. Raises InputError where a row is missing from `given`.
        """
        return self.resolve(dict(given), wanted)

    def resolve(self, known: dict[str, Any], wanted: Iterable[str]) -> dict[str, Scalar]:
        """The same from rows that are known, to which all that is computed on the way is added."""
        return {name: self._resolve(name, known) for name in wanted}

    def _resolve(self, name: str, known: dict[str, Any]) -> Any:
        if name in known:
            return known[name]
        base, _, point = name.partition("@")
        row = self.row(base)
        if not isinstance(row, Output) or isinstance(row, (*Supplied, Swing)):
            raise InputError(f"{name!r} has no value")
        known[name] = row.call([self._resolve(self._at(need, point), known) for need in row.needs])
        return known[name]

    def settled(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """The given rows and all that follow from them alone: neither of an instant nor behind anything supplied."""
        known = dict(given)
        for name in self._settled_names:
            self._resolve(name, known)
        return known

    @cached_property
    def _settled_names(self) -> list[str]:
        open_rows = {
            row.name for row in self.rows if isinstance(row, (*Supplied, Swing)) or getattr(row, "instant", False)
        }
        return [
            row.name
            for row in self.outputs
            if not row.per_point and row.name not in open_rows and not open_rows & self.ancestors(row.name)
        ]

    def evaluate_instant(self, given: Mapping[str, Any], wanted: Iterable[str]) -> dict[str, Scalar]:
        """Compute rows at one instant of a stage, each once; `given` must hold the state, the current and the stage.

        Of an event the value is what it waits for, of a path what it reduces, of a steady row what it takes. Rows of a
        swing want the contact at an instant of the swing instead.
        """
        known = dict(given)
        values: dict[str, Scalar] = {}
        for name in wanted:
            row = self.row(name)
            if isinstance(row, (*Supplied, Swing)):
                values[name] = row.call([self._resolve(need, known) for need in row.needs])
            else:
                values[name] = self._resolve(name, known)
        return values

    def _at(self, need: str, point: str) -> str:
        if need in _NO_ROWS or "@" in need:
            return need
        row = self.by_name[need]
        per_point = not isinstance(row, Choice) and row.per_point
        return f"{need}@{point}" if per_point and point else need

    @cached_property
    def _ancestors(self) -> dict[str, frozenset[str]]:
        """Those that were asked for."""
        return {}

    def ancestors(self, name: str) -> frozenset[str]:
        """Every row, by base name, that the named one depends on."""
        if name in self._ancestors:
            return self._ancestors[name]
        seen: set[str] = set()
        todo = [name.partition("@")[0]]
        while todo:
            row = self.by_name[todo.pop()]
            for need in row.needs if isinstance(row, Output) else ():
                base = need.partition("@")[0]
                if base not in seen and base not in _NO_ROWS:
                    seen.add(base)
                    todo.append(base)
        found = self._ancestors[name] = frozenset(seen)
        return found
