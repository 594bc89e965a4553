"""Design and currents found together: no worse than a constant current, within all limits, the same from anywhere."""

from functools import cache

import numpy as np
import pytest
from support import fine, sample_text

from tvimdesign.base.errors import InputError
from tvimdesign.device import table_for
from tvimdesign.solve.nlp.solution import ActiveConstraint, Solution
from tvimdesign.solve.search import optimize
from tvimdesign.study import read_study_text

TABLE = table_for("shear")
HEATING = sample_text("profile_heating")
CYCLE = sample_text("profile_cycle")
TOLERANCE = 2e-3  # share of a limit: the peaks of the equations are at their points, the simulation's anywhere


@cache
def solve(text: str) -> Solution:
    return optimize(read_study_text(text, "a test"))


def with_pieces(pieces: int, text: str = HEATING) -> str:
    return text.replace("softening: 0", f"softening: {pieces}")


def terminals(solution: Solution, phase: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Voltage, hot and cold side over a stage, by the Peltier equations from temperatures and currents."""
    line, model = solution.cycle.trajectories[phase], solution.model
    temperatures = model.phases[phase].temperatures
    seen = np.array([
        np.asarray(temperatures(line.states[:, i], line.currents[i], solution.inputs)).ravel()[:2]
        for i in range(len(line.times))
    ])  # fmt: skip
    share = solution.values["heater_scale"]
    seebeck, ohms = (share * solution.inputs[model.index[f"heater_{name}"]] for name in ("seebeck", "resistance"))
    return np.abs(seebeck * (seen[:, 1] - seen[:, 0]) + ohms * line.currents), seen[:, 1], seen[:, 0]


@pytest.mark.slow
def test_more_pieces_are_never_slower_and_beat_a_constant_current():
    # Nodes of four pieces are nodes of eight; each is also free to stay constant.
    times = [solve(with_pieces(pieces)).values["response_time"] for pieces in (0, 1, 4, 8)]
    assert all(solve(with_pieces(pieces)).status == "optimal" for pieces in (0, 1, 4, 8))
    for fewer, more in ((0, 1), (1, 4), (4, 8)):
        first, then = times[(0, 1, 4, 8).index(fewer)], times[(0, 1, 4, 8).index(more)]
        assert then <= first * (1.0 + 1e-3), f"{more} pieces against {fewer}"
    assert times[2] < 0.95 * times[0]  # the pads' power first, then their temperature is at its limit


@pytest.mark.gate
@pytest.mark.parametrize("pieces", [4, pytest.param(8, marks=pytest.mark.slow)])
def test_the_limits_hold_all_along_the_simulated_heating(pieces):
    solution = solve(with_pieces(pieces))
    voltage, hot, _ = terminals(solution, "softening")
    line = solution.cycle.trajectories["softening"]
    assert np.max(voltage) <= 7.6 * (1.0 + TOLERANCE)
    assert np.max(voltage * line.currents) <= 15.0 * (1.0 + TOLERANCE)
    assert np.max(hot) <= 393.15 + 100.0 * TOLERANCE
    profile = solution.current_profiles["softening"]
    assert (profile.moments[0], profile.currents[0]) == (0.0, 0.0)
    ramped = line.times >= profile.moments[1]
    assert profile.moments[1] == pytest.approx(profile.currents[1] / 0.2)
    assert np.min(line.currents[ramped]) >= 0.3
    assert np.max(line.currents) <= 3.0
    assert solution.current_profiles["softening"].steepest <= 0.2 * (1.0 + 1e-6)
    # The limits that are reported active are so: one is met.
    assert max(np.max(voltage) / 7.6, np.max(voltage * line.currents) / 15.0) > 0.99
    assert np.max(hot) > 393.15 - 0.3


@pytest.mark.slow
def test_the_limits_hold_all_along_the_simulated_cycle():
    solution = solve(CYCLE)
    assert solution.status == "optimal"
    voltage, hot, _ = terminals(solution, "softening")
    assert np.max(voltage * solution.cycle.trajectories["softening"].currents) <= 20.0 * (1.0 + TOLERANCE)
    assert np.max(hot) <= 393.15 + 100.0 * TOLERANCE
    voltage, _, _ = terminals(solution, "stiffening")
    profile = solution.current_profiles["stiffening"]
    assert profile.currents[0] == 0.0
    line = solution.cycle.trajectories["stiffening"]
    cooling = line.currents[line.times >= profile.moments[1]]
    assert np.max(voltage) <= 6.0 * (1.0 + TOLERANCE)
    assert np.max(cooling) <= -0.05
    assert np.min(cooling) >= -2.5
    assert all(profile.steepest == pytest.approx(0.5, rel=1e-9) for profile in solution.current_profiles.values())


@pytest.mark.slow
def test_the_reported_times_are_those_of_the_drives_simulated_again():
    solution = solve(CYCLE)
    again = fine(solution.model).run(solution.inputs, solution.current_profiles)
    for phase, event in (("softening", "response_time"), ("stiffening", "stiffening_time")):
        assert again.values[event] == pytest.approx(solution.values[event], rel=2e-4)
        assert solution.current_profiles[phase].moments[-1] == pytest.approx(again.values[event], rel=1e-3)
        assert abs(solution.current_profiles[phase].mean) == pytest.approx(
            solution.inputs[solution.model.index[TABLE.phase(phase).current_input]], rel=1e-12
        )


@pytest.mark.slow
def test_a_cycle_with_profiles_is_not_longer_than_with_constants():
    # A constant current must be small from the start, for the pads' temperature at the end.
    constant, profile = solve(CYCLE.replace("profile: {softening: 4, stiffening: 4}\n", "")), solve(CYCLE)
    for solution in (constant, profile):
        assert solution.values["peak_heater_temperature"] == pytest.approx(393.15, abs=100.0 * TOLERANCE)
    assert constant.values["peak_power"] < 0.8 * 20.0
    assert profile.values["peak_power"] == pytest.approx(20.0, rel=TOLERANCE)
    assert profile.values["cycle_time"] < 0.95 * constant.values["cycle_time"]


@pytest.mark.slow
def test_a_slow_supply_costs_time_and_is_reported():
    slow, eased = (solve(CYCLE.replace("0.5 A/s", f"{slew} A/s")) for slew in ("0.08", "0.0808"))
    assert slow.status == "optimal"
    assert slow.values["cycle_time"] > solve(CYCLE).values["cycle_time"]
    assert max(profile.steepest for profile in slow.current_profiles.values()) == pytest.approx(0.08, rel=1e-4)
    # The solver's own objectives: what a hundredth saves is not far above the simulator's tolerance.
    ends = [solution.starts[0].objective for solution in (slow, eased)]
    prices = [active(solution, "current_slew <=").shadow_price for solution in (slow, eased)]
    assert min(prices) > 1e-3
    assert 100.0 * (ends[0] - ends[1]) / ends[0] == pytest.approx(sum(prices) / 2.0, rel=0.05)


def active(solution: Solution, name: str) -> ActiveConstraint:
    (held,) = (held for held in solution.held if held.name == name)
    return held


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "name", "written", "step", "shares"),
    [
        (with_pieces(8), "peak_heater_temperature <=", "120 degC", 1.0, 1.0),
        (with_pieces(8), "peak_power <=", "15 W", 0.03, 0.2),
        pytest.param(CYCLE, "peak_heater_temperature <=", "120 degC", 1.0, 1.0, marks=pytest.mark.slow),
        pytest.param(CYCLE, "peak_power <=", "20 W", 0.2, 1.0, marks=pytest.mark.slow),
        pytest.param(CYCLE, "stiffening_peak_voltage <=", "6 V", 0.06, 1.0, marks=pytest.mark.slow),
    ],
)
def test_the_price_of_a_limit_on_a_path_is_what_moving_it_saves(text, name, written, step, shares):
    # `shares` is the step in kelvins or hundredths. To either side, for another limit may take over nearby.
    number, unit = written.split()
    below, above = (
        solve(text.replace(f"<= {written}", f"<= {float(number) + moved} {unit}")) for moved in (-step, step)
    )
    shadow_price = active(solve(text), name).shadow_price
    assert shadow_price > 1e-2
    saved = 100.0 * (below.objective - above.objective) / (2.0 * shares * solve(text).objective)
    assert saved == pytest.approx(shadow_price, rel=0.1)


def test_a_profile_of_no_effect_or_beside_another_time_is_refused():
    text = CYCLE.replace("minimize: cycle_time", "minimize: response_time").replace(
        '  stiffening_peak_voltage: "<= 6 V"\n', ""
    )
    with pytest.raises(InputError, match=r"profile\.stiffening: nothing that is required or minimised depends"):
        solve(text)
    text = with_pieces(4).replace("require:", 'require:\n  near_face_time: "<= 100 s"')
    with pytest.raises(InputError, match=r"profile\.softening: .* near_face_time cannot be limited"):
        solve(text)
