"""Results of studies: a feasible design without optimality, its account, walls that a process can make, a yardstick."""

import random
import re
from dataclasses import replace
from typing import Any

import pytest
from answers import shipped_answer
from comparable import SHEAR
from support import sample_text

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import from_si, parse_quantity
from tvimdesign.device import MODES, table_for
from tvimdesign.report.run.reasons import complaint
from tvimdesign.solve import anchored_search, result, search
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.nlp.constraints import constraints_of, refuse_impossible, unchangeable
from tvimdesign.solve.nlp.solver_run import FEASIBLE, Array, Run
from tvimdesign.solve.result import answer
from tvimdesign.study import Study, given, read_study_text
from tvimdesign.study.resolve import missing_geometry

STUDY = sample_text("feasible_not_optimal")


@pytest.mark.parametrize("first", [True, False])
def test_a_feasible_design_is_reported_before_a_better_infeasible_one(monkeypatch, first):
    study = read_study_text(STUDY, "test")
    made: list[Run] = []

    def failing(self: Relaxation, begin: Array) -> Run:
        run = self.optimizer.solve(begin=begin)
        best = first is not bool(made)
        status, objective = (FEASIBLE, run.start.objective) if best else ("Maximum_Iterations_Exceeded", 0.0)
        inputs = run.inputs.copy()
        if not best:
            inputs[self.optimizer.model.index["current"]] = 2.5
        run = replace(run, inputs=inputs)
        run.start = replace(run.start, status=status, objective=objective, converged=False)
        made.append(run)
        return run

    monkeypatch.setattr(Relaxation, "_from_one_of_each", failing)
    monkeypatch.setattr(Relaxation, "from_all_over", lambda _: [])
    monkeypatch.setattr(search, "find_conflicts", lambda *_: None)
    results = answer(study)
    assert len(made) == 2
    assert not results.has_design
    assert results.solution.feasible
    assert complaint(results).startswith("test: no design known to be the best one (not converged: a feasible design")


@pytest.mark.gate
def test_a_design_is_handed_on_before_the_rest_is_computed(monkeypatch):
    study = Study.model_validate(shipped_answer("paper_reconstructed").design.study)
    order: list[Any] = []
    history = result.phase_history
    monkeypatch.setattr(result, "phase_history", lambda *of: order.append("history") or history(*of))
    answered = answer(study, designed=lambda design, _: order.append(design))
    assert order[0] is answered.design
    assert order[1:] == ["history"] * len(answered.histories)


@pytest.mark.gate
def test_where_a_search_ends_without_a_design_nothing_is_handed_on():
    known = shipped_answer("paper_shear")
    assert known.solution
    study = Study.model_validate(known.design.study)
    for status, is_design in (("optimal", True), ("infeasible: this design violates its limits least", False)):
        made: list[Any] = []
        solution = replace(known.solution, status=status)
        answered = answer(
            study, search=lambda *_, of=solution: of, designed=lambda *given, made=made: made.append(given)
        )
        assert (bool(made), answered.has_design) == (is_design, is_design)


PROCESS_STUDY = sample_text("walls_of_a_process")


@pytest.mark.parametrize(("process", "wall"), [("print_petg", 1.2e-3), ("machine_6061", 1.0e-3)])
def test_walls_end_where_the_process_ends(process, wall):
    design = answer(read_study_text(PROCESS_STUDY.format(process=process), "a test")).design
    assert design.status == "optimal"
    assert design.values["wall_thickness"] == pytest.approx(wall, rel=1e-4)
    # Keys in the plate and narrow teeth of the stops would want more of it; they are left out.
    assert design.values["rotor_thickness"] == pytest.approx(wall, rel=1e-4)
    # The floor keeps that wall below a pad of 1.5 mm; in metal the screws in the core ask for more.
    assert design.values["floor_thickness"] >= 1.5e-3 + wall - 1e-7


def test_one_yardstick_is_the_geometric_mean_and_one_of_zeros():
    starts = [{"module_mass": 0.2, "response_time": 50.0}, None, {"module_mass": 0.8, "response_time": 200.0}]
    for order in (starts, starts[::-1]):
        assert anchored_search.common(order) == pytest.approx({"module_mass": 0.4, "response_time": 100.0})
    assert anchored_search.common([{"backlash@hot": 0.0}, {"backlash@hot": 0.0}]) == {"backlash@hot": 1.0}
    assert anchored_search.common([{"backlash@hot": 0.0}, {"backlash@hot": 0.1}]) == pytest.approx(
        {"backlash@hot": 0.1}
    )


