"""How a room of the device writes its rows: the function's name is the row's name, its docstring the description."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from importlib import resources
from typing import Any, Literal, TypeVar

import yaml

from tvimdesign.base.units import to_si
from tvimdesign.device.table.quantity import (
    Choice,
    Event,
    Extra,
    Input,
    Output,
    Path,
    Row,
    Rule,
    Stage,
    Steady,
    Swing,
    its_name,
)

F = TypeVar("F", bound=Callable[..., Any])


class Book:
    """Collects the rows of one group in the order they are written."""

    def __init__(self, group: str, extras: tuple[Extra, ...] = ()) -> None:
        """`group` is the heading under which reports list the rows, `extras` what they are of unless they say it."""
        self.group = group
        self.extras = extras
        self.rows: list[Row] = []
        self.anchors: dict[int, str] = {}
        """Of the rows that stand after a certain row of the group, by their place here, that row's name."""

    def after(self, name: str) -> None:
        """Let the next rows stand after a row that another book of the group wrote, where reports list them."""
        self.anchors[len(self.rows)] = name

    def inputs(self) -> None:
        """Add the inputs that `inputs.yaml` lists under this group."""
        for name, entry in _all_inputs()[self.group].items():
            unit = str(entry["unit"])
            record = (str(entry["record"][0]), str(entry["record"][1])) if "record" in entry else None
            self.rows.append(
                Input(
                    name=name,
                    unit=unit,
                    description=entry["about"],
                    group=self.group,
                    default=None if record else to_si(float(entry["value"]), unit),
                    lower=to_si(float(entry["from"]), unit),
                    upper=to_si(float(entry["to"]), unit),
                    variable=entry.get("vary", False),
                    integer=entry.get("integer", False),
                    per_point=entry.get("per_point", False),
                    source=_of_record(record) if record else f"{entry['status']}: {entry['source']}",
                    record=record,
                    mode=entry.get("mode"),
                    extras=(Extra(*entry["extra"]),) if "extra" in entry else (),
                )
            )

    def property(
        self, name: str, unit: str, record: tuple[str, str], description: str, mode: str | None = None
    ) -> None:
        """Add a number that comes from a chosen record, (choice, field), unless the study sets it."""
        row = Input(
            name=name, unit=unit, description=description, group=self.group, lower=0.0, record=record,
            source=_of_record(record), mode=mode,
        )  # fmt: skip
        self.rows.append(row)

    def record(
        self,
        name: str,
        shelf: str,
        default: str | tuple[str, str],
        description: str,
        only: tuple[str, str, str] | None = None,
        others: tuple[str, ...] = (),
        extras: tuple[Extra, ...] = (),
    ) -> None:
        """Add the choice of a catalogue record; `only` is (word, value, reason) of the records that fit.

        `default` is the name of one, or (choice, word) of the chosen record that names it. `others` are words that may
        stand for no record at all.
        """
        word, record = (default, None) if isinstance(default, str) else ("", default)
        row = Choice(
            name=name, description=description, group=self.group, default=word, record=record, shelf=shelf, only=only,
            options=others, extras=extras,
        )  # fmt: skip
        self.rows.append(row)

    def option(
        self, name: str, options: tuple[str, ...], description: str, record: tuple[str, str] | None = None
    ) -> None:
        """Add a choice among words; the default is the first, or the word `record` of (choice, word) names."""
        default = "" if record else options[0]
        row = Choice(
            name=name, description=description, group=self.group, default=default, options=options, record=record
        )
        self.rows.append(row)

    def output(
        self,
        unit: str,
        *rules: Rule,
        advice: tuple[Rule, ...] = (),
        per_point: bool = False,
        instant: bool = False,
        hidden: bool = False,
        headline: bool = False,
        least_of: tuple[str, ...] = (),
        extras: tuple[Extra, ...] | None = None,
        otherwise: Any = 0.0,
    ) -> Callable[[F], F]:
        """Add a function as a row; in a module that lacks one of its extras it is `otherwise`."""

        def add(function: F) -> F:
            row = Output(
                name=function.__name__,
                unit=unit,
                description=_summary(function),
                group=self.group,
                function=function,
                per_point=per_point,
                instant=instant,
                hidden=hidden,
                headline=headline,
                least_of=least_of,
                rules=rules,
                advice=advice,
                better=directions().get(function.__name__),
                extras=self.extras if extras is None else extras,
                otherwise=otherwise,
            )
            self.rows.append(row)
            return function

        return add

    def event(self, stage: Stage, *, headline: bool = True) -> Callable[[F], F]:
        """Add a time: the first instant of a stage at which the function, which rises, passes zero."""

        def add(function: F) -> F:
            row = Event(name=function.__name__, unit="s", description=_summary(function), group=self.group,
                        function=function, stage=stage.name, headline=headline,
                        better=directions().get(function.__name__))  # fmt: skip
            self.rows.append(row)
            return function

        return add

    def alike(
        self,
        of: str,
        words: str,
        function: Callable[..., Any],
        unit: str = "",
        *rules: Rule,
        extras: tuple[Extra, ...] = (),
    ) -> None:
        """Add a row that several things have alike, for one of them; without a unit it is an intermediate result.

        The function is written with `its_` for the thing in its name and in its parameters, and {it} for `words`.
        """
        row = Output(
            name=its_name(function.__name__, of),
            unit=unit or "1",
            description=_summary(function).format(it=words),
            group=self.group,
            function=function,
            hidden=not unit,
            rules=rules,
            of=of,
            extras=extras,
        )
        self.rows.append(row)

    def helper(
        self,
        *,
        per_point: bool = False,
        instant: bool = False,
        extras: tuple[Extra, ...] | None = None,
        otherwise: Any = 0.0,
    ) -> Callable[[F], F]:
        """Add an intermediate result that other rows use and nobody asks for."""
        return self.output("1", per_point=per_point, instant=instant, hidden=True, extras=extras, otherwise=otherwise)

    def path(
        self, stage: Stage, unit: str, reduce: Literal["integral", "maximum"], *, headline: bool = False
    ) -> Callable[[F], F]:
        """Add what an instant's value adds up to, or reaches, over a stage."""

        def add(function: F) -> F:
            row = Path(name=function.__name__, unit=unit, description=_summary(function), group=self.group,
                       function=function, stage=stage.name, reduce=reduce, headline=headline,
                       better=directions().get(function.__name__))  # fmt: skip
            self.rows.append(row)
            return function

        return add

    def steady(self, stage: Stage, unit: str, *, headline: bool = False) -> Callable[[F], F]:
        """Add what an instant's value is when everything stays where a stage ends."""

        def add(function: F) -> F:
            row = Steady(name=function.__name__, unit=unit, description=_summary(function), group=self.group,
                         function=function, stage=stage.name, headline=headline,
                         better=directions().get(function.__name__))  # fmt: skip
            self.rows.append(row)
            return function

        return add

    def swing(self, unit: str, *, headline: bool = True) -> Callable[[F], F]:
        """Add what is seen at each operating point in the first swing of a released link, on average over it."""

        def add(function: F) -> F:
            row = Swing(name=function.__name__, unit=unit, description=_summary(function), group=self.group,
                        function=function, per_point=True, headline=headline,
                        better=directions().get(function.__name__))  # fmt: skip
            self.rows.append(row)
            return function

        return add


