"""Heat of the strip and of the cold sides."""

import csv
import sys
from typing import Any

import numpy as np
import pytest
from cad_designs import TILES, design_of
from device_values import all_of
from device_values import inputs_of as default_inputs
from support import ROOT, cases_of, study_path

from tvimdesign.cad.assembly.bill_of_materials import beside
from tvimdesign.device.shear import floor_heat
from tvimdesign.device.table import Module
from tvimdesign.physics.heat_flow.peltier import SIDE_SHARE, PeltierModule

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
def test_times_are_those_of_the_plane(name):
    for time, pair in compared(model_of(study_path(name))).items():
        assert pair.product == pytest.approx(pair.plane, rel=THREE_PERCENT), time


@pytest.mark.parametrize("name", ["paper_reconstructed", "paper_compression", "elbow_machined"])
def test_the_table_has_the_times_of_today_s_product(name):
    ours = product_times(model_of(study_path(name)))
    ours_before = {
        row["time"]: float(row["product [s]"]) for row in rows() if (row["study"], row["design"]) == (name, "start")
    }
    assert ours == pytest.approx(ours_before, rel=2e-3)


KELVINS = {"elbow_machined": 3.0}
"""Its layer is cooled at edges where its spreader is colder than its mean; others are within 2 K."""


def test_every_study_is_on_the_page_of_the_plane_within_two_kelvins():
    wanted = {(name, "start") for name in studies()}
    wanted |= {(name, "optimum") for name, path in studies().items() if read_study(path).vary}
    assert {(row["study"], row["design"]) for row in rows()} == wanted
    for row in beyond("results"):
        assert abs(float(row["warmer by [K]"])) < KELVINS.get(row["study"], 2.0), row
    page = PAGE.read_text(encoding="utf-8")
    assert written(page, rows(), rows("fresh")) == page, "run python docs/make/heat_tables.py"


def beyond(name: str) -> list[dict[str, str]]:
    """Rows of a table that differ by more than three per cent."""
    return [row for row in rows(name) if abs(float(row["difference [%]"])) > 100.0 * THREE_PERCENT]


@cases_of("heat_of_the_strip", "rigid_modules")
def test_rigid_modules_are_drawn_as_large_as_they_are(study, length, within):
    model = model_of(ROOT / f"{study}.yaml")
    plane, known = plane_of(model), inputs_of(model)
    sizes = model.table.evaluate(known, ["pcl_area", length, "spreader_volume", "heater_count"])
    drawn = {name: np.sum(plane.volume[plane.cells(name)]) for name in plane.materials}
    tiles = sizes["heater_count"] * known["heater_length"] * known["heater_width"] * known["heater_thickness"]
    assert drawn["hot"] + drawn["legs"] + drawn["cold"] == pytest.approx(tiles / sizes[length], rel=1e-9)
    around = sizes["pcl_area"] * known["heater_thickness"] - tiles
    assert drawn["beside tiles"] == pytest.approx(around / sizes[length], rel=1e-9)
    assert drawn["spreader"] == pytest.approx(sizes["spreader_volume"] / sizes[length], rel=within)


@pytest.mark.slow
def test_a_fresh_design_of_each_mode_is_compared_again():
    for study in ("wrist_joint_own_pins", "wrist_compression_own_pins"):
        first = next(row["design"] for row in rows("fresh") if row["study"] == study)
        for name, model, _ in designs(study, [int(first.removeprefix("draw "))]):
            recorded = {row["time"]: row for row in rows("fresh") if (row["study"], row["design"]) == (study, name)}
            times = compared(model)
            assert times.keys() == recorded.keys()
            for time, pair in times.items():
                assert pair.product == pytest.approx(float(recorded[time]["product [s]"]), rel=5e-3), time
                assert pair.plane == pytest.approx(float(recorded[time]["plane [s]"]), rel=5e-3), time


@pytest.mark.parametrize("block_height", [0.0071, 0.0083, 0.0097, 0.0113])
def test_pads_between_vanes_are_drawn_as_high_as_their_blocks(block_height):
    plane = plane_of(model_of(study_path("wrist_compression"), block_height=block_height))
    assert np.min(plane.volume) > 0.0
    assert "beside tiles" not in plane.material


