"""FMPy runs the FMU: heat as in the run, torque as the joint's stiffness and damping say."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import cache
from pathlib import Path
from shutil import rmtree
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.fmi2 import FMU2Slave
from robot_models import module_of

from tvimdesign.robot.fmu_file import write_fmu
from tvimdesign.simulation.joint_tests.release import ANGLE, release
from tvimdesign.simulation.working_cycle.curves import Curves, phase_history, temperature_names
from tvimdesign.simulation.working_cycle.cycle import TOLERANCE, Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, ResolvedModule
from tvimdesign.solve.duty import Duty

pytestmark = pytest.mark.slow  # a compiler builds each
SHARE = 0.005
"""That the FMU's cycle may be off the run's."""
STEP = 0.5
"""Communication step of heat [s]."""


@cache
def _run(mode: str) -> tuple[DeviceFunctions, Mapping[str, float], dict[str, Curves]]:
    resolved = module_of(mode)
    model = resolved.functions
    cycle = Simulator(model).run(model.start)
    phases = ("softening", "stiffening")
    return model, cycle.values, {n: phase_history(model, model.start, cycle.trajectories[n], n) for n in phases}


@pytest.fixture(scope="module")
def fmus(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("fmus")
    return {mode: write_fmu(module_of(mode), folder / f"{mode}.fmu").path for mode in ("shear", "compression")}


class _Joint:
    """The FMU, by the names of its variables."""

    def __init__(self, slave: FMU2Slave, references: Mapping[str, int]) -> None:
        self.slave, self.references, self.time = slave, references, 0.0

    def set(self, **values: float) -> None:
        self.slave.setReal([self.references[name] for name in values], list(values.values()))

    def get(self, *names: str) -> Any:
        return np.array(self.slave.getReal([self.references[name] for name in names]))

    def step(self, seconds: float) -> None:
        self.slave.doStep(currentCommunicationPoint=self.time, communicationStepSize=seconds)
        self.time += seconds

    def heat(self, current: float, seconds: float) -> None:
        self.set(current=current)
        count = int(np.ceil(seconds / STEP))
        for _ in range(count):
            self.step(seconds / count)


@contextmanager
def _joint(fmu: Path, **start: float) -> Iterator[_Joint]:
    description = fmpy.read_model_description(str(fmu))
    unpacked = fmpy.extract(str(fmu))
    slave = FMU2Slave(
        guid=description.guid, unzipDirectory=unpacked, instanceName="joint",
        modelIdentifier=description.coSimulation.modelIdentifier,
    )  # fmt: skip
    slave.instantiate()
    slave.setupExperiment(startTime=0.0)
    joint = _Joint(slave, {variable.name: variable.valueReference for variable in description.modelVariables})
    slave.enterInitializationMode()
    joint.set(**start)
    slave.exitInitializationMode()
    try:
        yield joint
    finally:
        slave.terminate()
        slave.freeInstance()
        rmtree(unpacked)


def _cycle(mode: str, fmu: Path) -> tuple[Any, float]:
    """Return the FMU's columns over softening and stiffening, and when the first ends [s]."""
    model, _, phases = _run(mode)
    first, second = (phases[name]["time"][-1] for name in ("softening", "stiffening"))
    heating, cooling = (float(model.start[model.index[name]]) for name in ("current", "cooling_current"))
    kind = [("time", float), ("current", float)]
    driven = [(0.0, heating), (first, heating), (first, -cooling), (first + 1.05 * second, -cooling)]
    columns = fmpy.simulate_fmu(
        str(fmu), stop_time=driven[-1][0], step_size=STEP, output_interval=STEP, input=np.array(driven, dtype=kind),
        start_values={"angle": 0.0, "ambient_temperature": float(model.start[model.index["ambient_temperature"]])},
        output=["joint_impedance", "electrical_power", *_TEMPERATURES],
    )  # fmt: skip
    return columns, first


_TEMPERATURES = {f"temperature_{place}": place for place in ("near_face", "far_face", "core_and_link", "housing")}


def test_temperatures_are_those_of_the_run(mode, fmus):
    columns, turned = _cycle(mode, fmus[mode])
    for name, start in (("softening", 0.0), ("stiffening", turned)):
        curves = _run(mode)[2][name]
        times = np.array(curves["time"]) + start
        # The step in which the current changes is the client's, not the joint's.
        seen = times > start + STEP
        for variable, place in _TEMPERATURES.items():
            column = np.interp(times, columns["time"], columns[variable]) - 273.15
            expected = np.array(curves[place])
            assert np.max(np.abs(column - expected)[seen]) < SHARE * np.ptp(curves["near_face"]), (name, place)


