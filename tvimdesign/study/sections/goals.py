"""The sections `require`, `accept`, `minimize` and `front`: limits, objective, and outputs that are traded."""

import math
import re
from collections.abc import Collection
from contextlib import suppress

from tvimdesign.base.errors import UnitError
from tvimdesign.base.units import format_quantity, parse_quantity
from tvimdesign.device import Output, Simulated, Table
from tvimdesign.device.core.softening import CONTROL, DUTY
from tvimdesign.study.sections import section
from tvimdesign.study.study import CONTROLLED, FEWEST_POINTS, MOST_POINTS, FrontOptions, Requirement, Study
from tvimdesign.study.text import values
from tvimdesign.study.text.mistakes import At, RefusedError, one_of, quoted, step
from tvimdesign.study.text.yaml_text import Node, Sequence, Text

MOST_LIMITS = 10
_INSTEAD = "limit `backlash` or `relaxation_loss`"
_BETWEEN = re.compile(r"(?P<low>[0-9][^\s]*)(?: (?P<unit>\S+))? (?:to|-) (?P<high>[0-9].*)")
_LIMIT = re.compile(r"(?P<sense><=|>=)\s*(?P<quantity>[^\s<>=].*)")


def _read_require(reading: values.Reading, node: Node | None) -> tuple[Requirement, ...]:
    requirements: list[Requirement] = []
    for name, (key, value) in values.entries(
        reading.problems, node, "require", "outputs, each with its limits"
    ).items():
        path = step("require", name)
        with suppress(RefusedError):
            row = (_simulated if is_simulated(name, reading.points) else named_output)(reading, key, path, name)
            read = _limits(reading, value, path, name, row)
            floors = [limit.limit for limit in read if limit.sense == ">="]
            ceilings = [limit.limit for limit in read if limit.sense == "<="]
            if floors and ceilings and values.below(min(ceilings), max(floors)):
                floor, ceiling = format_quantity(max(floors), row.unit), format_quantity(min(ceilings), row.unit)
                message = f"cannot be both at least {floor} and at most {ceiling}"
                reading.problems.add(value, path, message, "limits that leave room between them")
            requirements += read
    return (*requirements, *reading.section("task")["require"])


def _read_minimize(reading: values.Reading, node: Node | None) -> dict[str, float]:
    weights: dict[str, float] = {}
    if isinstance(node, Text) and not node.empty:
        with suppress(RefusedError):
            named_output(reading, node, "minimize", node.value)
            weights = {node.value: 1.0}
    else:
        expected = "the name of an output, or outputs with their weights"
        named = values.entries(reading.problems, node, "minimize", expected)
        weights = values.readable(lambda name, entry: _weight(reading, name, *entry), named)
    if node is not None and reading.has("minimize") and not reading.has("vary"):
        reading.problems.add(node, "minimize", "nothing may change: `vary` is missing", "both or neither")
    return weights


def _weight(reading: values.Reading, name: str, key: Text, node: Node) -> float:
    path = step("minimize", name)
    named_output(reading, key, path, name)
    weight = values.number(reading.problems, node, path, "a weight, a number above 0")
    if weight <= 0:
        reading.problems.refuse(node, path, f"the weight {weight:g} is not above 0", "a number above 0")
    return weight


def _read_front(reading: values.Reading, node: Node | None) -> FrontOptions | None:
    front = None
    with suppress(RefusedError):
        front = _traded_outputs(reading, node)
    if node is not None and reading.has("front") and not reading.has("vary"):
        expected = "`vary` and `minimize` with it"
        reading.problems.add(node, "front", "nothing may change: `vary` is missing", expected)
    return front


def _traded_outputs(reading: values.Reading, node: Node | None) -> FrontOptions | None:
    expected, refuse = "'{of: [response_time, module_mass], points: 12}'", reading.problems.refuse
    known = list(FrontOptions.model_fields)
    parts = values.unknown_keys(
        reading.problems, values.entries(reading.problems, node, "front", expected), "front", "key", known
    )
    if node is None or not parts:
        return None
    outputs = parts.get("of")
    if not isinstance(outputs, Sequence) or len(outputs.items) not in (2, 3):
        refuse(outputs or node, "front.of", "are not two or three outputs", "[response_time, module_mass]")
    listed = dict(enumerate(outputs.items))
    names = values.readable(lambda i, item: read_output(reading, item, f"front.of[{i}]"), listed)
    points = {"points": values.whole(reading.problems, parts["points"], "front.points")} if "points" in parts else {}
    if len(names) < len(listed):
        raise RefusedError
    if len(set(names.values())) < len(names):
        refuse(outputs, "front.of", "names an output twice", "two or three different ones")
    least, most = FEWEST_POINTS, MOST_POINTS
    for count in points.values():
        if not least <= count <= most:
            refuse(parts["points"], "front.points", f"{count} points", f"{least} to {most}")
    return FrontOptions(of=tuple(names.values()), **points)


