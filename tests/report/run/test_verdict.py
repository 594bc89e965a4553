"""The verdict and the facts of a result: each rule on a result that it decides."""

from collections import ChainMap
from dataclasses import replace
from itertools import starmap
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from support import cases_of

from tvimdesign.cad.parts.jigs import TRIED
from tvimdesign.device import table_for
from tvimdesign.report.output.tables import margin_text
from tvimdesign.report.run.blocks.facts import heater_voltage
from tvimdesign.report.run.blocks.more_facts import chosen_fact, stalling_in_words, time_over_rise
from tvimdesign.report.run.blocks.verdict import TARGET, TESTED, starts_in_words, verdict
from tvimdesign.report.run.blocks.warnings import RunWarning, advice_text
from tvimdesign.solve.nlp.solution import Choosing, ConflictSet, Side, Solution, SolverEffort, Standard, Start
from tvimdesign.solve.result import ConstraintCheck, StudyResult
from tvimdesign.study.design import Design

SURE = {
    "parts_yield": {"share": 0.97, "low": 0.96, "high": 0.98}, "held": {"retainer_thread_margin >=": 0.4},
    "intervals": {"retainer_thread_margin": {"shares": {"structure_layer_strength": 0.8}}},
}  # fmt: skip
BOTH = {
    "held": {"retainer_thread_margin >=": 0.4, "friction_share <=": 0.7, "pin_wear <=": 0.9},
    "intervals": {
        "retainer_thread_margin": {"shares": {"structure_layer_strength": 0.8}},
        "friction_share": {"shares": {"pin_friction": 0.6}}, "pin_wear": {"shares": {"bond_strength": 0.6}},
    },
}  # fmt: skip
THREE = BOTH | {"held": BOTH["held"] | {"pin_wear <=": 0.7}}
CERTAIN = {"held": {"retainer_thread_margin >=": 0.8}}
FEW, SOME = ({"ranges_hold": {"share": count / 512}, "draws": 512} for count in (5, 50))
FOUR = {
    "held": THREE["held"] | {"foot_margin >=": 0.7},
    "intervals": BOTH["intervals"] | {"foot_margin": {"shares": {"layer_height": 0.6}}},
}
WALL = {
    "held": {"hole_margin >=": 0.3, **FOUR["held"]},
    "intervals": {"hole_margin": {"shares": {"minimum_wall": 0.8}}, **FOUR["intervals"]},
}
RUBS = RunWarning(advice_text("friction_share", 13.7, "", "1"), "", "grave", "it does not return by its springs")
GRAVE = RunWarning("pin fillet safety is 0.93: pins may crack at their fillet", "", "grave")
HOT = {"output": "joint_stiffness@hot", "sense": "<=", "limit": 1.5}
COOL = {"softened_temperature": 340.15, "temperature@hot": 373.15, "softened_stiffness": 2.5, "softened_range": 50.0}


def check(text: str, margin: float) -> ConstraintCheck:
    """Return a limit that is met by a margin, or violated."""
    return ConstraintCheck(text, text.split(maxsplit=1)[0], 1.0, margin, 1.0, False, margin >= 0.0, margin, "require")


def answer(
    values: dict[str, float] | None = None, require: tuple[dict[str, Any], ...] = (), *, feasible: bool = True,
    checks: tuple[ConstraintCheck, ...] = (), status: str = "optimal", above: tuple[str, ...] = (),
    robust: dict[str, float] | None = None, **solution: Any,
) -> StudyResult:  # fmt: skip
    """Return an optimised study as far as a verdict looks at it."""
    every = {"response_time": 60.0, "stiffening_time": 120.0, **(values or {})}
    design = SimpleNamespace(
        table=table_for("shear"), choices={"making_method": "printed"}, status=status, values=every,
        value=every.__getitem__, above_rating=above,
        study={"require": require, "robust": robust, "minimize": {"module_mass": 1.0}},
    )  # fmt: skip
    of = {"conflict_set": None, "out_of_time": None, "yield_reached": None, **solution}
    fields = {"has_design": feasible, "checks": checks, "yield_reached": of["yield_reached"]}
    return cast(StudyResult, SimpleNamespace(design=design, solution=SimpleNamespace(**of), **fields))


def named(parts: list[Any]) -> list[Any]:
    """Return what a row of cases names of this file, and the rest as it is."""
    return [globals()[part] if isinstance(part, str) and part.isupper() else part for part in parts]


