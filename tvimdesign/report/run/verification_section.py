"""Rows of a verification as table, JSON and page, and as a section of its run's page, read from the folder."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape

from tvimdesign.base.atomic_files import digest_of
from tvimdesign.base.units import pretty
from tvimdesign.cad.fe.model_comparison import Compared
from tvimdesign.cad.fe.run_solvers import Solved
from tvimdesign.page.blocks import Block, Page, Picture, Points, Section, Tone, Words
from tvimdesign.page.page_file import FILE, MOST, with_section
from tvimdesign.report.output.numbers import head, number
from tvimdesign.report.output.page_sections import grid, made_by_words, there, versions_section
from tvimdesign.report.output.results_folder import ResultsFolder, made_from, rewrite
from tvimdesign.report.output.terminal import print_grid

FAR = 0.10
"""Share by which model and FE may differ before the row is marked."""
SOLVED = """Solved with netgen and NGSolve from the exported parts. Stresses and stiffness: quadratic tetrahedra, tied
where parts are bonded; the core's top turns as one, the feet are held. Screws: link and core touch without friction.
Heat: half an arc or half a vane in cells, each of the part drawn in its middle, implicit steps in time."""
HEADS = ("", "model", "FE", "unit", "model / FE", "mesh", "what")


def verified(rows: Sequence[Compared], solved: dict[str, Solved]) -> dict[str, Any]:
    """Return what `verify.json` has."""
    return {
        **head(),
        "summary": summary(rows),
        "rows": [
            {"name": row.name, "unit": pretty(row.unit), "model": row.model, "fe": row.fe, "ratio": row.ratio,
             "mesh_change": row.mesh_change, "meaning": row.meaning}
            for row in rows
        ],
        "solved": {name: {"fine": _finite(fe.found), "coarse": _finite(fe.coarse)} for name, fe in solved.items()},
    }  # fmt: skip


def _finite(values: Mapping[str, float]) -> dict[str, float | None]:
    """Return what a solver found; None for a time that did not come, which JSON has no number for."""
    return {name: value if math.isfinite(value) else None for name, value in values.items()}


def table_csv(rows: Sequence[Compared]) -> str:
    """Return the rows, worst first."""
    lines = ["name,unit,model,fe,model over fe,finer over coarser mesh,meaning"]
    lines += [
        f"{row.name},{row.unit},{row.model:.5g},{row.fe:.5g},{row.ratio:.3f},{1.0 + row.mesh_change:.3f},"
        f'"{row.meaning}"'
        for row in rows
    ]
    return "\n".join(lines) + "\n"


def print_rows(rows: Sequence[Compared], console: Console) -> None:
    """Print the rows for people, worst first, and what to make of them."""
    print_grid(grid("", HEADS, [cells(row) for row in rows], right=(1, 2, 4, 5)), console)
    console.print(escape(summary(rows)))


def cells(row: Compared) -> tuple[str, ...]:
    """Return a row as text, under `HEADS`."""
    return (row.name, number(row.model), number(row.fe), pretty(row.unit), f"{row.ratio:.3f}",
            f"{100.0 * row.mesh_change:+.1f} %", row.meaning)  # fmt: skip


def far(rows: Sequence[Compared]) -> list[str]:
    """Return the names of the rows that differ by more than `FAR`."""
    return [row.name for row in rows if not abs(row.ratio - 1.0) <= FAR]


def summary(rows: Sequence[Compared]) -> str:
    """Return how near the model is, in a sentence or two."""
    beyond = far(rows)
    sentence = (
        f"{len(rows) - len(beyond)} of {len(rows)} within {100.0 * FAR:.0f} % of finite elements on the drawn parts"
    )
    worst = f"; beyond: {', '.join(beyond)}" if beyond else ""
    return f"{sentence}{worst}. `mesh` is how far a value moved from elements 1.6 times as large."


def page(name: str, rows: Sequence[Compared], solved: dict[str, Solved], *, pictures: bool) -> str:
    """Return the page of the folder, in Markdown."""
    lines = [f"# {name}: the model against finite elements", "", summary(rows), ""]
    lines += ["| quantity | model | FE | unit | model / FE | mesh | what |", "|---|---|---|---|---|---|---|"]
    lines += [f"| {' | '.join(cells(row))} |" for row in rows]
    lines += ["", SOLVED, "", f"| {' | '.join(SOLVER_HEADS)} |", "|---|---|---|---|"]
    lines += [f"| {' | '.join(row)} |" for row in solver_rows(solved)]
    if pictures:
        lines += ["", *(f"![{key}]({key}.png)" for key in solved)]
    return "\n".join(lines) + "\n"


SOLVER_HEADS = ("solver", "unknowns", "processor seconds", "GB")


def solver_rows(solved: dict[str, Solved]) -> list[tuple[str, ...]]:
    """Return how large each solver's finer mesh was and what it took, under `SOLVER_HEADS`."""
    return [
        (
            key,
            f"{solution.found['unknowns']:.0f}",
            f"{solution.found['seconds']:.0f}",
            f"{solution.found['gigabytes']:.1f}",
        )
        for key, solution in solved.items()
    ]


