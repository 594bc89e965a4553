"""The log of a module, simulated by CVODES and not by what is fitted: contacts and losses come back, and a record."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from cvodes_cycle import CvodesSimulator
from measured_files import csv, found, holds, measured
from support import study_path

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.kinds.heating_log import Course, LoggedModule
from tvimdesign.simulation.measurement.record_file import write_record
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule, resolve_study
from tvimdesign.study import read_study

STUDY = study_path("paper_reconstructed")
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


def test_its_course_is_that_of_cvodes_through_heating_and_cooling() -> None:
    module = LoggedModule(resolved(), [*MADE, "ambient_temperature"])
    rows = np.concatenate([np.round(np.linspace(0, 1, 20) ** 2 * 48), 48 + np.round(np.linspace(0, 1, 20) ** 2 * 96)])
    rows = np.unique(rows).astype(int)
    time = EVERY * rows
    course = Course(time, np.where(time[:-1] < HEATED, 1.5, 0.0), int(np.searchsorted(time, HEATED)))
    ambient = float(resolved().values["ambient_temperature"])
    found_ = module.temperatures(course, {**MADE, "ambient_temperature": ambient})
    for place, reference in simulated().items():
        mine = np.asarray(ca.evalf(ca.MX(found_[place]))).ravel()
        assert np.max(np.abs(mine - reference[rows])[1:]) < 0.1, place


@pytest.mark.slow
def test_contacts_and_losses_come_back_and_make_a_record(tmp_path: Path) -> None:
    path = log(tmp_path / "log.csv", noise=0.2, places=("hot_temperature", "far_face_temperature", "rotor_temperature"))
    result = measured(path, study=str(STUDY), fitted="rotor_contact rotor_coefficient")
    fit = result.measurement.fit
    for name, value in MADE.items():
        assert fit.value(name) == pytest.approx(value, rel=0.15)
        assert holds(fit[name], value)
    written = write_record(result, tmp_path / "mine", "bench_module")
    assert "based_on: handbook" in written.read_text()


@pytest.mark.slow
def test_one_thermocouple_cannot_tell_six_values_apart_and_says_so(tmp_path: Path) -> None:
    path = log(tmp_path / "log.csv", noise=0.2, places=("rotor_temperature",))
    result = found(path, study=str(STUDY))
    assert "6 values from 1 places" in " ".join(result.notes)
    assert any("apart" in said or "do not bound" in said for said in result.fit.words)


@pytest.mark.parametrize(
    ("columns", "given", "said"),
    [
        ({"rotor__degC": [22.0, 23.0, 24.0, 25.0]}, {}, "--set study=...: needed"),
        ({"rotor__degC": [22.0, 23.0, 24.0, 25.0]}, {"study": str(STUDY), "fitted": "rotor"}, "no contact or loss"),
        ({"rotor__degC": [22.0] * 4, "housing__degC": [30.0] * 4}, {"study": str(STUDY)}, "differ by 8.0 K"),
        ({"sink__degC": [22.0] * 4}, {"study": str(STUDY)}, "the module of the study has no such place"),
        ({"rotor__degC": [22.0] * 4, "current__A": [1.0, 0.0, 1.0, 0.0]}, {"study": str(STUDY)}, "one heating"),
    ],
)
def test_what_lacks_is_said(tmp_path: Path, columns: dict[str, object], given: dict[str, str], said: str) -> None:
    path = csv(tmp_path / "l.csv", **{"time__s": range(4), "current__A": [1.0] * 4, **columns})
    with pytest.raises(InputError, match=said):
        found(path, "heating_log", **given)