@cases_of("verdict", "each_rule_decides")
def test_each_rule_decides(answered, uncertainty, warnings, text):
    given = answered | {"checks": tuple(starmap(check, answered.get("checks", {}).items()))}
    sides = tuple(Side(limit, "require", 0.1) for limit in given.pop("conflict", ()))
    searched = given.pop("searched", True)
    given |= {"values": ChainMap({}, *named(given.get("values", []))[::-1]), "require": named(given.get("require", []))}
    result = answer(**given, conflict_set=ConflictSet((), sides, ()) if sides else None)
    result.solution = result.solution if searched else None
    of = [part if isinstance(part, RunWarning) else RunWarning(**part) for part in named(warnings)]
    assert verdict(result, dict(ChainMap({}, *named(uncertainty)[::-1])), of).text == text


@pytest.mark.parametrize(
    ("values", "require"),
    [
        (COOL, ()),  # nothing is required at the hot point
        (COOL | {"softened_stiffness": 1.4}, (HOT,)),  # the joint is as soft as required before
        (COOL | {"softened_stiffness": 1.50002}, (HOT,)),  # at its limit, as a solver leaves it
        (COOL | {"softened_temperature": 373.05}, (HOT,)),  # rounding
        (COOL, ({"output": "impedance_range", "sense": ">=", "limit": 40.0},)),
        (COOL | {"temperature@cold": 303.15}, (HOT | {"output": "joint_stiffness@cold"},)),
    ],
)
def test_a_hot_point_that_is_not_needed_is_no_matter(values, require):
    assert verdict(answer(values, require), SURE, []).kind == "build_one"


def test_a_study_with_margins_is_no_nominal_optimum():
    low = SURE | {"parts_yield": {"share": TARGET - 0.05}}
    assert verdict(answer(robust={"share": 0.9}), low, []).kind == "build_one"
    assert verdict(answer(), low, []).kind == "add_margins"
    evaluated = answer(robust={"share": 0.92})
    evaluated.solution = None
    assert verdict(evaluated, low, []).text == "Margins not reached: yield 90 % of 92 % asked"
    assert verdict(evaluated, SURE, []).kind == "build_one"


def test_a_violation_below_rounding_is_not_shown_as_none():
    table, gap = (
        table_for("shear"),
        ConstraintCheck("core_web >= 1 mm", "core_web", 0.0, -4e-5, 1e-2, True, False, -4e-5, "rule"),
    )
    assert margin_text(gap, table) == "-0.0004 mm"
    assert margin_text(replace(gap, absolute=False), table) == "-0.004 %"
    heat = replace(gap, output="heater_temperature_margin", margin=4.7, scale=5.0, absolute=False)
    assert margin_text(heat, table) == "23.5 K"  # a difference is no size that a share could be taken of
    assert margin_text(replace(gap, met=True), table) == "0 mm"  # within the solver's tolerance
    assert verdict(answer(checks=(gap,)), SURE, []).text.endswith("by 0.0004 mm")


@pytest.mark.parametrize(
    ("feasible", "converged", "optima", "words"),
    [
        (True, [False], 0, "no start converged, a later search did"),
        (True, [True], 1, "1 start tried"),
        (False, [False], 0, "1 start, no design"),
        (False, [True, False], 1, "1 of 2 starts converged"),
    ],
)
def test_starts_are_counted_in_words(feasible, converged, optima, words):
    free = [SimpleNamespace(converged=each) for each in converged]
    result = answer(
        feasible=feasible, free_starts=free, distinct_optima=lambda: free[:optima], start_count=lambda: len(free)
    )
    assert starts_in_words(result) == [words]


def test_a_search_beside_an_optimum_counts_with_its_start():
    first = Start(0, "Solve_Succeeded", True, 5, 1.0, 0.0, {"current": 1.0}, {"current": 2.0})
    beside = replace(first, number=1, by_neighbor=True, objective=0.9, end={"current": 1.5})
    other = replace(first, number=2, begin={"current": 3.0})
    account = cast("Solution", SimpleNamespace(free_starts=(first, beside, other)))
    assert Solution.start_count(account) == 2
    assert Solution.reached(account, first) == 2
    assert Solution.reached(account, beside) == 1


def entry(value: float, now: tuple[float, float], before: tuple[float, float | None] | None) -> dict[str, Any]:
    earlier = None if before is None else {"low": before[0], "high": before[1]}
    return {"value": value, "low": now[0], "high": now[1], "unit": "s", "before": earlier}


