"""Times of a switch against two dimensions, by finite volumes that share no equation with the product.

`validation/heat_sector/results.csv` has every shipped study as it starts and at its optimum; here two of them
again.
"""

from __future__ import annotations

import csv
import re
import sys
from collections.abc import Iterator

import numpy as np
import pytest
from support import ROOT

sys.path.insert(0, str(ROOT / "validation" / "heat_sector"))

from compare import STUDIES, compared, model_of, product_times, studies

from tvimdesign.study import read_study

THREE_PERCENT = 0.03


def rows(name: str = "results") -> list[dict[str, str]]:
    with (ROOT / "validation" / "heat_sector" / f"{name}.csv").open() as file:
        return list(csv.DictReader(file))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["paper_shear", "calibrated_shear"])
def test_times_of_the_paper_s_sizes_are_those_of_the_plane(name: str) -> None:
    for time, (ours, plane) in compared(model_of(STUDIES / f"{name}.yaml")).items():
        assert ours == pytest.approx(plane, rel=THREE_PERCENT), time


@pytest.mark.parametrize("name", ["calibrated_shear", "calibrated_compression"])
def test_the_table_has_the_times_of_today_s_product(name: str) -> None:
    ours = product_times(model_of(STUDIES / f"{name}.yaml"))
    kept = {
        row["time"]: float(row["product [s]"]) for row in rows() if (row["study"], row["design"]) == (name, "start")
    }
    assert ours == pytest.approx(kept, rel=2e-3)


def test_every_study_was_held_against_the_plane_at_its_start_and_its_optimum() -> None:
    wanted = {(path.stem, "start") for path in studies()}
    wanted |= {(path.stem, "optimum") for path in studies() if read_study(path).vary}
    assert {(row["study"], row["design"]) for row in rows()} == wanted


def reached(mode: str, time: str) -> Iterator[float]:
    """Differences of a time in all studies of a mode that the plane reached [%]."""
    for row in rows():
        of_mode = read_study(STUDIES / f"{row['study']}.yaml").mode == mode
        if row["time"] == time and of_mode and np.isfinite(float(row["plane [s]"])):
            yield float(row["difference [%]"])


@pytest.mark.parametrize("mode", ["shear", "compression"])
@pytest.mark.parametrize("time", ["softening_time", "mean_time", "far_face_time"])
def test_the_theory_says_how_far_the_product_is_off(mode: str, time: str) -> None:
    page = (ROOT / "docs" / "theory" / "heat.md").read_text()
    (line,) = re.findall(rf"^\| `{time}`, {mode} \| (.*) \|$", page, flags=re.MULTILINE)
    low, high = (float(number.replace("−", "-")) for number in re.findall(r"[+−][\d.]+", line))
    found = list(reached(mode, time))
    assert (low, high) == pytest.approx((min(found), max(found)), abs=0.06)


def test_finite_elements_bear_the_plane_out() -> None:
    judged = rows("outside_judge")
    assert {row["pads"] for row in judged} == {"usual", "badly conducting", "well conducting"}
    assert all(abs(float(row["difference [%]"])) < 100.0 * THREE_PERCENT for row in judged)
