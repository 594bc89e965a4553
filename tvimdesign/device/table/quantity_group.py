"""Collection of a file's quantities: a function's name is the quantity's name, its docstring the description."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cache, partial
from types import ModuleType
from typing import Any, Literal, TypeVar

import numpy as np

from tvimdesign.base.record import Record, own_data
from tvimdesign.base.units import to_si
from tvimdesign.device.table.module import Module
from tvimdesign.device.table.quantity import (
    Choice,
    Event,
    Feature,
    FirstOscillation,
    Input,
    Output,
    Path,
    Phase,
    Quantity,
    Rule,
    Scalar,
    Simulated,
    Steady,
    at_least,
    template_name,
)

F = TypeVar("F", bound=Callable[[Module], Any])

GROUPS = (
    "Materials", "Process", "Layout", "Springs", "Impedance", "Lost motion", "Hold", "Task", "Switch", "Softening",
    "Stiffening", "Size and weight", "Gaps", "Axial play", "Cost",
)  # fmt: skip
"""The headings under which reports list quantities, in their order."""


class QuantityGroup:
    """Quantities of one group in the order they are written."""

    def __init__(self, group: str, requires: tuple[Feature, ...] = (), sprung: bool = False) -> None:
        """Start an empty group.

        Parameters
        ----------
        group
            The heading under which reports list the quantities, one of `GROUPS`.
        requires
            Features that a module needs to have the quantities, unless they say otherwise.
        sprung
            Whether only modules with torsion springs have the outputs.
        """
        self.group = group
        self.requires = requires
        self.sprung = sprung
        self.quantities: list[Quantity] = []
        self.anchors: dict[int, str] = {}
        """Name of the quantity that the one at a place here is listed after."""

    def after(self, name: str) -> None:
        """List the next quantities after a quantity that another file defines under this heading."""
        self.anchors[len(self.quantities)] = name

    def inputs(self, *names: str, **changes: Any) -> None:
        """Add the inputs that `inputs.yaml` lists under this group, or some of them with `changes` of their entries."""
        for name, listed in _all_inputs()[self.group].items():
            if names and name not in names:
                continue
            entry = {**listed, **changes}
            unit, record = str(entry["unit"]), _words(entry, "record")
            source = f"{entry['status']}: {entry['source']}" if "value" in entry or not record else _of_record(record)
            numbers = {field: to_si(float(entry[key]), unit) for field, key in _NUMBERS.items() if key in entry}
            self.quantities.append(
                Input(
                    name=name, unit=unit, description=entry["about"], group=self.group, source=source, record=record,
                    variable=entry.get("vary", False), integer=entry.get("integer", False), part=entry.get("part", ""),
                    per_point=entry.get("per_point", False), range_of=_words(entry, "range_of"),
                    stock_record=_words(entry, "stock_record"), mode=entry.get("mode"),
                    stock=tuple(entry["stock"]) if "stock" in entry else None,
                    requires=tuple(Feature(of, word) for of, *words in [entry.get("feature", [""])] for word in words),
                    read_by=entry.get("read_by", ""), **numbers,
                )
            )  # fmt: skip

    def choices(self, key: str) -> None:
        """Add the choices that `choices.yaml` lists under a key, and the numbers that the chosen records give."""
        for name, entry in _all_choices()[key].items():
            add = self.option if "options" in entry else self.record if "category" in entry else self.property
            fields: dict[str, Any] = {word: tuple(of) if isinstance(of, list) else of for word, of in entry.items()}
            if "requires" in entry:
                fields["requires"] = _features(entry)
            add(name, **fields)

    def property(self, name: str, unit: str, record: tuple[str, str], description: str, **fields: Any) -> None:
        """Add a number that comes from a chosen record, (choice, field), unless the study sets it.

        `fields` are those of `Input`. A `default` (SI) is for records that lack it; without one they are refused where
        the module has what it `requires`.
        """
        quantity = Input(
            name=name, unit=unit, description=description, group=self.group, lower=0.0, record=record,
            source=_of_record(record), **fields,
        )  # fmt: skip
        self.quantities.append(quantity)

    def record(
        self,
        name: str,
        category: str,
        default: str | tuple[str, str],
        description: str,
        others: tuple[str, ...] = (),
        requires: tuple[Feature, ...] = (),
        stock_record: tuple[str, str] | None = None,
    ) -> None:
        """Add the choice of a catalogue record.

        `default` is the name of one, or (choice, word) of the chosen record that names it. `others` are words that may
        stand for no record at all. `stock_record` is (choice, word) of a record that brings this one along.
        """
        word, record = (default, None) if isinstance(default, str) else ("", default)
        quantity = Choice(
            name=name, description=description, group=self.group, default=word, record=record, category=category,
            options=others, requires=requires, stock_record=stock_record,
        )  # fmt: skip
        self.quantities.append(quantity)

    def option(
        self,
        name: str,
        options: tuple[str, ...],
        description: str,
        record: tuple[str, str] | None = None,
        idealized: Mapping[str, str] | None = None,
    ) -> None:
        """Add a choice among words; the default is the first, or the word `record` of (choice, word) names.

        `idealized` says of words that leave out something of the drawn part what that is.
        """
        default = "" if record else options[0]
        quantity = Choice(
            name=name, description=description, group=self.group, default=default, options=options, record=record,
            idealized=idealized or {},
        )  # fmt: skip
        self.quantities.append(quantity)

    def output(self, unit: str, *rules: Rule, **fields: Any) -> Callable[[F], F]:
        """Add a function as a quantity; `fields` are those of `Output`, or else the group's."""
        return self._add(Output, unit, rules=rules, **self._featured(fields))

    def gap(self, reason: str, **fields: Any) -> Callable[[F], F]:
        """Add a gap or margin: a length that must not be negative, for a reason; `fields` as an output has them."""
        return self.output("mm", at_least(0.0, reason), **fields)

    def margins(self, key: str) -> None:
        """Add the margins and safeties that `margins.yaml` lists under a key, formulas of other quantities."""
        for name, entry in _all_margins()[key].items():
            fields: dict[str, Any] = {word: entry[word] for word in ("sprung", "rises_with") if word in entry}
            if "requires" in entry:
                fields["requires"] = _features(entry)
            why = next(word for word in _LIMITED if word in entry)
            fields[_LIMITED[why]] = (at_least(entry.get("at_least", 0.0), entry[why]),)
            self._add_formula(Output, name, entry, **self._featured(fields))

    def formulas(self, key: str) -> None:
        """Add the outputs that `formulas.yaml` lists under a key."""
        for name, entry in _all_formulas()[key].items():
            fields: dict[str, Any] = {word: entry[word] for word in _FLAGS if word in entry}
            if "requires" in entry:
                fields["requires"] = _features(entry)
            self._add_formula(Output, name, entry, **self._featured(fields))

    def phase_values(self, key: str) -> None:
        """Add what `phase_values.yaml` lists under a key, read off a phase of the working cycle."""
        for name, entry in _all_phase_values()[key].items():
            fields = {"phase": entry["phase"], "headline": entry.get("headline", False)}
            if entry["take"] == "steady":
                self._add_formula(Steady, name, entry, **fields)
            else:
                self._add_formula(Path, name, entry, reduce=entry["take"], **fields)

    def from_template(
        self, of: str, words: str, function: Callable[[Module], Any], unit: str = "", *rules: Rule, name: str = "",
        **fields: Any,
    ) -> None:  # fmt: skip
        """Add a quantity that several things have alike, for one of them; without a unit it is an intermediate result.

        The function has `template_` for the thing in what it reads and, unless there is a `name`, in its own name, and
        {it} for `words`.
        """
        name = name or template_name(function.__name__, of)
        quantity = Output(
            name=name, unit=unit or "1", description=_summary(function).format(it=words), group=self.group,
            function=function, hidden=not unit, rules=rules, better=directions().get(name), of=of,
            **self._featured(fields),
        )  # fmt: skip
        self.quantities.append(quantity)

    def same(self, name: str, of: str, description: str, unit: str = "", *rules: Rule, **fields: Any) -> None:
        """Add a quantity that is another one, under its own name; without a unit it is an intermediate result."""
        self.from_template(of, description, _itself, unit, *rules, name=name, **fields)

    def field(self, name: str, of: str, field: str, description: str, unit: str, **fields: Any) -> None:
        """Add a quantity that is a field of another one, or what a chosen record has under that name."""

        def value(m: Module) -> Any:
            """{it}."""
            other = m.template
            return other.value(field) if isinstance(other, Record) else getattr(other, field)

        self.from_template(of, description, value, unit, name=name, **fields)

    def _featured(self, fields: Mapping[str, Any]) -> dict[str, Any]:
        """Return the fields of an output with those of the group."""
        return {"requires": self.requires, **fields, "sprung": fields.get("sprung", False) or self.sprung}

    def helper(self, **fields: Any) -> Callable[[F], F]:
        """Add an intermediate result that other quantities use and nobody asks for."""
        return self.output("1", hidden=True, **fields)

    def event(self, phase: Phase, *, headline: bool = True) -> Callable[[F], F]:
        """Add a time: the first instant of a phase at which the function, which rises, passes zero."""
        return self._add(Event, "s", phase=phase.name, headline=headline)

    def path(
        self, phase: Phase, unit: str, reduce: Literal["integral", "maximum", "end"], *, headline: bool = False
    ) -> Callable[[F], F]:
        """Add the integral or the largest value of a function over a phase, or its value at the end."""
        return self._add(Path, unit, phase=phase.name, reduce=reduce, headline=headline)

    def first_oscillation(self, unit: str, *, headline: bool = True) -> Callable[[F], F]:
        """Add the mean of a function over the first swing of a released link, at each operating point."""
        return self._add(FirstOscillation, unit, per_point=True, headline=headline)

    def simulated(self, name: str, unit: str, state: str, description: str) -> None:
        """Add what is simulated of a design in a state such as its duty."""
        quantity = Simulated(
            name=name, unit=unit, description=description, group=self.group, function=_nowhere, state=state,
            better=directions().get(name),
        )  # fmt: skip
        self.quantities.append(quantity)

    def _add_formula(self, kind: type[Output], name: str, entry: Mapping[str, Any], **fields: Any) -> None:
        """Add an output that a data file lists with its formula."""
        quantity = kind(
            name=name, unit=entry.get("unit", "1" if fields.get("hidden") else "mm"), description=entry["about"],
            group=self.group, function=_formula(entry["is"]), better=directions().get(name), **fields,
        )  # fmt: skip
        self.quantities.append(quantity)

    def _add(self, kind: type[Output], unit: str, **fields: Any) -> Callable[[F], F]:
        """Return a decorator that adds a function as a quantity of a kind."""

        def add(function: F) -> F:
            name = function.__name__
            quantity = kind(
                name=name, unit=unit, description=_summary(function), group=self.group, function=function,
                better=directions().get(name), **fields,
            )  # fmt: skip
            self.quantities.append(quantity)
            return function

        return add


