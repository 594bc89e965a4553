"""What a softening time may be in two dimensions, against the table of the studies that were held against them."""

from __future__ import annotations

import csv
import math

import pytest
from support import ROOT

from tvimdesign.report.run.first_screen.two_dimensions import in_two_dimensions
from tvimdesign.report.run.first_screen.verdict import module_lines
from tvimdesign.solve.result import answer
from tvimdesign.study import read_study
from tvimdesign.study.design import Design


def design(mode: str, seconds: float, form: str = "flexible") -> Design:
    return Design(
        tvimdesign="0", name="x", mode=mode, status="evaluated", choices={"heater_form": form},
        values={"softening_time": seconds}, study={},
    )  # fmt: skip


@pytest.mark.parametrize("mode", ["shear", "compression"])
def test_every_study_s_time_in_two_dimensions_lies_within_what_is_told_and_two_lie_at_its_ends(mode: str) -> None:
    with (ROOT / "validation/heat_sector/results.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["time"] == "softening_time"]
    found = []
    for row in rows:
        if read_study(ROOT / f"studies/{row['study']}.yaml").mode == mode:
            product, plane = float(row["product [s]"]), float(row["plane [s]"])
            low, high = in_two_dimensions(design(mode, product)) or (0.0, 0.0)
            assert low * 0.999 <= plane <= high * 1.001, row
            found.append(plane / product)
    low, high = in_two_dimensions(design(mode, 1.0)) or (0.0, 0.0)
    assert (min(found), max(found)) == pytest.approx((low, high), rel=1e-3)


def test_nothing_is_told_of_modules_that_were_not_looked_at_or_never_soften() -> None:
    assert in_two_dimensions(design("shear", 20.0, "rigid")) is None
    assert in_two_dimensions(design("shear", math.inf)) is None


def test_the_screen_has_it_beside_the_time() -> None:
    study = read_study(ROOT / "studies/calibrated_compression.yaml")
    found = answer(study)
    soft = next(line for line in module_lines(found, study.table, {}, 200) if line.startswith("Soft after"))
    time = found.design.values["softening_time"]
    assert f"{time / 0.871:.3g} to {time / 0.597:.3g} s in two dimensions" in soft
