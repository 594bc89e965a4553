"""Reads single values: a quantity, a whole number, true or false, the name of a record."""

import math
import re
from collections.abc import Callable, Collection, Iterable
from collections.abc import Mapping as Mapped
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from tvimdesign.base.errors import CatalogError, UnitError
from tvimdesign.base.record import Record
from tvimdesign.base.units import exact_digits, format_quantity, from_si, parse_quantity
from tvimdesign.catalog import Catalog
from tvimdesign.device import MODES, Choice, Input, Output, Table, table_for
from tvimdesign.study.text.mistakes import At, Mistakes, RefusedError, nearest, one_of, quoted, step, synonyms
from tvimdesign.study.text.yaml_text import Broken, Mapping, Node, Sequence, Text

LONGEST_VALUE = 200
ROUNDING = 1e-9
"""Relative difference below which two quantities are the same: 3.2 mm may be read as 0.0032000000000000001 m."""
_WHOLE = re.compile(r"0|-?[1-9][0-9]{0,17}")
_OCTAL = re.compile(r"[+-]?0[0-9]")
_FLAGS = {"true": True, "True": True, "false": False, "False": False}
K = TypeVar("K")
T = TypeVar("T")
R = TypeVar("R")


@dataclass(frozen=True)
class Reading:
    """A study while it is read: its nodes, what they are read against, and where their problems go."""

    problems: Mistakes
    mode: str  # Empty if it is not known
    table: Table
    catalog: Catalog
    nodes: Mapped[str, Node]  # The sections as they are written
    readers: "Mapped[str, Callable[[Reading, Node | None], Any]]"
    folder: Path = Path()  # The study's, from which the files that it names are sought
    values: dict[str, Any] = field(default_factory=dict)  # The sections that have been read

    def section(self, name: str) -> Any:
        """Return the value of a section, None of a refused one; it is read when it is first asked for."""
        if name not in self.values:
            self.values[name] = None
            with suppress(RefusedError):
                self.values[name] = self.readers[name](self, self.nodes.get(name))
        return self.values[name]

    @property
    def points(self) -> Collection[str]:
        """The study's operating points."""
        points: Collection[str] = self.section("operating_points")
        return points

    def has(self, name: str) -> bool:
        """Return whether anything stands in a section."""
        node = self.nodes.get(name)
        empty = (isinstance(node, Text) and node.empty) or (isinstance(node, Mapping) and not node.entries)
        return node is not None and not empty

    def unknown_quantity(
        self, place: At, path: str, what: str, name: str, known: Iterable[str], point: str = ""
    ) -> None:
        """Note a name that is no such quantity; of one that only another mode has, which one.

        A quantity that is meant instead is named with its operating point, `point` or else the hot one.
        """
        if self.problems.full:
            self.problems.add(place, path, f"no such {what}")
            return
        others = [mode for mode in MODES if mode != self.mode and _has(mode, name)]
        if others and not _has(self.mode, name):
            self.problems.add(place, path, f"{name} is of {others[0]} mode, this study is {self.mode} mode")
            return
        names = list(known)
        meant = next(iter(synonyms().get(name.lower().replace("_", " "), ())), nearest(name, names))
        row, hint = self.table.by_name.get(meant), ""
        if isinstance(row, Output) and meant not in names:
            hint = f"limit {meant!r} under `require`"
        elif isinstance(row, Output) and row.per_point:
            hint = f"did you mean '{meant}@{point or 'hot'}'?"
        self.problems.unknown(place, path, what, name, names, hint)


def _has(mode: str, name: str) -> bool:
    """Return whether a mode has a quantity of that name that a study may use."""
    row = table_for(mode).by_name.get(name)
    return row is not None and not (isinstance(row, Output) and row.hidden)


