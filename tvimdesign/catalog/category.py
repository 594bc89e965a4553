"""Categories: the content that `categories.yaml` requires of records, and the laws that values follow from."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import prod
from typing import Any, NamedTuple

from pydantic import TypeAdapter

from tvimdesign.base.record import Entry, Record, RecordTable, own_data

AGREEMENT = 0.1
"""Share by which a value may differ from what a table of the same record comes to: fits of one melt are no closer."""


@dataclass(frozen=True)
class Columns:
    """The columns a table must have, with a unit of the kind each needs.

    `exact` wants these very units, where a formula goes with them. `rising` columns must rise within each row,
    `falling` ones fall from row to row.
    """

    units: Mapping[str, str]
    exact: bool = False
    rising: tuple[str, ...] = ()
    falling: tuple[str, ...] = ()


@dataclass(frozen=True)
class PowerLaw:
    """A value that follows from a size: that of a known size, times the ratio of the sizes to a power; names and units.

    Only where a record has all four and not the value itself.
    """

    known_value: str
    size: str
    known_size: str
    exponent: str
    size_unit: str

    @property
    def names(self) -> tuple[str, str, str, str]:
        """The four, in the order of the formula."""
        return self.known_value, self.size, self.known_size, self.exponent


@dataclass(frozen=True)
class Category:
    """The content of a record. Every required number is greater than zero, or `may_be_zero`; `rising` lists rise.

    The rows of `paired` tables belong together, first to first: there must be as many in each. A table of `instead` may
    stand in place of values or they in its place: each is the sum over the rows of the product of some columns, and
    where a record has both they must agree to `AGREEMENT`. A value of `follows` may be left out where its law has what
    it needs. `values_of` are further values that a record needs if it has a word, `rising_of` lists that rise then.
    `usual_words` stand where a record has none, `may_have` are values it can leave out, with their units.

    `laws` are groups of values and tables that belong to one material, by what people call them: a record that is based
    on another material's and has none of a group has that one's law. Of those under a word of `own_laws` a record with
    that word needs its own. `material` are the values by which materials differ.
    """

    values: Mapping[str, str] = field(default_factory=dict)
    tables: Mapping[str, Columns] = field(default_factory=dict)
    words: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    rising: tuple[tuple[str, ...], ...] = ()
    paired: tuple[str, ...] = ()
    may_be_zero: tuple[str, ...] = ()
    instead: Mapping[str, Mapping[str, tuple[str, ...]]] = field(default_factory=dict)
    follows: Mapping[str, PowerLaw] = field(default_factory=dict)
    values_of: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    rising_of: Mapping[str, tuple[tuple[str, ...], ...]] = field(default_factory=dict)
    usual_words: Mapping[str, str] = field(default_factory=dict)
    may_have: Mapping[str, str] = field(default_factory=dict)
    laws: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    own_laws: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    material: tuple[str, ...] = ()

    @property
    def units(self) -> dict[str, str]:
        """A unit of the kind each number needs: what a record must have, and what values of `follows` follow from."""
        of_words = {name: unit for needed in self.values_of.values() for name, unit in needed.items()}
        units = {**self.may_have, **self.values, **of_words}
        for name, law in self.follows.items():
            units |= {law.known_value: units[name], law.exponent: "1"}
            units |= dict.fromkeys((law.size, law.known_size), law.size_unit)
        return units


CATEGORIES = TypeAdapter(Mapping[str, Category]).validate_python(own_data(__file__, "categories.yaml"))


def following(category: Category, entries: Mapping[str, Entry], tables: Mapping[str, RecordTable]) -> dict[str, Entry]:
    """Return the entries that follow from others of a record, by name, without those it has itself."""
    entries_found = {}
    for table, values in category.instead.items():
        for name, columns in values.items() if table in tables else ():
            if name not in entries:
                entries_found[name] = _sum(tables[table], columns, category.units[name])
    for name, law in category.follows.items():
        if name not in entries and name not in entries_found and {*law.names} <= entries.keys():
            entries_found[name] = _power(law, entries, category.units[name])
    return entries_found


def _sum(table: RecordTable, columns: tuple[str, ...], unit: str) -> Entry:
    rows = [dict(zip(table.columns, row, strict=True)) for row in table.rows]
    total = sum(prod(row[column] for column in columns) for row in rows)
    return Entry(total, unit, table.source, table.status, None, None)


def _power(law: PowerLaw, entries: Mapping[str, Entry], unit: str) -> Entry:
    """value = reference (size/reference size)^exponent; the range is that of reference and exponent together."""
    reference, size, known, exponent = (entries[name] for name in law.names)
    ratio = size.value / known.value

    def ends(entry: Entry) -> tuple[float, float]:
        low, high = (entry.value if end is None else end for end in (entry.low, entry.high))
        return low, high

    powers = [ratio**end for end in ends(exponent)]
    low, high = (end * power for end, power in zip(ends(reference), (min(powers), max(powers)), strict=True))
    source = f"{exponent.status}: follows from {law.size}: {reference.source}; {exponent.source}"
    return Entry(reference.value * ratio**exponent.value, unit, source, exponent.status, low, high)


SAME_MATERIAL = 0.03
"""Share, in SI, by which values of two records of one material may differ: 10 K of a melting temperature, and more
than the densities of a polymer's grades."""


