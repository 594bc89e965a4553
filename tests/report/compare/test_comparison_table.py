"""Ratios and verdicts: what is better is said by the row, and swapping two studies turns everything round."""

import csv
import io
import math
from typing import Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tvimdesign.device import MODES, Output, table_for
from tvimdesign.device.table.quantity_group import directions
from tvimdesign.report.compare.comparison_table import Row, against, compare_csv
from tvimdesign.solve.pareto.front_shape import ALIKE


def row(
    a: float, b: float, better: Literal["less", "more"] | None = "less", unit: str = "s",
    ends: dict[str, tuple[float, float]] | None = None, name: str = "response_time",
) -> Row:  # fmt: skip
    return Row(name, unit, "", True, better, {"a": a, "b": b}, ends or {})


@pytest.mark.parametrize(("better", "verdict"), [("less", "worse"), ("more", "better"), (None, "")])
def test_twice_as_much_is_what_the_row_says(better: Literal["less", "more"] | None, verdict: str) -> None:
    one = row(70.0, 140.0, better)
    assert one.ratio("b") == pytest.approx(2.0)
    assert one.verdict("b") == verdict


SIZES = st.floats(1e-3, 1e3)


@given(SIZES, SIZES, st.sampled_from(["less", "more"]))
def test_swapping_two_studies_inverts_ratio_and_verdict(a: float, b: float, better: Literal["less", "more"]) -> None:
    one, other = row(a, b, better), row(b, a, better)
    ratio, turned = one.ratio("b"), other.ratio("b")
    assert ratio * turned == pytest.approx(1.0)
    opposite = {"better": "worse", "worse": "better", "same": "same"}
    assert other.verdict("b") == opposite[one.verdict("b")]


def test_what_hardly_differs_never_happens_or_is_open_has_its_own_verdict() -> None:
    assert row(100.0, 100.0 * (1.0 + 0.9 * ALIKE)).verdict("b") == "same"
    assert row(100.0, 100.0 * (1.0 + 1.1 * ALIKE)).verdict("b") == "worse"
    one = row(70.0, math.inf)
    assert one.ratio("b") is None
    assert one.verdict("b") == "worse"
    assert row(math.inf, 70.0).verdict("b") == "better"
    both = row(math.inf, math.inf)
    assert (both.ratio("b"), both.verdict("b")) == (1.0, "same")
    assert row(300.0, 600.0, unit="degC").ratio("b") is None
    reserve = row(-23.0, -49.0, "more", "K")
    assert reserve.ratio("b") is None
    assert reserve.verdict("b") == "worse"
    assert row(70.0, 140.0, ends={"a": (60.0, 150.0)}).verdict("b") == "open"
    assert row(70.0, 140.0, ends={"a": (60.0, 130.0)}).verdict("b") == "worse"


def test_sentence_and_csv_of_a_comparison() -> None:
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


def test_every_direction_belongs_to_an_output() -> None:
    outputs = {row.name for mode in MODES for row in table_for(mode).outputs}
    assert directions().keys() <= outputs
    mass = table_for("compression").quantity("module_mass")
    assert isinstance(mass, Output)
    assert mass.better == "less"
    times = [row for row in table_for("shear").outputs if row.name in {"response_time", "cycle_time", "switch_energy"}]
    assert [row.better for row in times] == ["less"] * 3