def _itself(m: Module) -> Any:
    """{it}."""
    return m.template


def _nowhere(_: Module) -> float:
    """Return no number: a simulation supplies it."""
    return float("nan")


def with_parts(quantities: Iterable[Quantity]) -> tuple[Quantity, ...]:
    """Return quantities, and what rises with the least of others once more for each of these, with its rules."""
    listed = tuple(quantities)
    outputs = {quantity.name: quantity for quantity in listed if isinstance(quantity, Output)}
    every: list[Quantity] = []
    for quantity in listed:
        if not isinstance(quantity, Output) or not quantity.rises_with:
            every.append(quantity)
            continue
        whole = quantity.rises_with
        parts = [
            replace(
                quantity, name=name.replace(whole, quantity.name), description=f"{quantity.description}, by `{name}`",
                instead=name, requires=(*quantity.requires, *outputs[name].requires), headline=False, advice=(),
            )
            for name in outputs[whole].least_of
        ]  # fmt: skip
        every += [replace(quantity, least_of=tuple(part.name for part in parts), rules=()), *parts]
    return tuple(every)


def gather(files: Iterable[ModuleType], modes: tuple[str, ...]) -> tuple[Quantity, ...]:
    """Return the quantities that the files define, those of a group together, with the inputs of some modes."""
    gathered: dict[str, list[Quantity]] = {group: [] for group in GROUPS}
    for group in (group for file in files for group in _groups_of(file)):
        together = gathered[group.group]
        place = len(together)
        for i, quantity in enumerate(group.quantities):
            if i in group.anchors:
                place = 1 + next(k for k, other in enumerate(together) if other.name == group.anchors[i])
            if not (isinstance(quantity, Input) and quantity.mode not in {None, *modes}):
                together.insert(place, quantity)
                place += 1
    return tuple(quantity for together in gathered.values() for quantity in together)


