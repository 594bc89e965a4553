"""Reads a catalogue choice such as `{catalog: music_wire_gauge, from: 1.5 mm, to: 3.2 mm}`: the sizes one can buy."""

from __future__ import annotations

from tvimdesign.base.errors import CatalogError
from tvimdesign.base.units import format_quantity
from tvimdesign.device import Input
from tvimdesign.study.study import Options
from tvimdesign.study.text.values import Reading, below, quantity, record, text
from tvimdesign.study.text.yaml_text import Node


def read_sizes(reading: Reading, parts: dict[str, Node], path: str, row: Input) -> Options | None:
    """Return the sizes a catalogue record lists for an input, within `from` and `to` where they are given."""
    node = parts["catalog"]
    ends = {key: quantity(reading.problems, parts[key], f"{path}.{key}", row) for key in ("from", "to") if key in parts}
    name = text(reading.problems, node, f"{path}.catalog", f"the name of a record in the category {row.sizes_in[0]}")
    sizes = [] if name is None else _sizes(reading, node, f"{path}.catalog", name, row)
    if not sizes or None in ends.values():
        return None
    lower, upper = ends.get("from"), ends.get("to")
    low = row.lower if lower is None else lower
    high = row.upper if upper is None else upper
    if below(high, low):
        reading.problems.add(parts.get("from", node), path, "the range is upside down", "from < to", "swap the two")
        return None
    within = tuple(size for size in sizes if not below(size, low) and not below(high, size))
    if within:
        return Options(values=within, source=name)
    first, last = format_quantity(sizes[0], row.unit), format_quantity(sizes[-1], row.unit)
    message = f"{name} has no size from {format_quantity(low, row.unit)} to {format_quantity(high, row.unit)}"
    reading.problems.add(node, path, message, f"part of {first} to {last}")
    return None


def _sizes(reading: Reading, node: Node, path: str, name: str, row: Input) -> list[float]:
    """Return every size the record lists, smallest first; none (and a problem) where it lists none."""
    category, of, column = row.sizes_in
    found = record(reading, node, path, category, name)
    if found is None:
        return []
    try:
        table = found.table(of)
    except CatalogError as error:
        reading.problems.add(node, path, str(error))
        return []
    sizes = sorted({float(line[column]) for line in table if column in line})
    if not sizes:
        columns = ", ".join(sorted({listed for line in table for listed in line}))
        message = f"{name} lists no {column}, only {columns or 'nothing'}"
        reading.problems.add(node, path, message, "a record that lists it")
    return sizes
