"""Records: values and tables in SI, each with source and status, and this package's own YAML and templates."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from tvimdesign.base.errors import CatalogError

_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # The C library takes a tenth of the time


def plain_data(text: str) -> Any:
    """Return the mappings, lists, texts and numbers of a text."""
    return yaml.load(text, Loader=_LOADER)


@cache
def own_data(module: str, name: str) -> Any:
    """Return the content of the data file of a name beside a module's file, read once. Nobody may change it."""
    return plain_data(Path(module).with_name(name).read_text(encoding="utf-8"))


@cache
def own_template(module: str, name: str, **filters: Callable[..., str]) -> Any:
    """Return a jinja template of the folder `templates` beside a module's file; HTML and XML escape all text."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined, select_autoescape

    environment = Environment(
        loader=FileSystemLoader(Path(module).with_name("templates")), undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True, autoescape=select_autoescape(("html.jinja", "xml.jinja")),
    )  # fmt: skip
    environment.filters.update(filters)
    return environment.get_template(name)


STATUSES = ("measured", "datasheet", "handbook", "calibrated", "assumed")


@dataclass(frozen=True)
class Entry:
    """One value in SI, with the unit it was written in, its source, its status and its range (SI) where it has one."""

    value: float
    unit: str
    source: str
    status: str
    low: float | None = None
    high: float | None = None

    @property
    def share_of_range(self) -> tuple[float, float] | None:
        """The range over the value; None where there is none."""
        if self.low is None or self.high is None or self.value == 0.0:
            return None
        return self.low / self.value, self.high / self.value


@dataclass(frozen=True)
class RecordTable:
    """One table in SI, with the units its columns were written in, source and status; `range` says how sure it is."""

    columns: Mapping[str, str]
    rows: tuple[tuple[float, ...], ...]
    source: str
    status: str
    range: str = ""


@dataclass(frozen=True)
class Record:
    """One thing of a category: a material, a wire table, a Peltier module."""

    category: str
    name: str
    title: str
    entries: Mapping[str, Entry] = field(default_factory=dict)
    tables: Mapping[str, RecordTable] = field(default_factory=dict)
    words: Mapping[str, str] = field(default_factory=dict)
    file: str = ""
    based_on: "Record | None" = None  # The record that has what this one leaves out

    def value(self, name: str) -> float:
        """Return a value in SI; raises CatalogError where the record lacks it."""
        return self.entry(name).value

    def has(self, name: str) -> bool:
        """Return whether the record has a value of that name."""
        return name in self.entries

    def entry(self, name: str) -> Entry:
        """Return a value with its source and status; raises CatalogError where the record lacks it."""
        entry: Entry = self._find("values", self.entries, name)
        return entry

    def table(self, name: str) -> list[dict[str, float]]:
        """Return a table's rows by column, in SI; raises CatalogError where the record lacks it.

        The columns convert by their units, which in `strength` makes the coefficient pascal while its exponent keeps
        going with d in millimetres: S_ut = coefficient / (d / 1 mm)^exponent.
        """
        sheet: RecordTable = self._find("tables", self.tables, name)
        return [dict(zip(sheet.columns, row, strict=True)) for row in sheet.rows]

    def word(self, name: str) -> str:
        """Return a plain word such as a module's form; raises CatalogError where the record lacks it."""
        word: str = self._find("words", self.words, name)
        return word

    def _find(self, section: str, where: Mapping[str, Any], name: str) -> Any:
        if name in where:
            return where[name]
        close = get_close_matches(name, where, n=1)
        hint = f"did you mean {close[0]}?" if close else f"it has {', '.join(where) or 'none'}"
        raise CatalogError(f"{self.file or self.category + '/' + self.name}: {section}.{name} is missing; {hint}")