def _groups_of(file: ModuleType) -> Iterator[QuantityGroup]:
    """Yield the groups that a file defines, alone or in tuples (`screwed_joint`)."""
    for value in vars(file).values():
        if isinstance(value, QuantityGroup):
            yield value
        elif isinstance(value, tuple):
            yield from (group for group in value if isinstance(group, QuantityGroup))


def _of_record(record: tuple[str, str]) -> str:
    """Return the source of an input whose value a chosen record gives."""
    return f"record: {record[1]} of the chosen {record[0]}"


_NUMBERS = {"default": "value", "lower": "from", "upper": "to", "period": "period", "low": "low", "high": "high"}
"""Keys of `inputs.yaml` that hold numbers, by the field of `Input`."""


_FLAGS = ("headline", "hidden", "per_point", "sprung", "default")  # Keys of `formulas.yaml` that are fields of `Output`
_FUNCTIONS = {"fmax": np.fmax, "fmin": np.fmin, "hypot": np.hypot, "sqrt": np.sqrt}  # What a formula may call


_LIMITED = {"reason": "rules", "advice": "advice", "rating": "ratings"}
"""Keys of `margins.yaml` that say what it means to be below the limit, by the field of `Output` that has the limit."""


def _words(entry: Mapping[str, Any], key: str) -> tuple[str, str] | None:
    """Return a pair of words of an entry of `inputs.yaml`, if it has it."""
    return (str(entry[key][0]), str(entry[key][1])) if key in entry else None


