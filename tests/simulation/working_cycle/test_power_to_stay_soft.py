"""Current to stay soft against two dimensions: a plane heated by it for days, with equations of its own.

An independent reading of the modules, which counted the gap but neither ledges nor what leaves the layer's free side,
with a floor at ambient temperature, had 3.7 W and 5.0 W for these two; `docs/theory/heat.md` says what becomes of that.
"""

import sys
from typing import Any

import pytest
from support import ROOT

sys.path.insert(0, str(ROOT / "validation" / "heat_sector"))

from compare import STUDIES, Judge, model_of, plane_of

from tvimdesign.simulation.working_cycle.cycle import Simulator

DAYS = 2e5  # s
OPTIMUM_OF_THAT_DAY = {
    "wire_diameter": 1.81288e-3, "coil_diameter": 8e-3, "coil_count": 3.0, "placement_radius": 31.6415e-3,
    "core_radius": 7.52928e-3, "link_thickness": 5.16203e-3, "pcl_inner_radius": 11.92928e-3,
    "pcl_outer_radius": 23.84339e-3, "arc_span": 1.3193123, "pcl_thickness": 0.6e-3, "current": 1.6288039,
}  # fmt: skip


@pytest.mark.parametrize(
    ("study", "sizes"),
    [("paper_shear", OPTIMUM_OF_THAT_DAY), ("paper_reconstructed", {})],
    ids=["optimum", "published"],
)
def test_the_plane_stays_at_the_target_by_the_product_s_current(study: str, sizes: dict[str, Any]) -> None:
    path = STUDIES / f"{study}.yaml"
    model = model_of(path, **sizes)
    amps = Simulator(model).run(model.start, phases=["softening"]).values["hold_current"]
    held = model_of(path, **{**sizes, "current": amps})
    judge = Judge(held, plane_of(held, 0.7))
    _, states = judge.found.heat(DAYS, 30)
    rise = judge.known["target_temperature"] - judge.known["ambient_temperature"]
    assert judge.far_face(states[-1]) - judge.found.ambient == pytest.approx(rise, rel=0.03)
