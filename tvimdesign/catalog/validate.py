"""Turns a file's tree into a record, and names everything that is wrong with it: field, and what was expected."""

from __future__ import annotations

import re
from collections.abc import Iterable
from difflib import get_close_matches
from itertools import pairwise
from math import prod
from pathlib import Path
from typing import Any, TypeAlias

import yaml

from tvimdesign.base import units
from tvimdesign.base.errors import CatalogError, UnitError
from tvimdesign.base.record import STATUSES, Entry, Record, RecordTable
from tvimdesign.catalog.category import AGREEMENT, CATEGORIES, Columns, following
from tvimdesign.catalog.offers import piece_price

Tree: TypeAlias = "str | list[Tree] | dict[str, Tree]"
"""Numbers stay text until their unit is known, so that no YAML rule turns 1:30 or 010 into something else."""

LARGEST_FILE = 1_000_000
DEEPEST = 8
MOST_NODES = 10_000
_Loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def read_tree(path: Path) -> dict[str, Tree]:
    """Read a file whose top is a mapping; raises CatalogError naming file and line."""
    try:
        if not path.is_file():  # a pipe or a device would be read for ever
            raise CatalogError(f"{path}: this is no file")
        with path.open("rb") as stream:
            data = stream.read(LARGEST_FILE + 1)
    except (OSError, ValueError) as error:
        raise CatalogError(f"{path}: cannot be read ({type(error).__name__})") from None
    if len(data) > LARGEST_FILE:
        raise CatalogError(f"{path}: larger than {LARGEST_FILE // 1000} kB, which no record is")
    try:
        text = data.decode("utf-8-sig")
        _guard(text)
        node = yaml.compose(text, Loader=_Loader)
        tree = _plain(node) if node is not None else ""
    except UnicodeDecodeError:
        raise CatalogError(f"{path}: this is no UTF-8 text") from None
    except CatalogError as error:
        raise CatalogError(f"{path}:{error}") from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = mark.line + 1 if mark else 1
        raise CatalogError(f"{path}:{line}: this is no YAML ({error.problem or error.context})") from None
    except (yaml.YAMLError, RecursionError, ValueError):
        raise CatalogError(f"{path}: this is no YAML") from None
    if not isinstance(tree, dict):
        raise CatalogError(f"{path}: expected a mapping with title, values, tables and words")
    return tree


def _guard(text: str) -> None:
    """Refuse aliases, tags, depth and size while the file is still a stream of events."""
    depth = 0
    events: Any = yaml.parse(text, Loader=_Loader)
    for count, event in enumerate(events):
        line = event.start_mark.line + 1
        if isinstance(event, yaml.AliasEvent) or getattr(event, "anchor", None):
            raise CatalogError(f"{line}: anchors and aliases (& and *) are not read; write the value out")
        if getattr(event, "tag", None):
            raise CatalogError(f"{line}: tags ({str(event.tag)[:40]!r}) are not read")
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
        if depth > DEEPEST or count > MOST_NODES:
            raise CatalogError(f"{line}: deeper or longer than any record is")


def _plain(node: Any) -> Tree:
    """Turn nodes into text, lists and mappings; a key said twice is an error."""
    if isinstance(node, yaml.ScalarNode):
        return str(node.value)
    if isinstance(node, yaml.SequenceNode):
        return [_plain(child) for child in node.value]
    tree: dict[str, Tree] = {}
    for key, child in node.value:
        line = key.start_mark.line + 1
        if not isinstance(key, yaml.ScalarNode):
            raise CatalogError(f"{line}: a key must be a plain word")
        if key.value in tree:
            raise CatalogError(f"{line}: {key.value[:40]!r} is given twice")
        tree[str(key.value)] = _plain(child)
    return tree


_ENTRY_FIELDS = ("value", "unit", "source", "status", "low", "high")
_TABLE_FIELDS = ("columns", "rows", "source", "status", "range")
_SECTIONS = ("title", "based_on", "values", "tables", "words")
_LONGEST_UNIT = 40
_NAME = re.compile(r"[a-z][a-z0-9_]{0,60}")