def gather(books: Iterable[Book], mode: str) -> tuple[Row, ...]:
    """Rows of a mode from the books of its rooms, books of one group together where its first one stands."""
    rows: dict[str, list[Row]] = {}
    for book in books:
        group = rows.setdefault(book.group, [])
        place = len(group)
        for i, row in enumerate(book.rows):
            if i in book.anchors:
                place = 1 + next(k for k, other in enumerate(group) if other.name == book.anchors[i])
            if not (isinstance(row, Input) and row.mode not in {None, mode}):
                group.insert(place, row)
                place += 1
    return tuple(row for group in rows.values() for row in group)


def _of_record(record: tuple[str, str]) -> str:
    """Source of an input whose value a chosen record gives."""
    return f"record: {record[1]} of the chosen {record[0]}"


def _summary(function: Callable[..., Any]) -> str:
    """First paragraph of the docstring, on one line."""
    text = function.__doc__ or ""
    return " ".join(text.split("\n\n")[0].split()).rstrip(".")


@cache
def directions() -> dict[str, Literal["less", "more"]]:
    """Which way an output is better, by name, of those for which that can be said of any module."""
    listed: dict[Literal["less", "more"], list[str]] = _data("better.yaml")
    return {name: way for way, names in listed.items() for name in names}


@cache
def _all_inputs() -> dict[str, dict[str, dict[str, Any]]]:
    """Inputs by group and name, as the data file has them."""
    loaded: dict[str, dict[str, dict[str, Any]]] = _data("inputs.yaml")
    return loaded


def _data(file: str) -> Any:
    """What a data file of this floor holds."""
    text = resources.files("tvimdesign.device.table").joinpath(file).read_text(encoding="utf-8")
    return yaml.load(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
