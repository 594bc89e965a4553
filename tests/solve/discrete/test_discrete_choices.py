"""Listed choices: the answer is that of solving every combination, and the account of the search is right."""

import math
import re
from dataclasses import replace

import pytest
from bonmin import best_by_bonmin
from choosing import LISTED, by_brute_force, listed

from tvimdesign.base.errors import InputError
from tvimdesign.device import table_for
from tvimdesign.report.output.choices_tables import choosing_data, price_in_words, tally_in_words
from tvimdesign.report.run.reasons import complaint
from tvimdesign.solve.discrete.combinations import every_combination
from tvimdesign.solve.discrete.discrete_choices import discrete_sizes
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.infeasibility.feasibility_screen import FeasibilityScreen
from tvimdesign.solve.nlp.solution import Choosing, Solution, SolverEffort
from tvimdesign.solve.nlp.solver_run import NO_COMBINATION
from tvimdesign.solve.optimizer.optimizer import SETTLED, Optimizer
from tvimdesign.solve.result import answer
from tvimdesign.solve.search import optimize
from tvimdesign.study import Study, given, read_study_text

TABLE = table_for("shear")
# The aluminium draws so much of the layer's heat that 9 W never soften it.
POWERFUL = LISTED.replace("<= 9 W", "<= 30 W").replace("[0.5 A, 2 A]", "[0.5 A, 4 A]")


def _chosen(solution: Solution) -> Choosing:
    assert solution.choosing is not None
    return solution.choosing


def _agrees(study: Study, solution: Solution, alone: dict[tuple[float, ...], float] | None = None) -> None:
    """Compare the best combinations with each solved `alone` from three starts, and check the tally."""
    choosing = _chosen(solution)
    alone = alone or by_brute_force(study, solution.reference, 3)
    expected = sorted(alone.items(), key=lambda item: item[1])
    assert solution.status == "optimal"
    for candidate, (sizes, objective) in zip(choosing.best, expected, strict=False):
        assert candidate.objective == pytest.approx(objective, rel=SETTLED)
        assert tuple(candidate.choices.values()) == pytest.approx(sizes)
    assert len(choosing.best) == min(study.solver.alternatives, len(expected))
    assert choosing.solved + choosing.pruned + choosing.without_design == choosing.combinations
    assert choosing.solved + choosing.pruned >= len(expected)
    assert choosing.without_design >= choosing.combinations - len(expected) - choosing.pruned
    assert choosing.inside <= SETTLED  # each run places its own steps in time
    assert choosing.between.objective <= choosing.best[0].objective * (1.0 + SETTLED)


@pytest.fixture(scope="module")
def solution() -> Solution:
    return optimize(listed())


@pytest.fixture(scope="module")
def alone(solution: Solution) -> dict[tuple[float, ...], float]:
    """Return every combination solved alone, from the study's start."""
    return by_brute_force(listed(), solution.reference, starts=1)


@pytest.mark.gate
def test_branch_and_bound_is_as_good_as_solving_every_combination_alone(solution, alone):
    _agrees(listed(), solution, alone)
    work = _chosen(solution).work
    assert work.warm_iterations <= 8 * work.warm  # a re-solve takes a few iterations


@pytest.mark.gate
def test_the_bounds_save_most_of_the_work():
    # One design is asked for; the solver runs for half of the combinations at most, though some have no design.
    alone = listed(LISTED.replace("solver: {", "solver: {alternatives: 1, "))
    choosing = _chosen(optimize(alone))
    assert len(choosing.best) == 1
    assert choosing.work.warm + choosing.work.cold <= choosing.combinations // 2


@pytest.mark.slow
def test_solving_every_combination_finds_the_same_and_says_so(solution, alone):
    proven = _chosen(optimize(listed(LISTED.replace("solver: {", "solver: {prove: true, "))))
    assert proven.proven
    assert proven.improved <= 1e-6
    assert [best.choices for best in proven.best] == [best.choices for best in _chosen(solution).best]
    assert (proven.solved, proven.pruned) == (len(alone), 0)
    assert proven.solved + proven.without_design == proven.combinations
    assert "Every combination was then solved" in tally_in_words(proven)


@pytest.mark.gate
def test_every_combination_is_as_good_as_solved_alone_and_cold(solution, alone):
    messages: list[str] = []
    relaxation = _relaxation(solution)
    relaxation.optimizer.progress = messages.append
    each = {
        tuple(low for low, _ in relaxation.sizes.ends(box).values()): run.start.objective
        for (_, box), run in every_combination([relaxation], {})[0].items()
    }
    assert set(each) == set(alone)
    for sizes, objective in alone.items():
        assert each[sizes] <= objective * (1.0 + SETTLED)
    assert min(each.values()) == pytest.approx(min(alone.values()), rel=SETTLED)
    assert f"0 of {relaxation.sizes.count} combinations" in messages[0]


@pytest.mark.slow
def test_bonmin_comes_to_the_same(solution):
    # A solver of others' making, by the algorithm of it that is right.
    chosen = best_by_bonmin(listed(), solution.reference)
    best = _chosen(solution).best[0]
    assert chosen.success
    assert chosen.objective == pytest.approx(best.objective, rel=SETTLED)
    assert chosen.choices == pytest.approx(best.choices, rel=1e-6)


