"""The command `verify`: a design's parts by finite elements beside its model, from a result to a finished folder."""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from tvimdesign.base.errors import InputError
from tvimdesign.base.record import Record
from tvimdesign.cad.fe.model_comparison import SOLVERS, Compared, compared
from tvimdesign.cad.fe.run_solvers import Solved, export_parts, require_fe, run_solvers
from tvimdesign.page.blocks import Block, Page, Points
from tvimdesign.report.output.command import Command, design_file
from tvimdesign.report.output.terminal import Progress
from tvimdesign.report.verification_tables import FILES, far, table_csv, verified, verify_sections
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_design
from tvimdesign.study.design import Design, read_design

_WORK = ".verify-"
"""What the name of the folder begins with in which the parts stand while they are solved."""
TITLES = {
    "joint": "von Mises\nMPa at 1 N m", "spring": "von Mises\nMPa at 1 N m", "link": "von Mises\nMPa at 1 N",
    "screws": "von Mises\nMPa at 1 N",
}  # fmt: skip


def verify_design(path: Path, out: Path, fe_python: str, *, overwrite: bool, as_json: bool, told: bool = True) -> None:
    """Solve the parts of a design and write the folder.

    Nothing is printed unless `told`. Raises InputError, SimulationError, OutputError.
    """
    source = design_file(path)
    design = read_design(source)
    python = fe_python or sys.executable
    require_fe(python)
    module = resolve_design(design)
    refuse_other_parts(module)
    with Command(out, overwrite=overwrite, as_json=as_json) as command:
        with TemporaryDirectory(dir=command.folder.path, prefix=_WORK) as work:
            rows, solved = _solved(design, module, Path(work).resolve(), python, command.progress)
            data = verified(rows, solved)
            _write(command, data, rows, solved, Path(work))
        page = verify_page(command, design.name, data, rows)
        command.finish("verified", {"design": source}, design.study, page=page)
    if told:
        command.report(data, "report.html with table and pictures is")


def verify_page(command: Command, name: str, data: dict[str, Any], rows: list[Compared]) -> Page:
    """Return the page of a verification, whose folder has the pictures."""
    beyond = len(far(rows))
    status = "ALL WITHIN 10 %" if not beyond else f"{beyond} OF {len(rows)} BEYOND 10 %"
    sections = verify_sections(command.folder.path, data)
    first: list[Block] = [Points([data["summary"]])]
    return command.page(name, "verification", status, first, sections, tone="warn" if beyond else "good", files=FILES)


def refuse_other_parts(module: ResolvedModule) -> None:
    """Raise InputError for parts that the solvers do not draw."""
    if module.study.mode == "lock":
        raise InputError("verify: FE compares springs as well, and a lock has none")
    form = module.values.get("heater_form", "flexible")
    if form != "flexible" and module.study.mode == "compression":
        raise InputError(
            f"verify: heater_form is {form}; FE draws rigid modules below an arc, in a vane only pads cut to the PCL"
        )
    liner = module.values.get("liner_material", "none")
    if isinstance(liner, Record):
        raise InputError(f"verify: liner_material is {liner.name}; FE knows no sheet between PCL and rotor")


def _solved(
    design: Design, module: ResolvedModule, work: Path, python: str, progress: Progress
) -> tuple[list[Compared], dict[str, Solved]]:
    """Export the parts and solve in a folder of work; return the rows and what each solver found."""
    progress("verify: drawing the parts")
    _export(design, work / "parts")
    solved = run_solvers(SOLVERS, work / "parts", work, python, lambda text: progress(f"verify: {text}"))
    return compared(module, solved), solved


def _export(design: Design, folder: Path) -> None:
    from tvimdesign.cad.jobs.main import load_kernel

    load_kernel()
    export_parts(design, folder)


def _write(
    command: Command, data: dict[str, Any], rows: list[Compared], solved: dict[str, Solved], work: Path
) -> None:  # fmt: skip
    from tvimdesign.cad.render.render import write_field_picture

    command.folder.write_json("verify.json", data)
    command.folder.write("verify.csv", table_csv(rows))
    command.progress("verify: drawing the fields")
    for name, solution in solved.items():
        with np.load(solution.field) as field:
            points, triangles, values, ways = (field[part] for part in ("points", "triangles", "values", "ways"))
        picture = work / f"{name}.png"
        write_field_picture(picture, points, triangles, values, ways, TITLES[name])
        command.folder.write(picture.name, picture.read_bytes())
