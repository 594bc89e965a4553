"""The section `accept`: the ratings of materials and bought parts beyond which the design may be."""

from __future__ import annotations

from tvimdesign.device import Table
from tvimdesign.study.sections.section import Schema, Section
from tvimdesign.study.text.mistakes import one_of, quoted
from tvimdesign.study.text.values import Reading, misfit, text
from tvimdesign.study.text.yaml_text import Node, Sequence, Text


def rating_names(table: Table) -> list[str]:
    """Return the quantities that a study may accept to be beyond their rating."""
    return [row.name for row in table.outputs if row.ratings]


def _read(reading: Reading, node: Node | None) -> tuple[str, ...]:
    """Return the accepted ratings by the quantity's name, one name or a list of them; every problem is noted."""
    known = rating_names(reading.table)
    if node is None or (isinstance(node, Text) and node.empty):
        return ()
    if not isinstance(node, Text | Sequence):
        misfit(reading.problems, node, "accept", f"a list of ratings: {', '.join(known)}")
        return ()
    items: list[tuple[str, Node]] = [("accept", node)] if isinstance(node, Text) else []
    items += [(f"accept[{i}]", item) for i, item in enumerate(node.items)] if isinstance(node, Sequence) else []
    found: list[str] = []
    for path, item in items:
        name = text(reading.problems, item, path, one_of(known))
        if name is None:
            continue
        if name in found:
            reading.problems.add(item, path, f"names {quoted(name)} twice", "each rating once")
        elif name in known:
            found.append(name)
        elif name in reading.table.by_name:
            reading.problems.add(item, path, f"{name} is no rating of a material or a bought part", one_of(known))
        else:
            reading.unknown_quantity(item, path, "rating", name, known)
    return tuple(found)


def _schema(table: Table) -> Schema:
    name = {"enum": rating_names(table)}
    return {"anyOf": [{"type": "array", "uniqueItems": True, "items": name}, name, {"type": "null"}]}


ACCEPT = Section(
    "accept", "ratings of materials and bought parts that the design may exceed",
    _read, _schema, lambda study: list(study.accept),
)  # fmt: skip