THICKNESS, CONDUCTIVITY = 3.9e-3, 25.0  # m, W/m K, a rigid module's sides
AREA, EDGES = 3200e-6, 0.2  # m^2, m: a pad's half width is 16 mm


def slab(up: float) -> floor_heat.ColdSide:
    pads = PeltierModule(seebeck=0.05, resistance=2.0, conductance=up * AREA / THICKNESS)
    return floor_heat.cold_side_slab(
        Module(
            pads=pads, pad_conductivity=CONDUCTIVITY, heater_thickness=THICKNESS, heated_area=AREA, edge_length=EDGES
        )
    )


def with_cold_area(side: floor_heat.ColdSide, area: float) -> Module:
    return Module(cold_side_slab=side, heated_area=AREA, cold_area=area)


@pytest.mark.parametrize("ledges", [0.2, 0.4, 0.7])
def test_heat_goes_to_the_ledges_as_along_a_fin(ledges):
    """Compare with a fin heated evenly that gives its heat evenly over its first share s.

    Its mean is warmer by (1 - s)^2/3 of its heat over its conductance along (Carslaw and Jaeger, ch. IV).
    """
    side = slab(up=CONDUCTIVITY * 200.0)  # legs that conduct up so well that all of their height conducts along
    share = floor_heat.cold_to_ledges(with_cold_area(side, (1.0 - ledges) * AREA))
    along = CONDUCTIVITY * (1.0 - SIDE_SHARE) * THICKNESS * EDGES / (AREA / EDGES)
    assert share == pytest.approx((1.0 - ledges) ** 2 / 3.0 / along, rel=0.02)


def test_sinks_and_poor_legs_leave_a_fin_s_way():
    side = slab(up=1.5)
    to_ledges = floor_heat.cold_to_ledges(with_cold_area(side, 0.7 * AREA))
    assert floor_heat.cold_to_sink(with_cold_area(side, 0.3 * AREA)) == pytest.approx(to_ledges)
    assert floor_heat.cold_to_sink(with_cold_area(side, AREA)) == pytest.approx(0.0, abs=1e-12)
    # With next to nothing up, heat stays in the side: a fin of its thickness alone.
    share = floor_heat.cold_to_ledges(with_cold_area(slab(up=1e-6), 0.6 * AREA))
    along = CONDUCTIVITY * SIDE_SHARE * THICKNESS * EDGES / (AREA / EDGES)
    assert share == pytest.approx(0.6**2 / 3.0 / along, rel=0.02)


ROWS = "ledge_tension freezing_traction pcl_area"


def test_the_pull_of_the_layer_comes_to_the_ledges():
    # Four arcs of 0.3 to ...: the ledge is 2 mm wide around each, its corners left out of the count.
    free = all_of(ROWS, axial_preload="wave_21x25")
    inputs = default_inputs()
    inner, outer, span, ledge = (
        inputs[name] for name in ("pcl_inner_radius", "pcl_outer_radius", "arc_span", "window_ledge")
    )
    whole = 0.5 * span * (outer**2 - inner**2)
    window = 0.5 * (span - 2.0 * ledge / inner) * ((outer - ledge) ** 2 - (inner + ledge) ** 2)
    share = whole / (whole - window)
    pull = min(free["freezing_traction"], free["pcl_bond_strength"])
    assert free["ledge_tension"] == pytest.approx(pull * share, rel=0.01)
    held = all_of(ROWS, pcl_thickness=2e-3)
    assert held["ledge_tension"] <= held["pcl_bond_strength"] * share * 1.01


def test_the_bill_has_adhesive_or_grease_for_pads():
    def kinds(mode: str, changes: dict[str, Any]) -> list[str]:
        return [item.kind for item in beside(design_of("held", changes, mode), {})]

    assert "heater_adhesive" in kinds("shear", {})
    assert "thermal_grease" not in kinds("shear", {})
    assert {"heat_conducting_adhesive", "thermal_grease", "heater_adhesive"} <= set(kinds("shear", TILES))
    assert "thermal_grease" in kinds("compression", {})
