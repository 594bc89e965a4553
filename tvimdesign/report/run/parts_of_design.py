"""The sections on the parts, read off the files that CAD has written: solids, checks, materials, steps, springs."""

import csv
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tvimdesign.base.atomic_files import TABLE_ENCODING
from tvimdesign.base.units import pretty
from tvimdesign.cad import cad_report
from tvimdesign.cad.cad_report import SolidCheck
from tvimdesign.report.output.numbers import number
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.page.blocks import Block, Cell, Drawn, Folded, Grid, Head, Picture, Section, Steps, Words


def in_short(checks: Sequence[SolidCheck]) -> str:
    """Return how many checks passed, how many did not, and the worst of those."""
    worst = worst_first(checks)
    passed = sum(check.level == "pass" for check in checks)
    clauses = [f"{'all' if passed == len(checks) else f'{passed} of'} {len(checks)} checks passed"]
    for level in ("failure", "warning"):
        missed = [check.text for check in worst if check.level == level]
        if missed:
            clauses.append(f"{len(missed)} {level}{'s' if len(missed) > 1 else ''}, the worst: {missed[0]}")
    return "; ".join([*clauses, "cad/checks.json"] if worst else clauses)


def worst_first(checks: Sequence[SolidCheck]) -> list[SolidCheck]:
    """Return failures, then warnings, those that miss their limit by the most first."""
    rank = {"failure": 0, "warning": 1}
    reported = [check for check in checks if check.level in rank]
    missed = {check.name: abs(check.value - check.limit) / max(abs(check.limit), 1e-9) for check in reported}
    return sorted(reported, key=lambda check: (rank[check.level], -missed[check.name], check.name))


FOLDER, CYCLE = "cad", "cycle"  # Folder of the parts, and name of the figure of the cycle beside them
_CARRIED = (".step", ".3mf", ".pdf")
"""Files of parts that the page carries, by their ending; in this order, as there may not be room for all."""
_LEVELS = ("failure", "warning", "pass")


def preview(cad: Path) -> Picture | None:
    """Return the module whole, where CAD has drawn it."""
    path = cad / cad_report.PREVIEW
    return Picture(path.read_bytes(), "The module, whole and opened") if path.exists() else None


def solids_section(cad: Path, study: str) -> Section:
    """Return the assembly to turn; or, where no parts were made, how to make them."""
    model, data = cad / cad_report.ASSEMBLY_GLB, cad / cad_report.ASSEMBLY_DATA
    if not (model.exists() and data.exists()):
        words = (
            f"This run made no parts, so there is no module to turn here. `tvimdesign run {study} --overwrite` makes "
            "them and writes this page with them."
        )
        return Section("assembly", "Assembly in 3-D", [Words([words])])
    says = (
        "The assembly: turn it, hide parts, take it apart, cut it, turn its rotor; pick a part for what it is made "
        "of and its files."
    )
    solids: dict[str, Any] = json.loads(data.read_text("utf-8"))
    drawn = Drawn(
        "solids", "solids/viewer.js", says, {**solids, "folder": FOLDER, "cycle": CYCLE}, model.read_bytes(), ["three"]
    )
    return Section("assembly", "Assembly in 3-D", [drawn])


def checks_section(cad: Path) -> list[Section]:
    """Return every check on the solids, those that did not pass first."""
    path = cad / "checks.json"
    if not path.exists():
        return []
    checks: list[dict[str, Any]] = json.loads(path.read_text("utf-8"))["checks"]
    ordered = sorted(checks, key=lambda check: _LEVELS.index(check["level"]))
    counts = ((level, sum(check["level"] == level for check in checks)) for level in reversed(_LEVELS))
    summary = ", ".join(f"{count} {level}" for level, count in counts if count)
    failed = [check for check in ordered if check["level"] != "pass"]
    blocks: list[Block] = [Words([f"{len(checks)} checks on the solids: {summary}."])]
    blocks += [checks_grid("Checks that did not pass", failed)] if failed else []
    return [
        Section("checks", "Checks", [*blocks, Folded("All checks", [checks_grid("Checks on the solids", ordered)])])
    ]


