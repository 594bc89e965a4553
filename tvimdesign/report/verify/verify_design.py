"""The command `verify`: a design's parts by finite elements beside its model, from a result to a finished folder.

Stiffness of a joint by the temperatures of polymer and structure where each of them is.

The product's own stack has one column of polymer; here every column has its own temperatures, as finite elements in
space find them. What the polymer and the structure are at a temperature is the product's.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.markup import escape

from tvimdesign.base.errors import InputError
from tvimdesign.base.record import Record
from tvimdesign.cad.fe.run_solvers import Solved, require_fe, run_solvers
from tvimdesign.device import Table
from tvimdesign.device.core.impedance.warm_structure import WAY_OUT, PartTemperatures, in_series
from tvimdesign.page.page_file import FILE
from tvimdesign.physics.layers import block
from tvimdesign.physics.polymers import polymer
from tvimdesign.report.command import Command, design_file
from tvimdesign.report.output.results_folder import ResultsFolder
from tvimdesign.report.output.terminal import Progress
from tvimdesign.report.run.verification_section import put_on_page
from tvimdesign.report.verify.comparison import HEAT, SOLVERS, TIMES, Compared, compared
from tvimdesign.report.verify.verify_report import page, print_rows, table_csv, verified, verify_page
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_design
from tvimdesign.study.design import Design, read_design

_WORK = ".verify-"
"""What the name of the folder begins with in which the parts stand while they are solved."""
TITLES = {
    "joint": "von Mises\nMPa at 1 N m", "spring": "von Mises\nMPa at 1 N m", "link": "von Mises\nMPa at 1 N",
    "screws": "von Mises\nMPa at 1 N", "heat": "degC at the\npolymer's\ntarget",
}  # fmt: skip


def verify_design(
    path: Path, out: Path, fe_python: str, *, overwrite: bool, pictures: bool, as_json: bool, told: bool = True
) -> None:
    """Solve the parts of a design and write the folder, and the section of its run's page where it has one.

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
            _write(command, design.name, rows, solved, Path(work), pictures=pictures)
        page = verify_page(command.folder, design.name, rows, solved)
        command.finish("verified", {"design": source}, design.study, page=page)
    on_page = put_on_page(out, source.parent)
    if told:
        also = f"{escape(str(source.parent))}/{FILE} shows table and pictures, too; they are" if on_page else ""
        where = also or "report.html with table and pictures is"
        command.report({**data, "on_page_of_run": on_page}, lambda console: print_rows(rows, console), where)


def solvers_of(design: Design) -> tuple[str, ...]:
    """Return what is solved: heat where pads heat the polymer and the model gets it warm, the slowest first."""
    warmed = any(np.isfinite(design.values.get(name, np.inf)) for name in TIMES)
    in_pads = design.choices.get("heat_source", "pads") == "pads"
    return (SOLVERS[0], HEAT, *SOLVERS[1:]) if warmed and in_pads else SOLVERS


def _with_softening(module: ResolvedModule, heat: Solved, parts: Path) -> Solved:
    """Return the heat with the times at which the joint is soft."""
    joint, times = WarmJoint(module.table, module.values), {}
    for mesh in ("fine", "coarse"):
        with np.load(parts / f"heat_{mesh}.npz") as course:
            times[mesh] = {TIMES[0]: softening_time(joint, dict(course))}
    return replace(heat, found={**heat.found, **times["fine"]}, coarse={**heat.coarse, **times["coarse"]})


def refuse_other_parts(module: ResolvedModule) -> None:
    """Raise InputError for parts that the solvers do not draw."""
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
    names = solvers_of(design)
    solved = run_solvers(names, work / "parts", work, python, lambda text: progress(f"verify: {text}"))
    if HEAT in solved:
        solved[HEAT] = _with_softening(module, solved[HEAT], work / "parts")
    return compared(module, solved, design.values), solved


def _write(
    command: Command, name: str, rows: list[Compared], solved: dict[str, Solved], work: Path, *, pictures: bool
) -> None:
    folder = command.folder
    folder.write_json("verify.json", verified(rows, solved))
    folder.write("verify.csv", table_csv(rows))
    folder.write("verify.md", page(name, rows, solved, pictures=pictures))
    if pictures:
        command.progress("verify: drawing the fields")
        for solver, solution in solved.items():
            _draw(folder, work, solver, solution)


def _export(design: Design, folder: Path) -> None:
    from tvimdesign.cad.jobs.main import load_kernel

    load_kernel()
    from tvimdesign.cad.fe.exported_parts import export_parts

    export_parts(design, folder)


