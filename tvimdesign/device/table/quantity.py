"""Quantities of the one table: numbers and words that a study sets, and results with the function each follows from.

A table says what a module is. `Input` quantities are numbers that a study may set, `Choice` quantities are words (a
catalogue record or an option), `Output` quantities are what follows. An output's function reads what it needs from the
module `m`: `m.wire_diameter` is the quantity `wire_diameter`. So the table is also the dependency graph, and floats,
arrays and CasADi symbols go through the same functions.

A quantity with `per_point=True` has one value at each operating point and is written `name@point`; another quantity
reads it at a certain point as `m.name_at_point`. A quantity with `instant=True` has a value at each
instant of a phase (heating until the joint is soft is one, cooling until it is stiff again another). `Event` quantities
are the times at which something that rises passes zero; `Path` quantities reduce an instant's value over a phase;
`Steady` quantities are what it takes to stay where a phase ends. The solver, or a simulation, supplies those three;
everything else is arithmetic. `FirstOscillation` quantities are seen in a simulated release of the link, after a design
is found.

`PHASES` is the device's working cycle: soft by heating, stiff again by cooling.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Literal, TypeAlias

from tvimdesign.device.table.module import Module, names_read

Scalar: TypeAlias = Any  # A float, a numpy array or a CasADi expression


@dataclass(frozen=True, kw_only=True)
class Rule:
    """A limit that belongs to the machine, in SI, with the reason that reports show."""

    sense: Literal["<=", ">="]
    value: float
    reason: str
    exists_above: float | None = None
    """The value at and below which there is no such geometry, and the equations mean nothing."""


def at_least(value: float, reason: str, exists_above: float | None = None) -> Rule:
    """Return a lower limit that belongs to the machine."""
    return Rule(sense=">=", value=value, reason=reason, exists_above=exists_above)


def at_most(value: float, reason: str) -> Rule:
    """Return an upper limit that belongs to the machine."""
    return Rule(sense="<=", value=value, reason=reason)


@dataclass(frozen=True)
class Feature:
    """Something a module has only where a study asks for it."""

    choice: str  # The quantity it is chosen by
    without: str  # The word of that choice for a module that lacks it


def have_features(features: Sequence[Feature], chosen: Mapping[str, Any]) -> bool:
    """Return whether a module has features, with some options chosen, by name; an option left open may be any."""
    return all(chosen.get(feature.choice) != feature.without for feature in features)


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
    period: float | None = None
    """Step by which it may change without a change of what turns with it, as a coil leaves its legs; an optimum has
    neighbors there, and the search tries them."""
    part: str = ""
    """The part that this number and others shape alone: the search takes them together from one optimum to another."""
    per_point: bool = False
    source: str = ""  # Where the default comes from: `status: source`
    low: float | None = None
    high: float | None = None  # The range within which the default is known, if it is unmeasured
    range_of: tuple[str, str] | None = None
    """(choice, field) of the chosen record's value that the quantity is a factor of: its range is the factor's."""
    record: tuple[str, str] | None = None
    """(choice, field): where the default comes from when the study does not set it."""
    stock_record: tuple[str, str] | None = None
    """(choice, field): where the value comes from, and from nowhere else, in a study that chooses such a record."""
    stock: tuple[str, str, str] | None = None
    """(category, table, column) of the records that list the sizes one can buy; the sizes of wires where not told."""
    mode: str | None = None  # The one mode that has it, where not all have
    requires: tuple[Feature, ...] = ()  # Features that a module needs for it to have an effect
    read_by: str = ""  # The floor that reads it; may be empty if a quantity does

    @property
    def falls_back(self) -> bool:
        """Return whether records may lack it: then it has a default with a source of its own."""
        return self.record is not None and not self.source.startswith("record: ")

    def exists(self, chosen: Mapping[str, Any]) -> bool:
        """Return whether it is of any effect with some options chosen, by name; an option left open may be any."""
        return have_features(self.requires, chosen)

    @property
    def sizes_in(self) -> tuple[str, str, str]:
        """Return the category, table and column where a record lists sizes of it."""
        return self.stock or ("wires", "sizes", self.name)


@dataclass(frozen=True, kw_only=True)
class Choice:
    """A word the study may set: the name of a record on a catalogue category, or one of a few options."""

    name: str
    description: str
    group: str
    default: str = ""
    category: str | None = None
    options: tuple[str, ...] = ()  # The words there are; of a category, those beside its records
    record: tuple[str, str] | None = None
    """(choice, word): where the default comes from, of a choice that stands before this one."""
    stock_record: tuple[str, str] | None = None
    """(choice, word): where it comes from, and from nowhere else, in a study that chooses such a record before."""
    requires: tuple[Feature, ...] = ()  # Features that a module needs for it to have an effect
    idealized: Mapping[str, str] = field(default_factory=dict)
    """The words that leave out something of the drawn part, and what they leave out. The default is none of them."""


def template_name(name: str, of: str) -> str:
    """Name of a quantity that several things have alike, of one of them: `template_screw` of `link` is `link_screw`.

    `template` alone is that one thing, a quantity itself.
    """
    if name == "template":
        return of
    return f"{of}_{name.removeprefix('template_')}" if of and name.startswith("template_") else name


@dataclass(frozen=True, kw_only=True)
class Output:
    """A named result. `function` reads quantities of the module and returns SI."""

    name: str
    unit: str
    description: str
    group: str
    function: Callable[[Module], Scalar]
    per_point: bool = False
    instant: bool = False
    hidden: bool = False  # An intermediate result, of any type, that other quantities use and nobody asks for
    headline: bool = False  # True for a quantity that the summary shows
    least_of: tuple[str, ...] = ()
    """The quantities this one is the least of; a lower limit on it is put on each of them, which have no kinks."""
    rises_with: str = ""
    """The quantity it rises with, where that is the least of others: it is the least of what it would be with each."""
    instead: str = ""  # The one of those that it has in place of that
    also_limited: tuple[str, ...] = ()
    """The quantities on which each limit on this one is put as well, from whichever side."""
    at_end: str = ""  # The quantity that this one, at the hot point if it has points, is when heating ends
    parts_differ_with: Feature | None = None
    """Feature without which those, or the quantities it is the least of, are equal."""
    rules: tuple[Rule, ...] = ()
    """Limits that hold in every study whose module has the quantity's features, unless it sets its own in the same
    sense."""
    advice: tuple[Rule, ...] = ()
    """Limits that are reported where they are broken, and enforced only where a study requires them."""
    ratings: tuple[Rule, ...] = ()
    """Limits that a material or a bought part is rated for: a design beyond one is no optimum unless the study
    accepts it by the quantity's name, and a search keeps it only where a study requires it."""
    better: Literal["less", "more"] | None = None
    """Direction in which it is better for any use of the module; None where that depends."""
    of: str = ""
    """Name of the part that has the quantity, where several have it alike: `template_` in the names it reads stands for
    that."""
    requires: tuple[Feature, ...] = ()
    """Features that a module needs to have the quantity; in one that lacks them it is `default`."""
    sprung: bool = False
    """True if only modules with torsion springs have it; in a mode without, it is `default` where others read it."""
    default: Any = 0.0

    @cached_property
    def reads(self) -> tuple[str, ...]:
        """Return the attributes of the module that the function reads; raises ValueError if they cannot be found."""
        try:
            return names_read(self.function)
        except ValueError as error:
            raise ValueError(f"the function of the quantity {self.name!r} {error}") from error

    @cached_property
    def needs(self) -> tuple[str, ...]:
        """Return the quantities this one is computed from, `name@point` for the attribute `name_at_point`.

        First those that say whether the module has the quantity's features.
        """
        named = ("@".join(template_name(name, self.of).rsplit("_at_", 1)) for name in self.reads)
        read = (self.instead if self.instead and name == self.rises_with else name for name in named)
        return (*(feature.choice for feature in self.requires), *read)

    def call(self, arguments: Sequence[Any]) -> Scalar:
        """Apply the function to the values of `needs`, in order; `default` where the module lacks a feature."""
        chosen, given = arguments[: len(self.requires)], arguments[len(self.requires) :]
        if any(word == feature.without for word, feature in zip(chosen, self.requires, strict=True)):
            return self.default
        return self.function(Module(**dict(zip(self.reads, given, strict=True))))

    def exists(self, chosen: Mapping[str, Any]) -> bool:
        """Return whether there is anything to limit with some options chosen, by name; an option left open may be
        any."""
        return have_features(self.requires, chosen)