def test_a_switch_that_never_ends_counts_as_long_as_it_is_followed():
    cold = SHEAR.replace("current: 1.5 A", "current: 0.1 A\n  horizon: 900 s")
    values = anchored_search.at_its_start(read_study_text(cold, "test"))
    assert values["response_time"] == 900.0
    assert values.keys() == {"module_mass", "response_time"}  # only what is minimised


CROSSED = "vary: {pcl_outer_radius: [20 mm, 25 mm], pcl_inner_radius: [41 mm, 56 mm]}\nminimize: module_mass\n"


def study_of(text: str) -> Study:
    """Return a study in shear mode."""
    return read_study_text(f"mode: shear\n{text}", "test")


def refusal(study: Study) -> str:
    """Return the message that refuses a study."""
    with pytest.raises(InputError) as caught:
        refuse_impossible(study)
    return str(caught.value)


def partial_study(mode: str, seed: int) -> str:
    """Return a study with random ranges, 0.3 to 3 times the default, of some variables."""
    drawn = random.Random(seed)
    rows = [
        row for row in table_for(mode).inputs
        if row.variable and row.default and not row.integer and row.record is None and not row.requires
    ]  # fmt: skip
    lines = []
    for row in drawn.sample(rows, drawn.randint(1, 5)):
        low, high = sorted(row.default * 0.3 * 10.0 ** drawn.random() for _ in range(2))
        ends = [
            f"{from_si(min(max(end, row.lower), row.upper), row.unit):.4g} {row.unit}" for end in (low, 1.01 * high)
        ]
        lines += [f"  {row.name}: [{', '.join(end.removesuffix(' 1') for end in ends)}]"] * (ends[0] != ends[1])
    return f"mode: {mode}\nminimize: module_mass\nvary:\n" + "\n".join(lines)


def test_open_lengths_follow_those_that_are_given():
    study = study_of("vary: {pcl_outer_radius: [12 mm, 30 mm]}\nminimize: module_mass\n")
    refuse_impossible(study)
    start = given(study)
    assert start["pcl_inner_radius"] / start["pcl_outer_radius"] == pytest.approx(26 / 40)
    # Defaults that give a module stay.
    assert given(study_of("module: {pcl_outer_radius: 41 mm}"))["pcl_inner_radius"] == pytest.approx(0.026)


@pytest.mark.parametrize("mode", MODES)
def test_a_partial_study_has_a_module_or_says_what_clashes(mode):
    studies = {seed: read_study_text(partial_study(mode, seed), "test") for seed in range(60)}
    refused = {seed: refusal(study) for seed, study in studies.items() if missing_geometry(given(study), study.table)}
    for seed, study in studies.items():
        if seed not in refused:
            refuse_impossible(study)
    for seed, message in refused.items():
        assert not re.search(r"\de-\d", message), f"seed {seed}: {message}"
        assert re.search(r"It follows from \w+ .*\.\nOne of these is enough: \w+ ", message), f"seed {seed}: {message}"
    assert len(refused) <= 6


def test_the_values_that_clash_are_named_with_the_defaults():
    assert "It follows from pcl_inner_radius 41 mm, pcl_outer_radius 25 mm." in refusal(study_of(CROSSED))
    wide = refusal(study_of("module: {arc_span: 130 deg}"))
    assert "It follows from arc_span 130°, pcl_inner_radius 26 mm (default), arc_count 4 (default)." in wide


@pytest.mark.parametrize("text", [CROSSED, "module: {pcl_inner_radius: 45 mm, pcl_outer_radius: 40 mm}\n"])
def test_each_cure_that_is_advised_cures(text):
    study = study_of(text)
    advice = refusal(study).partition("is enough: ")[2]
    cures = re.findall(r"(\w+) (\S+ mm) in place of \S+ mm(?: \(beyond its range\))?[,.]", advice)
    assert len(cures) == 2
    for name, value in cures:
        module = {**study.module, name: parse_quantity(value, "mm")}
        refuse_impossible(study.model_copy(update={"module": module, "vary": {}, "minimize": {}}))


def test_a_cure_of_one_limit_violates_no_other_that_is_met():
    wire = "module: {spring_material: music_wire}\nvary: {pcl_outer_radius: [12 mm, 30 mm]}\nminimize: module_mass\n"
    study = study_of(wire)
    start, table = given(study), study.table
    web = next(limit for limit in constraints_of(study, table, start) if limit.output == "core_web")
    advice = unchangeable(web, table, 0.4e-3, study).partition("is enough: ")[2]
    # Springs further out leave the core its web, but their pins would stand beside the rotor plate.
    assert "link_thickness" in advice
    assert "placement_radius" not in advice