class InheritedLaw(NamedTuple):
    """A law of one material in the record of another."""

    law: str  # Its name in the field
    owner: Record  # The record it comes from
    differs: str  # The value by which the owner is another material
    names: tuple[str, ...]  # The values and tables; the record needs one of its own
    kind_differs: bool  # True if the two freeze or soften in different ways, so that the law means nothing here


def inherited_laws(record: Record) -> list[InheritedLaw]:
    """Return the laws that a record takes from another material's record, of those its kind uses."""
    category = CATEGORIES[record.category]
    used = {law for word in record.words.values() for law in category.own_laws.get(word, ())}
    inherited = []
    for law, names in category.laws.items():
        owner = _owner(record, names) if law in used else record
        differs = "" if owner is record else _difference(record, owner, category)
        if differs:
            kind_differs = any(owner.words.get(word) != record.words.get(word) for word in category.usual_words)
            inherited.append(InheritedLaw(law, owner, differs, names, kind_differs))
    return inherited


def meaningless_laws(record: Record) -> list[str]:
    """Return a problem for each law that a record has from a material of another kind."""
    return [
        f"{record.file}: {inherited.law}: those of {inherited.owner.name} mean nothing here, where {_kind(record)}; "
        f"give {' or '.join(inherited.names)} of its own"
        for inherited in inherited_laws(record)
        if inherited.kind_differs
    ]


def inherited_law_warnings(record: Record) -> list[str]:
    """Return a sentence for each law that a record has from another material."""
    return [
        f"{record.title}: the {inherited.law} are those of {inherited.owner.title}, and its {inherited.differs} is "
        f"another material's; give {' or '.join(inherited.names)} of its own"
        for inherited in inherited_laws(record)
    ]


def _owner(record: Record, names: tuple[str, ...]) -> Record:
    """Return the record in a chain that first gave the values and tables as they are."""

    def content(of: Record) -> dict[str, Any]:
        everything: Mapping[str, Any] = {**of.entries, **of.tables}
        return {name: everything[name] for name in names if name in everything}

    while record.based_on is not None and content(record) == content(record.based_on):
        record = record.based_on
    return record


def _difference(record: Record, owner: Record, category: Category) -> str:
    """Return the first value by which two records are of different materials; empty if there is none."""
    for name in category.material:
        own, other = record.value(name), owner.value(name)
        if abs(own / other - 1.0) > SAME_MATERIAL:
            return name
    return ""


def _kind(record: Record) -> str:
    words = CATEGORIES[record.category].usual_words
    return " and ".join(f"{word} is {record.words[word]}" for word in words)
