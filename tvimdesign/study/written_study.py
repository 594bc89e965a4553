"""A study that was read, as the values it would be written with: what the reader makes the same study of."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

from pydantic import BaseModel

from tvimdesign.base.errors import UnitError
from tvimdesign.base.units import from_si, parse_quantity, si_unit
from tvimdesign.device import Input, Table
from tvimdesign.study.sections.tolerances import STANDARD, difference_unit, standard_tolerances
from tvimdesign.study.study import GivenCurrent, Options, Robust, Study, Tolerance, Vary, unit_of


def written(study: Study) -> dict[str, Any]:
    """A study's sections as Python values; every quantity with as many digits as it takes to read the same number."""
    table = study.table
    sections: dict[str, Any] = {
        "name": study.name,
        "description": study.description,
        "mode": study.mode,
        "catalog": study.catalog_folder,
        "module": {name: _value(table, name, value) for name, value in study.module.items()},
        "vary": {name: _vary(table, name, allowed) for name, allowed in study.vary.items()},
        "require": _require(study),
        "accept": list(study.accept),
        "minimize": study.minimize,
        "front": study.front and {"of": list(study.front.of), "points": study.front.points},
        "operating_points": {
            point: {name: _value(table, name, value) for name, value in values.items()}
            for point, values in study.operating_points.items()
        },
        "profile": _changed(study.profile),
        "currents": {phase: _current(given) for phase, given in study.currents.items()},
        "tolerances": _tolerances(table, study.tolerances),
        "robust": study.robust and _robust(study.robust),
        "solver": _changed(study.solver),
        "write": _changed(study.write),
    }
    return {name: section for name, section in sections.items() if section not in (None, "", {}, [])}


def exactly(value: float, unit: str) -> str:
    """A quantity in a unit, or else in the SI one, with the fewest digits that read as the same number."""
    for digits in range(1, 18):
        number = float(f"{from_si(value, unit):.{digits}g}")
        text = f"{number:.{max(digits, 6)}g} {unit}".removesuffix(" 1")
        with suppress(UnitError):  # rounded, a temperature may lie below absolute zero
            if parse_quantity(text, unit) == value:
                return text
    return f"{value!r} {si_unit(unit)}".removesuffix(" 1")


def _value(table: Table, name: str, value: float | str) -> str:
    return value if isinstance(value, str) else exactly(value, table.unit(name))


def _current(given: GivenCurrent) -> dict[str, list[str]]:
    return {
        "moments": [exactly(moment, "s") for moment in given.moments],
        "currents": [exactly(current, "A") for current in given.currents],
    }


def _vary(table: Table, name: str, allowed: Vary) -> Any:
    if isinstance(allowed, Options):
        values = [_value(table, name, value) for value in allowed.values]
        if allowed.source is None:
            return {"choose": values}
        return {"catalog": allowed.source, "from": values[0], "to": values[-1]}
    ends = {"from": allowed.lower, "to": allowed.upper, "start": allowed.start}
    return {key: _value(table, name, end) for key, end in ends.items() if end is not None}


def _require(study: Study) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for limit in study.require:
        unit = study.table.unit(limit.output)
        same = limit.text.startswith(limit.sense) and _reads_as(limit.text.removeprefix(limit.sense), unit, limit.limit)
        text = limit.text if same else f"{limit.sense} {exactly(limit.limit, unit)}"
        found.setdefault(limit.output, []).append(text)
    return found


def _reads_as(text: str, unit: str, value: float) -> bool:
    try:
        return math.isclose(parse_quantity(text, unit), value, rel_tol=1e-15)
    except UnitError:
        return False


def _tolerances(table: Table, tolerances: Mapping[str, Tolerance]) -> dict[str, Any]:
    """Each tolerance; where all the usual ones are there, only that they are and what differs from them."""
    usual = standard_tolerances(table)
    usual = usual if usual.keys() <= tolerances.keys() else {}
    found: dict[str, Any] = {STANDARD: "true"} if usual else {}
    for name, one in tolerances.items():
        if one != usual.get(name):
            found[name] = _tolerance(table, name, one, usual.get(name))
    return found


def _tolerance(table: Table, name: str, one: Tolerance, usual: Tolerance | None) -> dict[str, Any]:
    row = table.by_name[name.partition("@")[0]]
    unit = difference_unit(row.unit if isinstance(row, Input) else "1")
    size: dict[str, Any] = {"row": one.row} if one.row else {"plus_minus": _size(one, unit)}
    size = {} if usual and one.source == usual.source else size
    left = {} if one.adjusted_to is None else {"adjusted_to": exactly(one.adjusted_to, unit)}
    return {**size, "distribution": one.distribution, "sigma": one.sigma, "adjustable": one.adjustable, **left}


def _size(one: Tolerance, unit: str) -> str | None:
    if one.share is not None:
        return exactly(one.share, "percent").replace(" percent", " %")
    return None if one.plus_minus is None else exactly(one.plus_minus, unit)


def _robust(asked: Robust) -> dict[str, float | None]:
    return {"sigma": asked.sigma} if asked.share is None else {"yield": asked.share}


def _changed(options: BaseModel) -> dict[str, Any]:
    """The settings that are not as they are unless said."""
    fields = type(options).model_fields
    changed = options.model_dump(exclude_defaults=True)
    return {name: exactly(value, unit) if (unit := unit_of(fields[name])) else value for name, value in changed.items()}
