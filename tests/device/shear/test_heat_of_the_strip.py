"""Times of a switch against two dimensions, by finite volumes that share no equation with the product.

`validation/heat_sector/results.csv` has every study as it starts and at its optimum; here two of them
again.
"""

import csv
import sys

import numpy as np
import pytest
from support import ROOT, study_path

sys.path.insert(0, str(ROOT / "validation" / "heat_sector"))
sys.path.insert(0, str(ROOT / "docs" / "make"))

from compare import compared, inputs_of, model_of, plane_of, product_times, studies
from fresh import designs
from heat_tables import PAGE, written

from tvimdesign.study import read_study

THREE_PERCENT = 0.03


def rows(name: str = "results") -> list[dict[str, str]]:
    with (ROOT / "validation" / "heat_sector" / f"{name}.csv").open() as file:
        return list(csv.DictReader(file))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["paper_shear", "paper_compression", "wrist_compression", "wrist_joint"])
def test_times_are_those_of_the_plane(name: str) -> None:
    for time, one in compared(model_of(study_path(name))).items():
        assert one.product == pytest.approx(one.plane, rel=THREE_PERCENT), time


@pytest.mark.parametrize("name", ["paper_reconstructed", "paper_compression", "elbow_machined"])
def test_the_table_has_the_times_of_today_s_product(name: str) -> None:
    ours = product_times(model_of(study_path(name)))
    kept = {
        row["time"]: float(row["product [s]"]) for row in rows() if (row["study"], row["design"]) == (name, "start")
    }
    assert ours == pytest.approx(kept, rel=2e-3)


def test_every_study_is_on_the_page_of_the_plane_within_two_kelvins() -> None:
    wanted = {(name, "start") for name in studies()}
    wanted |= {(name, "optimum") for name, path in studies().items() if read_study(path).vary}
    assert {(row["study"], row["design"]) for row in rows()} == wanted
    for row in beyond("results"):
        assert abs(float(row["warmer by [K]"])) < 2.0, row
    page = PAGE.read_text(encoding="utf-8")
    assert written(page, rows(), rows("fresh")) == page, "run python docs/make/heat_tables.py"


def beyond(name: str) -> list[dict[str, str]]:
    """Rows of a table that differ by more than three per cent."""
    return [row for row in rows(name) if abs(float(row["difference [%]"])) > 100.0 * THREE_PERCENT]


@pytest.mark.parametrize(
    ("study", "length", "within"),
    # The arcs' corners, rounded as the spreaders are, take less than a hundredth of their volume.
    [
        ("studies/elbow_printed", "edge_length", 0.01),
        ("validation/fe_structure/studies/rigid_modules_compression", "ring_width", 1e-9),
    ],
)
def test_rigid_modules_are_drawn_as_large_as_they_are(study: str, length: str, within: float) -> None:
    model = model_of(ROOT / f"{study}.yaml")
    found, known = plane_of(model), inputs_of(model)
    sizes = model.table.evaluate(known, ["pcl_area", length, "spreader_volume", "heater_count"])
    drawn = {name: np.sum(found.volume[found.cells(name)]) for name in found.materials}
    tiles = sizes["heater_count"] * known["peltier_length"] * known["peltier_width"] * known["peltier_thickness"]
    assert drawn["hot"] + drawn["legs"] + drawn["cold"] == pytest.approx(tiles / sizes[length], rel=1e-9)
    around = sizes["pcl_area"] * known["peltier_thickness"] - tiles
    assert drawn["beside tiles"] == pytest.approx(around / sizes[length], rel=1e-9)
    assert drawn["spreader"] == pytest.approx(sizes["spreader_volume"] / sizes[length], rel=within)


@pytest.mark.slow
def test_a_fresh_design_of_each_mode_is_compared_anew() -> None:
    for study in ("wrist_joint", "wrist_compression"):
        for name, model in designs(study, 1):
            kept = {row["time"]: row for row in rows("fresh") if (row["study"], row["design"]) == (study, name)}
            found = compared(model)
            assert found.keys() == kept.keys()
            for time, one in found.items():
                assert one.product == pytest.approx(float(kept[time]["product [s]"]), rel=5e-3), time
                assert one.plane == pytest.approx(float(kept[time]["plane [s]"]), rel=5e-3), time


@pytest.mark.parametrize("block_height", [0.0071, 0.0083, 0.0097, 0.0113])
def test_pads_between_vanes_are_drawn_as_high_as_their_blocks(block_height: float) -> None:
    found = plane_of(model_of(study_path("wrist_compression"), block_height=block_height))
    assert np.min(found.volume) > 0.0
    assert "beside tiles" not in found.material
