"""Reads a catalogue choice such as `{catalog: music_wire_gauge, from: 1.5 mm, to: 3.2 mm}`: the sizes one can buy."""

from __future__ import annotations

from tvimdesign.device import Input
from tvimdesign.errors import CatalogError
from tvimdesign.study.model import Options
from tvimdesign.study.problems import quoted
from tvimdesign.study.values import Reading, below, quantity, record, text
from tvimdesign.study.yaml_text import Node, Text
from tvimdesign.units import format_quantity

SIZES_SHELF = "wires"
SIZES_TABLE = "sizes"


def read_sizes(reading: Reading, parts: dict[str, Node], path: str, row: Input) -> Options | None:
    """Return the sizes a catalogue record lists for an input, within `from` and `to` where they are given."""
    ends = {key: quantity(reading.problems, parts[key], f"{path}.{key}", row) for key in ("from", "to") if key in parts}
    sizes = _sizes(reading, parts["catalog"], f"{path}.catalog", row)
    if sizes is None or None in ends.values():
        return None
    lower, upper = ends.get("from"), ends.get("to")
    low = row.lower if lower is None else lower
    high = row.upper if upper is None else upper
    if below(high, low):
        reading.problems.add(parts["from"], path, "the range is upside down", "from < to", "swap the two")
        return None
    within = tuple(size for size in sizes if not below(size, low) and not below(high, size))
    if within:
        return Options(
            values=within, source=parts["catalog"].value.strip() if isinstance(parts["catalog"], Text) else None
        )
    first, last = format_quantity(sizes[0], row.unit), format_quantity(sizes[-1], row.unit)
    message = f"no size between {format_quantity(low, row.unit)} and {format_quantity(high, row.unit)}"
    reading.problems.add(parts["catalog"], path, message, f"part of {first} to {last}")
    return None


def _sizes(reading: Reading, node: Node, path: str, row: Input) -> list[float] | None:
    """Return every size the named record lists, smallest first."""
    name = text(reading.problems, node, path, f"the name of a record on the shelf {SIZES_SHELF}")
    found = None if name is None else record(reading, node, path, SIZES_SHELF, name)
    if found is None:
        return None
    try:
        table = found.table(SIZES_TABLE)
    except CatalogError as error:
        reading.problems.add(node, path, str(error))
        return None
    sizes = sorted({float(line[row.name]) for line in table if row.name in line})
    if not sizes:
        columns = ", ".join(sorted({column for line in table for column in line}))
        message = f"{quoted(name or '')} lists no {row.name}, only {columns or 'nothing'}"
        reading.problems.add(node, path, message, "a record that lists it")
        return None
    return sizes
