"""Laws that a record has from another material: it is based on a record of one, and its own values tell them apart."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from tvimdesign.base.record import Record
from tvimdesign.catalog.category import CATEGORIES, Category

SAME_MATERIAL = 0.03
"""Share, in SI, by which values of two records of one material may differ: 10 K of a melting temperature, and more
than the densities of a polymer's grades."""


class InheritedLaw(NamedTuple):
    """A law of one material in the record of another."""

    law: str
    """What people call it."""
    owner: Record
    """The record it comes from."""
    differs: str
    """The value by which the owner is another material."""
    names: tuple[str, ...]
    """The values and tables; the record needs one of its own."""
    kind_differs: bool
    """True if the two freeze or soften in different ways, so that the law means nothing here."""


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
