"""How a room of the device writes its rows: the function's name is the row's name, its docstring the description."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any, Literal, TypeVar

from tvimdesign.device.rows import Choice, Event, Input, Output, Path, Row, Rule

F = TypeVar("F", bound=Callable[..., Any])


class Book:
    """Collects the rows of one group in the order they are written."""

    def __init__(self, group: str) -> None:
        """`group` is the heading under which reports list the rows."""
        self.group = group
        self.rows: list[Row] = []

    def variable(self, name: str, unit: str, default: float, lower: float, upper: float, description: str) -> None:
        """Add a number that a study may set or vary, with the limits within which the models hold. SI."""
        row = Input(name=name, unit=unit, description=description, group=self.group, default=default, lower=lower,
                    upper=upper, variable=True)  # fmt: skip
        self.rows.append(row)

    def condition(
        self,
        name: str,
        unit: str,
        default: float,
        lower: float,
        upper: float,
        description: str,
        *,
        integer: bool = False,
        per_point: bool = False,
    ) -> None:
        """Add a number that a study may set but not vary. SI."""
        self.rows.append(
            Input(
                name=name,
                unit=unit,
                description=description,
                group=self.group,
                default=default,
                lower=lower,
                upper=upper,
                integer=integer,
                per_point=per_point,
            )
        )

    def property(self, name: str, unit: str, record: tuple[str, str], description: str) -> None:
        """Add a number that comes from a chosen record, (choice, field), unless the study sets it."""
        row = Input(name=name, unit=unit, description=description, group=self.group, lower=0.0, record=record)
        self.rows.append(row)

    def record(
        self, name: str, shelf: str, default: str, description: str, only: tuple[str, str, str] | None = None
    ) -> None:
        """Add the choice of a catalogue record; `only` is (word, value, reason) of the records that fit."""
        row = Choice(name=name, description=description, group=self.group, default=default, shelf=shelf, only=only)
        self.rows.append(row)

    def option(self, name: str, options: tuple[str, ...], description: str) -> None:
        """Add a choice among words; the first is the default."""
        self.rows.append(
            Choice(name=name, description=description, group=self.group, default=options[0], options=options)
        )

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
    ) -> Callable[[F], F]:
        """Add a function as a row."""

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
            )
            self.rows.append(row)
            return function

        return add

    def event(self, function: F) -> F:
        """Add a time: the first instant at which the function, which rises, passes zero."""
        name, about = function.__name__, _summary(function)
        row = Event(name=name, unit="s", description=about, group=self.group, function=function, headline=True)
        self.rows.append(row)
        return function

    def helper(self, *, per_point: bool = False, instant: bool = False) -> Callable[[F], F]:
        """Add an intermediate result that other rows use and nobody asks for."""
        return self.output("1", per_point=per_point, instant=instant, hidden=True)

    def path(self, unit: str, reduce: Literal["integral", "maximum"], *, headline: bool = False) -> Callable[[F], F]:
        """Add what an instant's value adds up to, or reaches, over the switch."""

        def add(function: F) -> F:
            row = Path(name=function.__name__, unit=unit, description=_summary(function), group=self.group,
                       function=function, reduce=reduce, headline=headline)  # fmt: skip
            self.rows.append(row)
            return function

        return add


def _summary(function: Callable[..., Any]) -> str:
    """First paragraph of the docstring, on one line."""
    text = inspect.getdoc(function) or ""
    return " ".join(text.split("\n\n")[0].split()).rstrip(".")
