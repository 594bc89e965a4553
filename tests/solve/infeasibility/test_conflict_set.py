"""Studies without a design: conflicting limits or the nearest target are named, and the way out works."""

import math
import re
from dataclasses import replace
from functools import cache, partial
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from support import ROOT, cases_of, sample_text, study_path

from tvimdesign.base.errors import InfeasibleError
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.infeasibility.conflict_set import _conflicting, conflict_in_words, second_try, tried_with_margins
from tvimdesign.solve.infeasibility.early_checks import refuse_infeasible
from tvimdesign.solve.infeasibility.feasibility_screen import FeasibilityScreen, _broken, designs_all_over, least_broken
from tvimdesign.solve.nlp.solution import Side
from tvimdesign.solve.nlp.solver_run import ITERATIONS_OVER, NO_DESIGN, SOLVED, Array, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.solve.search import optimize
from tvimdesign.study import read_study, read_study_text, read_tree
from tvimdesign.study.sizing import JointTask, study_text
from tvimdesign.study.tree import tree_of_text

STIFF = sample_text("conflict_in_stiffness")
HEAVY = sample_text("conflict_in_mass")
HURRIED = sample_text("conflict_in_time")


@cache
def _answer(text: str) -> StudyResult:
    return answer(read_study_text(text))


def _refusal(text: str) -> str:
    with pytest.raises(InfeasibleError) as caught:
        refuse_infeasible(read_study_text(text))
    return str(caught.value)


@pytest.mark.gate
def test_a_limit_that_cannot_hold_is_named_with_what_the_ranges_allow():
    message = _refusal(HEAVY)
    assert "module_mass <= 60 g cannot hold" in message
    assert "pcl_thickness >= 0.6 mm" in message
    (figure,) = re.findall(r"move to <= ([\d.]+) g", message)
    free = _answer(HEAVY.replace(', module_mass: "<= 60 g"', ""))
    lightest = 1e3 * free.design.values["module_mass"]
    assert figure == f"{lightest:.4g}"  # in the digits that are printed
    # And what a design keeps is never refused.
    refuse_infeasible(read_study_text(HEAVY.replace("<= 60 g", f"<= {lightest * (1.0 + 1e-6):.9g} g")))


def test_the_fixed_number_that_moves_a_limit_most_is_named_and_helps():
    text = (
        "mode: shear\nvary: {coil_diameter: [16 mm, 30 mm]}\n"
        'require: {envelope_diameter: "<= 137 mm"}\nminimize: module_mass\n'
    )
    assert "vary placement_radius (57 mm), which moves it more than all that is varied" in _refusal(text)
    freed = text.replace("30 mm]}", "30 mm], placement_radius: [45 mm, 57 mm]}")
    refuse_infeasible(read_study_text(freed))
    little = freed.replace("45 mm", "56 mm")  # nothing that is fixed moves it more now
    assert "moves it more" not in _refusal(little)


@pytest.mark.slow
def test_records_are_named_with_which_conflicting_limits_hold():
    # The wave spring of this hardware must go around a core that bears the torque; of a stronger plastic it is thinner.
    task = JointTask.read("9 N.m", "1.5 N.m/rad", "74 mm", "60 s", "24 V, 3 A")
    text = study_text(task, "middle")
    records = re.findall(r"`(\w+): (\w+)`", _refusal(text))
    assert [choice for choice, _ in records] == ["axial_preload", "process"]
    for choice, record in records:
        refuse_infeasible(read_study_text(re.sub(rf"(?m)^  {choice}: .*$", f"  {choice}: {record}", text)))


def test_limits_that_cannot_hold_together_are_named_without_the_others():
    # A coil of 12 mm at least with an index of 6 at most needs wire of 2 mm, with a gap between its coils.
    text = HEAVY.replace(
        'spring_stiffness: ">= 5 N.m/rad", module_mass: "<= 60 g"',
        'module_mass: "<= 400 g", spring_index: "<= 6", coil_pitch: "<= 2.05 mm"',
    )
    message = _refusal(text)
    assert "These cannot hold together" in message
    assert "spring_index <= 6" in message
    assert "module_mass" not in message
    (figure,) = re.findall(r"coil_pitch <= 2.05 mm: alone it would have to move to <= ([\d.]+) mm", message)
    assert float(figure) > 2.05
    refuse_infeasible(read_study_text(text.replace("<= 2.05 mm", f"<= {1.001 * float(figure):.6g} mm")))
    refuse_infeasible(read_study_text(text.replace(', coil_pitch: "<= 2.05 mm"', "")))
    refuse_infeasible(read_study_text(text.replace('spring_index: "<= 6", ', "")))