def build_record(category: str, name: str, file: str, tree: dict[str, Tree]) -> tuple[Record, list[str]]:
    """Build the record; the list names every problem, and the record is only to be used where there is none."""
    check = _Check(category, file)
    check.unknown("", tree, _SECTIONS)
    title = check.text("title", tree, "a line that says what this is")
    entries = {key: entry for key, item in check.section(tree, "values") if (entry := check.entry(key, item))}
    sheets = {key: sheet for key, item in check.section(tree, "tables") if (sheet := check.sheet(key, item))}
    own_words = {
        key: item for key, item in check.section(tree, "words") if check.word(key, item) and isinstance(item, str)
    }
    words = {**check.category.usual_words, **own_words}
    check.required(tree, entries, words)
    check.paired(sheets)
    check.agreeing(entries, sheets)
    if not check.problems:
        entries.update(following(check.category, entries, sheets))
        if "price" in check.category.may_have and "price" not in entries and (price := piece_price(name, title)):
            entries["price"] = price
    return Record(category, name, title, entries, sheets, words, file), check.problems


class _Check:
    """Gathers the problems of one file."""

    def __init__(self, category: str, file: str) -> None:
        self.category = CATEGORIES[category]
        self.file = file
        self.problems: list[str] = []

    def no(self, field: str, message: str) -> None:
        self.problems.append(f"{self.file}: {field}: {message}")

    def unknown(self, field: str, tree: dict[str, Tree], allowed: Iterable[str]) -> None:
        allowed = list(allowed)
        for key in tree:
            if key not in allowed:
                close = get_close_matches(key, allowed, n=1)
                hint = f"did you mean {close[0]}?" if close else f"expected {', '.join(allowed)}"
                if key[:40].isdigit():  # 6,1 between braces reads as 6 and a key 1
                    hint = "is this a decimal comma? write a decimal point"
                self.no(f"{field}.{key[:40]}".lstrip("."), f"unknown; {hint}")

    def section(self, tree: dict[str, Tree], name: str) -> list[tuple[str, Tree]]:
        part = tree.get(name, {})
        if not isinstance(part, dict):
            if part != "":
                self.no(name, "expected a mapping of names")
            return []
        return [(key, item) for key, item in part.items() if self.named(f"{name}.{key[:40]}", key)]

    def named(self, field: str, key: str) -> bool:
        if _NAME.fullmatch(key):
            return True
        self.no(field, "a name is small letters, digits and underscores")
        return False

    def text(self, field: str, tree: dict[str, Tree], expected: str) -> str:
        value = tree.get(field.rpartition(".")[2])
        if not isinstance(value, str) or not value.strip():
            self.no(field, f"missing; expected {expected}")
            return ""
        return value.strip()

    def number(self, field: str, text: Tree, unit: str, wanted: str) -> float | None:
        """Read a number in `unit` where a quantity of the kind of `wanted` belongs."""
        if not isinstance(text, str) or not re.match(r"[+-]?[0-9]", text) or re.search(r"[^0-9eE.,+-]", text):
            self.no(field, "expected a number")
            return None
        if len(unit) > _LONGEST_UNIT:
            self.no(field, f"{unit[:20]!r}... is no unit")
            return None
        try:
            return units.parse_quantity(text if unit == "1" else f"{text} {unit}", wanted)
        except UnitError as error:
            self.no(field, str(error))
            return None

    def provenance(self, field: str, tree: dict[str, Tree]) -> tuple[str, str]:
        """Check that a source is named, and that it says what its status promises."""
        source = self.text(f"{field}.source", tree, "the handbook, data sheet, paper or test it comes from")
        status = self.text(f"{field}.status", tree, f"one of {', '.join(STATUSES)}")
        if status and status not in STATUSES:
            self.no(f"{field}.status", f"{status[:40]!r} is not one of {', '.join(STATUSES)}")
        if status == "calibrated" and source and not re.search(r"\b(to|from|against)\b", source):
            self.no(f"{field}.source", 'a calibrated value must say to what, as in "calibrated to ..."')
        if status == "assumed" and source and not source.startswith("assumed: "):
            self.no(f"{field}.source", 'an assumed value must say why, as in "assumed: the reason"')
        return source, status

    def entry(self, name: str, item: Tree) -> Entry | None:
        field = f"values.{name}"
        if not isinstance(item, dict):
            self.no(field, "expected {value: , unit: , source: , status: }")
            return None
        before = len(self.problems)
        self.unknown(field, item, _ENTRY_FIELDS)
        source, status = self.provenance(field, item)
        unit = self.text(f"{field}.unit", item, 'a unit such as MPa, or "1" for a plain number')
        wanted = self.category.units.get(name, unit)
        numbers: dict[str, float | None] = {"low": None, "high": None}
        for part in ("value", "low", "high"):
            if unit and (part == "value" or part in item):
                numbers[part] = self.number(f"{field}.{part}", item.get(part, ""), unit, wanted)
        value, low, high = (numbers.get(part) for part in ("value", "low", "high"))
        is_too_small = value is not None and (value < 0.0 or (value == 0.0 and name not in self.category.may_be_zero))
        if is_too_small and name in self.category.units:
            self.no(f"{field}.value", "must be greater than zero")
        if status == "assumed" and not {"low", "high"} <= set(item):
            self.no(field, "an assumed value needs its plausible range, low and high")
        if any(a is not None and b is not None and a > b for a, b in ((low, value), (value, high), (low, high))):
            self.no(field, "expected low <= value <= high")
        if len(self.problems) > before or value is None:
            return None
        return Entry(value, unit, source, status, low, high)

    def sheet(self, name: str, item: Tree) -> RecordTable | None:
        field = f"tables.{name}"
        if not isinstance(item, dict):
            self.no(field, "expected {columns: , rows: , source: , status: }")
            return None
        before = len(self.problems)
        self.unknown(field, item, _TABLE_FIELDS)
        source, status = self.provenance(field, item)
        bound = self.text(f"{field}.range", item, "how far an assumed table may be off") if status == "assumed" else ""
        needed = self.category.tables.get(name, Columns({}))
        before_columns = len(self.problems)
        columns = self.columns(field, item.get("columns"), needed)
        # With a column wrong, every row would be wrong in the same way: say it once.
        rows = self.rows(field, item.get("rows"), columns, needed) if len(self.problems) == before_columns else []
        if len(self.problems) > before:
            return None
        return RecordTable(columns, tuple(rows), source, status, bound)

    def columns(self, field: str, item: Tree | None, needed: Columns) -> dict[str, str]:
        field = f"{field}.columns"
        if not isinstance(item, dict) or not item:
            self.no(field, "expected a mapping of column to unit")
            return {}
        columns: dict[str, str] = {}
        for key, unit in item.items():
            if not self.named(f"{field}.{key[:40]}", key):
                continue
            columns[key] = unit if isinstance(unit, str) else ""
            wanted = needed.units.get(key, columns[key])
            if self.number(f"{field}.{key}", "1", columns[key], wanted) is None:
                continue
            if needed.exact and columns[key] != wanted:
                self.no(f"{field}.{key}", f"must be in {wanted}, for the formula goes with it")
        for key in needed.units:
            if key not in item:
                self.no(f"{field}.{key}", f"missing; expected a column in {needed.units[key]}")
        return columns

    def rows(self, field: str, item: Tree | None, columns: dict[str, str], needed: Columns) -> list[tuple[float, ...]]:
        field = f"{field}.rows"
        if not isinstance(item, list) or not item:
            self.no(field, "expected a list of rows")
            return []
        rows: list[tuple[float, ...]] = []
        for index, cells in enumerate(item, start=1):
            here = f"{field}[{index}]"
            if not isinstance(cells, list) or len(cells) != len(columns):
                self.no(here, f"expected {len(columns)} numbers: {', '.join(columns)}")
                continue
            pairs = zip(columns.items(), cells, strict=True)
            values = {key: self.number(f"{here}.{key}", cell, unit, unit) for (key, unit), cell in pairs}
            row = [value for value in values.values() if value is not None]
            if len(row) < len(columns):
                continue
            rows.append(tuple(row))
            for key in needed.units:
                if (values[key] or 0.0) <= 0.0:
                    self.no(f"{here}.{key}", f"{values[key]:g} does not do: it must be greater than zero")
            if any((values[a] or 0.0) >= (values[b] or 0.0) for a, b in pairwise(needed.rising)):
                self.no(here, f"expected {' < '.join(needed.rising)}")
        for key in needed.falling:
            down = [row[list(columns).index(key)] for row in rows]
            if min(down, default=0.0) <= 0.0:  # named already
                continue
            for index, (above, below) in enumerate(pairwise(down), start=2):
                if below >= above:
                    self.no(f"{field}[{index}].{key}", f"{below:g} does not do: it must be below the row's before")
        return rows

    def word(self, name: str, item: Tree) -> bool:
        allowed = self.category.words.get(name)
        if not isinstance(item, str) or not item or (allowed and item not in allowed):
            self.no(f"words.{name}", f"expected {' or '.join(allowed) if allowed else 'a word'}")
            return False
        return True

    def paired(self, sheets: dict[str, RecordTable]) -> None:
        counts = {name: len(sheets[name].rows) for name in self.category.paired if name in sheets}
        if len(set(counts.values())) > 1:
            lengths = ", ".join(f"{name} has {count}" for name, count in counts.items())
            self.no("tables", f"{lengths} rows; they belong together, first to first, and must be as many")

    def agreeing(self, entries: dict[str, Entry], sheets: dict[str, RecordTable]) -> None:
        """Name the values that differ from what a table of the record, which may stand in their place, comes to."""
        for table, values in self.category.instead.items():
            for name, columns in values.items() if table in sheets else ():
                if name not in entries:
                    continue
                rows = [dict(zip(sheets[table].columns, row, strict=True)) for row in sheets[table].rows]
                total, value = sum(prod(row[column] for column in columns) for row in rows), entries[name].value
                if abs(total - value) > AGREEMENT * value:
                    self.no(
                        f"values.{name}",
                        f"{value:g} and tables.{table} contradict each other: the sum of {' times '.join(columns)} is "
                        f"{total:g}; they must agree to {AGREEMENT:.0%}, in SI; leave one of them out",
                    )

    def required(self, tree: dict[str, Tree], entries: dict[str, Entry], words: dict[str, str]) -> None:
        """Name what the category wants and the file does not have at all; what is there but wrong is named already."""
        of_words = [self.category.values_of.get(word, {}) for word in words.values()]
        wanted: dict[str, dict[str, Any]] = {
            "values": {**self.category.values, **{name: unit for more in of_words for name, unit in more.items()}},
            "tables": dict.fromkeys(self.category.tables, "see the shipped records"),
            "words": {name: " or ".join(allowed) for name, allowed in self.category.words.items() if name not in words},
        }
        for table, values in self.category.instead.items():
            tables = tree.get("tables")
            wanted["tables"].pop(table)
            for name in values if isinstance(tables, dict) and table in tables else ():
                wanted["values"].pop(name, None)
        for name, law in self.category.follows.items():
            if {*law.names} <= entries.keys():
                wanted["values"].pop(name, None)
        for section, names in wanted.items():
            part = tree.get(section)
            present = part if isinstance(part, dict) else {}
            for name, expected in names.items():
                if name not in present:
                    close = get_close_matches(name, set(present) - set(names), n=1)
                    hint = f"; is {close[0]} meant to be it?" if close else ""
                    self.no(f"{section}.{name}", f"missing; expected {expected}{hint}")
        of_word = [order for word in words.values() for order in self.category.rising_of.get(word, ())]
        for order in (*self.category.rising, *of_word):
            values_in_order = [(name, entries[name].value) for name in order if name in entries]
            for (lower_name, low), (name_above, high) in pairwise(values_in_order):
                if low >= high:
                    self.no(f"values.{name_above}", f"must be above {lower_name}")
