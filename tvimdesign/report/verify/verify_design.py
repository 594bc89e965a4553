"""The command `verify`: a design's parts by finite elements beside its model, from a result to a finished folder."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.table import Table as Grid

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import pretty
from tvimdesign.cad.fe.run_solvers import Solved, hold_ready, run_solvers
from tvimdesign.report.output.number_format import head
from tvimdesign.report.output.progress import progress_output, wide_console
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.output.tables import number
from tvimdesign.report.verify.comparison import SOLVERS, Compared, compared
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_design
from tvimdesign.study.design import Design, read_design

FAR = 0.10
"""Share by which model and FE may differ before the row is marked."""
SOLVED = """Solved with netgen and NGSolve from the exported STEP solids: quadratic tetrahedra, tied where parts are
bonded. The core's top turns as one, the feet are held."""
TITLES = {"joint": "von Mises\nMPa at 1 N m", "spring": "von Mises\nMPa at 1 N m", "link": "von Mises\nMPa at 1 N"}


def verify_design(path: Path, out: Path, fe_python: str, *, overwrite: bool, pictures: bool, as_json: bool) -> None:
    """Solve the parts of a design and write the folder. Raises InputError, SimulationError, OutputError."""
    source = path / "design.json" if path.is_dir() else path
    design = read_design(source)
    python = fe_python or sys.executable
    hold_ready(python)
    module = resolve_design(design)
    refuse_other_parts(module)
    with ExitStack() as stack:
        folder = stack.enter_context(ResultsFolder(out, overwrite))
        progress = stack.enter_context(progress_output())
        work = Path(stack.enter_context(TemporaryDirectory(prefix="tvimdesign-verify-")))
        progress("verify: drawing the parts")
        _export(design, work / "parts")
        solved = run_solvers(SOLVERS, work / "parts", work, python, lambda text: progress(f"verify: {text}"))
        rows = compared(module, solved)
        data = verified(rows, solved)
        folder.write_json("verify.json", data)
        folder.write("verify.csv", table_csv(rows))
        folder.write("verify.md", page(design.name, rows, solved, pictures=pictures))
        if pictures:
            progress("verify: drawing the fields")
            for name, one in solved.items():
                _draw(folder, name, one)
        progress("")
        folder.finish("verified", {"design": source}, design.study)
    if as_json:
        print(json.dumps({**data, "folder": str(out)}, indent=2, allow_nan=False))
    else:
        print_rows(rows, wide_console())
        wide_console().print(f"\nTable and pictures are in [bold]{escape(str(out))}[/bold]", soft_wrap=True)


def refuse_other_parts(module: ResolvedModule) -> None:
    """Raise InputError for parts that the solvers do not draw."""
    form = module.values.get("heater_form", "flexible")
    if form != "flexible" and module.study.mode == "compression":
        raise InputError(
            f"verify: heater_form is {form}; in a vane FE draws only pads cut to the PCL, rigid modules below an arc"
        )


def _export(design: Design, folder: Path) -> None:
    from tvimdesign.cad.fe.exported_parts import export_parts

    export_parts(design, folder)


def _draw(folder: ResultsFolder, name: str, solved: Solved) -> None:
    from tvimdesign.cad.render.field_picture import write_field_picture

    with np.load(solved.field) as field:
        points, triangles, values, ways = (field[part] for part in ("points", "triangles", "values", "ways"))
    with TemporaryDirectory() as beside:
        picture = Path(beside) / f"{name}.png"
        write_field_picture(picture, points, triangles, values, ways, TITLES[name])
        folder.write(picture.name, picture.read_bytes())


def verified(rows: Sequence[Compared], solved: dict[str, Solved]) -> dict[str, Any]:
    """What `verify.json` has."""
    return {
        **head(),
        "rows": [
            {"name": row.name, "unit": pretty(row.unit), "model": row.model, "fe": row.fe, "ratio": row.ratio,
             "mesh_change": row.mesh_change, "meaning": row.meaning}
            for row in rows
        ],
        "solved": {name: {"fine": one.found, "coarse": one.coarse} for name, one in solved.items()},
    }  # fmt: skip


def table_csv(rows: Sequence[Compared]) -> str:
    """The rows, worst first."""
    lines = ["name,unit,model,fe,model over fe,finer over coarser mesh,meaning"]
    lines += [
        f"{row.name},{row.unit},{row.model:.5g},{row.fe:.5g},{row.ratio:.3f},{1.0 + row.mesh_change:.3f},"
        f'"{row.meaning}"'
        for row in rows
    ]
    return "\n".join(lines) + "\n"


def print_rows(rows: Sequence[Compared], console: Console) -> None:
    """Print the rows for people, worst first, and what to make of them."""
    grid = Grid(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim")
    for title in ("", "model", "FE", "unit", "model / FE", "mesh", "what"):
        grid.add_column(title, justify="right" if title in ("model", "FE", "model / FE", "mesh") else "left")
    for row in rows:
        grid.add_row(*_cells(row))
    console.print(grid)
    console.print(escape(summary(rows)))


def _cells(row: Compared) -> tuple[str, ...]:
    return (row.name, number(row.model), number(row.fe), pretty(row.unit), f"{row.ratio:.3f}",
            f"{100.0 * row.mesh_change:+.1f} %", row.meaning)  # fmt: skip


def summary(rows: Sequence[Compared]) -> str:
    """How near the model is, in a sentence or two."""
    far = [row.name for row in rows if not 1.0 - FAR <= row.ratio <= 1.0 / (1.0 - FAR)]
    told = f"{len(rows) - len(far)} of {len(rows)} within {100.0 * FAR:.0f} % of finite elements on the drawn parts"
    worst = f"; beyond: {', '.join(far)}" if far else ""
    return f"{told}{worst}. `mesh` is how far a value moved from elements 1.6 times as large."


def page(name: str, rows: Sequence[Compared], solved: dict[str, Solved], *, pictures: bool) -> str:
    """The page of the folder, in Markdown."""
    lines = [f"# {name}: the model against finite elements", "", summary(rows), ""]
    lines += ["| quantity | model | FE | unit | model / FE | mesh | what |", "|---|---|---|---|---|---|---|"]
    lines += [f"| {' | '.join(_cells(row))} |" for row in rows]
    lines += ["", SOLVED, "", "| solver | unknowns | seconds | GB |", "|---|---|---|---|"]
    lines += [
        f"| {key} | {one.found['unknowns']:.0f} | {one.found['seconds']:.0f} | {one.found['gigabytes']:.1f} |"
        for key, one in solved.items()
    ]
    if pictures:
        lines += ["", *(f"![{key}]({key}.png)" for key in solved)]
    return "\n".join(lines) + "\n"