def test_a_robust_study_is_refused_with_what_its_margins_take():
    # Coils of 12 mm at least stand a wire and 0.1 mm apart. A third of each tolerance is its standard deviation.
    text = HEAVY.replace(
        'spring_stiffness: ">= 5 N.m/rad", module_mass: "<= 60 g"', 'spring_index: "<= 6", coil_pitch: "<= 2.05 mm"'
    )
    refusal = _refusal(
        f"{text}tolerances: {{wire_diameter: 0.02 mm, coil_diameter: 0.1 mm}}\nrobust: {{yield: 95 %}}\n"
    )
    wire = 2.05 - 0.1 - 2.5 * 0.02 / 3.0
    assert f"to <= 6.154 as drawn, to <= {12.0 / wire:.4g} with 2.5 deviations of margin" in refusal
    wire = 2.0 * (1.0 + 2.5 * math.hypot(0.02 / 2.0, 0.1 / 12.0) / 3.0)
    assert f"to <= 2.1 mm as drawn, to <= {wire + 0.1:.4g} mm with 2.5 deviations of margin" in refusal
    assert "deviations" not in _refusal(text)


def test_where_runs_end_nowhere_what_is_broken_stands_for_the_conflict():
    runs: list[int] = []
    limits = [SimpleNamespace(origin="require", name=str(i)) for i in range(9)]
    run = SimpleNamespace(inputs=np.zeros(1), unknowns=np.zeros(1))
    slacks, ends = np.where(np.arange(9) == 4, 0.5, 0.0), np.array([1.0])
    least = SimpleNamespace(run=run, pressing=np.ones(9), slacks=slacks, ends=ends)

    def settle(*_: Any) -> Any:
        runs.append(len(runs))
        return SimpleNamespace(converged=len(runs) == 1, conflict_search=False, pressing=np.ones(9), ends=ends)

    elastic = SimpleNamespace(limits=limits, count=9, settle=settle)
    texts: list[str] = []
    assert _conflicting(cast(Any, elastic), cast(Any, least), texts.append) == ([4], ends)
    assert len(runs) < 9
    counted = [f"looking for the fewest limits that conflict, {i + 1} of 9: without {i}" for i in (0, 1, 2)]
    assert texts[:3] == counted


def test_every_limit_that_the_fixed_inputs_violate_is_named_at_once():
    message = _refusal(
        "mode: shear\nmodule: {wire_diameter: 4 mm, coil_diameter: 12 mm, core_radius: 6 mm}\n"
        'vary: {current: [0.5 A, 2.5 A]}\nrequire: {envelope_diameter: "<= 100 mm"}\nminimize: peak_power\n'
    )
    lines = [line for line in message.splitlines() if "nothing under `vary` can change it" in line]
    assert any("spring_index >= 4 does not hold (it is 3; " in line for line in lines)
    assert any("envelope_diameter" in line for line in lines)
    assert len(lines) >= 3


@pytest.mark.gate
def test_every_listed_record_must_be_impossible_before_a_study_is_refused():
    listed = HEAVY.replace("vary: {", "vary: {structure_material: {choose: [petg, aluminum_6061_t6]}, ")
    assert "every listed structure_material" in _refusal(listed)
    refuse_infeasible(read_study_text(listed.replace("<= 60 g", "<= 250 g")))