def _relaxation(solution: Solution) -> Relaxation:
    """Return the problem of the listed study with its starts run, its objective over the same reference."""
    study = listed()
    optimizer = Optimizer(study, solution.reference)
    relaxation = Relaxation(0, optimizer, {}, discrete_sizes(study, TABLE), SolverEffort())
    relaxation.starts()
    return relaxation


@pytest.mark.gate
def test_the_price_of_going_standard_is_what_the_two_designs_differ_by(solution, alone):
    choosing = _chosen(solution)
    standard = 1e3 * min(alone, key=lambda sizes: alone[sizes])[0]
    text, data = price_in_words(choosing, TABLE), choosing_data(choosing, TABLE)
    for name, value in choosing.best[0].values.items():
        assert value == pytest.approx(solution.values[name], rel=1e-5), "simulated at other samples"
        share = value / choosing.between.values[name] - 1.0
        assert data["cost_of_standard_sizes"][name] == pytest.approx(share, rel=1e-9)
        assert f"{name} {share:+.1%}" in text
    assert f"wire_diameter {standard:.4g} mm instead of {1e3 * choosing.between.choices['wire_diameter']:.4g}" in text
    # Margins may lead to another combination.
    second = choosing.best[1]
    share = second.objective / choosing.between.objective - 1.0
    assert f"objective {share:+.1%} (both without margins)." in price_in_words(choosing, TABLE, second.choices)


@pytest.mark.gate
def test_records_that_differ_in_numbers_share_functions():
    text = POWERFUL.replace("vary:", "module: {structure_material: STUFF}\nvary:")
    words = ("petg", "aluminum_6061_t6", "petg, spring_material: stainless_302")
    petg, metal, stainless = (Optimizer(listed(text.replace("STUFF", word))) for word in words)
    wanted = petg.problem.wanted
    assert metal.model.outputs(wanted) is petg.model.outputs(wanted)
    assert stainless.model.outputs(wanted) is not petg.model.outputs(wanted), "its strength is a table"


def test_a_design_between_listed_sizes_is_infeasible_with_advice():
    """By hand: the rate goes as the wire's diameter to the fourth, 3.56 N.m/rad at most with 2.6 mm, so that 2.4 mm has
    2.58 at most and 2.33 at least; between 2.65 and 3.1 the stroke fits at 2.5 mm, with neither of the two."""
    study = read_study_text(
        "mode: shear\n"
        "vary: {wire_diameter: {choose: [2.4 mm, 2.6 mm]}, pcl_thickness: [0.6 mm, 2 mm]}\n"
        "require: {spring_stiffness: ['>= 2.65 N.m/rad', '<= 3.1 N.m/rad']}\n"
        "accept: [structure_temperature_margin, stiffening_structure_margin, heater_temperature_margin]\n"
        "minimize: module_mass\nsolver: {starts: 1, cells: 6}\n"
    )
    result = answer(study)
    assert result.design.status == NO_COMBINATION
    message = complaint(result)
    assert re.search(r"With wire_diameter 2\.[45]\d* mm there is a design: list values nearer", message)
    assert "time_limit" not in message
    assert result.solution is not None
    late = replace(result, solution=replace(result.solution, out_of_time=60.0))
    assert "raise `solver.time_limit`" in complaint(late)
    assert "solver.starts" not in message  # no other start helps


def test_the_screen_refuses_what_arithmetic_alone_refuses():
    study = listed()
    optimizer = Optimizer(study)
    screen, begin = FeasibilityScreen(optimizer), optimizer.model.start
    thin, thick = {"wire_diameter": (1.5e-3, 1.6e-3)}, {"wire_diameter": (1.5e-3, 2.4e-3)}
    assert screen.impossible(thin, [begin])
    assert not screen.impossible(thick, [begin])
    # Of thin wire by hand: k = E d^4 / (64 D n) in N.m per radian, four springs, D and n as small as they may be.
    rate = 196.5e9 * 1.6e-3**4 / (64.0 * 12e-3 * 3.0)
    stress = 32.0 * rate * given(study)["stroke"] / (math.pi * 1.6e-3**3)
    assert 4.0 * rate < 5.0 or stress > 0.5 * 2211e6 / 1.6**0.145 / 1.2


def test_too_many_combinations_are_refused_with_advice():
    text = LISTED.replace("{from: 3, to: 4, step: 0.5}", "{from: 3, to: 8, step: 0.03}").replace(
        "[12 mm, 30 mm]", "{from: 12 mm, to: 22 mm, step: 0.1 mm}"
    )
    text = text.replace("[32 mm, 40 mm]", "{from: 32 mm, to: 40 mm, step: 0.5 mm}")
    assert discrete_sizes(listed(text), TABLE).count > 1_000_000
    with pytest.raises(InputError, match="combinations of listed choices; the limit is 1000000; narrow a list"):
        optimize(listed(text))
