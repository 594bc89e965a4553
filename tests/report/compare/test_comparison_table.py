"""Ratios and verdicts are those of the rows, swapped or not; without an optimum both are shown as drawn."""

import csv
import io
import math
from typing import Any, Literal

import pytest
from comparable import COARSE, COMPRESSION, cases, written
from hypothesis import given
from hypothesis import strategies as st

from tvimdesign.device import MODES, Output, table_for
from tvimdesign.device.table.quantity_group import directions
from tvimdesign.report.compare.comparison import Outcome, side_by_side, summary_text
from tvimdesign.report.compare.comparison_job import ComparisonJob
from tvimdesign.report.compare.comparison_table import Row, against, compare_csv
from tvimdesign.report.run.blocks.warnings import advice_text
from tvimdesign.solve.pareto.front_shape import ALIKE
from tvimdesign.study.tree import tree_of_file


def row(
    a: float, b: float, better: Literal["less", "more"] | None = "less", unit: str = "s",
    ends: dict[str, tuple[float, float]] | None = None, name: str = "response_time",
) -> Row:  # fmt: skip
    return Row(name, unit, "", True, better, {"a": a, "b": b}, ends or {})


@pytest.mark.parametrize(("better", "verdict"), [("less", "worse"), ("more", "better"), (None, "")])
def test_twice_as_much_is_what_the_row_says(better, verdict):
    mass = row(70.0, 140.0, better)
    assert mass.ratio("b") == pytest.approx(2.0)
    assert mass.verdict("b") == verdict


SIZES = st.floats(1e-3, 1e3)


@given(SIZES, SIZES, st.sampled_from(["less", "more"]))
def test_swapping_two_studies_inverts_ratio_and_verdict(a, b, better):
    straight, other = row(a, b, better), row(b, a, better)
    ratio, turned = straight.ratio("b"), other.ratio("b")
    assert ratio * turned == pytest.approx(1.0)
    opposite = {"better": "worse", "worse": "better", "same": "same"}
    assert other.verdict("b") == opposite[straight.verdict("b")]


def test_what_hardly_differs_never_happens_or_is_open_has_its_own_verdict():
    assert row(100.0, 100.0 * (1.0 + 0.9 * ALIKE)).verdict("b") == "same"
    assert row(100.0, 100.0 * (1.0 + 1.1 * ALIKE)).verdict("b") == "worse"
    endless = row(70.0, math.inf)
    assert endless.ratio("b") is None
    assert endless.verdict("b") == "worse"
    assert row(math.inf, 70.0).verdict("b") == "better"
    both = row(math.inf, math.inf)
    assert (both.ratio("b"), both.verdict("b")) == (1.0, "same")
    assert row(300.0, 600.0, unit="degC").ratio("b") is None
    reserve = row(-23.0, -49.0, "more", "K")
    assert reserve.ratio("b") is None
    assert reserve.verdict("b") == "worse"
    assert row(70.0, 140.0, ends={"a": (60.0, 150.0)}).verdict("b") == "open"
    assert row(70.0, 140.0, ends={"a": (60.0, 130.0)}).verdict("b") == "worse"


def test_sentence_and_csv_of_a_comparison():
    rows = [row(70.0, 140.0), row(0.1, 0.092, unit="g", name="module_mass"), row(1.0, 1.0, unit="mm", name="size")]
    text = against("b", "a", rows, ["response_time", "module_mass", "size"])
    assert text == (
        "b is 2 times slower (response_time 140 s against 70 s) and 8 % lighter (module_mass 92 g against 100 g) than a"
    )
    assert against("b", "a", [row(1.0, 1.0)], ["response_time"]) == "b and a do not differ"
    reported = list(csv.DictReader(io.StringIO(compare_csv({"drawn": [row(70.0, math.inf)]}))))
    assert [(line["a"], line["b"], line["ratio b"], line["verdict b"]) for line in reported] == [
        ("70.0", "never", "", "worse")
    ]


