"""Where one of two studies has no optimum, both are drawn and told as drawn, and neither one's optimum stands in."""

from typing import Any

import pytest
from comparable import COARSE, COMPRESSION, entrants, written

from tvimdesign.report.compare.comparison import Outcome
from tvimdesign.report.compare.comparison_job import ComparisonJob
from tvimdesign.report.compare.comparison_page import summary_text
from tvimdesign.study.tree import tree_of_file

FIXED = COMPRESSION[: COMPRESSION.index("vary:")] + COMPRESSION[COMPRESSION.index("operating_points:") :]
REQUIRED = 'require: {spring_stiffness: ">= 5 N.m/rad", holding_torque: ">= 5 N.m"}\n'


@pytest.fixture(scope="module")
def outcome(tmp_path_factory: pytest.TempPathFactory) -> Outcome:
    """A study with an optimum, and one that only says what a module is."""
    folder = tmp_path_factory.mktemp("unlike")
    first, second = COARSE, FIXED + REQUIRED
    paths = written(folder, shear=first, compression=second)
    jobs = {
        name: ComparisonJob(tree_of_file(path), 0, list, lambda _: None)
        for name, path in zip(("s", "c"), paths, strict=True)
    }
    return Outcome(
        dict(zip(("s", "c"), entrants(folder, first, second), strict=True)),
        {name: job.run() for name, job in jobs.items()},
    )


@pytest.mark.gate
def test_drawn_modules_are_compared_where_one_has_no_optimum(outcome: Outcome) -> None:
    assert "optimised" in outcome.found["s"]
    assert "optimised" not in outcome.found["c"]
    assert outcome.which == "drawn"
    sentence, rows = outcome.sentence, {row.name: row for row in outcome.rows["drawn"]}
    assert ", as drawn: " in sentence
    assert "each optimised" not in sentence
    assert f"{1e3 * rows['module_mass'].values['s']:.4g} g" in sentence
    assert outcome.rows.keys() == {"drawn"}


@pytest.mark.gate
def test_warnings_are_of_the_same_designs(outcome: Outcome) -> None:
    text = " ".join(summary_text(outcome).split())
    for name in ("s", "c"):
        told: dict[str, Any] = outcome.found[name]["drawn"]
        assert f"{name}: {told['soft']}" in text
        assert all(f"Warning {name}: {warning['output']} is" in text for warning in told["warnings"])
    other = {warning["output"] for warning in outcome.found["s"]["optimised"]["warnings"]}
    for output in other - {warning["output"] for warning in outcome.found["s"]["drawn"]["warnings"]}:
        assert f"Warning s: {output}" not in text
    reported = outcome.plain()
    assert (reported["format"], reported["units"]) == (1, "SI")
    mass = next(row for row in reported["comparisons"]["drawn"] if row["name"] == "module_mass")
    assert mass["si"]["s"] == pytest.approx(1e-3 * mass["values"]["s"])
    assert mass["si_unit"] == "kg"
    mine = {"s": outcome.found["s"]}
    assert Outcome({"s": outcome.entrants["s"]}, mine).which == "optimised"
