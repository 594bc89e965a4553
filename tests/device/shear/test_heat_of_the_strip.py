"""Times of a switch against a strip in two dimensions, by finite volumes that share no equation with the product.

`validation/heat_sector/results.csv` has every shipped study in shear; here those that differ most, with coarser cells.
"""

from __future__ import annotations

import csv
import sys

import pytest
from support import ROOT

sys.path.insert(0, str(ROOT / "validation" / "heat_sector"))

from compare import STUDIES, compared, model_of, studies
from sector import Grid

THREE_PERCENT = 0.03
COARSE = Grid(layer=20, plate=6, across=8, beside=6)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["paper_shear", "wrist_joint"])
def test_times_are_those_of_a_strip_in_two_dimensions(name: str) -> None:
    for time, (ours, strip) in compared(model_of(STUDIES / f"{name}.yaml"), COARSE).items():
        assert ours == pytest.approx(strip, rel=THREE_PERCENT), time


def test_every_study_in_shear_with_pads_of_its_arcs_was_held_against_the_strip() -> None:
    with (ROOT / "validation" / "heat_sector" / "results.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert {row["study"] for row in rows} == {path.stem for path in studies()}
    assert all(abs(float(row["difference [%]"])) < 100.0 * THREE_PERCENT for row in rows)
