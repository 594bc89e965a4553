"""Power to stay soft against an independent reading of the module, with the floor at ambient temperature.

That reading counted the gap's air and the plate's underside, with a cold floor and pads that lose nothing at their
edges: 3.7 W for the optimum of `paper_shear` of that day, and 5.0 W for the module as published.
"""

from __future__ import annotations

from typing import Any

import pytest
from support import ROOT

from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.study import given, read_study

COLD_FLOOR = {"housing_coefficient": 1e4, "pad_edge_contact": 1.0}
OPTIMUM_OF_THAT_DAY = {
    "wire_diameter": 1.81288e-3, "coil_diameter": 8e-3, "coil_count": 3.0, "placement_radius": 31.6415e-3,
    "core_radius": 7.52928e-3, "link_thickness": 5.16203e-3, "pcl_inner_radius": 11.92928e-3,
    "pcl_outer_radius": 23.84339e-3, "arc_span": 1.3193123, "pcl_thickness": 0.6e-3, "current": 1.6288039,
}  # fmt: skip


@pytest.mark.parametrize(
    ("study", "sizes", "watts"),
    [("paper_shear", OPTIMUM_OF_THAT_DAY, 3.7), ("paper_as_published", {}, 5.0)],
    ids=["optimum", "published"],
)
def test_gap_and_underside_take_what_an_independent_reading_found(
    study: str, sizes: dict[str, Any], watts: float
) -> None:
    read = read_study(ROOT / "studies" / f"{study}.yaml")
    values = {**given(read), **sizes, **COLD_FLOOR}
    model = DeviceFunctions(table_for("shear"), values, tuple(read.operating_points), read.solver.cells)
    found = Simulator(model).run(model.start, phases=["softening"]).values
    assert found["hold_power"] == pytest.approx(watts, rel=0.1)