def test_a_check_says_the_same_of_limits_that_need_no_simulation():
    message = _refusal(STIFF)
    assert "spring_fatigue_safety >= 3" in message
    assert "module_mass" not in message
    (figure,) = re.findall(r"spring_stiffness >= 12 N·m/rad: alone it would have to move to >= ([\d.]+)", message)
    solution = _answer(STIFF).solution
    assert len(solution.starts) == 1
    (place,) = (side.move_to for side in solution.conflict_set.sides if side.text.startswith("spring_stiffness"))
    assert float(figure) == pytest.approx(place, rel=1e-3)


@pytest.mark.slow
def test_the_smallest_set_holds_once_a_limit_of_it_moves_as_far_as_named():
    result = _answer(STIFF)
    assert result.design.status.startswith("infeasible")
    conflict_set = result.solution.conflict_set
    sides = {side.text.split(" ")[0]: side for side in conflict_set.sides}
    assert set(sides) == {"spring_stiffness", "spring_fatigue_safety"}
    place = sides["spring_stiffness"].move_to
    eased = STIFF.replace(">= 12 N.m/rad", f">= {0.999 * place:.6g} N.m/rad")
    assert _answer(eased).design.status == "optimal"
    short = STIFF.replace(">= 12 N.m/rad", f">= {1.02 * place:.6g} N.m/rad")
    assert _answer(short).design.status.startswith("infeasible")


def test_the_design_that_violates_least_does_so_by_what_is_reported():
    result = _answer(STIFF)
    assert not result.has_design
    # A requirement that is put on several outputs at once, as that on the stiffness over the stroke, is one.
    broken: dict[str, float] = {}
    for check in (limit for limit in result.checks if not limit.met):
        name = check.part_of or check.output
        broken[name] = max(-check.margin, broken.get(name, 0.0))
    reported = {side.text.split(" ")[0]: side.by for side in result.solution.conflict_set.broken}
    assert set(broken) == set(reported)
    for text, by in reported.items():
        assert broken[text] == pytest.approx(by, rel=1e-4)


@pytest.mark.slow
def test_a_limit_on_a_time_quarrels_with_the_power_it_takes():
    result = _answer(HURRIED)
    conflict_set = result.solution.conflict_set
    sides = {side.text.split(" ")[0]: side for side in conflict_set.sides}
    assert set(sides) == {"response_time", "peak_power"}
    for name, limit, factor in (("response_time", "<= 150 s", 1.01), ("peak_power", "<= 9 W", 1.01)):
        place = sides[name].move_to
        unit = limit.rpartition(" ")[2]
        assert _answer(HURRIED.replace(limit, f"<= {factor * place:.6g} {unit}")).design.status == "optimal"


@pytest.mark.gate
def test_a_robust_study_is_advised_a_time_that_has_its_margins():
    spread = "tolerances: {wire_diameter: 0.02 mm, coil_diameter: 0.1 mm, pcl_thickness: 0.05 mm}\n"
    text = f"{HURRIED}{spread}robust: {{yield: 95 %}}\n"
    assert "deviations of margin, an estimate" in " ".join(conflict_in_words(_answer(text).solution.conflict_set))
    eased = answer(read_study_text(text), search=partial(optimize, eases=True))
    advice = " ".join(conflict_in_words(eased.solution.conflict_set))
    drawn, robust = (float(place) for place in re.findall(r"to <= ([\d.]+) s", advice))
    assert re.search(rf"to <= {robust} s with margins: tried, yield 9[5-9]", advice)
    assert _answer(text.replace("<= 150 s", f"<= {robust} s")).design.status == "optimal"
    assert _answer(text.replace("<= 150 s", f"<= {1.001 * drawn} s")).design.status != "optimal"


def test_a_rule_that_conflicts_is_not_tried_with_margins():
    rule = Side("wire_gap >= 0 mm", "rule", 1e-4, move_to=-1e-4, move_words="to >= -0.1 mm as drawn", robust_to=-2e-4)
    searched: list[Any] = []
    study = read_study_text(HURRIED)
    assert tried_with_margins(study, rule, cast("Any", searched.append), lambda _: None) is rule
    assert not searched


def test_a_start_restarted_from_a_feasible_design_converges():
    study = read_study_text(STIFF.replace(">= 12 N.m/rad", ">= 4.5 N.m/rad"))
    optimizer = Optimizer(study)
    run = optimizer.solve()
    again = second_try(optimizer, run)
    assert again.start.second_try
    assert again.start.objective == pytest.approx(run.start.objective, rel=1e-6)