RANKED = ((1.0e-3, 0.6339), (1.1e-3, 0.6426), (1.2e-3, 0.6541))
"""Wires and objectives of the printed elbow's search."""


def chosen(own: float, robust: dict[str, Any] | None, spring: str = "none") -> str:
    """Return the sentence on a design with this wire [m], whose study requires margins or not."""
    best = tuple(Standard({"wire_diameter": wire, "stock_spring": "none"}, objective, {}) for wire, objective in RANKED)
    none = SolverEffort()
    choosing = Choosing(
        20, 20, 0, 0, best=best, between=None, proven=False, improved=0.0, work=none, proof=none, inside=0.0
    )
    design = SimpleNamespace(
        table=table_for("shear"),
        values={"wire_diameter": own},
        choices={"stock_spring": spring},
        study={"robust": robust},
    )
    answer = SimpleNamespace(solution=SimpleNamespace(choosing=choosing), design=design)
    return chosen_fact(cast(StudyResult, answer))[0].text


def test_a_design_s_own_choices_are_shown_beside_the_ranking():
    text = chosen(1.0e-3, None)
    assert text == "wire diameter 1 mm · stock spring none · best of 20 combinations"
    robust = {"share": 0.95, "sigma": None}
    assert "the best is stock spring none" in chosen(1.0e-3, robust, "central_t10160")
    assert "best of 20 combinations, ranked without margins" in chosen(1.0e-3, robust)
    text = chosen(1.1e-3 * (1 + 1e-12), {"share": None, "sigma": 2.0})
    assert "without margins the best is wire diameter 1 mm" in text


def warmed(share: np.ndarray) -> dict[str, list[float]]:
    """Two cells that warm from 20 degC by shares of 80 K, one a little behind, over 100 s."""
    return {"time": np.linspace(0.0, 100.0, len(share)).tolist(), "cell_1": (20.0 + 80.0 * share).tolist(),
            "cell_2": (20.0 + 76.0 * share).tolist()}  # fmt: skip


def test_a_layer_that_stalls_cools_again_or_never_softens():
    times = np.linspace(0.0, 1.0, 2001)
    assert time_over_rise(warmed(times), 60.0) == pytest.approx(1.0, rel=1e-6)
    assert time_over_rise(warmed(np.sqrt(times)), 60.0) == pytest.approx(2.0, rel=1e-3)
    # 1 - exp(-t/tau): rise over (t slope) is (exp(x) - 1)/x with x = t/tau, here 3.
    temperatures = warmed(1.0 - np.exp(-times / 0.2))
    assert time_over_rise(temperatures, 60.0) == pytest.approx((np.exp(3.0) - 1.0) / 3.0, rel=1e-3)
    assert stalling_in_words(temperatures, 60.0) == "it stalls: 1 % less heat takes 6 % longer"
    assert stalling_in_words(temperatures, 20.0) == ""
    falling = warmed(np.concatenate([np.linspace(0.0, 1.0, 50), np.linspace(1.0, 0.9, 50)]))
    assert "never soft" in stalling_in_words(falling, 90.0)
    assert stalling_in_words(falling, float("inf")) == ""
    assert stalling_in_words(None, 10.0) == ""
    assert stalling_in_words(falling, 0.0) == ""  # soft from the start: nothing is waited for


@pytest.mark.parametrize(
    ("volts", "words"),
    [(7.151, "7.15 V (7 to 8) of the supply's 24 V"), (22.0, "22 V (7 to 8)"), (24.0, "24 V (7 to 8)")],
)
def test_a_heater_that_needs_far_less_than_the_supply_is_stepped_down(volts, words):
    limits = [{"output": "peak_voltage", "sense": "<=", "limit": 24.0}]
    values = {"peak_voltage": volts, "stiffening_peak_voltage": 1.0}
    design = Design.model_construct(mode="shear", values=values, study={"require": limits})
    answered = cast(StudyResult, SimpleNamespace(design=design))
    assert heater_voltage(answered, {"intervals": {"peak_voltage": entry(volts, (7.0, 8.0), None)}}) == words
    design.study["require"] = []
    assert heater_voltage(answered, {}) == f"{volts:.3g} V"


def test_the_verdict_knows_what_the_test_pieces_try():
    assert {name for name, _ in TRIED.values()} <= set(TESTED)
