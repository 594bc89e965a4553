"""Makes the parts of a design into a folder, with their checks, and says which of those fail.

The sections on the parts, read off the files that CAD has written: solids, checks, materials, steps, springs.
"""

import csv
import json
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Self

from tvimdesign.base.atomic_files import TABLE_ENCODING, atomic_write, make_folder
from tvimdesign.base.errors import GeometryError
from tvimdesign.base.processes import Niceness, set_low_priority
from tvimdesign.base.units import pretty
from tvimdesign.cad import cad_report
from tvimdesign.cad.cad_report import CadReport, SolidCheck
from tvimdesign.page.blocks import Block, Cell, Drawn, Folded, Grid, Head, Picture, Section, Steps, Words
from tvimdesign.report.output.numbers import number
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.terminal import Progress
from tvimdesign.study.design import Design, write_design

_DESIGN_COPY = ".design.json.part"
"""The design as the parts are asked for, beside them: it is removed once they are made."""


def make_parts_of(design: Path, out: Path, progress: Progress) -> CadReport:
    """Make the parts of a design.json beside their checks.json. Raises GeometryError where they cannot be made."""
    with BackgroundPartsJob() as parts:
        parts.begin_with(design, out)
        return parts.finish(progress)


class BackgroundPartsJob:
    """Parts made while a run goes on: the CAD kernel is loaded as the solver works, and begins with the answer."""

    def __init__(self, mode: str = "", *, gives_way: bool = True) -> None:
        """Start the process that loads the kernel, and reads the table of the mode that is known to come.

        By default its priority is lower than the solver's; its parts but the first have a still lower one.
        """
        from tvimdesign.cad.make import PartsProcess

        self._stack = ExitStack()
        self._process = self._stack.enter_context(PartsProcess(mode=mode))
        if gives_way:
            set_low_priority(self._process.process, Niceness.LOW)
        self._out = Path()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self.stop()

    def stop(self) -> None:
        """End the process if it has not ended: nothing more is written into the folder."""
        self._stack.close()
        (self._out / _DESIGN_COPY).unlink(missing_ok=True)

    def begin(self, design: Design, out: Path) -> None:
        """Let the parts be made into a folder, and come back at once."""
        make_folder(out)
        design_file = out / _DESIGN_COPY
        self.begin_with(write_design(design, design_file), out)

    def begin_with(self, design: Path, out: Path) -> None:
        """Do so with a design.json, which is read while this goes on."""
        self._out = out
        self._process.begin(design, out)

    def finish(self, progress: Progress) -> CadReport:
        """Wait for the parts, and write their checks.json. Raises GeometryError where they cannot be made."""
        progress("parts: starting the CAD kernel")
        try:
            report = self._process.finish(lambda text: progress(f"parts, {text}"))
        finally:
            self.stop()
        atomic_write(self._out / "checks.json", (json.dumps(plain_report(report), indent=2) + "\n").encode())
        progress("")
        return report


def plain_report(report: CadReport) -> dict[str, Any]:
    """Return the parts' checks, files and notes as plain data."""
    return {
        "checks": [check.plain() for check in report.checks], "files": list(report.files), "notes": list(report.notes)
    }  # fmt: skip


def refuse_failed(report: CadReport) -> None:
    """Raise GeometryError where a check on the solids fails; the files are there."""
    if not report.failed:
        return
    worst = sorted(report.failed, key=lambda check: -abs(check.value))[:3]
    lines = [
        f"  {check.text}: {check.value:.4g}{check.unit and ' '}{check.unit}, limit {check.limit:.4g}" for check in worst
    ]
    raise GeometryError(
        f"the parts are written, but {len(report.failed)} of {len(report.checks)} checks fail, the worst:\n"
        + "\n".join(lines)
        + "\nSee checks.json beside the parts, and which rules the design violates."
    )


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
