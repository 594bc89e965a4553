"""The command `verify`: a design's parts by finite elements beside its model, from a result to a finished folder."""

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tvimdesign.base.units import pretty
from tvimdesign.cad.fe.model_comparison import Compared, compare_with_fe, refuse_unsolvable
from tvimdesign.cad.fe.run_solvers import Solved
from tvimdesign.report.output.command import Command, design_file
from tvimdesign.report.output.numbers import csv_text, finite, head, number
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.page.blocks import Block, Grid, Page, Picture, Points, Section, Words
from tvimdesign.study import read_design

DATA = "verify.json"
FAR = 0.10  # Share by which model and FE may differ before the row is marked
SOLVED = (
    "Solved with netgen and NGSolve from the exported parts. Stresses and stiffness: quadratic tetrahedra, tied where "
    "parts are bonded; the core's top turns as one, the feet are held. Screws: link and core touch without friction."
)
FILES = {"verify.csv": "the rows", DATA: "rows and what each solver found"}
_SHOWS = {
    "joint": "Stress in the frozen joint, bent by the torque on its core",
    "spring": "Stress in one spring under the pin's force on its leg",
    "screws": "Stress in link and core under the tightened link screws",
    "link": "Stress in the link under a force in its tool hole",
}


def verified(rows: Sequence[Compared], solved: Mapping[str, Solved]) -> dict[str, Any]:
    """Return what `verify.json` has."""
    return {
        **head(),
        "summary": summary(rows),
        "rows": [
            {"name": row.name, "unit": pretty(row.unit), "model": row.model, "fe": row.fe, "ratio": row.ratio,
             "mesh_change": row.mesh_change, "meaning": row.meaning}
            for row in rows
        ],
        "solved": {
            name: {mesh: {key: finite(value) for key, value in values.items()}
                   for mesh, values in (("fine", fe.fine), ("coarse", fe.coarse))}
            for name, fe in solved.items()
        },
    }  # fmt: skip


def table_csv(rows: Sequence[Compared]) -> str:
    """Return the rows, worst first."""
    return csv_text(
        {"name": row.name, "unit": row.unit, "model": f"{row.model:.5g}", "fe": f"{row.fe:.5g}",
         "model over fe": f"{row.ratio:.3f}", "finer over coarser mesh": f"{1.0 + row.mesh_change:.3f}",
         "meaning": row.meaning}
        for row in rows
    )  # fmt: skip


def far(rows: Sequence[Compared]) -> list[str]:
    """Return the names of the rows that differ by more than `FAR`."""
    return [row.name for row in rows if not abs(row.ratio - 1.0) <= FAR]


def summary(rows: Sequence[Compared]) -> str:
    """Return how near the model is, in a sentence or two."""
    beyond = far(rows)
    near = f"{len(rows) - len(beyond)} of {len(rows)} within {100.0 * FAR:.0f} % of finite elements on the drawn parts"
    worst = f"; beyond: {', '.join(beyond)}" if beyond else ""
    return f"{near}{worst}. `mesh` is how far a value moved from elements 1.6 times as large."


def rows_grid(verification: Mapping[str, Any]) -> Grid:
    """Return the rows of `verify.json` as a table."""
    heads = ("", "model", "FE", "unit", "model / FE", "mesh", "what")
    cells = [
        (row["name"], number(row["model"]), number(row["fe"]), row["unit"], f"{row['ratio']:.3f}",
         f"{100.0 * row['mesh_change']:+.1f} %", row["meaning"])
        for row in verification["rows"]
    ]  # fmt: skip
    return grid("The model against finite elements on the drawn parts", heads, cells, right=(1, 2, 4, 5))


def verify_sections(folder: Path, verification: Mapping[str, Any]) -> list[Section]:
    """Return the sections of the command's own page; pictures are those that the folder has."""
    solvers = [
        (name, f"{fine['unknowns']:.0f}", f"{fine['seconds']:.0f}", f"{fine['gigabytes']:.1f}")
        for name, fine in ((name, meshes["fine"]) for name, meshes in verification["solved"].items())
    ]
    shown = ((folder / f"{name}.png", words) for name, words in _SHOWS.items())
    fields = [Picture(picture.read_bytes(), words, words) for picture, words in shown if picture.exists()]
    table = grid("Solvers", ("solver", "unknowns", "processor seconds", "GB"), solvers, right=(1, 2, 3))
    return [
        Section("rows", "Model and finite elements", [rows_grid(verification)]),
        *([Section("fields", "Fields", fields)] if fields else []),
        Section("solved", "How it was solved", [Words([SOLVED]), table]),
    ]


_WORK = ".verify-"  # Start of the name of the folder of the parts while they are solved
TITLES = {
    "joint": "von Mises\nMPa at 1 N m", "spring": "von Mises\nMPa at 1 N m", "link": "von Mises\nMPa at 1 N",
    "screws": "von Mises\nMPa at 1 N",
}  # fmt: skip


def verify_design(path: Path, out: Path, fe_python: str, *, overwrite: bool, as_json: bool) -> None:
    """Solve the parts of a design and write the folder. Raises InputError, SimulationError, OutputError."""
    source = design_file(path)
    design = read_design(source)
    python = fe_python or sys.executable
    refuse_unsolvable(design, python)
    with Command(out, overwrite=overwrite, as_json=as_json) as command:
        with TemporaryDirectory(dir=command.folder.path, prefix=_WORK) as work:
            rows, solved = compare_with_fe(design, Path(work).resolve(), python, command.progress)
            data = verified(rows, solved)
            _write(command, data, rows, solved, Path(work))
        page = verify_page(command, design.name, data, rows)
        command.finish("verified", {"design": source}, design.study, page=page)
    command.report(data, "report.html with table and pictures is")


def verify_page(command: Command, name: str, data: dict[str, Any], rows: list[Compared]) -> Page:
    """Return the page of a verification, whose folder has the pictures."""
    beyond = len(far(rows))
    status = "ALL WITHIN 10 %" if not beyond else f"{beyond} OF {len(rows)} BEYOND 10 %"
    sections = verify_sections(command.folder.path, data)
    first: list[Block] = [Points([data["summary"]])]
    return command.page(name, "verification", status, first, sections, tone="warn" if beyond else "good", files=FILES)


def _write(command: Command, data: dict[str, Any], rows: list[Compared], solved: dict[str, Solved], work: Path) -> None:
    command.folder.write_json("verify.json", data)
    command.folder.write("verify.csv", table_csv(rows))
    command.progress("verify: drawing the fields")
    for name, solution in solved.items():
        picture = work / f"{name}.png"
        solution.write_picture(picture, TITLES[name])
        command.folder.write(picture.name, picture.read_bytes())