def read_output(reading: values.Reading, node: Node, path: str) -> str:
    """Return the full name of an output. Raises RefusedError where it is none."""
    word = values.text(reading.problems, node, path, "the name of an output")
    named_output(reading, node, path, word)
    return word


def named_output(reading: values.Reading, key: At, path: str, name: str) -> Output:
    """Return the output a full name means. Raises RefusedError (a problem is noted) where it means none."""
    base, at, point = name.partition("@")
    points = reading.points
    row = reading.table.by_name.get(base)
    refuse = reading.problems.refuse
    if row is None or (isinstance(row, Output) and row.hidden):
        names = [name.partition("@")[0] for name in reading.table.names(list(points)[:1])]
        reading.unknown_quantity(key, path, "output", base, names, point if point in points else "")
        raise RefusedError
    if not isinstance(row, Output):
        refuse(
            key, path, "is something the study sets, no output", "the name of an output", f"limit {base} under `vary`"
        )
    if row.instant:
        refuse(key, path, "changes during the switch and has no single value", "an output with one value")
    if isinstance(row, Simulated):
        instead = f"limit `{base}@{row.state}`" if row.state else _INSTEAD
        refuse(key, path, "is simulated once a design is found", "an output that is computed", instead)
    if row.per_point and not at:
        refuse(key, path, "has a value at each operating point", one_of([f"{base}@{name}" for name in points]))
    if row.per_point and point not in points:
        reading.problems.unknown(key, path, f"operating point: {quoted(point)}", point, points)
        raise RefusedError
    if at and not row.per_point:
        refuse(key, path, "is the same at every operating point", repr(base), f"leave out {quoted('@' + point)}")
    return row


def is_simulated(name: str, points: Collection[str]) -> bool:
    """Return whether the full name of an output means its value in a duty or under the controller."""
    return name.partition("@")[2] in {DUTY, CONTROL} - set(points)


def _simulated(reading: values.Reading, key: Text, path: str, name: str) -> Output:
    """Return the output that is limited in a duty or under the controller. Raises RefusedError where there is none."""
    base, _, state = name.partition("@")
    given = reading.table.by_name.get(base)
    own = isinstance(given, Simulated) and given.state == state
    row = given if own and isinstance(given, Output) else named_output(reading, key, path, base)
    duty, control = reading.section("duty"), reading.section("control")
    if not (duty.switches_per_hour if state == DUTY else control.draws):
        wanted = f"`{DUTY}: {{switches_per_hour: 6}}`" if state == DUTY else f"`{CONTROL}: {{draws: 64}}`"
        reading.problems.refuse(key, path, f"the study has no {state}", wanted)
    if not own and base not in (reading.table.behind_supplied if state == DUTY else CONTROLLED):
        expected = (
            "an output of the switch, such as peak_heater_temperature" if state == DUTY else one_of(list(CONTROLLED))
        )
        reading.problems.refuse(key, path, f"is not simulated in a {state}", expected)
    return row


def _limits(reading: values.Reading, node: Node, path: str, name: str, row: Output) -> list[Requirement]:
    if not isinstance(node, Sequence):
        return [read_limit(reading, node, path, name, row)]
    if not 1 <= len(node.items) <= MOST_LIMITS:
        reading.problems.refuse(node, path, f"a list of {len(node.items)} limits", f"1 to {MOST_LIMITS} limits")
    listed = dict(enumerate(node.items))
    return list(values.readable(lambda i, item: read_limit(reading, item, f"{path}[{i}]", name, row), listed).values())


def read_limit(reading: values.Reading, node: Node, path: str, name: str, row: Output) -> Requirement:
    """Return one limit on an output. Raises RefusedError (a problem is noted) where it is none."""
    unit = "" if row.unit == "1" else f" {row.unit}"
    expected = f"a limit such as '<= 5{unit}' or '>= 5{unit}'"
    word = values.text(reading.problems, node, path, expected)
    if several := _several(word):
        listed = ", ".join(f'"{limit}"' for limit in several)
        reading.problems.refuse(node, path, f"{len(several)} limits in one text", f"a list: [{listed}]")
    parts = _LIMIT.fullmatch(word)
    if parts is None:
        values.misfit(reading.problems, node, path, expected)
    limit = values.si_value(reading.problems, node, path, parts["quantity"], row.unit)
    return Requirement(output=name, sense="<=" if parts["sense"] == "<=" else ">=", limit=limit, text=word)