def entries(problems: Mistakes, node: Node | None, path: str, expected: str) -> dict[str, tuple[Text, Node]]:
    """Return a section's keys and values; a missing or empty section has none."""
    if isinstance(node, Mapping):
        return node.entries
    if node is not None and not (isinstance(node, Text) and node.empty):
        with suppress(RefusedError):
            misfit(problems, node, path, expected)
    return {}


def readable(read: Callable[[K, T], R], nodes: Mapped[K, T]) -> dict[K, R]:
    """Return what is read of some values, without those that are refused."""
    values = {}
    for name, node in nodes.items():
        with suppress(RefusedError):
            values[name] = read(name, node)
    return values


def all_readable(read: Callable[[K, T], R], nodes: Mapped[K, T]) -> dict[K, R]:
    """Return what is read of some values; raises RefusedError, once all are read, if any is refused."""
    values = readable(read, nodes)
    if len(values) < len(nodes):
        raise RefusedError
    return values


def misfit(problems: Mistakes, node: Node, path: str, expected: str) -> NoReturn:
    """Note that a node has the wrong shape, or nothing where that was noted already. Raises RefusedError."""
    if isinstance(node, Broken):
        raise RefusedError
    if isinstance(node, Text):
        what = "no value" if node.empty else f"the value {quoted(node.value)}"
    else:
        what = "a list" if isinstance(node, Sequence) else "a mapping (name: value)"
    problems.refuse(node, path, f"{what} does not fit here", expected)


# What follows notes why a value cannot be used, and raises RefusedError then.


def text(problems: Mistakes, node: Node, path: str, expected: str) -> str:
    """Return the text of a scalar that is not over-long."""
    if not isinstance(node, Text) or node.empty:
        misfit(problems, node, path, expected)
    if len(node.value) > LONGEST_VALUE:
        message = f"{quoted(node.value)} has {len(node.value)} characters, the limit is {LONGEST_VALUE}"
        problems.refuse(node, path, message, expected)
    return node.value.strip()


def word_of(problems: Mistakes, node: Node | None, path: str, known: Collection[str]) -> str:
    """Return one of some words; empty if none is written, or (with a problem) another one."""
    with suppress(RefusedError):
        word = "" if node is None else text(problems, node, path, one_of(list(known)))
        if node is None or word in known:
            return word
        problems.unknown(node, path, f"{path.rpartition('.')[2]}: {quoted(word)}", word, known)
    return ""


def whole(problems: Mistakes, node: Node, path: str) -> int:
    """Return a whole number written in plain digits."""
    expected = "a whole number in plain digits"
    word = text(problems, node, path, expected)
    if not _WHOLE.fullmatch(word):
        misfit(problems, node, path, expected)
    return int(word)


def flag(problems: Mistakes, node: Node, path: str) -> bool:
    """Return true or false; YAML's other words for them (yes, on) are refused, as they surprise."""
    word = text(problems, node, path, "true or false")
    if word not in _FLAGS:
        misfit(problems, node, path, "true or false")
    return _FLAGS[word]


def number(problems: Mistakes, node: Node, path: str, expected: str = "a number") -> float:
    """Return a number without a unit."""
    return in_unit(problems, node, path, "1", expected)


def in_unit(problems: Mistakes, node: Node, path: str, unit: str, expected: str) -> float:
    """Return the SI value of a quantity that must have the dimension of `unit`."""
    return si_value(problems, node, path, text(problems, node, path, expected), unit)


def quantities(problems: Mistakes, node: Sequence, path: str, unit: str) -> tuple[float, ...]:
    """Return the SI values of a list of quantities in a unit."""
    listed, expected = {str(place): item for place, item in enumerate(node.items)}, f"a quantity in {unit}"
    read = all_readable(lambda place, item: in_unit(problems, item, step(path, place), unit, expected), listed)
    return tuple(read.values())


def si_value(problems: Mistakes, node: Node, path: str, word: str, unit: str) -> float:
    """Return the SI value of a word that stands in a node."""
    if _OCTAL.match(word):
        problems.refuse(node, path, f"{quoted(word)} starts with a zero, which some read as octal", hint="leave it out")
    try:
        return parse_quantity(word, unit)
    except UnitError as error:
        problems.refuse(node, path, str(error))


