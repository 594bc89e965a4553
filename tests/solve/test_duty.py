"""Repeated switching: its periodic state against many cycles, its limit, and what a study reports."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from answers import shipped_answer
from numpy.typing import NDArray
from robot_models import module_of
from scipy.integrate import solve_ivp
from support import study_path

from tvimdesign.base.errors import InputError
from tvimdesign.physics.heat_flow import heat, lumps
from tvimdesign.report.output.tables import control_entry, duty_entry
from tvimdesign.report.run.blocks.facts import main_facts
from tvimdesign.report.run.blocks.more_facts import more_facts
from tvimdesign.report.run.reasons import complaint
from tvimdesign.simulation.working_cycle.symbols import ca, symbols
from tvimdesign.solve.duty import HOUR, Duty, DutyCycle, duty_of
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import Study, read_study
from tvimdesign.study.reader import read_study_text
from tvimdesign.study.sections import written
from tvimdesign.study.study import Requirement
from tvimdesign.study.tree import tree_of_text
from tvimdesign.sweep.plan import plan_of

pytestmark = pytest.mark.gate
SOFT = 60.0


@cache
def _duty(mode: str) -> Duty:
    resolved = module_of(mode)
    return Duty(resolved.functions, resolved.functions.start, {}, SOFT)


@cache
def _returning(mode: str) -> tuple[Duty, DutyCycle, float, tuple[NDArray[np.float64], DutyCycle]]:
    """Return a duty, its first cycle, a period of a fifth more, and the periodic state with its cycle."""
    duty = _duty(mode)
    first = duty.cycle(duty.ambient, 0.0)
    assert first is not None
    period = 1.2 * first.taken
    returning = duty.periodic(period)
    assert returning is not None
    return duty, first, period, returning


@pytest.mark.parametrize("mode", ["shear", pytest.param("compression", marks=pytest.mark.slow)])
def test_fifty_cycles_end_in_the_periodic_state(mode):
    duty, first, period, (state, cycle) = _returning(mode)
    now, last = duty.ambient, first
    for _ in range(50):
        step = duty.cycle(now, period)
        assert isinstance(step, DutyCycle)
        now, last = step.end, step
    rise = np.max(np.abs(state - duty.ambient)[: duty.heat])
    assert np.max(np.abs(now - state)[: duty.heat]) < 0.01 * rise
    assert last.energy == pytest.approx(cycle.energy, rel=0.01)
    assert last.values == pytest.approx(cycle.values, rel=0.01)
    # It begins warmer than ambient, so that it is soft sooner and stiff later than once.
    assert cycle.values["response_time"] < duty.cold.values["response_time"]
    assert cycle.values["return_time"] > duty.cold.values["return_time"]
    assert 0.0 < duty.settling(state, period) < 50.0 * period


def _lost(now: heat.Profile, stack: heat.Stack, current: Any) -> Any:
    """Heat that all surfaces and links give to the air [W]."""
    bodies, temperatures = (*stack.beside, *stack.around), (*now.beside, *now.around)
    faces = [(body.surface, at) for body, at in zip(bodies, temperatures, strict=True)]
    faces.append((stack.cold_surface, now.cold) if stack.sink is None else (stack.sink.surface, now.sink[0]))
    by_links = heat._linked(now, stack, current)["ambient"][0]
    return sum(lumps.surface_heat(*face, stack.ambient) for face in faces) + now.through_plate[-1] + by_links


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_the_heat_of_a_period_is_lost_in_it(mode):
    duty, _, period, (state, cycle) = _returning(mode)
    assert duty.hold is not None
    up, back = (float(duty.drives[name].currents[0]) for name in ("softening", "stiffening"))
    phases = (
        (duty.heating, up, cycle.values["response_time"]),
        (duty.heating, float(duty.hold.currents[0]), SOFT),
        (duty.cooling, back, cycle.values["return_time"]),
        (duty.cooling, 0.0, period - cycle.taken),
    )
    # LSODA in place of the engine's steps; beside the state what comes in and what is lost.
    y = np.append(state, [0.0, 0.0])
    for engine, current, seconds in phases:
        compiled = engine.phase
        stack, drive = compiled._stack, symbols(compiled._drive)[0]

        def columns(rates: Any, now: heat.Profile, stack: heat.Stack = stack, drive: Any = drive) -> list[Any]:
            supplied = heat.electrical_power(now, stack, drive) + stack.motion_heat
            return [ca.vertcat(rates), supplied, _lost(now, stack, drive)]

        rates = compiled.evaluated(["state_rates", "stack_profile"], columns)

        def right(_: float, y: np.ndarray, rates: Any = rates, current: float = current) -> np.ndarray:
            return np.asarray(rates(y[:-2], current, duty.inputs)).ravel()

        y = solve_ivp(right, (0.0, seconds), y, method="LSODA", rtol=1e-7, atol=1e-9).y[:, -1]
    assert y[-1] == pytest.approx(y[-2], rel=1e-3)
    assert cycle.energy == pytest.approx(y[-2], rel=1e-2)
    assert y[: duty.heat] == pytest.approx(state[: duty.heat], abs=1e-3)  # a tenth of a kelvin


def test_the_first_cycle_is_the_one_of_a_run():
    duty = _duty("shear")
    cycle = Duty(duty.model, duty.inputs, {}, 0.0).cycle(duty.ambient, 0.0)
    assert cycle is not None
    # It melts `melting_time` behind the equilibrium curve, which a run follows.
    for name in ("response_time", "return_time", "peak_heater_temperature", "peak_cold_side_temperature"):
        assert cycle.values[name] == pytest.approx(duty.cold.values[name], rel=0.01)


def test_a_duty_too_quick_for_a_cycle_has_its_limit_alone(monkeypatch):
    duty = _duty("shear")
    above = duty.above({}, ())
    assert duty.most((), 3.0) == (0.0, above[0])  # one switch is beyond it
    monkeypatch.setattr(Duty, "most", lambda *_: (7.0, "time"))
    study = read_study(study_path("paper_reconstructed"))
    hurried = study.model_copy(update={"duty": study.duty.model_copy(update={"switches_per_hour": 60.0})})
    too_often = duty_of(hurried, duty.model, duty.inputs, {})
    assert too_often is not None
    assert (too_often.values, too_often.most, too_often.limited_by) == ({}, 7.0, "time")


@pytest.fixture(scope="module")
def study() -> Study:
    """Read a study with a duty, a controller and limits on both."""
    text = study_path("paper_reconstructed").read_text()
    limits = (
        "{return_time@duty: '<= 3000 s', response_time@control: '<= 1 s', "
        "highest_switch_rate@duty: '>= 30 1/h', overshoot@control: '<= 20 K', slowdown@control: '<= 0.5'}"
    )
    sections = "duty: {switches_per_hour: 2, soft: 1 min}\ncontrol: {draws: 2, thermistor_lag: 1 s}"
    return read_study_text(f"{text}\n{sections}\nrequire: {limits}\n")


@pytest.fixture(scope="module")
def limited(study: Study) -> StudyResult:
    return answer(study)


def test_limits_of_both_are_read_written_and_checked(study, limited):
    assert (len(study.require), len(study.simulated)) == (0, 5)
    names = ["return_time@duty", "response_time@control", "highest_switch_rate@duty", "overshoot@control",
             "slowdown@control"]  # fmt: skip
    assert list(written(study)["require"]) == names
    satisfied = {check.output: check.met for check in limited.checks if check.origin == "require"}
    assert satisfied == dict(zip(names, (True, False, False, True, False), strict=True))
    assert limited.duty is not None
    assert limited.design.values["highest_switch_rate@duty"] == pytest.approx(limited.duty.most / HOUR)
    assert not limited.feasible


def test_a_study_reports_its_duty(study, limited):
    duty = limited.duty
    assert (study.duty.switches_per_hour, study.duty.soft) == (2.0, SOFT)
    assert written(study)["duty"] == {"switches_per_hour": 2.0, "soft": "60 s"}
    assert duty is not None
    reported = duty_entry(duty, study.table)
    assert reported["energy_a_day"]["si"]["value"] > 48.0 * limited.design.values["switch_energy"] * 0.8
    assert reported["values"]["response_time"]["value"] > 0.0
    settling = reported["settling_time"]
    assert (settling["unit"], settling["si"]["unit"], settling["si"]["value"]) == ("min", "s", duty.settling)
    assert "2 switches an hour" in next(fact for fact in main_facts(limited, {}) if fact.label == "Duty").text
    peaks = next(fact for fact in more_facts(limited, {}, None) if fact.label == "Duty").text
    assert "heater" in peaks
    assert "mean power" in peaks
    # The highest duty is the last that keeps the ratings.
    assert duty.most > 0.0
    assert _duty("shear").limit(HOUR / duty.most, study.accept, None)[0] == ""
    assert _duty("shear").limit(HOUR / (1.05 * duty.most), study.accept, None)[0] == duty.limited_by != ""


def test_a_study_reports_its_controller(study, limited):
    assert written(study)["control"]["thermistor_lag"] == "1 s"
    assert limited.control is not None
    entry = control_entry(limited.control)
    assert entry["controller"]["sensor_lag"] == 1.0
    assert entry["overshoot"]["unit"] == "K"
    assert "overshoot" in next(fact for fact in main_facts(limited, {}) if fact.label == "Control").text


def test_a_study_without_them_has_the_same_values(limited):
    without = shipped_answer("paper_reconstructed")
    assert (without.duty, without.control) == (None, None)
    assert without.design.values.items() <= limited.design.values.items()


@pytest.mark.slow
def test_a_limit_in_the_duty_is_kept_by_another_search():
    text = study_path("paper_shear").read_text()
    switched = read_study_text(f"{text}\nduty: {{switches_per_hour: 4}}\n")
    rows = (Requirement(output="return_time@duty", sense="<=", limit=292.0, text="<= 292 s"),)
    progress: list[str] = []
    result = answer(switched.model_copy(update={"simulated": rows}), progress.append)
    assert result.design.status == "optimal"
    assert result.feasible
    assert 285.0 < result.design.values["return_time@duty"] <= 292.0
    assert any("searching again" in line for line in progress)
    missed = answer(switched.model_copy(update={"simulated": (rows[0].model_copy(update={"limit": 20.0}),)}))
    assert not missed.has_design
    assert [check.output for check in missed.checks if not check.met] == ["return_time@duty"]
    assert "switches_per_hour" in complaint(missed)


def test_a_sweep_refuses_limits_on_a_duty():
    text = "mode: shear\nduty: {switches_per_hour: 2}\nrequire: {return_time@duty: '<= 60 s'}"
    with pytest.raises(InputError, match="return_time@duty: a sweep simulates no duty"):
        plan_of(tree_of_text(f"{text}\nsweep: {{over: {{pcl_thickness: [1 mm]}}}}", "study", "study", Path()))