def _features(entry: Mapping[str, Any]) -> tuple[Feature, ...]:
    """Return the features that an entry of a data file requires."""
    return tuple(Feature(*pair) for pair in entry["requires"])


def _formula(text: str) -> Callable[[Module], Scalar]:
    """Return the function of the module that a formula in names of quantities is."""
    in_module = re.sub(r"(?<![.\w])[a-z]\w*+(?!\()", r"m.\g<0>", text)
    function: Callable[[Module], Scalar] = eval(f"lambda m: {in_module}", {**_FUNCTIONS})
    return function


def _summary(function: Callable[..., Any]) -> str:
    """Return the first paragraph of the docstring, on one line."""
    text = function.__doc__ or ""
    return " ".join(text.split("\n\n")[0].split()).rstrip(".")


@cache
def directions() -> dict[str, Literal["less", "more"]]:
    """Return which way an output is better, by name, of those for which that can be said of any module."""
    listed: dict[Literal["less", "more"], list[str]] = own_data(__file__, "better.yaml")
    return {name: way for way, names in listed.items() for name in names}


_all_inputs = partial(own_data, __file__, "inputs.yaml")  # The inputs by group and name
_all_choices = partial(own_data, __file__, "choices.yaml")  # The choices and numbers of records by key and name
_all_margins = partial(own_data, __file__, "margins.yaml")  # The margins by key and name
_all_formulas = partial(own_data, __file__, "formulas.yaml")  # The plain outputs by key and name
_all_phase_values = partial(own_data, __file__, "phase_values.yaml")  # What is read off phases by key and name