def checks_grid(title: str, checks: Sequence[Mapping[str, Any]]) -> Grid:
    """Return checks on the solids as a table: value against limit, exact or sampled, and where."""
    rows = [
        (check["level"], check["text"], _with_unit(check, "value"), _with_unit(check, "limit"), check["basis"],
         ", ".join(f"{x:.1f}" for x in check.get("place") or ()))
        for check in checks
    ]  # fmt: skip
    heads = ("", "what was checked", "value", "limit", "basis", "at x, y, z in mm")
    return grid(title, heads, rows, right=(2, 3), code=(), toned=(0,))


def _with_unit(check: Mapping[str, Any], what: str) -> str:
    return f"{number(check[what])} {pretty(check['unit'])}".rstrip()


_HEADS = {"made_or_bought": "made or bought", "mass_each_g": "g each", "mass_all_g": "g all", "lead_time": "lead time"}
"""Of columns of the bill of materials, where the page has other words."""


def materials_section(cad: Path) -> list[Section]:
    """Return the bill of materials, with links to the files a part is made from."""
    rows = _csv(cad / cad_report.BILL_OF_MATERIALS)
    if not rows:
        return []
    shown = ["item", "part", "quantity", "made_or_bought", "title", "fit", "mass_each_g", "mass_all_g"]
    shown += ["number", "price", "lead_time"]
    heads = [*(_HEADS.get(name, name) for name in shown), "files"]
    numbers = ("item", "quantity", "mass_each_g", "mass_all_g")
    right = [name in numbers for name in shown]
    cells = [
        [
            *(Cell(row.get(name, ""), float(row[name]) if name in numbers else None) for name in shown),
            _files(row["files"].split()),
        ]
        for row in rows
    ]
    materials = Grid(
        "Bill of materials", [Head(text, at) for text, at in zip(heads, [*right, False], strict=True)], cells
    )
    return [Section("materials", "Bill of materials", [materials])]


def _files(names: list[str]) -> Cell:
    """Return links to a part's files, by their endings."""
    links = tuple((name.rpartition(".")[2].upper(), f"{FOLDER}/{name}") for name in names)
    return Cell(" ".join(text for text, _ in links), links=links)


def steps_section(cad: Path) -> list[Section]:
    """Return how the parts go together, in order, with the pictures that CAD has drawn."""
    path = cad / cad_report.ASSEMBLY_DATA
    if not path.exists():
        return []
    steps = json.loads(path.read_text("utf-8"))["steps"]
    drawn = (
        (cad_report.EXPLODED, "The parts in the order in which they go on, the lowest first"),
        (cad_report.SECTION, "The module cut through its axis"),
    )
    pictures = [Picture((cad / name).read_bytes(), says, says) for name, says in drawn if (cad / name).exists()]
    return [Section("steps", "Assembly steps", [Steps([step["text"] for step in steps], "solids"), *pictures])]


def spring_section(cad: Path) -> list[Section]:
    """Return what the spring's maker needs."""
    rows = _csv(cad / cad_report.SPRING_TABLE)
    if not rows:
        return []
    heads = ("", "value", "unit", "tolerance", "note")
    cells = [tuple(row[name] for name in ("name", "value", "unit", "tolerance", "note")) for row in rows]
    return [Section("spring", "Spring sheet", [grid("The spring", heads, cells, right=(1,), code=())])]


def carried_files(cad: Path) -> dict[str, bytes]:
    """Return the files that a part, a row of the bill of materials or the spring sheet leads to, by their addresses."""
    names = [name for row in _csv(cad / cad_report.BILL_OF_MATERIALS) for name in row["files"].split()]
    data = cad / cad_report.ASSEMBLY_DATA
    if data.exists():
        names += [name for part in json.loads(data.read_text("utf-8"))["parts"] for name in part["files"]]
    names.append(cad_report.SPRING_SHEET)
    files = [name for ending in _CARRIED for name in dict.fromkeys(names) if name.endswith(ending)]
    return {f"{FOLDER}/{name}": (cad / name).read_bytes() for name in files if (cad / name).exists()}


def _csv(path: Path) -> list[dict[str, str]]:
    """Return rows of a table, by column; none where there is no such file."""
    if not path.exists():
        return []
    with path.open(encoding=TABLE_ENCODING, newline="") as file:
        return list(csv.DictReader(file))
