"""The controller on drawn modules, and in the exported FMU."""

import json
from dataclasses import replace
from pathlib import Path

import fmpy
import numpy as np
import pytest
from support import study_path

from tvimdesign.robot.fmu_file import write_fmu
from tvimdesign.simulation.control.controller import ControlledModule, Lags
from tvimdesign.simulation.control.sizing import controller_of
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule, resolve_study
from tvimdesign.solve.duty import LATE, OVERSHOOT, SHARE, WATCHED, control_of, drawn_modules
from tvimdesign.study import read_study

FROZEN = Path(__file__).parents[2] / "campaigns/frozen/studies"


def _optimum(name: str, draws: int) -> ResolvedModule:
    """Return the module that a shipped study came to."""
    study = read_study(study_path(name))
    chosen = json.loads((FROZEN / f"{name}.json").read_text())["chosen"]
    control = study.control.model_copy(update={"draws": draws})
    changed = {"vary": {}, "robust": None, "module": {**study.module, **chosen}, "control": control}
    return resolve_study(study.model_copy(update=changed))


@pytest.mark.slow
def test_drawn_modules_are_soft_in_their_own_time_and_do_not_overshoot():
    control = control_of(_optimum("elbow_printed", 16))
    assert control is not None
    assert control.overshoot < OVERSHOOT
    assert control.settling < LATE
    assert control.controlled.share > 0.9


STEP = 0.1


def _soft_after(fmu: Path, seconds: float, threshold: float, **start: float) -> tuple[float, float]:
    """Time until the joint is soft, and the highest temperature of the layer's hot face."""
    names = ["joint_impedance", "temperature_near_face"]
    columns = fmpy.simulate_fmu(
        str(fmu), stop_time=seconds, step_size=STEP, output_interval=STEP, start_values=start, output=names
    )
    soft = columns["joint_impedance"] <= threshold
    after = columns["time"][np.argmax(soft)] if np.any(soft) else np.inf
    return float(after), float(np.max(columns["temperature_near_face"]))


@pytest.mark.slow  # a compiler builds each module
@pytest.mark.parametrize("name", ["elbow_printed", "wrist_joint"])
def test_drawn_modules_are_controlled_in_fmpy(name, tmp_path):
    resolved = _optimum(name, 64)
    controller = controller_of(resolved)
    assert controller is not None
    model = resolved.functions
    drive = Simulator(model).constant_drive("softening", model.start)
    nominal = ControlledModule(model, model.start).uncontrolled(drive)
    good = []
    for drawn, lags in drawn_modules(resolved, resolved.study.control.draws):
        values = {**resolved.values, **dict(zip(model.names, drawn.tolist(), strict=True))}
        values["rotor_cells"] = resolved.values["rotor_cells"]
        control = resolved.study.control.model_copy(update={"driver_lag": lags.driver})
        module = replace(resolved, study=resolved.study.model_copy(update={"control": control}), values=values)
        fmu = write_fmu(module, tmp_path / "drawn.fmu", controller).path
        own = float(module.quantity("soft_threshold"))
        alone, _ = _soft_after(fmu, WATCHED * 2.0 * nominal, own, current=drive.currents[0])
        seconds = WATCHED * max(alone, nominal)
        start = {"impedance_command": controller.soft, "thermistor_lag": lags.thermistor}
        after, hottest = _soft_after(fmu, seconds, own, **start)
        good.append(hottest - controller.hottest < OVERSHOOT and after <= LATE * alone)
    print(f"{name}: {sum(good)} of {len(good)}")
    assert np.mean(good) >= SHARE


@pytest.mark.slow
def test_the_fmu_s_controller_is_the_simulated_one(tmp_path):
    resolved = _optimum("elbow_printed", 0)
    controller, model = controller_of(resolved), resolved.functions
    assert controller is not None
    written_fmu = write_fmu(resolved, tmp_path / "joint.fmu", controller)
    names = ["temperature_near_face", "impedance_estimate"]
    columns = fmpy.simulate_fmu(
        str(written_fmu.path), stop_time=100.0, step_size=STEP, output_interval=STEP, output=names,
        start_values={"impedance_command": 0.01},
    )  # fmt: skip
    course = ControlledModule(model, model.start).switch(controller, Lags(2.0, 0.05), 100.0)
    count = min(len(course.times), len(columns["time"]) - 1)
    assert columns["temperature_near_face"][1 : count + 1] == pytest.approx(course.near[:count], abs=0.1)
    assert columns["impedance_estimate"][1 : count + 1] == pytest.approx(course.impedances[:count], rel=0.02)