def test_outputs_that_do_not_differ_beyond_rounding_are_counted():
    alike = [row(0.0, 0.0, name="sag"), row(70.0, 70.001, name="cycle_time"), row(math.inf, math.inf, name="hold")]
    table = side_by_side("As drawn", [*alike, row(70.0, 70.1), row(0.0, 1.0, name="backlash")])
    assert [cells[0].text for cells in table.rows] == ["response_time", "backlash"]
    assert table.note == "3 more are equal."


def test_every_direction_belongs_to_an_output():
    outputs = {row.name for mode in MODES for row in table_for(mode).outputs}
    assert directions().keys() <= outputs
    mass = table_for("compression").quantity("module_mass")
    assert isinstance(mass, Output)
    assert mass.better == "less"
    times = [row for row in table_for("shear").outputs if row.name in {"response_time", "cycle_time", "switch_energy"}]
    assert [row.better for row in times] == ["less"] * 3


FIXED = COMPRESSION[: COMPRESSION.index("vary:")] + COMPRESSION[COMPRESSION.index("operating_points:") :]
REQUIRED = 'require: {spring_stiffness: ">= 5 N.m/rad", holding_torque: ">= 5 N.m"}\n'


@pytest.fixture(scope="module")
def outcome(tmp_path_factory: pytest.TempPathFactory) -> Outcome:
    """Compare a study with an optimum and another that only describes a module."""
    folder = tmp_path_factory.mktemp("unlike")
    first, second = COARSE, FIXED + REQUIRED
    paths = written(folder, shear=first, compression=second)
    jobs = {
        name: ComparisonJob(tree_of_file(path), 0, list, lambda _: None)
        for name, path in zip(("s", "c"), paths, strict=True)
    }
    return Outcome(
        dict(zip(("s", "c"), cases(folder, first, second), strict=True)),
        {name: job.run() for name, job in jobs.items()},
    )


@pytest.mark.slow
def test_drawn_modules_are_compared_where_one_has_no_optimum(outcome):
    assert "optimised" in outcome.answers["s"]
    assert "optimised" not in outcome.answers["c"]
    assert outcome.which == "drawn"
    sentence, rows = outcome.sentence, {row.name: row for row in outcome.rows["drawn"]}
    assert ", as drawn: " in sentence
    assert "each optimised" not in sentence
    assert f"{1e3 * rows['module_mass'].values['s']:.4g} g" in sentence
    assert outcome.rows.keys() == {"drawn"}


@pytest.mark.gate
def test_warnings_are_of_the_same_designs(outcome):
    text = " ".join(summary_text(outcome).split())
    for name in ("s", "c"):
        drawn: dict[str, Any] = outcome.answers[name]["drawn"]
        assert f"{name}: {drawn['soft']}" in text
        shown = [
            advice_text(warning["output"], warning["value"], warning["because"], outcome.unit(warning["output"]))
            for warning in drawn["warnings"]
        ]
        assert shown
        assert all(f"Warning {name}: {line}" in text for line in shown)
    other = {warning["output"] for warning in outcome.answers["s"]["optimised"]["warnings"]}
    for output in other - {warning["output"] for warning in outcome.answers["s"]["drawn"]["warnings"]}:
        assert f"Warning s: {output}" not in text
    reported = outcome.plain()
    assert (reported["format"], reported["units"]) == (1, "SI")
    mass = next(row for row in reported["comparisons"]["drawn"] if row["name"] == "module_mass")
    assert mass["si"]["s"] == pytest.approx(1e-3 * mass["values"]["s"])
    assert mass["si_unit"] == "kg"
    mine = {"s": outcome.answers["s"]}
    assert Outcome({"s": outcome.cases["s"]}, mine).which == "optimised"


def test_a_comparison_says_first_which_design_is_infeasible():
    answers = {label: {"optimised": {"broken": broken}} for label, broken in (("a", []), ("b", ["diameter <= 70 mm"]))}
    outcome = Outcome({}, answers, ["one"])
    outcome.designs = {"optimised": {"a": None, "b": None}}
    assert outcome._violated("optimised") == ["b is infeasible: not diameter <= 70 mm"]