_FILES = {
    "verify.md": "all of this as text",
    "verify.csv": "the rows",
    "verify.json": "rows and what each solver found",
}
_SHOWS = {
    "joint": "Stress in the frozen joint, bent by the torque on its core",
    "heat": "Temperature of half an arc or half a vane when the polymer's mean is as warm as asked",
    "spring": "Stress in one spring under the pin's force on its leg",
    "screws": "Stress in link and core under the tightened link screws",
    "link": "Stress in the link under a force in its tool hole",
}


def verify_page(folder: ResultsFolder, name: str, rows: Sequence[Compared], solved: dict[str, Solved]) -> Page:
    """Return the page; pictures are those that the folder has."""
    beyond = len(far(rows))
    verdict = "ALL WITHIN 10 %" if not beyond else f"{beyond} OF {len(rows)} BEYOND 10 %"
    first: list[Block] = [Points([summary(rows)])]
    table = grid("The model against finite elements", HEADS, [cells(row) for row in rows], right=(1, 2, 4, 5))
    fields: list[Block] = [
        Picture((folder.path / f"{key}.png").read_bytes(), _SHOWS[key], _SHOWS[key])
        for key in solved
        if (folder.path / f"{key}.png").exists()
    ]
    by: list[Block] = [
        Words([" ".join(SOLVED.split())]),
        grid("Solvers", SOLVER_HEADS, solver_rows(solved), right=(1, 2, 3)),
    ]
    sections = [
        Section("rows", "Model and finite elements", [table]),
        *([Section("fields", "Fields", fields)] if fields else []),
        Section("solved", "How it was solved", by),
        versions_section(folder),
    ]
    tone: Tone = "warn" if beyond else "good"
    files = there(folder, _FILES)
    return Page(name, "verification", verdict, tone, first, None, sections, made_by_words(folder), files)


NAME, DATA, DESIGN = "verification", "verify.json", "design.json"
_BEFORE = "study"
"""The section of a run's page that it stands before."""
_HEADS = ("", "model", "FE", "unit", "model / FE", "mesh", "what")
_SHOWN = {
    "joint": "Stress in the frozen joint", "spring": "Stress in one spring",
    "screws": "Stress in link and core under the link screws", "link": "Stress in the link", "heat": "Temperature",
}  # fmt: skip
_BASE64 = 4.0 / 3.0
"""Bytes that a byte of a picture takes in a page."""
_AROUND = 1000
"""Bytes at most of what stands around a picture."""


def folder_of_verification(run: Path) -> Path:
    """Return the default folder of a run's verification."""
    return run.with_name(f"{run.resolve().name}-verified")


def verification_sections(run: Path) -> list[Section]:
    """Return the section of a run's page where there is a verification of this very design; none otherwise."""
    folder = folder_of_verification(run)
    if not _is_of(folder, run):
        return []
    return [verification_section(folder, run)]


def verification_section(folder: Path, run: Path, room: float = MOST) -> Section:
    """Return rows worst first, a conclusion, and those fields for which there is `room` in the page [bytes]."""
    verification: dict[str, Any] = json.loads((folder / DATA).read_text("utf-8"))
    cells = [
        (row["name"], number(row["model"]), number(row["fe"]), row["unit"], f"{row['ratio']:.3f}",
         f"{100.0 * row['mesh_change']:+.1f} %", row["meaning"])
        for row in verification["rows"]
    ]  # fmt: skip
    sentences = [verification["summary"], f"Solvers and versions: {os.path.relpath(folder, run)}/{FILE}."]
    table = grid("The model against finite elements on the drawn parts", _HEADS, cells, right=(1, 2, 4, 5))
    blocks: list[Block] = [Words(sentences), table]
    for name, words in _SHOWN.items():
        picture = folder / f"{name}.png"
        taken = _AROUND + _BASE64 * picture.stat().st_size if picture.exists() else float("inf")
        if taken < room:
            blocks.append(Picture(picture.read_bytes(), words, words))
            room -= taken
    return Section(NAME, "Finite elements", blocks, folded=True)


def put_on_page(folder: Path, run: Path) -> bool:
    """Put a finished verification on the page of its run; returns whether there is such a page, as it was written.

    Of the fields it takes as many as the page has room for: it is to go into a mail.
    """
    page = run / FILE
    if not _is_of(folder, run) or not page.exists():
        return False
    text = page.read_text("utf-8")
    alone = with_section(text, verification_section(folder, run, 0.0), _BEFORE)
    if alone is None:
        return False
    room = MOST - len(alone.encode())
    data = (with_section(text, verification_section(folder, run, room), _BEFORE) or alone).encode()
    return rewrite(run, FILE, data)


def _is_of(folder: Path, run: Path) -> bool:
    """Return whether a folder has the verification of a run's design, as it is now."""
    design = run / DESIGN
    return (folder / DATA).exists() and design.exists() and made_from(folder, "design") == digest_of(design)
