"""Everything of a joint for simulators in a folder: bodies, models of each state, FMU, controller, and the tables."""

from collections.abc import Callable

from tvimdesign.base.results_folder import ResultsFolder
from tvimdesign.physics.polymers.polymer import ZERO_CELSIUS
from tvimdesign.robot.fmu_file import WrittenFmu, controller_files, write_fmu
from tvimdesign.robot.joint_model import JointModel, joint_model, make_bodies, refuse_step
from tvimdesign.robot.model_files import mjcf, ros2_control, sdf, urdf
from tvimdesign.simulation.control.sizing import controller_of
from tvimdesign.simulation.working_cycle.curves import impedance_sweep
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule, resolve_design
from tvimdesign.study import Design, write_design

Columns = dict[str, list[float]]
UNITS = {
    "temperature": "degC", "frequency": "Hz", "stiffness": "N*m/rad", "damping": "N*m*s/rad", "springs": "N*m/rad",
    "friction": "N*m", "relaxation_time": "s", "joint_stiffness": "N*m/rad", "joint_damping": "N*m*s/rad",
}  # fmt: skip
"""Of the columns; what is not here has none."""


def _unit_of(column: str) -> str:
    """Return the unit of a column, also of its least and largest value."""
    return UNITS.get(column.removesuffix("_low").removesuffix("_high"), "1")


def _states(model: JointModel) -> Columns:
    """Tabulate for each state the whole joint's stiffness and damping by frequency, and its friction."""
    columns = {name: [state.plain[name] for state in model.states] for name in model.states[0].plain}
    return {**columns, "temperature": [value - ZERO_CELSIUS for value in columns["temperature"]]}


def _elements(model: JointModel) -> Columns:
    """Return a row for each Maxwell element of each state, beside the springs: all of the joint's linear behaviour."""
    rows = [(state.temperature - ZERO_CELSIUS, time, k) for state in model.states for time, k in state.modes]
    columns = map(list, zip(*rows, strict=True))
    return dict(zip(("temperature", "relaxation_time", "stiffness"), columns, strict=True))


def _over_temperature(resolved: ResolvedModule, model: JointModel) -> Columns:
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


def write_joint(
    design: Design, folder: ResultsFolder, step: float | None, progress: Callable[[str], None]
) -> tuple[JointModel, WrittenFmu, dict[str, tuple[Columns, dict[str, str]]]]:
    """Write bodies, models and FMU into a folder; return the tables, with units. Raises InputError, GeometryError."""
    refuse_step(step)
    resolved = resolve_design(design)
    written = write_design(design, folder.path / "design.json")
    base, moving, report = make_bodies(written, folder.path, lambda text: progress(f"bodies: {text}"))
    report.refuse_failed()
    progress("writing the robot models")
    model = joint_model(resolved, base, moving, step)
    for state in model.states:
        for ending, of in (("xml", mjcf), ("urdf", urdf), ("sdf", sdf)):
            folder.write(f"joint_{state.point}.{ending}", of(model, state))
    folder.write("joint.ros2_control.xacro", ros2_control(model))
    swept = _over_temperature(resolved, model)
    progress("building the FMU")
    controller = controller_of(resolved)
    fmu = write_fmu(resolved, folder.path / "joint.fmu", controller)
    for name, code in controller_files(controller).items():
        folder.write(f"controller/{name}", code)
    tables = {"states": _states(model), "elements": _elements(model), "temperatures": swept}
    return model, fmu, {name: (table, {each: _unit_of(each) for each in table}) for name, table in tables.items()}
