"""Reference pages: the sections of a study, and every quantity of both modes by group, with unit and source."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from tvimdesign.base.units import from_si, pretty
from tvimdesign.catalog import Catalog
from tvimdesign.device import MODES, Choice, Input, Output, table_for
from tvimdesign.study.sections import SECTIONS

Quantity = Input | Choice | Output

ABOUT = {
    "Materials": "Properties of PCL, springs, structure and Peltier module. They come from the chosen records.",
    "Process": "What the printer or the mill can make.",
    "Layout": "Radii, levels, thicknesses, screws and the fixtures a study may add.",
    "Springs": "Rate, stress, safety and size of the torsion springs.",
    "Impedance": "Stiffness and damping at the operating points, and the torque that is held.",
    "Lost motion": "How far the link moves before the joint takes notice, by source.",
    "Hold": "Creep under a load, the backlash it leaves, and what a quick turn loses.",
    "Axial play": "What the PCL loses in volume, how the rotor follows, and what creeps out of the melt.",
    "Switch": "The thermal stack and its surroundings.",
    "Task": "Arm, payload and motion of a study's task, and what they ask of the joint.",
    "Softening": "Heating until the joint is soft.",
    "Stiffening": "Cooling until the joint is stiff again.",
    "Size and weight": "Volumes, masses and inertias of the parts.",
    "Cost": "Prices of what is bought and of material, and what the module costs.",
    "Gaps": "Distances that must not vanish, and the rules that hold them.",
}
"""Subject of each group of quantities, in the order of the pages."""
_WIDE = "---\nhide: [toc]\n---\n"
"""Front matter that hides the table of contents."""


def reference_pages() -> dict[str, str]:
    """Return the pages by path: one for each group, a list of the groups, and the sections of a study.

    Raises KeyError where a group of the table has no sentence in `ABOUT`.
    """
    groups: dict[str, dict[str, tuple[Quantity, list[str]]]] = {}
    for mode in MODES:
        for quantity in table_for(mode).quantities:
            if not _internal(quantity):
                known = groups.setdefault(quantity.group, {}).setdefault(quantity.name, (quantity, []))
                known[1].append(mode)
    order = sorted(groups, key=list(ABOUT).index)
    pages = {f"reference/{_file_name(group)}.md": _page(group, groups[group].values()) for group in order}
    pages["reference/study.md"] = _sections_page()
    pages["reference/index.md"] = _index({group: len(groups[group]) for group in order})
    return pages


def _index(counts: dict[str, int]) -> str:
    rows = [f"| [{group}]({_file_name(group)}.md) | {count} | {ABOUT[group]} |" for group, count in counts.items()]
    return "\n".join([
        "# Reference: all quantities",
        "",
        "These pages are made from the table of quantities, as studies, reports and parts are.",
        "`tvimdesign rows WORD` lists the same in the terminal.",
        "",
        "- An **input** is a number that a study may set under `module`. A **variable** may also stand under `vary`.",
        "- A **choice** is a word: a record of the catalogue, or one of a few options.",
        "- An **output** is a result. A study may `require` and `minimize` it; `name@point` is at an operating point.",
        "- The [sections of a study](study.md) are listed with their keys.",
        "- *Allowed* are the ends of an input, or the rules that every study keeps unless it sets its own limit.",
        "",
        "| group | quantities | about |",
        "|---|---|---|",
        *rows,
        "",
    ])  # fmt: skip


def _sections_page() -> str:
    """Return the page of a study's sections: the meaning of each, and of its keys if these are no quantities."""
    table = table_for(MODES[0])
    rows = []
    for section in SECTIONS:
        keys = section.describe(table).get("properties", {})
        rows.append(f"| **`{section.name}`** | | {_text(section.meaning)} |")
        for name, key in keys.items() if table.by_name.keys().isdisjoint(keys) else ():
            rows.append(f"| `{section.name}.{name}` | {_default(key)} | {_text(key.get('description', ''))} |")
    return "\n".join(["# Sections of a study", "", "| key | default | meaning |", "|---|---|---|", *rows, ""])


def _default(key: dict[str, Any]) -> str:
    return f"`{key['default']}`" if "default" in key else ""


def _page(group: str, entries: Iterable[tuple[Quantity, list[str]]]) -> str:
    head = ["name", "kind", "unit", "default", "allowed", "meaning", "source"]
    rows = ["| " + " | ".join(_cells(quantity, modes)) + " |" for quantity, modes in entries]
    table = [f"| {' | '.join(head)} |", "|---" * len(head) + "|", *rows]
    return "\n".join([_WIDE, f"# {group}", "", ABOUT[group], "", *table, ""])


def _cells(quantity: Quantity, modes: list[str]) -> list[str]:
    """Return name, kind, unit, default, allowed values, meaning and source of a quantity as cells of a table."""
    point = "@point" if getattr(quantity, "per_point", False) else ""
    name = f'<span id="{quantity.name}"></span>`{quantity.name}{point}`'
    meaning = quantity.description + ("" if len(modes) == len(MODES) else f" ({' and '.join(modes)} mode only)")
    if isinstance(quantity, Choice):
        records = Catalog().names(quantity.category) if quantity.category else ()
        allowed = ", ".join(f"`{word}`" for word in (*quantity.options, *records))
        default = f"from `{quantity.record[0]}`" if quantity.record else f"`{quantity.default}`"
        return [name, "choice", "", default, allowed, _text(meaning), ""]
    unit = pretty(quantity.unit)
    if isinstance(quantity, Output):
        rules = "; ".join(f"{rule.sense} {_number(rule.value, quantity.unit)}" for rule in quantity.rules)
        why = "; ".join(dict.fromkeys(rule.reason for rule in quantity.rules))
        return [name, "output", unit, "", _text(rules), _text(meaning + (f" (rule: {why})" if why else "")), ""]
    kind = "variable" if quantity.variable else "input"
    default = "" if quantity.default is None else _number(quantity.default, quantity.unit)
    if quantity.record:
        default = f"from `{quantity.record[0]}`"
    return [name, kind, unit, default, _ends(quantity), _text(meaning), _text(quantity.source + _known(quantity))]


def _known(quantity: Input) -> str:
    """Return the status and range of an unmeasured default."""
    if quantity.low is None or quantity.high is None:
        return ""
    low, high = (_number(end, quantity.unit) for end in (quantity.low, quantity.high))
    return f"; known within {low} to {high}"


def _ends(quantity: Input) -> str:
    ends = (quantity.lower, quantity.upper)
    if not any(map(math.isfinite, ends)):
        return ""
    return " to ".join(_number(end, quantity.unit) if math.isfinite(end) else "any" for end in ends)


def _number(value: float, unit: str) -> str:
    return f"{from_si(value, unit):.6g}"


def _text(text: str) -> str:
    """Escape text for a cell of a Markdown table."""
    return text.replace("|", "\\|").replace("<", "&lt;").replace("\n", " ").replace("$", "\\$")


def _internal(quantity: Quantity) -> bool:
    return isinstance(quantity, Output) and (quantity.hidden or quantity.instant)


def _file_name(group: str) -> str:
    return group.lower().replace(" ", "-")
