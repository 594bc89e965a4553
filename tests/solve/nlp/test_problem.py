"""The problem in the space of the free numbers: derivatives, ends of driven phases, currents, kinks, own rows."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from explored import SMALL
from small_studies import FOUR_SIZES_IN_SHEAR
from support import fine, sample_text

from tvimdesign.base.errors import InputError
from tvimdesign.device.core.impedance.structure_stiffness import CORE_PARTS
from tvimdesign.solve.anchored_search import optimum_near
from tvimdesign.solve.nlp.constraints import constraints_of
from tvimdesign.solve.nlp.decision_vector import ExtendedProblem
from tvimdesign.solve.nlp.problem import LATEST
from tvimdesign.solve.nlp.problem_parts import Objective, Parameters
from tvimdesign.solve.nlp.solver_run import NO_DESIGN, Array, Run
from tvimdesign.solve.optimizer.optimizer import SETTLED, Optimizer
from tvimdesign.study import Study, given, read_study_text, read_tree
from tvimdesign.study.tree import tree_of_text, with_settings

REQUIRED = sample_text("required_of_a_problem")
SHEAR = FOUR_SIZES_IN_SHEAR + "  cooling_current: [0.3 A, 1.5 A]\n" + REQUIRED
COMPRESSION = sample_text("problem_in_compression")
SLOW = SHEAR.replace("mode: shear", "mode: shear\nmodule: {current_slew: 0.2 A/s}")
PROFILE = f"{SLOW}profile: {{softening: 3, stiffening: 2}}\n"
STUDIES = {"shear": SHEAR, "compression": COMPRESSION, "profile": PROFILE}
STEP = 1e-4
RIGHT = {"shear": 1e-5, "compression": 1e-6, "profile": 1e-4}
"""Largest difference of derivatives, as a share of the largest of a row: those of a step are taken with the matrix
of its last Newton iteration, whose state is up to 1e-5 off."""


@cache
def problem_of(text: str) -> tuple[Optimizer, Array, Parameters]:
    """Return an optimizer, a point beside its start with steps placed there, and its parameters."""
    optimizer = Optimizer(read_study_text(text, "a test"))
    x = optimizer.guess(optimizer.model.start)
    x = np.clip(x + 0.02 * np.random.default_rng(1).uniform(-1.0, 1.0, len(x)), *optimizer.vector.bounds({}))
    parameters = optimizer.parameters(Objective(optimizer.study.minimize))
    optimizer.problem.place_grids(x, parameters)
    return optimizer, x, parameters


@pytest.mark.parametrize("name", STUDIES)
def test_gradient_and_jacobian_are_those_of_central_differences(name):
    """By every unknown, at the same steps; of everything: objective, limits, what ends a phase, slopes, lateness."""
    optimizer, x, parameters = problem_of(STUDIES[name])

    def values(moved: Array) -> Array:
        point = optimizer.problem.at(moved, parameters)
        return np.append(point.rows, point.objective)

    point = optimizer.problem.at(x, parameters)
    exact = np.vstack([point.jacobian, point.gradient])
    assert np.all(np.isfinite(exact))
    assert exact.shape == (optimizer.problem.row_count + 1, optimizer.problem.unknown_count)
    shown = np.empty_like(exact)
    for i, step in enumerate(STEP * np.eye(len(x))):
        ends = values(x - 2.0 * step), values(x - step), values(x + step), values(x + 2.0 * step)
        shown[:, i] = np.array([1.0, -8.0, 8.0, -1.0]) @ np.array(ends) / (12.0 * STEP)
    sizes = np.maximum(np.max(np.abs(exact), axis=1, keepdims=True), 1e-3)
    worst = np.abs(shown - exact) / sizes
    row, column = np.unravel_index(np.argmax(worst), worst.shape)
    assert np.max(worst) < RIGHT[name], (row, column)


def test_a_time_that_is_limited_has_no_second_row_for_the_horizon():
    sooner = Optimizer(read_study_text(SHEAR.replace("require:", 'require:\n  response_time: "<= 600 s"'), "a test"))
    assert sooner.problem.unlimited == ["return_time"]
    later = Optimizer(read_study_text(SHEAR.replace("require:", 'require:\n  response_time: "<= 2 h"'), "a test"))
    assert later.problem.unlimited == ["response_time", "return_time"]
    optimizer, x, parameters = problem_of(SHEAR)
    point = optimizer.problem.at(x, parameters)
    horizon = optimizer.model.start[optimizer.model.index["horizon"]]
    assert point.rows[-2] == pytest.approx(point.times["response_time"] / (LATEST * horizon) - 1.0, abs=1e-12)


def test_where_its_equation_is_zero_a_driven_phase_ends_as_cvodes_ends_it():
    # The equation is solved for the time its pieces take; all else stays.
    optimizer, x, parameters = problem_of(PROFILE)
    problem, x = optimizer.problem, x.copy()
    last = problem.nodes_place(0).stop
    for _ in range(20):
        point = problem.at(x, parameters)
        x[last] -= np.clip(point.rows[0] / point.jacobian[0, last], -0.3, 0.3)
    assert abs(point.rows[0]) < 1e-10
    profiles = optimizer.vector.current_profiles(x)
    cycle = fine(optimizer.model).run(optimizer.vector.inputs(x), {"softening": profiles["softening"]}, ["softening"])
    ramp = profiles["softening"].moments[1]
    assert ramp > 1.0
    assert ramp + problem.pieces_time(x, 0) == pytest.approx(cycle.values["response_time"], rel=1e-3)


def test_values_at_the_placed_steps_are_within_a_thousandth_of_cvodes():
    for text in (SHEAR, COMPRESSION):
        optimizer, x, parameters = problem_of(text)
        inputs = optimizer.vector.inputs(x)
        cycle = fine(optimizer.model).run(inputs)
        expected = optimizer.model.some_values(optimizer.problem.wanted, inputs, cycle.values)
        point = optimizer.problem.at(x, parameters)
        assert point.values == pytest.approx(expected, rel=1e-3)


def test_a_point_whose_switch_never_ends_has_no_value_and_raises_nothing():
    optimizer, x, parameters = problem_of(SHEAR)
    weak = x.copy()
    (place,) = (i for i, free in enumerate(optimizer.free) if free.name == "current")
    weak[place] = optimizer.free[place].to_unknown(0.05)
    assert np.isnan(optimizer.problem.at(weak, parameters).objective)
    assert np.isfinite(optimizer.problem.at(x, parameters).objective)


def test_steps_are_part_of_what_a_point_is_remembered_by():
    optimizer, x, parameters = problem_of(SHEAR)
    problem, grids = optimizer.problem, optimizer.problem.grids
    here = problem.at(x, parameters)
    assert problem.at(x.copy(), parameters) is here
    thick = x + 0.3
    problem.place_grids(thick, parameters)
    elsewhere = problem.at(x, parameters)
    assert 0.0 < abs(elsewhere.objective / here.objective - 1.0) < 1e-3
    problem.grids = grids
    assert problem.at(x, parameters).objective == here.objective


def is_settled(optimizer: Optimizer, run: Run) -> bool:
    objective = Objective(optimizer.study.minimize)
    programme = ExtendedProblem(optimizer.problem, optimizer.parameters(objective))
    return optimizer._settled(programme, run.unknowns, optimizer.ends({}, objective)["ubg"])


def test_an_optimum_is_where_its_own_steps_have_it():
    """Steps are placed anew where a run ends, and the run goes on until that moves nothing."""
    optimizer, _, parameters = problem_of(SHEAR)
    run = optimizer.solve()
    assert run.start.converged
    optimizer.problem.grids = run.grids
    assert optimizer.problem.at(run.unknowns, parameters).objective == pytest.approx(run.start.objective, rel=1e-8)
    assert is_settled(optimizer, run)
    assert optimizer.problem.grids is not run.grids  # placed anew


def test_steps_of_a_quick_switch_are_placed_again_for_a_slow_one():
    # The least power heats for an hour; the steps of the study's start, which takes minutes, miss its end by 0.5 %.
    text = "mode: shear\nvary: {current: [0.1 A, 3 A]}\nminimize: peak_power\nsolver: {cells: 6, starts: 1}\n"
    optimizer = Optimizer(read_study_text(text, "a test"))
    parameters = optimizer.parameters(Objective(optimizer.study.minimize))
    run = optimizer.solve()
    assert run.times["response_time"] > 3000.0
    optimizer.problem.place_grids(optimizer.guess(optimizer.model.start), parameters)
    assert not is_settled(optimizer, run)
    assert is_settled(optimizer, run)


@pytest.mark.parametrize(("most", "status"), [("100 W", "Solve_Succeeded"), ("1 W", NO_DESIGN)])
def test_a_study_with_nothing_free_is_evaluated_and_its_limits_checked(most, status):
    text = SHEAR.replace("<= 9 W", f"<= {most}").replace(">= 5 N.m/rad", ">= 2 N.m/rad").replace("120 degC", "200 degC")
    study = read_study_text(text, "a test")
    optimizer = Optimizer(study.model_copy(update={"vary": {}}))
    assert optimizer.problem.unknown_count == 0
    run = optimizer.solve()
    assert run.start.status == status
    assert run.start.converged == (status != NO_DESIGN)
    assert run.start.objective == pytest.approx(3.0, rel=1e-3)  # the weights, over the start's values, which they are
    assert run.times["response_time"] == pytest.approx(optimizer.multistart.cycle["response_time"], rel=1e-3)


@pytest.mark.gate
def test_a_peak_of_a_profile_is_an_unknown_that_no_sample_exceeds():
    optimizer = Optimizer(read_study_text(PROFILE, "a test"))
    problem = optimizer.problem
    run = optimizer.solve()
    assert run.start.converged
    assert run.start.iterations < 100
    optimizer.problem.grids = run.grids
    rows = problem.at(run.unknowns, optimizer.parameters(Objective(optimizer.study.minimize))).rows
    first = problem.row_count - problem.sample_count
    for peak, unknown in zip(problem.peaks, run.unknowns[-len(problem.peaks) :], strict=True):
        samples = rows[first : first + problem.samples(peak)]
        first += problem.samples(peak)
        assert np.max(samples) < 1e-6
        cycle = fine(optimizer.model).run(run.inputs, run.current_profiles)
        assert cycle.values[peak.row.name] <= peak.scale * unknown * (1.0 + 2e-3)
    # Such a peak has no least.
    text = PROFILE.replace('peak_power: "<= 9 W"', 'peak_power: ">= 5 W"')
    with pytest.raises(InputError, match="peak_power: a peak can be kept below a limit, not above one"):
        Optimizer(read_study_text(text, "a test"))


STUDY = sample_text("problem_in_a_mode")


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_a_torque_limit_applies_at_the_core_s_foot_and_at_all_holes(mode):
    study = read_study_text(STUDY.format(mode=mode), "test")
    limited = {limit.output for limit in constraints_of(study, study.table, study.module)}
    assert set(CORE_PARTS) < limited
    assert not {"core_holding_torque", "holding_torque"} & limited
    parts = study.table.evaluate(given(study), [*CORE_PARTS, "core_holding_torque"])
    assert parts["core_holding_torque"] == min(parts[name] for name in CORE_PARTS)


def test_a_search_over_the_kink_between_foot_and_holes_ends():
    """As one limit on the core it runs out of 300 iterations; its foot and its holes apart take some thirty."""
    run = Optimizer(read_study_text(STUDY.format(mode="shear").replace("[7 mm", "[6 mm"), "test")).solve()
    assert run.start.converged
    assert run.start.iterations < 100


def _with(*settings: str) -> Study:
    return read_tree(with_settings(tree_of_text(SMALL, "small.yaml", "small", Path()), settings))


MOVED = {
    "an active limit": ["require.peak_power=<= 9 W"],
    "ends of a range": ["vary.current=[0.8 A, 1.2 A]"],
    "a weight": ["minimize.module_mass=4"],
    "a fixed number": ["core_radius=10.4 mm"],
    "all of them": ["require.peak_power=<= 10 W", "vary.pcl_thickness=[0.9 mm, 2.2 mm]", "minimize.response_time=2",
                    "stroke=0.09 rad"],
}  # fmt: skip


@pytest.fixture(scope="module")
def first() -> Run:
    return Optimizer(read_study_text(SMALL)).solve()


@pytest.mark.parametrize("name", MOVED)
def test_the_optimum_near_another_is_the_one_found_from_the_start(first, name):
    study = _with(*MOVED[name])
    moved, fresh = optimum_near(Optimizer(study), first.start.end), Optimizer(study).solve()
    assert moved.converged
    # Both are optima, each with the steps that were placed on its way: these differ most where a range ends.
    apart = SETTLED if name == "ends of a range" else 2e-6
    assert moved.run.start.objective == pytest.approx(fresh.start.objective, rel=apart)
    for variable, value in fresh.start.end.items():
        assert moved.run.start.end[variable] == pytest.approx(value, rel=10.0 * SETTLED)
        assert abs(value / first.start.end[variable] - 1.0) > 1e-6 or name != "all of them"


def test_active_limits_and_ends_of_ranges(first):
    bound = optimum_near(Optimizer(_with("require.peak_power=<= 9 W")), first.start.end)
    assert "peak_power <=" in bound.active
    ended = optimum_near(Optimizer(_with("vary.current=[0.8 A, 1.1 A]")), first.start.end)
    assert ended.ends["current"] == "upper"
