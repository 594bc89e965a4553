"""From a study to what a table is evaluated with: the study's own value, else the record's, else the default.

Warnings about the chosen records: contradictions, missing limits, and tasks they cannot do.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from tvimdesign.base.errors import CatalogError, InputError
from tvimdesign.base.record import Record
from tvimdesign.base.units import format_quantity
from tvimdesign.catalog import Catalog
from tvimdesign.catalog.category import inherited_law_warnings
from tvimdesign.device import Choice, Input, Output, Table
from tvimdesign.device.components.cost import COSTS
from tvimdesign.device.components.cost import GROUP as COST_GROUP
from tvimdesign.device.core.heater_form import CUT, contradiction
from tvimdesign.device.core.task import ARM, Trajectory
from tvimdesign.device.table.table import AS_DRAWN
from tvimdesign.study.study import Options, ProfileOptions, Range, Study, Vary

_NONE = 1e-12  # Length [m] that is rounding


def given(study: Study) -> dict[str, Any]:
    """Return what `Table.evaluate` wants: every input in SI by full name, every choice as its record or its word.

    What the study varies gets its start: the range's, else the module's or the default value, moved into the range or
    to the nearest of the listed values, so that the result is a member of the search. Raises InputError naming what has
    no value, and what cannot stand together.
    """
    known: dict[str, Any] = {}
    for choice in study.table.choices:
        known[choice.name] = _chosen(choice, study, known)
    if study.trajectory and known.get("task", ARM) == ARM:
        known["trajectory"] = Trajectory(*study.trajectory.model_dump().values())
    if study.as_drawn:
        known[AS_DRAWN] = study.as_drawn
    for row in study.table.inputs:
        if row.per_point:
            for point, values in study.operating_points.items():
                name = f"{row.name}@{point}"
                known[name] = _or_default(row, name, values.get(row.name), known)
        else:
            known[row.name] = _started(row, study, known)
    _refuse_incompatible(study, known)
    return known


def missing_geometry(values: Mapping[str, Any], table: Table) -> list[Output]:
    """Return the outputs that say that no module has these inputs: a gap or a width below the least there can be."""
    rows = _geometry_rows(table)
    least = [(row, rule.exists_above) for row in rows for rule in row.rules if rule.exists_above is not None]
    with np.errstate(invalid="ignore", divide="ignore"):
        outputs = table.evaluate(values, [row.name for row in rows])
    return [row for row, value in least if not outputs[row.name] > value + _NONE]


def _geometry_rows(table: Table) -> list[Output]:
    return [row for row in table.outputs if any(rule.exists_above is not None for rule in row.rules)]


def with_fitting_defaults(study: Study) -> Study:
    """Return the study with lengths that it leaves open in proportion to those it gives, if no module has the defaults.

    Such lengths are starts of ranges, and defaults if moving the starts is not enough. The proportion nearest to one
    that gives a module is taken; if none does, the study stays as it is. So does one that varies nothing: it asks for
    the module with the defaults.
    """
    if not study.vary:
        return study
    try:
        start = given(study)
    except InputError:  # whoever needs the value says so
        return study
    if not missing_geometry(start, study.table):
        return study
    behind = set().union(*(study.table.ancestors(row.name) for row in _geometry_rows(study.table)))
    rows = {
        row.name: row for row in study.table.inputs
        if row.name in behind and row.unit == "mm" and row.default and row.record is None and not row.requires
    }  # fmt: skip
    ends = {name: _ends(row, study) for name, row in rows.items()}
    shares = {end / (rows[name].default or 1.0) for name, span in ends.items() if span for end in span}
    nearest = sorted(shares, key=lambda share: abs(math.log(share)))
    for share, with_defaults in [(share, both) for both in (False, True) for share in nearest]:
        module, vary = dict(study.module), dict(study.vary)
        for name, row in rows.items():
            allowed, length = study.vary.get(name), share * (row.default or 0.0)
            if isinstance(allowed, Range) and allowed.start is None:
                vary[name] = allowed.model_copy(update={"start": float(_nearest(allowed, length))})
            elif with_defaults and not ends[name] and name in start and start[name] == row.default:
                module[name] = min(max(length, row.lower), row.upper)
        fitting = study.model_copy(update={"module": module, "vary": vary})
        if not missing_geometry(given(fitting), study.table):
            return fitting
    return study


def _ends(row: Input, study: Study) -> tuple[float, ...]:
    """Return the values that a study gives a length: its own, or the ends and the middle of its range; none if open."""
    allowed = study.vary.get(row.name)
    if isinstance(allowed, Range) and allowed.start is None:
        return allowed.lower, math.sqrt(allowed.lower * allowed.upper), allowed.upper
    if allowed is not None:
        return (_started(row, study, {}),)
    value = study.module.get(row.name)
    return (float(value),) if isinstance(value, int | float) and value > 0.0 else ()


def drawn(study: Study) -> Study:
    """Return the study that evaluates the module from which a study starts."""
    starts = given(study)
    module = {name: getattr(starts[name], "name", starts[name]) for name in study.vary}
    update = {"module": {**study.module, **module}, "vary": {}, "minimize": {}, "profile": ProfileOptions()}
    return study.model_copy(update=update)


def words_of(choice: Choice) -> list[str]:
    """Return the words a study may write for a choice: its options, then the shipped records."""
    return [*choice.options, *(Catalog().names(choice.category) if choice.category else [])]


def _chosen(row: Choice, study: Study, chosen: dict[str, Any]) -> Any:
    word, allowed = study.module.get(row.name), study.vary.get(row.name)
    if stock := _stock(row, study, chosen):
        word = stock.word(row.stock_record[1] if row.stock_record else "")
    if word is None:
        word = chosen[row.record[0]].word(row.record[1]) if row.record else row.default
    if isinstance(allowed, Options) and word not in allowed.values:
        word = allowed.values[0]
    return study.catalog.record(row.category, str(word)) if row.category and word not in row.options else word


def _started(row: Input, study: Study, chosen: dict[str, Any]) -> float:
    own, allowed = study.module.get(row.name), study.vary.get(row.name)
    if stock := _stock(row, study, chosen):
        return stock.value(row.stock_record[1] if row.stock_record else "")
    if allowed is None:
        return _or_default(row, row.name, own, chosen)
    if isinstance(allowed, Range) and allowed.start is not None:
        return allowed.start
    try:
        value = _or_default(row, row.name, own, chosen)
    except InputError:
        if isinstance(allowed, Range):
            return 0.5 * (allowed.lower + allowed.upper)
        return float(allowed.values[len(allowed.values) // 2])
    return _nearest(allowed, value)


def _stock(row: Choice | Input, study: Study, chosen: dict[str, Any]) -> Record | None:
    """Return the record bought whole that brings a quantity along, if the study chooses one.

    Raises InputError where the study sets or varies the quantity beside it.
    """
    record = chosen.get(row.stock_record[0]) if row.stock_record else None
    if not isinstance(record, Record):
        return None
    if row.name in study.module or row.name in study.vary:
        raise InputError(
            f"{row.name} is that of {record.category}/{record.name}, which {record.title} brings along; "
            f"leave {row.name} out, or set {row.stock_record[0] if row.stock_record else ''}: none"
        )
    return record


def brought_along(choices: Mapping[str, str], table: Table) -> set[str]:
    """Return the quantities that a design's records bought whole bring along."""
    bought = {row.name for row in table.choices if choices[row.name] not in row.options}
    rows: list[Choice | Input] = [*table.choices, *table.inputs]
    return {row.name for row in rows if row.stock_record and row.stock_record[0] in bought}


