"""Sines and logs of a module: what is fitted to them, against closed forms and CVODES."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from cvodes_cycle import CvodesSimulator
from measured_files import csv, fit_files, holds, measured, turned
from support import cases_of, study_path

from tvimdesign.base.errors import CatalogError, InputError
from tvimdesign.catalog import Catalog
from tvimdesign.simulation.measurement.kinds.heating_log import Course, LoggedModule
from tvimdesign.simulation.measurement.kinds.joint_of_module import JointOfModule
from tvimdesign.simulation.measurement.record_file import write_record, write_records
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions, ResolvedModule, resolve_study
from tvimdesign.solve.uncertainty.uncertain_inputs import unmeasured_inputs
from tvimdesign.study import read_study

STUDY = study_path("paper_reconstructed")
INERTIA = 4.3e-4
SIZE = 0.05


def joints(folder: Path, stiffness: float, damping: float, friction: float, hertz: tuple[float, ...]) -> list[Path]:
    joint = INERTIA, stiffness, damping, friction
    return [turned(folder / f"{rate}.csv", rate, seed, joint, SIZE, (1e-5, 1e-4)) for seed, rate in enumerate(hertz)]


@pytest.fixture(scope="module")
def module() -> ResolvedModule:
    return resolve_study(read_study(STUDY))


def test_a_molten_joint_tells_its_springs_its_melt_and_its_pins(tmp_path, module):
    # So slow that the melt only flows: T = eta J/t theta', and the springs' stiffness is as their modulus.
    springs, moment = float(module.quantity("spring_stiffness")), float(module.quantity("layer_polar_moment"))
    viscosity, modulus, coefficient = 5000.0, 195e9, 0.31
    damping = viscosity * moment / float(module.values["pcl_thickness"])
    stiffness = springs * modulus / float(module.values["spring_youngs_modulus"])
    friction = coefficient / 0.25 * float(module.quantity("pin_friction_torque"))
    paths = joints(tmp_path, stiffness, damping, friction, (0.01, 0.03))
    result = fit_files(paths, "sine", study=str(STUDY), state="molten", inertia="4.3e-4 kg.m^2")
    assert module.values["pin_friction"] == 0.25
    assert result.fit.value("spring_youngs_modulus") == pytest.approx(modulus, rel=5e-3)
    assert result.fit.value("pcl_zero_shear_viscosity") == pytest.approx(viscosity, rel=0.01)
    assert result.record_values["pin_friction"].value == pytest.approx(coefficient, rel=0.01)
    assert {record.choice: list(record.values) for record in result.more_records} == {
        "spring_material": ["youngs_modulus"], "pcl_grade": ["zero_shear_viscosity"],
    }  # fmt: skip


def test_a_molten_joint_tells_the_friction_of_its_dowel_pins(tmp_path):
    study = tmp_path / "pinned.yaml"
    pins = "module:\n  leg_pin: iso_8734_4\n  leg_pin_length: 10 mm\n"
    study.write_text(STUDY.read_text(encoding="utf-8").replace("module:\n", pins, 1), encoding="utf-8")
    pinned = resolve_study(read_study(study))
    friction = 0.21 / 0.15 * float(pinned.quantity("pin_friction_torque"))
    damping = 5000.0 * float(pinned.quantity("layer_polar_moment")) / float(pinned.values["pcl_thickness"])
    paths = joints(tmp_path, float(pinned.quantity("spring_stiffness")), damping, friction, (0.01, 0.03))
    result = fit_files(paths, "sine", study=str(study), state="molten", inertia="4.3e-4 kg.m^2")
    assert result.record_values["pin_friction"].value == pytest.approx(0.21, rel=0.01)


def test_a_melt_that_thins_over_a_wide_motion_is_known_by_its_amplitude(module):
    # At one hertz the same stiffness and damping over a wider motion are a longer melt's: strained more, it thins.
    of = {size: JointOfModule(module, STUDY, "molten", 2.0 * np.pi, size) for size in (0.01, 0.1)}
    seen = dict(zip(("stiffness", "damping"), of[0.1].impedance({}), strict=True))
    viscosity = {size: float(fit.derived()[1].formula(seen)) for size, fit in of.items()}
    assert viscosity[0.1] == pytest.approx(float(module.values["pcl_zero_shear_viscosity"]), rel=1e-6)
    assert viscosity[0.01] < 0.9 * viscosity[0.1]


def test_a_frozen_joint_tells_its_pads_and_a_run_counts_them_as_measured(tmp_path, module):
    names = ["joint_stiffness@cold", "joint_damping@cold"]
    softer = {**module.values, "heater_shear_modulus": 3e6, "clamped_loss_factor": 0.04, "frequency@cold": 1.0}
    stiffness, damping = map(float, module.table.evaluate(softer, names).values())
    paths = joints(tmp_path, stiffness, damping, 0.0, (1.0, 8.0))
    result = measured(paths, "sine", study=str(STUDY), state="frozen")
    written = write_records(result, tmp_path / "mine", "bench")
    assert list(written) == ["joint", "heater_module"]
    study = STUDY.read_text().replace(
        "\nmodule:", "\ncatalog: mine\nmodule:\n  joint: bench\n  heater_module: bench", 1
    )
    (tmp_path / "study.yaml").write_text(study)
    inputs = {
        assumed.name: assumed for assumed in unmeasured_inputs(resolve_study(read_study(tmp_path / "study.yaml")))
    }
    pads, loss = inputs["heater_shear_modulus"], inputs["clamped_loss_factor"]
    assert (pads.status, loss.status) == ("measured", "measured")
    assert pads.low < 3e6 < pads.high
    assert loss.low < 0.04 < loss.high
    assert loss.before == (0.002, 0.06)
    earlier = Catalog().record("heaters", "flexible_1600").entry("shear_modulus")
    assert pads.before == (earlier.low, earlier.high)


def test_what_no_value_of_the_module_explains_goes_to_no_record(tmp_path):
    # Stiffer than the structure is behind rigid pads.
    paths = joints(tmp_path, 2e4, 3.0, 0.0, (1.0, 8.0))
    result = measured(paths, "sine", study=str(STUDY), state="frozen", inertia="4.3e-4 kg.m^2")
    assert not result.measurement.more_records
    with pytest.raises(InputError, match="neither is written to a record"):
        write_records(result, tmp_path / "mine", "bench")


def test_a_release_with_a_known_inertia_writes_records_too(tmp_path, module):
    names = ["joint_stiffness@cold", "joint_damping@cold"]
    stiffness = float(module.quantity(names[0]))
    omega = float(np.sqrt(stiffness / INERTIA))
    values = {**module.values, "frequency@cold": omega / (2.0 * np.pi)}
    stiffness, damping = map(float, module.table.evaluate(values, names).values())
    decay = damping / (2.0 * INERTIA)
    ringing = np.sqrt(stiffness / INERTIA - decay**2) if decay < omega else 0.0
    time = np.linspace(0.0, 6.0 / omega * 2.0 * np.pi, 200)
    angle = 0.002 * np.exp(-decay * time) * (np.cos(ringing * time) + decay / ringing * np.sin(ringing * time))
    path = csv(tmp_path / "r.csv", time__s=time, angle__rad=angle + np.random.default_rng(1).normal(0.0, 2e-6, 200))
    result = fit_files(path, "release", inertia="4.3e-4 kg.m^2", study=str(STUDY), state="frozen")
    assert result.fit.value("heater_shear_modulus") == pytest.approx(module.values["heater_shear_modulus"], rel=0.05)
    assert [record.choice for record in result.more_records] == ["heater_module"]


def test_no_record_of_several_stays_where_one_cannot(tmp_path, module):
    names = ["joint_stiffness@cold", "joint_damping@cold"]
    stiffness, damping = (float(module.quantity(name)) for name in names)
    result = measured(joints(tmp_path, stiffness, damping, 0.0, (1.0, 8.0)), "sine", study=str(STUDY), state="frozen")
    folder = tmp_path / "mine"
    (folder / "heaters").mkdir(parents=True)
    (folder / "heaters" / "flexible_1600.yaml").write_text("title: broken\n")
    with pytest.raises(CatalogError):
        write_records(result, folder, "bench")
    assert not (folder / "joints" / "bench.yaml").exists()


def test_the_state_is_asked_for(tmp_path):
    with pytest.raises(InputError, match="--set state"):
        fit_files(joints(tmp_path, 5.0, 0.1, 0.0, (1.0, 8.0)), "sine", study=str(STUDY))


MADE = {"rotor_contact": 2500.0, "rotor_coefficient": 9.0}
HEATED, COOLED, EVERY = 240.0, 480.0, 5.0


@cache
def resolved() -> ResolvedModule:
    return resolve_study(read_study(STUDY))


@cache
def simulated() -> Mapping[str, np.ndarray]:
    """Temperatures [K] of the module with `MADE`, heated at 1.5 A, then left to the air, every five seconds."""
    module = resolved()
    model = DeviceFunctions(module.table, {**module.values, **MADE}, module.points, module.study.solver.cells)
    rows = {"hot_temperature": 1, "far_face_temperature": 31, "rotor_temperature": 39}
    seen, before = [], None
    for phase, seconds, current in (("softening", HEATED, 1.5), ("stiffening", COOLED, 0.0)):
        simulator = CvodesSimulator(model, 1e-8, int(seconds / EVERY))
        course = simulator.trace(phase, model.start, before, seconds, current)
        before, count = course.states[:, -1], len(course.times)
        inputs = np.repeat(model.start[:, None], count, axis=1)
        every = model.phases[phase].temperatures.map(count)(course.states, course.currents[None, :], inputs)
        seen.append(np.asarray(every)[list(rows.values())])
    whole = np.concatenate([seen[0], seen[1][:, 1:]], axis=1)
    return dict(zip(rows, whole, strict=True))


def log(path: Path, *, noise: float, places: tuple[str, ...]) -> Path:
    time = np.arange(0.0, HEATED + COOLED + 1.0, EVERY)
    draw = np.random.default_rng(1)
    columns = {f"{place}__degC": simulated()[place] - 273.15 + draw.normal(0.0, noise, len(time)) for place in places}
    return csv(path, time__s=time, current__A=np.where(time < HEATED, 1.5, 0.0), **columns)


def test_its_course_is_that_of_cvodes_through_heating_and_cooling():
    module = LoggedModule(resolved(), [*MADE, "ambient_temperature"])
    rows = np.concatenate([np.round(np.linspace(0, 1, 20) ** 2 * 48), 48 + np.round(np.linspace(0, 1, 20) ** 2 * 96)])
    rows = np.unique(rows).astype(int)
    time = EVERY * rows
    course = Course(time, np.where(time[:-1] < HEATED, 1.5, 0.0), int(np.searchsorted(time, HEATED)))
    ambient = float(resolved().values["ambient_temperature"])
    temperatures = module.temperatures(course, {**MADE, "ambient_temperature": ambient})
    for place, reference in simulated().items():
        mine = np.asarray(ca.evalf(ca.MX(temperatures[place]))).ravel()
        assert np.max(np.abs(mine - reference[rows])[1:]) < 0.1, place


@pytest.mark.slow
def test_contacts_and_losses_come_back_and_make_a_record(tmp_path):
    path = log(tmp_path / "log.csv", noise=0.2, places=("hot_temperature", "far_face_temperature", "rotor_temperature"))
    result = measured(path, study=str(STUDY), fitted="rotor_contact rotor_coefficient")
    fit = result.measurement.fit
    for name, value in MADE.items():
        assert fit.value(name) == pytest.approx(value, rel=0.15)
        assert holds(fit[name], value)
    written = write_record(result, tmp_path / "mine", "bench_module")
    assert "based_on: handbook" in written.read_text()


@pytest.mark.slow
def test_a_single_thermocouple_leaves_six_values_open_and_the_fit_says_so(tmp_path):
    path = log(tmp_path / "log.csv", noise=0.2, places=("rotor_temperature",))
    result = fit_files(path, study=str(STUDY))
    assert "6 values from 1 places" in " ".join(result.notes)
    assert any("apart" in sentence or "do not bound" in sentence for sentence in result.fit.words)


@cases_of("joint_of_module", "lacks")
def test_a_lack_is_reported(tmp_path, columns, given, message):
    path = csv(tmp_path / "l.csv", **{"time__s": range(4), "current__A": [1.0] * 4, **columns})
    with pytest.raises(InputError, match=message):
        fit_files(path, "heating_log", **{of: value for of, value in {"study": str(STUDY), **given}.items() if value})
