"""Listed records as families that share one problem, without those that arithmetic alone excludes."""

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tvimdesign.base.errors import InfeasibleError, InputError
from tvimdesign.device import Choice, Input, Output, Table
from tvimdesign.device.components.cost import GROUP as COST_GROUP
from tvimdesign.device.table.quantity import Simulated, Supplied
from tvimdesign.solve.nlp.constraints import ALGEBRAIC_TOLERANCE, Constraint, constraints_of, on_cycle, unchangeable
from tvimdesign.solve.nlp.mixture import MixedDevice, Mixture, discrete_records, listed_records, with_records
from tvimdesign.study import Study, asks_cost, given

Records = dict[str, str]


@dataclass(frozen=True)
class Family:
    """Combinations of records: one of them, and the mixtures that each contribute one record."""

    records: Records
    mixtures: tuple[Mixture, ...]

    @property
    def fixed(self) -> Records:
        """The records that every combination has."""
        mixed = {name for mixture in self.mixtures for name in mixture.records[0]}
        return {name: record for name, record in self.records.items() if name not in mixed}

    @property
    def count(self) -> int:
        """Combinations of records."""
        return math.prod(len(mixture.records) for mixture in self.mixtures)


def families_of(study: Study) -> list[Family]:
    """Return families that hold every combination of listed records once. Raise InputError as `given` does.

    Nothing is mixed where modules spread, as margins are those of a record's own numbers, or where a current follows a
    profile, which is compared with constant currents and the same records.
    """
    listed = listed_records(study, study.table)
    _refuse_unpriced(study, listed)
    if study.robust or study.profile.pieces():
        return [Family(records, ()) for records in discrete_records(study, study.table)]
    first = {name: values[0] for name, values in listed.items()}
    classes = [_classes(study, first, names, listed) for names in _groups(study, first, listed)]
    families = []
    for chosen in itertools.product(*classes):
        fixed: Records = {}
        for mixture in chosen:
            fixed |= mixture.records[0]
        families.append(Family(fixed, tuple(mixture for mixture in chosen if len(mixture.records) > 1)))
    return families


def _refuse_unpriced(study: Study, listed: Mapping[str, Sequence[str]]) -> None:
    """Raise InputError where a study asks for a cost and lists records with and without a price: none is no bargain."""
    if not asks_cost(study):
        return
    first = {name: values[0] for name, values in listed.items()}
    prices = {row.name: row.record[0] for row in study.table.inputs if row.group == COST_GROUP and row.record}
    options = {row.name: row.options for row in study.table.choices}
    for name, values in listed.items():
        facts = {value: _facts(study, {**first, name: value}) for value in values}
        for price, choice in prices.items():
            known = {value: fact[price] for value, fact in facts.items() if fact[choice] not in options[choice]}
            missing = [value for value, paid in known.items() if not paid]
            if missing and len(missing) < len(known):
                raise InputError(
                    f"vary.{name}: cost cannot compare records without a price: {', '.join(missing)}. Give `price` in "
                    f"records of your own, or leave them out"
                )


def _groups(study: Study, first: Records, listed: Mapping[str, Sequence[str]]) -> list[tuple[str, ...]]:
    """Return groups of listed choices that change the same quantity or are read by the same output."""
    groups: list[tuple[set[str], set[str]]] = []
    for name, values in listed.items():
        seen = [_facts(study, {**first, name: value}) for value in values]
        changed = {name for name in seen[0] if any(other[name] != seen[0][name] for other in seen)}
        changed |= {row.name for row in _readers(study.table, changed)}
        names = {name}
        for group in [candidate for candidate in groups if candidate[1] & changed]:
            groups.remove(group)
            names, changed = names | group[0], changed | group[1]
        groups.append((names, changed))
    return [tuple(name for name in listed if name in names) for names, _ in groups]


def _classes(study: Study, first: Records, names: Sequence[str], listed: Mapping[str, Sequence[str]]) -> list[Mixture]:
    """Return mixtures of the combinations of some choices, grouped by words that make the same structure."""
    combinations = [
        dict(zip(names, chosen, strict=True)) for chosen in itertools.product(*(listed[name] for name in names))
    ]
    facts = [_facts(study, {**first, **combination}) for combination in combinations]
    mixed = {name for name in facts[0] if isinstance(facts[0][name], float) and name not in study.vary}
    words = [name for name in facts[0] if name not in mixed and any(fact[name] != facts[0][name] for fact in facts)]
    read = [name for name in words if any(_readers(study.table, [name]))]
    structure = [name for name in read if not _blends(study.table, name)]
    alike: dict[tuple[Any, ...], list[int]] = {}
    for place, fact in enumerate(facts):
        endless = tuple(name for name in mixed if not math.isfinite(float(fact[name])))
        alike.setdefault((*(fact[name] for name in structure), endless), []).append(place)
    return [
        _mixture(study, [combinations[i] for i in places], [facts[i] for i in places], first)
        for places in alike.values()
    ]