def brought_along_by(study: Study) -> dict[str, str]:
    """Inputs that a record bought whole brings along in a study, and the choice of that record."""
    values = given(study)
    return {
        row.name: row.stock_record[0]
        for row in study.table.inputs
        if row.stock_record and isinstance(values[row.stock_record[0]], Record)
    }


def _or_default(row: Input, name: str, own: float | str | None, chosen: dict[str, Any]) -> float:
    """Return the study's value of an input, else its record's, else its default; zero for what the module lacks."""
    if own is not None:
        return float(own)
    if row.record is not None:
        choice, field = row.record
        if not isinstance(chosen[choice], str) and chosen[choice].has(field):
            return float(chosen[choice].value(field))
    if row.default is not None:
        return row.default
    if not row.exists(chosen):
        return 0.0
    section = "operating_points" if row.per_point else "module"
    raise InputError(f"{name} has no value{_reason(row, chosen)}; give it under `{section}`, in {row.unit}")


def _reason(row: Input, chosen: dict[str, Any]) -> str:
    """Explain why an input needs a value, and what its record has instead."""
    reason = "".join(f", needed as {feature.choice} is {chosen[feature.choice]}" for feature in row.requires)
    if row.record is not None and not isinstance(chosen[row.record[0]], str):
        choice, field = row.record
        try:
            chosen[choice].value(field)
        except CatalogError as error:
            reason += f" ({error})"
    return reason


def _nearest(allowed: Vary, value: float) -> float:
    if isinstance(allowed, Range):
        return min(max(value, allowed.lower), allowed.upper)
    return min((float(option) for option in allowed.values), key=lambda option: abs(option - value))


