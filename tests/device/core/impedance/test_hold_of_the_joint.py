"""Set, backlash and relaxation after a hold in either mode: by hand at the ends, and by one formula."""

from typing import Any

import numpy as np
import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.device import table_for

SHEAR, COMPRESSION = table_for("shear"), table_for("compression")
LEFT = ["hold_angle", "pcl_relaxation", "set_angle", "backlash", "relaxation_loss"]


def at(table: Any, given: dict[str, Any], point: str, *more: str) -> dict[str, Any]:
    rows = ["hold_torque", "spring_stiffness", *more]
    found = table.evaluate(given, [*rows, *(f"{name}@{point}" for name in [*LEFT, "elastic_support", "pcl_modes"])])
    return {name.partition("@")[0]: value for name, value in found.items()}


def test_loads_turn_springs_and_blocks_relax(squeezed: dict[str, Any]) -> None:
    found = at(COMPRESSION, {**squeezed, "hold_share": 0.4}, "hot")
    assert found["hold_torque"] == pytest.approx(0.4 * found["spring_stiffness"] * 0.104, rel=1e-12)
    # The melt has let go within ten seconds.
    assert found["hold_angle"] == pytest.approx(0.4 * 0.104, rel=1e-5)
    found = at(COMPRESSION, squeezed, "hot")
    assert found["backlash"] == pytest.approx(0.104, rel=1e-5)
    assert found["pcl_relaxation"] == pytest.approx(1.0, rel=1e-9)
    at_once = sum(stiffness for _, stiffness in found["pcl_modes"])
    branch = 1.0 / (1.0 / at_once + 1.0 / found["elastic_support"])
    left = found["spring_stiffness"] / (found["spring_stiffness"] + branch)
    assert found["relaxation_loss"] == pytest.approx(1.0 - left, rel=1e-5)
    gaps = [at(COMPRESSION, {**squeezed, "hold_time": time}, "cold")["backlash"] for time in (0.1, 10.0, 1000.0)]
    assert 0.0 < gaps[0] < gaps[1] < gaps[2] < 1e-3 * 0.104
    elastic = [(1e16, 4e4), (1e16, 1e3)]
    found = at(COMPRESSION, {**squeezed, "pcl_modes@cold": elastic}, "cold")
    assert found["backlash"] == pytest.approx(0.0, abs=1e-15)
    assert found["relaxation_loss"] == pytest.approx(0.0, abs=1e-12)
    assert not any("contact_lost" in name for name in COMPRESSION.names(("cold", "hot")))
    with pytest.raises(InputError, match="has no value"):
        COMPRESSION.evaluate(squeezed, ["contact_lost@hot"])


@pytest.mark.parametrize("point", ["cold", "hot"])
def test_bonded_layer_relaxes_and_cannot_part(inputs: dict[str, Any], point: str) -> None:
    found = at(SHEAR, inputs, point, "parting_share")
    assert found["parting_share"] == 0.0
    assert found["set_angle"] > 0.0
    assert found["pcl_relaxation"] > 0.1
    assert found["backlash"] == 0.0
    assert found["relaxation_loss"] == 0.0
    # The same layer that could part would leave its set as a gap: it is the bond that makes the difference.
    parted = at(SHEAR, {**inputs, "parting_share": 1.0}, point)
    assert parted["backlash"] == pytest.approx(found["set_angle"], rel=1e-12)
    assert parted["relaxation_loss"] > 0.0


def test_same_spectrum_and_support_leave_the_same_set_in_either_mode(
    inputs: dict[str, Any], squeezed: dict[str, Any]
) -> None:
    from_template = {
        "pcl_modes@hot": [(3.0, 200.0), (0.1, 900.0)],
        "elastic_support@hot": 700.0,
        "spring_stiffness": 5.6,
    }
    one, other = at(SHEAR, {**inputs, **from_template}, "hot"), at(COMPRESSION, {**squeezed, **from_template}, "hot")
    for name in ("hold_angle", "pcl_relaxation", "set_angle"):
        assert one[name] == pytest.approx(other[name], rel=1e-9), name


def test_bond_and_blocks_bear_the_load_when_it_has_just_come_on(
    inputs: dict[str, Any], squeezed: dict[str, Any]
) -> None:
    def borne(table: Any, given: dict[str, Any], row: str) -> tuple[float, float]:
        support = "elastic_support@hot"
        found = table.evaluate(given, [row, "hold_torque", "spring_stiffness", support, "pcl_modes@hot"])
        branch = 1.0 / (1.0 / sum(k for _, k in found["pcl_modes@hot"]) + 1.0 / found[support])
        return found[row], found["hold_torque"] * branch / (branch + found["spring_stiffness"])

    traction, torque = borne(SHEAR, inputs, "bond_traction@hot")
    # Four arcs of 48.962 degrees between 26 and 40 mm.
    moment = 0.25 * 4 * np.radians(48.962) * (40e-3**4 - 26e-3**4)
    assert traction == pytest.approx(torque * 40e-3 / moment, rel=1e-9)
    pressure, torque = borne(COMPRESSION, squeezed, "block_pressure@hot")
    # Six blocks of 14 x 3.5 mm at 33 mm.
    assert pressure == pytest.approx(torque / (6 * 49e-6 * 33e-3), rel=1e-9)