@dataclass(frozen=True, kw_only=True)
class Event(Output):
    """A time in seconds: the first instant of a phase at which `function`, which rises, passes zero."""

    phase: str


@dataclass(frozen=True, kw_only=True)
class Path(Output):
    """Output that `function` adds up to or reaches over a phase, or is at the event that ends it."""

    phase: str
    reduce: Literal["integral", "maximum", "end"]


@dataclass(frozen=True, kw_only=True)
class Steady(Output):
    """Output that `function` is in the steady state in which the event that ends a phase stays at zero."""

    phase: str


@dataclass(frozen=True, kw_only=True)
class Simulated(Output):
    """Output that is simulated once a design is found; it cannot be minimised."""

    state: str = ""  # State that is simulated: a study may require `name@state`. Empty if it cannot be required.


@dataclass(frozen=True, kw_only=True)
class FirstOscillation(Simulated):
    """Output that is the mean of `function` over the first oscillation of a released link."""


Quantity: TypeAlias = Input | Choice | Output
Supplied = (Event, Path, Steady)  # The kinds of output that a simulation or the optimiser supplies

STATE = "state"
"""The thermal state of the stack at an instant, one array. This and the next two are names that are no quantities."""
DRIVE = "drive_current"  # The current [A] at an instant, positive where it heats
PHASE = "phase"  # The `Phase` an instant belongs to
TOUCHING = "touching"
"""Sides of the PCL that are in contact at an instant of a first oscillation (`one_sided.Touching`). No quantity either.
"""
NOT_QUANTITIES = frozenset({STATE, DRIVE, PHASE, TOUCHING})


@dataclass(frozen=True, kw_only=True)
class Phase:
    """A part of the device's working cycle that is simulated in one go."""

    name: str
    description: str
    after: str | None  # The phase whose end it starts from; None starts with everything at ambient temperature
    ends: str  # The event that ends it
    current_input: str  # The input that is its current where that is constant
    sign: float  # 1 where the current heats the layer, -1 where it cools
    like: str | None = None  # The phase whose current it has, where it is that phase under another assumption
    history: bool  # True if the polymer's solid fraction has a history of its own, by the kinetics of freezing


SOFTENING = Phase(
    name="softening", description="heating from ambient until the joint is soft",
    after=None, ends="response_time", current_input="current", sign=1.0, history=False,
)  # fmt: skip
STIFFENING = Phase(
    name="stiffening", description="cooling from there until the joint is stiff again",
    after="softening", ends="return_time", current_input="cooling_current", sign=-1.0, history=True,
)  # fmt: skip
EQUILIBRIUM_STIFFENING = replace(
    STIFFENING, name="equilibrium_stiffening", description="the same, as if the layer froze where it melts",
    ends="equilibrium_stiffening_time", like="stiffening", history=False,
)  # fmt: skip
PHASES = (SOFTENING, STIFFENING, EQUILIBRIUM_STIFFENING)