def _refuse_incompatible(study: Study, values: Mapping[str, Any]) -> None:
    """Raise InputError where a study asks for a current that cools of a heater that only heats.

    `values` are those of the study's start. A heater that the study chooses from several may be another one, and a
    current that may be zero will be.
    """
    if values.get("heater_seebeck") != 0.0 or {"heater_module", "heater_seebeck"} & study.vary.keys():
        return
    least = _least(study, "cooling_current")
    if least > 0.0:
        heater = values["heater_module"]
        current = format_quantity(least, study.table.unit("cooling_current"))
        raise InputError(
            f"cooling_current of {current} and heater_module {heater.name} cannot stand together: {heater.title} "
            "has no Peltier effect, so any current heats; leave cooling_current out, and the air cools, or choose a "
            "Peltier module"
        )


def _least(study: Study, name: str) -> float:
    """Return the least value that a study sets or allows for a number; zero if the default applies."""
    allowed = study.vary.get(name)
    if isinstance(allowed, Range):
        return allowed.lower
    if allowed is not None:
        return min(float(value) for value in allowed.values)
    return float(study.module.get(name, 0.0))


def record_checks(study: Study) -> list[str]:
    """Return a warning for each chosen record that contradicts itself, has another material's law, cannot do its task,
    or names no limit."""
    values = given(study)
    records = [record for record in values.values() if isinstance(record, Record)]
    messages = [contradiction(record) for record in records if record.category == "heaters"]
    if values["heater_seebeck"] == 0.0 and values["cooling_current"] > 0.0:
        heats = format_quantity(values["cooling_current"], study.table.unit("cooling_current"))
        title = values["heater_module"].title
        messages.append(f"cooling_current of {heats} heats: {title} cannot cool; leave it out, and the air cools")
    messages += [warning for record in records for warning in inherited_law_warnings(record)]
    return [message for message in messages if message] + _pressed(study, values) + _unpriced(study, values)


def asks_cost(study: Study) -> bool:
    """Return whether a study limits, minimises or trades what the module costs."""
    traded = study.front.of if study.front else ()
    return any(name in COSTS for name in (*study.minimize, *traded, *(limit.output for limit in study.require)))


def _unpriced(study: Study, values: Mapping[str, Any]) -> list[str]:
    """Return a warning that names what a cost leaves out where a study asks for one."""
    kinds = unpriced_kinds(study.table, values, values)
    if not (asks_cost(study) and kinds):
        return []
    return [
        f"cost leaves out what has no price: {', '.join(kinds)}; ask for a quote and set "
        f"{kinds[0].replace(' ', '_')}_price and the like under `module`, or `price` in a record"
    ]


def unpriced_kinds(table: Table, values: Mapping[str, Any], chosen: Mapping[str, Any]) -> list[str]:
    """Return the kinds of a module that its cost leaves out, by `chosen` records or their names."""
    return [kind for kind, price in _prices(table, values, chosen).items() if not price]


def _prices(table: Table, values: Mapping[str, Any], chosen: Mapping[str, Any]) -> dict[str, float]:
    """Return the prices of the kinds of a module, zero where none is known; springs made to order have no record."""
    return {
        row.name.removesuffix("_price").replace("_", " "): values[row.name]
        for row in table.inputs
        if row.group == COST_GROUP and row.record and row.exists(chosen)
        and (row.name == "spring_price" or chosen[row.record[0]] != "none")
    }  # fmt: skip


def cost_in_words(table: Table, values: Mapping[str, Any], chosen: Mapping[str, Any]) -> list[str]:
    """Return what the cost of a module counts, and what it leaves out; summary and list of parts say the same."""
    prices = _prices(table, values, chosen)
    counted, missing = (", ".join(kind for kind, price in prices.items() if bool(price) == known) for known in (1, 0))
    words = [f"{format_quantity(values['cost'], 'USD', 3)} for what is fitted in one module, pieces by their share of "
             f"a pack, without work: {counted or 'nothing'}"]  # fmt: skip
    return [*words, f"without a price, so not in it: {missing}"] if missing else words


def _pressed(study: Study, values: Mapping[str, Any]) -> list[str]:
    """Return a warning if blocks press on rigid modules whose record has no pressure limit."""
    limit = "heater_pressure_limit"
    pressed = limit in values and values["heater_form"] != CUT
    module = values["heater_module"]
    if not pressed or limit in study.module or "max_pressure" in module.entries:
        return []
    bears = format_quantity(values[limit], study.table.unit(limit))
    return [
        f"{module.title}: its record does not say what pressure it bears; {bears} is assumed (makers mount modules "
        f"with 1 to 2.1 MPa). Ask the maker, and set {limit}."
    ]