FINGER = sample_text("conflict_in_a_finger")


@cases_of("conflict_set", "other_springs")
def test_another_spring_is_named_and_no_number_of_it(vary, limit):
    with pytest.raises(InfeasibleError) as caught:
        refuse_infeasible(read_study_text(FINGER.format(vary=vary, limit=limit), "test"))
    message = str(caught.value)
    assert "choose another `stock_spring`" in message, message
    assert "vary wire_diameter" not in message
    assert "wire_diameter," not in message


ONLY_THE_CYCLE = sample_text("conflict_in_the_cycle")
"""Its one free number changes nothing but the working cycle."""


@pytest.mark.gate
def test_designs_from_all_over_keep_the_arithmetic_limits_and_differ():
    optimizer = Optimizer(read_study(study_path("paper_shear")))
    screen = FeasibilityScreen(optimizer)
    designs = list(designs_all_over(optimizer))
    assert len(designs) == 3
    assert all(screen.broken(inputs) < 0.0 for inputs in designs)
    assert not np.allclose(designs[0], designs[1], rtol=1e-3)
    broken = [_broken(optimizer, inputs) for inputs in designs]
    assert broken == sorted(broken)  # as simulated
    assert np.isfinite(broken[:2]).all()  # the switch of the last may never end
    unknowns = np.array(
        [[free.to_unknown(inputs[optimizer.model.index[free.name]]) for inputs in designs] for free in optimizer.free]
    )
    together = screen.worst(unknowns)
    assert np.allclose(together, [screen.broken(inputs) for inputs in designs])


def test_where_no_limit_is_of_arithmetic_every_design_keeps_them():
    study = read_tree(tree_of_text(ONLY_THE_CYCLE, "one.yaml", "one", ROOT))
    optimizer = Optimizer(study)
    screen = FeasibilityScreen(optimizer)
    assert screen.worst(np.zeros((1, 4))).tolist() == [-1.0] * 4
    assert least_broken(optimizer, screen, 1, {})[1] < 0.0


@pytest.mark.slow
def test_a_start_that_ends_in_a_valley_is_not_the_last_word(monkeypatch):
    # Where no start comes to a design, those from all over do: here every start is made to fail.
    study = read_study(study_path("paper_shear"))
    usual = optimize(study)
    starts = Relaxation._from_one_of_each

    def failing(self: Relaxation, begin: Array) -> Run:
        run = starts(self, begin)
        run.start = replace(run.start, converged=False)
        return run

    monkeypatch.setattr(Relaxation, "_from_one_of_each", failing)
    solution = optimize(study)
    assert solution.status == "optimal"
    assert solution.objective <= usual.objective * (1.0 + 1e-6)


STUDY = sample_text("conflict_without_a_point")


@pytest.mark.parametrize(
    ("statuses", "impossible", "count"),
    [([NO_DESIGN, NO_DESIGN], True, 2), ([SOLVED], False, 1), ([NO_DESIGN, ITERATIONS_OVER], False, 2)],
    ids=["none has a point", "one has", "one does not end"],
)  # fmt: skip
def test_limits_are_infeasible_if_every_search_ends_without_a_point(monkeypatch, statuses, impossible, count):
    screen, ends = FeasibilityScreen(Optimizer(read_study_text(STUDY, "test"))), list[str]()

    def status(*_: Any) -> str:
        ends.append(statuses[len(ends)])
        return ends[-1]

    monkeypatch.setattr(screen, "_status", status)
    assert screen.impossible({}, [np.zeros(2)] * 2) is impossible
    assert len(ends) == count


def test_screen_tells_limits_that_can_be_met_from_those_that_cannot():
    light = STUDY.replace("minimize", 'require: {module_mass: "<= 1 g"}\nminimize')
    for text, impossible in ((STUDY, False), (light, True)):
        optimizer = Optimizer(read_study_text(text, "test"))
        assert FeasibilityScreen(optimizer).impossible({}, [optimizer.model.start]) is impossible