def _mixture(study: Study, records: Sequence[Records], facts: Sequence[Mapping[str, Any]], first: Records) -> Mixture:
    numbers = {
        name: tuple(fact[name] for fact in facts)
        for name, value in facts[0].items()
        if isinstance(value, float) and name not in study.vary and any(fact[name] != value for fact in facts)
    }
    changed = [name for name, value in facts[0].items() if not isinstance(value, float)
               and any(fact[name] != value for fact in facts)]  # fmt: skip
    chosen = [given(with_records(study, {**first, **record})) for record in records]
    words = tuple({name: resolved[name] for name in changed} for resolved in chosen)
    readers = tuple(row.name for row in _readers(study.table, changed))
    return Mixture(tuple(records), numbers, words, readers)


def _facts(study: Study, records: Records) -> dict[str, float | str]:
    """Return every number and word of a module with some records chosen; a record by its name."""
    module = given(with_records(study, records))
    return {
        name: float(value) if isinstance(value, int | float) else str(getattr(value, "name", value))
        for name, value in module.items()
    }


def _readers(table: Table, names: Iterable[str]) -> list[Output]:
    words = {row.name for row in table.choices} & set(names)
    return [row for row in table.outputs if words & set(row.needs)]


def _blends(table: Table, word: str) -> bool:
    """Return whether all that reads a word comes to numbers, so that shares can be taken of them."""
    rows: list[Output | Input | Choice] = [*table.outputs, *table.inputs, *table.choices]
    decides = {feature.choice for row in rows for feature in row.requires}
    decides |= {row.parts_differ_with.choice for row in table.outputs if row.parts_differ_with}
    plain = not any(
        row.hidden or row.instant or row.per_point or isinstance(row, (*Supplied, Simulated))
        for row in _readers(table, [word])
    )
    return word not in decides and plain


def possible(study: Study, family: Family) -> Family:
    """Return the family without the records that violate a limit which nothing else can change.

    Raises InfeasibleError, with what such a limit wants, where a mixture has no record left.
    """
    if not family.mixtures:
        return family
    chosen = with_records(study, family.records)
    known = (study.table, given(chosen), tuple(study.operating_points), study.solver.cells)
    model = MixedDevice(*known, family.mixtures)
    limits = constraints_of(chosen, study.table, model.words)
    records, mixtures = dict(family.records), []
    for mixture in family.mixtures:
        left = _left(chosen, model, mixture, _of_it_alone(study, model, limits, mixture))
        records |= left.records[0]
        mixtures += [left] if len(left.records) > 1 else []
    return Family(records, tuple(mixtures))


def _of_it_alone(study: Study, model: MixedDevice, limits: Sequence[Constraint], mixture: Mixture) -> list[Constraint]:
    """Return the limits that depend on a mixture's records and on nothing else that is free."""
    without_cycle = [limit for limit in limits if not on_cycle(study.table, limit.output)]
    outputs = list(dict.fromkeys(limit.output for limit in without_cycle))
    free = {name for name in study.vary if isinstance(study.table.quantity(name), Input)}
    free |= {name for other in model.mixtures if other is not mixture for name in other.shares}
    pairs = model.dependence(outputs)
    moved, own = ({output for output, name in pairs if name in those} for those in (free, mixture.shares))
    return [limit for limit in without_cycle if limit.output in own - moved]


def _left(study: Study, model: MixedDevice, mixture: Mixture, limits: Sequence[Constraint]) -> Mixture:
    """Return the records that satisfy the limits."""
    outputs = list(dict.fromkeys(limit.output for limit in limits))
    cycle = dict.fromkeys(model.switch_names, np.inf)
    places, messages = [], []
    for place in range(len(mixture.records)):
        inputs = model.inputs({name: float(other == place) for other, name in enumerate(mixture.shares)})
        values = model.some_values(outputs, inputs, cycle)
        broken = [limit for limit in limits if not limit.residual(values[limit.output]) <= ALGEBRAIC_TOLERANCE]
        messages += [unchangeable(limit, model.table, values[limit.output], study) for limit in broken]
        places += [] if broken else [place]
    if not places:
        raise InfeasibleError("\n  ".join(dict.fromkeys(messages)))
    return mixture.in_order(places)
