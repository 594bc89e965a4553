"""The command robot, from a design to a finished folder: models, tables, FMU, and what the terminal shows."""

from pathlib import Path
from typing import Any

from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.page.blocks import Block, Points, Section
from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS
from tvimdesign.report.output.command import Command, design_file
from tvimdesign.report.output.numbers import curves_csv, head, number
from tvimdesign.report.output.page_sections import grid
from tvimdesign.report.output.terminal import Progress
from tvimdesign.robot.fmu_file import WrittenFmu, controller_files, write_fmu
from tvimdesign.robot.joint_model import JointModel, joint_model, make_bodies, refuse_step
from tvimdesign.robot.model_files import mjcf, ros2_control, sdf, urdf
from tvimdesign.simulation.control.sizing import controller_of
from tvimdesign.simulation.working_cycle.curves import impedance_sweep
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule, resolve_design
from tvimdesign.study.design import Design, read_design, write_design

Columns = dict[str, list[float]]
UNITS = {
    "temperature": "degC", "frequency": "Hz", "stiffness": "N*m/rad", "damping": "N*m*s/rad", "springs": "N*m/rad",
    "friction": "N*m", "relaxation_time": "s", "joint_stiffness": "N*m/rad", "joint_damping": "N*m*s/rad",
}  # fmt: skip
"""Of the columns; what is not here has none."""


def unit_of(column: str) -> str:
    """Return the unit of a column, also of its least and largest value."""
    return UNITS.get(column.removesuffix("_low").removesuffix("_high"), "1")


_STATE = ("temperature", "frequency", "stiffness", "damping", "springs", "friction")


def states(model: JointModel) -> Columns:
    """Tabulate for each state the whole joint's stiffness and damping by frequency, and its friction."""
    columns = {name: [getattr(state, name) for state in model.states] for name in _STATE}
    return {**columns, "temperature": [value - ZERO_CELSIUS for value in columns["temperature"]]}


def elements(model: JointModel) -> Columns:
    """Return a row for each Maxwell element of each state, beside the springs: all of the joint's linear behaviour."""
    rows = [(state.temperature - ZERO_CELSIUS, time, k) for state in model.states for time, k in state.modes]
    columns = map(list, zip(*rows, strict=True))
    return dict(zip(("temperature", "relaxation_time", "stiffness"), columns, strict=True))


def over_temperature(resolved: ResolvedModule, model: JointModel) -> Columns:
    """Tabulate the joint's stiffness and damping against temperature, at the hot point's frequency, as heated.

    `..._low` and `..._high` are the least and the largest over what the PCL's history allows.
    """
    swept = impedance_sweep(resolved)
    joint_columns = [name for name in swept if name.startswith(("joint_", "solid_fraction"))]
    frequency = float(resolved.quantity("frequency@hot"))
    count = len(swept["temperature"])
    return {
        "temperature": swept["temperature"],
        "frequency": [frequency] * count,
        **{name: swept[name] for name in joint_columns},
        "springs": [model.states[0].springs] * count,
    }


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
    """Write bodies, models, tables and FMU into a folder. Raises InputError, GeometryError."""
    refuse_step(step)
    resolved = resolve_design(design)
    written = write_design(design, folder.path / "design.json")
    base, moving, report = make_bodies(written, folder.path, lambda text: progress(f"bodies: {text}"))
    report.refuse_failed()
    progress("writing the robot models")
    model = joint_model(resolved, base, moving, step)
    for state in model.states:
        folder.write(f"joint_{state.point}.xml", mjcf(model, state))
        folder.write(f"joint_{state.point}.urdf", urdf(model, state))
        folder.write(f"joint_{state.point}.sdf", sdf(model, state))
    folder.write("joint.ros2_control.xacro", ros2_control(model))
    swept = over_temperature(resolved, model)
    for name, columns in (("states", states(model)), ("elements", elements(model)), ("temperatures", swept)):
        folder.write(f"{name}.csv", curves_csv(columns, {column: unit_of(column) for column in columns}, "1"))
    progress("building the FMU")
    controller = controller_of(resolved)
    fmu = write_fmu(resolved, folder.path / "joint.fmu", controller)
    for name, text in controller_files(controller).items():
        folder.write(f"controller/{name}", text)
    folder.write_json("joint.json", plain_model(model, fmu))
    return model, fmu


def plain_model(model: JointModel, fmu: WrittenFmu) -> dict[str, Any]:
    """Return what the models say, as plain data in SI."""
    return {
        **head(),
        "name": model.name,
        "time_step": model.step,
        "stroke": model.stroke,
        "stop_angle": model.stop_angle,
        "holding_torque": model.holding_torque,
        "load_inertia": model.load,
        "masses": {body.name: body.mass for body in (model.base, model.moving)},
        "states": {
            state.point: {
                **{name: getattr(state, name) for name in _STATE},
                "files": [f"joint_{state.point}.{ending}" for ending in ("xml", "urdf", "sdf")],
            }
            for state in model.states
        },
        "fmu": {"file": fmu.path.name, "platform": fmu.platform},
        "left_out": list(model.left_out),
    }


def model_blocks(model: JointModel, fmu: WrittenFmu) -> list[Block]:
    """Return the states, what the models leave out, and the FMU."""
    rows = [
        (state.point, *map(number, (state.temperature - ZERO_CELSIUS, state.stiffness, state.damping, state.frequency)))
        for state in model.states
    ]
    heads = ("state", "°C", "stiffness N·m/rad", "damping N·m·s/rad", "at Hz")
    return [grid("", heads, rows, right=(1, 2, 3, 4)), Points([*model.left_out, fmu.summary])]
