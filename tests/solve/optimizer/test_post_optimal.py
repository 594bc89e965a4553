"""Shadow prices at an optimum, and a search of all of the bounds."""

import pytest
from small_studies import with_limit_eased
from support import sample_text, study_path

from tvimdesign.solve.discrete.discrete_choices import discrete_sizes
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.infeasibility.feasibility_screen import designs_all_over
from tvimdesign.solve.nlp.solution import ActiveConstraint, SolverEffort, same_optimum
from tvimdesign.solve.nlp.solver_run import Array
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.optimizer.verify_optimum import CYCLE_TOLERANCE, verify_optimum
from tvimdesign.solve.search import optimize
from tvimdesign.study import Range, Study, read_study, read_study_text

SMALL = sample_text("post_optimal")
_HOLDING = '  layer_holding_torque: ">= 30 N.m"\n'
CURVED = SMALL.replace("require:", "  arc_span: [20 deg, 60 deg]\nrequire:").replace(_HOLDING, "")
"""Fewer limits bind here than there are variables, so that how the optimum moves depends on curvature."""
STEP = 2e-3
"""Share by which limits are moved either way."""


def _study() -> Study:
    return read_study_text(SMALL, "a test")


def _optimum(study: Study) -> dict[str, float]:
    """Return the minimised outputs at a study's optimum, as its problem has them."""
    optimizer = Optimizer(study)
    run = optimizer.solve()
    assert run.start.converged
    return optimizer.derivatives(run).values


def _active(study: Study) -> tuple[ActiveConstraint, ...]:
    optimizer = Optimizer(study)
    run = optimizer.solve()
    return verify_optimum(optimizer, run, (run.start,), {}).held


@pytest.mark.slow
@pytest.mark.parametrize("text", [SMALL, CURVED], ids=["at a corner", "on a slope"])
def test_savings_are_what_optima_with_the_limit_moved_show(text):
    study = read_study_text(text, "a test")
    at_optimum = _optimum(study)
    binding = [held for held in _active(study) if held.shadow_price > 1e-3 and held.origin in ("require", "vary")]
    assert len(binding) >= 4
    assert {held.origin for held in binding} == {"require", "vary"}
    for held in binding:
        eased, tightened = (_optimum(with_limit_eased(study, held, share)) for share in (STEP, -STEP))
        for name, saving in held.sensitivity.items():
            shown = (tightened[name] - eased[name]) / (2.0 * STEP * at_optimum[name])
            assert saving == pytest.approx(shown, rel=1e-3, abs=2e-4), (held.text, name)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param("paper_shear", marks=pytest.mark.gate),
        pytest.param("fast_switch", marks=pytest.mark.slow),
        pytest.param("wrist_compression", marks=pytest.mark.slow),
    ],
)
def test_savings_add_up_to_the_price_in_the_objective(name):
    # The envelope theorem: to first order the weighted sum changes by the multiplier.
    study = read_study(study_path(name))
    study = study.model_copy(update={"solver": study.solver.model_copy(update={"starts": 1})})
    solution = optimize(study)
    weights = {n: w * solution.values[n] / solution.reference[n] for n, w in study.minimize.items()}
    priced = [held for held in solution.held if held.shadow_price > 1e-3 and held.sensitivity]
    assert len(priced) >= 5
    for held in priced:
        parts = [weights[n] * saving / solution.objective for n, saving in held.sensitivity.items()]
        # Savings are shares of what the engine's steps have; they are weighed by simulated values, 1e-3 off at most.
        assert sum(parts) == pytest.approx(held.shadow_price, abs=1e-5 + 1e-3 * sum(map(abs, parts))), held.text


def test_a_limit_with_room_saves_nothing():
    slack = [held for held in _active(_study()) if held.residual < -0.01]
    assert len(slack) >= 5
    assert all(saving == 0.0 for held in slack for saving in held.sensitivity.values())


def test_a_variable_nothing_depends_on_hides_no_saving():
    study = _study()
    idle = study.model_copy(update={"vary": {**study.vary, "cooling_current": Range(lower=0.5, upper=2.0)}})
    sensitivity = {held.name: held.sensitivity for held in _active(study)}
    for held in _active(idle):
        if held.shadow_price > 1e-3:
            assert held.sensitivity == pytest.approx(sensitivity[held.name], rel=1e-4, abs=1e-6), held.text


@pytest.mark.gate
def test_of_a_limit_that_is_written_twice_no_saving_is_claimed():
    study = _study()
    again = study.require[0].model_copy(update={"output": "least_spring_stiffness"})
    twice = study.model_copy(update={"require": (*study.require, again)})
    alone = {held.name: held.sensitivity for held in _active(study)}
    both = [held for held in _active(twice) if held.name == "spring_stiffness_full_stroke >="]
    assert len(both) == 2
    for held in _active(twice):
        if held.name == "spring_stiffness_full_stroke >=":
            assert held.sensitivity == {}
        elif held.shadow_price > 1e-3:
            assert held.sensitivity == pytest.approx(alone[held.name], rel=1e-4, abs=1e-6), held.text


STUDY = sample_text("searched_all_over")


@pytest.fixture(scope="module")
def optimizer() -> Optimizer:
    return Optimizer(read_study_text(STUDY, "test"))


@pytest.fixture(scope="module")
def design(optimizer: Optimizer) -> Array:
    return designs_all_over(optimizer)[0]


def broken(optimizer: Optimizer, inputs: Array) -> float:
    """Return the most by which a design, simulated, violates a limit."""
    cycle = optimizer.problem.simulated(inputs)
    values = optimizer.model.values(inputs, cycle)
    return max(float(limit.residual(values[limit.output])) for limit in optimizer.problem.limits)


@pytest.mark.gate
def test_a_design_leads_to_an_optimum(optimizer, design):
    assert broken(optimizer, design) <= 0.0
    run = optimizer.solve(begin=design)
    assert run.start.converged
    assert broken(optimizer, run.inputs) <= CYCLE_TOLERANCE
    heights = [optimizer.model.values(x, optimizer.multistart.cycle)["envelope_height"] for x in (design, run.inputs)]
    assert heights[1] < 0.95 * heights[0]


@pytest.mark.gate
def test_what_is_to_be_within_ends_stays_there(optimizer, design):
    run = optimizer.solve({"placement_radius": (0.0452, 0.0452), "coil_diameter": (0.012, 0.02)}, begin=design)
    assert run.start.converged
    assert run.start.end["placement_radius"] == pytest.approx(0.0452, rel=1e-7)
    assert run.start.end["coil_diameter"] == pytest.approx(0.02, rel=1e-6)  # without the ends it goes to 32 mm
    assert broken(optimizer, run.inputs) <= CYCLE_TOLERANCE


@pytest.mark.gate
def test_a_study_without_a_feasible_start_is_searched_all_over(optimizer):
    """From designs all over the ranges, until two come to the same optimum."""
    study = optimizer.study
    tree = Relaxation(0, optimizer, {}, discrete_sizes(study, study.table), SolverEffort())
    runs = tree.from_all_over()
    assert [run.start.converged for run in runs] == [True, True]
    assert same_optimum(runs[0].start, runs[1].start)
    assert len(tree.optima) == 1
    assert broken(optimizer, tree.optima[0].inputs) <= CYCLE_TOLERANCE