def _draw(folder: ResultsFolder, work: Path, name: str, solved: Solved) -> None:
    from tvimdesign.cad.render.render import write_field_picture

    with np.load(solved.field) as field:
        points, triangles, values, ways = (field[part] for part in ("points", "triangles", "values", "ways"))
    picture = work / f"{name}.png"
    write_field_picture(picture, points, triangles, values, ways, TITLES[name])
    folder.write(picture.name, picture.read_bytes())


Array = NDArray[np.float64]
_WANTED = ("pcl_rheology", "pcl_moment", "pcl_depth", "spring_stiffness", "soft_threshold", "structure_compliances",
           "structure_softening", "lossless_compliance", "pcl_melting")  # fmt: skip


class WarmJoint:
    """A module's joint, by the temperatures of its parts."""

    def __init__(self, table: Table, values: Mapping[str, Any]) -> None:
        """Take what the joint is beside its heat off the table; `values` are all inputs in SI."""
        self.values, self.sheared = values, "arc_span" in values
        self.quantity = table.evaluate(values, _WANTED if self.sheared else [*_WANTED, "shape_factor"])
        self.omega = 2.0 * np.pi * float(values["frequency@hot"])

    @property
    def soft(self) -> float:
        """Size of the dynamic stiffness below which the joint is soft [N*m/rad]."""
        return float(self.quantity["soft_threshold"])

    def molten(self, celsius: Array) -> Array:
        """Share of the polymer that is molten as it is heated, even between the ends of its melting range."""
        melting = self.quantity["pcl_melting"]
        share = (celsius + 273.15 - melting.start) / (melting.end - melting.start)
        return np.asarray(np.clip(share, 0.0, 1.0))

    def parts(self, core: float, edge: float, plate: Array, hot: float, cold: float) -> PartTemperatures:
        """Return temperatures of the structure's parts [K] by those of core, plate beside the polymer, what lies on the
        polymer in slices, and the pads' sides [degC]."""
        kelvin, beside = 273.15, core + WAY_OUT * (edge - core)
        walls = 0.5 * (hot + cold) + kelvin
        return PartTemperatures(core + kelvin, beside + kelvin, list(plate + kelvin), walls, cold + kelvin)

    def stiffness(self, celsius: Array, shares: Array, slices: Array, parts: PartTemperatures) -> float:
        """Size of the dynamic stiffness at the hot point's frequency [N*m/rad].

        `celsius` has the shape (columns, slices); `shares` are the columns' of the stiffness where all are alike,
        `slices` are of the depth; of a block they are alike, as a squeezed film's share of them is counted.
        """
        q = self.quantity
        if not self.sheared and np.ptp(slices) > 1e-9:
            raise ValueError("a block's slices are alike")
        storage, loss = polymer.moduli(celsius + 273.15, 1.0 - self.molten(celsius), self.omega, q["pcl_rheology"])
        moments = np.full(len(celsius), q["pcl_moment"])
        if not self.sheared:
            soft = np.array([block.soft_share(*pair) for pair in zip(storage, loss, strict=True)])
            shape = q["shape_factor"]
            moments = moments * (1.0 + 2.0 * (shape / soft) ** 2) / (1.0 + 2.0 * shape**2)
        layer = np.sum(shares * moments / ((1.0 / (storage + 1j * loss)) @ slices)) / q["pcl_depth"]
        law = (q["structure_softening"], self.values["clamped_loss_factor"], q["lossless_compliance"])
        support = complex(*in_series(q["structure_compliances"], parts, *law))
        return float(abs(q["spring_stiffness"] + 1.0 / (1.0 / layer + 1.0 / support)))


def softening_time(joint: WarmJoint, course: Mapping[str, Array]) -> float:
    """Return when the joint is soft [s], by the heat solver's course of temperatures; infinite where it is not.

    Between two moments the stiffness falls as an exponential.
    """
    stiffness = np.array([
        joint.stiffness(
            columns, course["shares"], course["slices"], joint.parts(*(course[name][at] for name in _PARTS))
        )
        for at, columns in enumerate(course["columns"])
    ])  # fmt: skip
    below = np.flatnonzero(stiffness <= joint.soft)
    if not len(below) or below[0] == 0:
        return float("inf")
    pair = slice(below[0] - 1, below[0] + 1)
    return float(np.interp(-np.log(joint.soft), -np.log(stiffness[pair]), course["times"][pair]))


_PARTS = ("core", "edge", "plate", "hot", "cold")