def _softened_evenly(model: DeviceFunctions) -> tuple[float, float]:
    """Return time [s] and impedance [N*m/rad] at which a layer is soft that melts alike over its width, as the FMU's.

    The run's melts last at its edges.
    """
    engine, inputs = model.either_way_engine, model.start
    drive = Simulator(model).constant_drive("softening", inputs)
    start, horizon = np.asarray(engine.phase.initial(inputs)).ravel(), float(inputs[model.index["horizon"]])
    _, moments, _ = engine.simulate(inputs, drive, start, ["softening_time"], horizon, TOLERANCE, going_on=True)
    soft = moments["softening_time"]
    return soft.time, float(engine.phase.watch(["impedance_now"])(soft.state[: engine.size], soft.current, inputs))


def _stiffened(mode: str) -> tuple[float, float]:
    """Return time [s] and impedance [N*m/rad] at which the run is stiff."""
    _, values, phases = _run(mode)
    time, curves = values["stiffening_time"], phases["stiffening"]
    return time, float(np.interp(time, curves["time"], curves["joint_impedance"]))


def test_it_softens_and_stiffens_when_the_run_does(mode, fmus):
    columns, turned = _cycle(mode, fmus[mode])
    for (time, level), start, sense in ((_softened_evenly(_run(mode)[0]), 0.0, -1.0), (_stiffened(mode), turned, 1.0)):
        during = (columns["time"] > start + STEP) & (columns["time"] <= start + 1.05 * time)
        beyond = sense * (columns["joint_impedance"][during] - level)
        last = int(np.flatnonzero(beyond < 0.0)[-1])  # the last time that it passes the level
        share = beyond[last] / (beyond[last] - beyond[last + 1])
        assert columns["time"][during][last] + share * STEP - start == pytest.approx(time, rel=SHARE)


def test_it_takes_the_energy_of_the_run(mode, fmus):
    columns, _ = _cycle(mode, fmus[mode])
    phases = _run(mode)[2].values()
    expected = sum(curves["electrical_energy"][-1] for curves in phases)
    seen = columns["time"] <= sum(curves["time"][-1] for curves in phases)
    assert np.trapezoid(columns["electrical_power"][seen], columns["time"][seen]) == pytest.approx(expected, rel=SHARE)


PERIODS, SAMPLES = 3, 400
"""What is viscous lags by half a sample, as the angle is straight between two of them."""


def _stiffness_and_damping(joint: _Joint, frequency: float, amplitude: float) -> tuple[float, float]:
    """Of the last period of a sine, from the torque alone."""
    turns = 2.0 * np.pi * np.arange(1, PERIODS * SAMPLES + 1) / SAMPLES
    torques = []
    for turn in turns:
        joint.set(angle=amplitude * float(np.sin(turn)))
        joint.step(1.0 / frequency / SAMPLES)
        torques.append(joint.get("torque")[0])
    last = slice(-SAMPLES, None)
    return tuple(
        float(-2.0 * np.mean(np.array(torques)[last] * wave(turns[last])) / amplitude / by)
        for wave, by in ((np.sin, 1.0), (np.cos, 2.0 * np.pi * frequency))
    )


@pytest.mark.parametrize("ambient", [295.15, 343.15, 373.15])
def test_the_torque_of_a_sine_has_the_joint_s_stiffness_and_damping(fmus, ambient):
    # Of a bonded layer: blocks that only push leave the link for a part of each period.
    with _joint(fmus["shear"], ambient_temperature=ambient) as joint:
        frequency, *expected = (float(value) for value in joint.get("frequency", "joint_stiffness", "joint_damping"))
        stiffness_and_damping = _stiffness_and_damping(joint, frequency, 1e-3)
    assert stiffness_and_damping == pytest.approx(tuple(expected), rel=SHARE)


def test_what_freezes_turned_stays_turned(fmus):
    model, values, _ = _run("shear")
    heating, cooling = (float(model.start[model.index[name]]) for name in ("current", "cooling_current"))
    springs = float(module_of("shear").quantity("spring_stiffness"))
    with _joint(fmus["shear"]) as joint:
        joint.heat(heating, values["response_time"])
        joint.set(angle=0.1)
        joint.heat(-cooling, 1.2 * values["stiffening_time"])
        held, stiff = joint.get("torque", "joint_stiffness")
        joint.set(angle=0.101)
        joint.step(0.05)
        more = joint.get("torque")[0]
        joint.set(angle=0.0)
        joint.heat(heating, values["response_time"])
        let_go = joint.get("torque")[0]
    assert held == pytest.approx(-0.1 * springs, rel=0.02)  # of a melt that is held still the springs are left
    assert (held - more) / 1e-3 == pytest.approx(stiff, rel=0.1)  # quicker than the 1 Hz at which that is stated
    assert abs(let_go) < 1e-3 * springs


