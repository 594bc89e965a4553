"""The command robot, from a design to a finished folder: models, tables, FMU, and what the terminal shows."""

from pathlib import Path
from typing import Any

from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.report.output.command import Command, design_file
from tvimdesign.report.output.numbers import curves_csv, head, in_unit, number
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.terminal import Progress
from tvimdesign.report.page.blocks import Block, Points, Section
from tvimdesign.robot.fmu_file import WrittenFmu
from tvimdesign.robot.joint_folder import write_joint
from tvimdesign.robot.joint_model import JointModel
from tvimdesign.study import Design, read_design


def write_robot(path: Path, out: Path, step: float | None, *, overwrite: bool, as_json: bool) -> None:
    """Write the joint of a design.json, or of the folder of a run. Raises InputError, GeometryError."""
    source = design_file(path)
    design = read_design(source)
    with Command(out, overwrite=overwrite, as_json=as_json) as command:
        model, fmu = write_models(design, command.folder, step, command.progress)
        title = f"{model.name}: joint for simulators, time step {number(1e3 * model.step)} ms"
        command.headline, command.shown = title, [Section("states", "", model_blocks(model, fmu))]
        command.finish("written", {"design": source}, design.study)
    command.report(plain_model(model, fmu), "MJCF, URDF, SDF, FMU, meshes and tables are")


def write_models(
    design: Design, folder: ResultsFolder, step: float | None, progress: Progress
) -> tuple[JointModel, WrittenFmu]:
    """Write bodies, models, FMU and tables into a folder. Raises InputError, GeometryError."""
    model, fmu, tables = write_joint(design, folder, step, progress)
    for name, (columns, units) in tables.items():
        folder.write(f"{name}.csv", curves_csv(columns, units, "1"))
    folder.write_json("joint.json", plain_model(model, fmu))
    return model, fmu


def plain_model(model: JointModel, fmu: WrittenFmu) -> dict[str, Any]:
    """Return what the models say, as plain data in SI."""
    return {
        **head(),
        "name": model.name, "time_step": model.step, "stroke": model.stroke, "stop_angle": model.stop_angle,
        "holding_torque": model.holding_torque, "load_inertia": model.load,
        "masses": {body.name: body.mass for body in (model.base, model.moving)},
        "states": {
            state.point: {
                **state.plain,
                "files": [f"joint_{state.point}.{ending}" for ending in ("xml", "urdf", "sdf")],
            }
            for state in model.states
        },
        "fmu": {"file": fmu.path.name, "platform": fmu.platform},
        "left_out": list(model.left_out),
    }  # fmt: skip


def model_blocks(model: JointModel, fmu: WrittenFmu) -> list[Block]:
    """Return the states, what the models leave out, and the FMU."""
    rows = [
        (state.point, in_unit(state.temperature, "degC"), number(state.stiffness), number(state.damping),
         number(state.frequency))
        for state in model.states
    ]  # fmt: skip
    heads = ("state", "°C", "stiffness N·m/rad", "damping N·m·s/rad", "at Hz")
    return [grid("", heads, rows, right=(1, 2, 3, 4)), Points([*model.left_out, fmu.summary])]