def exactly(value: float, unit: str) -> str:
    """Write a quantity in a unit with the fewest digits that read as the same number."""
    for digits in range(1, 18):
        number = float(f"{from_si(value, unit):.{digits}g}")
        text = f"{number:.{max(digits, 6)}g} {unit}".removesuffix(" 1")
        with suppress(UnitError):  # rounded, a temperature may lie below absolute zero
            if parse_quantity(text, unit) == value:
                return text
    return f"{exact_digits(value, unit)} {unit}".removesuffix(" 1")


def difference_unit(unit: str) -> str:
    """Return the unit of a difference: a temperature's is the kelvin."""
    return "K" if unit == "degC" else unit


def quantity(problems: Mistakes, node: Node, path: str, row: Input) -> float:
    """Return the SI value of an input, which must lie within the row's own limits."""
    value = in_unit(problems, node, path, row.unit, expected_for(row))
    shown = quoted(node.value.strip()) if isinstance(node, Text) else ""
    if row.integer and not value.is_integer():
        problems.refuse(node, path, f"{shown} is not a whole number", "a whole number")
    if below(value, row.lower):
        lower = format_quantity(row.lower, row.unit)
        problems.refuse(node, path, f"{shown} is below the lower limit {lower}", limits(row))
    if below(row.upper, value):
        upper = format_quantity(row.upper, row.unit)
        problems.refuse(node, path, f"{shown} is above the upper limit {upper}", limits(row))
    return value


def choice(reading: Reading, node: Node, path: str, row: Choice) -> str:
    """Return the name of a record that is on the row's category, or one of the row's options."""
    word = text(reading.problems, node, path, "the name of a record" if row.category else "one of the options")
    if word in row.options:
        return word
    if row.category:
        return record(reading, node, path, row.category, word).name
    reading.problems.unknown(node, path, f"option: {quoted(word)}", word, row.options)
    raise RefusedError


def record(reading: Reading, node: Node, path: str, category: str, name: str) -> Record:
    """Return a record of the catalogue."""
    try:
        known = reading.catalog.names(category)
        if name in known:
            return reading.catalog.record(category, name)
        reading.problems.unknown(node, path, f"record in the category {category}: {quoted(name)}", name, known)
    except CatalogError as error:
        reading.problems.add(node, path, str(error))
    raise RefusedError


def read_input(reading: Reading, node: Node, path: str, row: Input | Choice) -> float | str:
    """Return the SI value of an input, or the word of a choice."""
    return choice(reading, node, path, row) if isinstance(row, Choice) else quantity(reading.problems, node, path, row)


def below(value: float, limit: float) -> bool:
    """Return whether a value lies below a limit by more than rounding."""
    return value < limit - ROUNDING * abs(limit) if math.isfinite(limit) else value < limit


def expected_for(row: Input) -> str:
    """Describe what to write for an input."""
    return ("a whole number" if row.integer else "a number") if row.unit == "1" else f"a quantity in {row.unit}"


def limits(row: Input) -> str:
    """Format the span an input may have, in its own unit."""
    lower, upper = (format_quantity(limit, row.unit) for limit in (row.lower, row.upper))
    if math.isinf(row.upper):
        return f"at least {lower}"
    return f"at most {upper}" if math.isinf(row.lower) else f"{lower} to {upper}"


def unknown_keys(
    problems: Mistakes, keys: dict[str, tuple[Text, Node]], path: str, what: str, known: list[str]
) -> dict[str, Node]:
    """Return the values of the known keys; every other key is a problem."""
    for name, (key, _) in keys.items():
        if name not in known:
            problems.unknown(key, step(path, name), what, name, known)
    return {name: value for name, (_, value) in keys.items() if name in known}
