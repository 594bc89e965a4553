"""The requirements of a category: values, tables, words, and relations between them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

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
    that word needs its own. `material` are the values by which two records are told to be of different materials.
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
        found = {**self.may_have, **self.values, **of_words}
        for name, law in self.follows.items():
            found |= {law.known_value: found[name], law.exponent: "1"}
            found |= dict.fromkeys((law.size, law.known_size), law.size_unit)
        return found