def _borne(resolved: ResolvedModule) -> float:
    """Return the virtual test's angle [rad], or that at which the frozen joint bears 0.8 of its holding torque."""
    stiffness, most = (float(resolved.quantity(name)) for name in ("joint_stiffness@cold", "holding_torque"))
    return min(ANGLE, 0.8 * most / stiffness)


def test_a_link_let_go_moves_as_in_the_virtual_test(mode, fmus):
    resolved = module_of(mode)
    ambient = float(resolved.quantity("ambient_temperature"))  # where all of the structure is as cold as the PCL
    # The virtual test's structure follows its law from 0.1 to 100 Hz: hold and motion are in that band.
    changed = {
        "temperature@cold": ambient,
        "hold_time": 1.0,
        "moving_inertia": 20.0 * resolved.values["moving_inertia"],
    }
    resolved = replace(resolved, values={**resolved.values, **changed})
    # The FMU neither yields nor slips; the virtual test does beyond the holding torque.
    trial = release(resolved, _borne(resolved), kelvin_voigt=False)
    sheet = next(table for table in trial.sheets if table.name in {"release_cold", "release_cold_nominal"})
    times, expected = sheet.column("time").values, sheet.column("angle").values
    inertia, step, seconds = float(resolved.quantity("moving_inertia")), 5e-5, 0.1
    angle = expected[0]
    angles = [angle]
    with _joint(fmus[mode]) as joint:
        joint.set(angle=angle)
        joint.step(1e-6)  # turned at once, then held
        joint.step(1.0)
        speed = -0.5 * step * joint.get("torque")[0] / inertia  # the speed is given half a step before the angle
        for _ in range(int(seconds / step)):
            torque, friction = joint.get("torque", "pin_friction_torque")
            speed += step * (torque - friction * np.sign(speed)) / inertia
            angle += step * speed
            joint.set(angle=angle)
            joint.step(step)
            angles.append(angle)
    seen = times < seconds
    turned = np.interp(times[seen], step * np.arange(len(angles)), angles)
    assert np.max(np.abs(turned - expected[seen])) < 0.01 * expected[0]


def test_a_state_that_is_kept_goes_on_as_it_did(fmus):
    with _joint(fmus["compression"]) as joint:
        joint.heat(1.0, 5.0)
        joint.set(angle=0.02)
        state = joint.slave.getFMUState()
        joint.step(1.0)
        once = joint.get("torque", "temperature_hot_side")
        joint.slave.setFMUState(state)
        joint.set(angle=0.02)
        joint.step(1.0)
        assert np.array_equal(joint.get("torque", "temperature_hot_side"), once)
        joint.slave.freeFMUState(state)


DUTY_STEP = 5.0
"""Communication step of repeated switching [s]."""


def test_its_temperatures_after_fifty_cycles_are_those_of_the_duty(mode, fmus):
    resolved = module_of(mode)
    model = resolved.functions
    duty = Duty(model, model.start, {}, soft := 60.0)
    first = duty.cycle(duty.ambient, 0.0)
    assert first is not None
    period = 1.2 * first.taken
    settled = duty.periodic(period)
    assert settled is not None
    state, cycle = settled
    times = [cycle.values["response_time"], soft, cycle.values["return_time"], period - cycle.taken]
    assert duty.hold is not None
    currents = [duty.drives["softening"].currents[0], duty.hold.currents[0], duty.drives["stiffening"].currents[0], 0.0]
    seen = np.asarray(model.either_way.temperatures(state, 0.0, model.start)).ravel()
    expected = dict(zip(temperature_names(model, model.start, "softening"), seen, strict=True))
    with _joint(fmus[mode], ambient_temperature=float(model.start[model.index["ambient_temperature"]])) as joint:
        for _ in range(50):
            for current, seconds in zip(currents, times, strict=True):
                joint.set(current=current)
                for _ in range(count := int(np.ceil(seconds / DUTY_STEP))):
                    joint.step(seconds / count)
        reached = joint.get(*_TEMPERATURES)
    assert reached == pytest.approx([expected[place] for place in _TEMPERATURES.values()], abs=1.0)