def _several(word: str) -> list[str]:
    """Return the limits of a text that holds several, `>= 1 mm, <= 2 mm` or `1 to 2 mm`; none if it does not."""
    if between := _BETWEEN.fullmatch(word):
        unit = between["unit"] or between["high"].partition(" ")[2]
        return [f">= {between['low']} {unit}".rstrip(), f"<= {between['high']}"]
    limits = [limit.strip(" ,;&") for limit in re.split(r"(?=[<>]=)|\band\b", word)]
    limits = [limit for limit in limits if limit]
    return limits if len(limits) > 1 and all(map(_LIMIT.fullmatch, limits)) else []


def _write_require(study: Study) -> dict[str, list[str]]:
    limits: dict[str, list[str]] = {}
    for limit in (*study.require, *study.simulated):
        unit = study.table.unit(limit.output)
        same = limit.text.startswith(limit.sense) and _reads_as(limit.text.removeprefix(limit.sense), unit, limit.limit)
        text = limit.text if same else f"{limit.sense} {values.exactly(limit.limit, unit)}"
        limits.setdefault(limit.output, []).append(text)
    return limits


def _reads_as(text: str, unit: str, value: float) -> bool:
    try:
        return math.isclose(parse_quantity(text, unit), value, rel_tol=1e-15)
    except UnitError:
        return False


def _require_schema(table: Table) -> section.Schema:
    limits = [section.LIMIT, {"type": "array", "minItems": 1, "items": section.LIMIT}]
    either: section.Schema = {"anyOf": limits}
    of_state = {DUTY: sorted(table.behind_supplied), CONTROL: list(CONTROLLED)}
    for row in table.outputs:
        if isinstance(row, Simulated) and row.state:
            of_state[row.state].append(row.name)
    simulated = {f"^({'|'.join(names)})@{state}$": either for state, names in of_state.items()}
    return section.mapping({}, section.by_output(table, either) | simulated)


def _front_schema(table: Table) -> section.Schema:
    fields = section.field_schemas(FrontOptions)
    fields["of"] |= {"uniqueItems": True, "items": section.output_name(table)}
    return section.mapping(fields)


def rating_names(table: Table) -> list[str]:
    """Return the quantities that a study may accept to be beyond their rating."""
    return [row.name for row in table.outputs if row.ratings]


def _read_accept(reading: values.Reading, node: Node | None) -> tuple[str, ...]:
    known = rating_names(reading.table)
    accepted: list[str] = []

    def read(path: str, item: Node) -> None:
        name = values.text(reading.problems, item, path, one_of(known))
        if name in accepted:
            reading.problems.add(item, path, f"names {quoted(name)} twice", "each rating once")
        elif name in known:
            accepted.append(name)
        elif name in reading.table.by_name:
            reading.problems.add(item, path, f"{name} is no rating of a material or a bought part", one_of(known))
        else:
            reading.unknown_quantity(item, path, "rating", name, known)

    if isinstance(node, Sequence):
        values.readable(read, {f"accept[{i}]": item for i, item in enumerate(node.items)})
    elif isinstance(node, Text) and not node.empty:
        values.readable(read, {"accept": node})
    elif node is not None and not isinstance(node, Text):
        with suppress(RefusedError):
            values.misfit(reading.problems, node, "accept", f"a list of ratings: {', '.join(known)}")
    return tuple(accepted)


def _accept_schema(table: Table) -> section.Schema:
    name = {"enum": rating_names(table)}
    return {"anyOf": [{"type": "array", "uniqueItems": True, "items": name}, name, {"type": "null"}]}


REQUIRE = section.Section("require", "limits on outputs", _read_require, _require_schema, _write_require)
MINIMIZE = section.Section(
    "minimize",
    "objective: outputs to minimise, with weights",
    _read_minimize,
    lambda table: {
        "anyOf": [section.mapping({}, section.by_output(table, section.NUMBER_VALUE)), section.output_name(table)]
    },
    lambda study: study.minimize,
)
FRONT = section.Section(
    "front", "two or three outputs to trade against one another, and the number of designs",
    _read_front, _front_schema,
    lambda study: study.front and {"of": list(study.front.of), "points": study.front.points},
)  # fmt: skip
ACCEPT = section.Section(
    "accept", "ratings of materials and bought parts that the design may exceed",
    _read_accept, _accept_schema, lambda study: list(study.accept),
)  # fmt: skip
