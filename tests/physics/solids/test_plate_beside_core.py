"""Stress of the plate beside a core against finite elements of the drawn parts and against equilibrium."""

import numpy as np
import pytest
import yaml
from support import ROOT

from tvimdesign.physics.solids import plate_beside_core, structure

MM = 1e-3
SHIPPED = yaml.safe_load((ROOT / "validation/fe_structure/shipped.yaml").read_text())
IN_SHEAR = [name for name, case in SHIPPED.items() if case["mode"] == "shear"]


def fillet_beside(name: str) -> float:
    mm = SHIPPED[name]["mm"]
    return plate_beside_core.thicker_by_fillet(mm["rotor_thickness"] * MM, mm["foot_fillet"] * MM, MM)


@pytest.mark.parametrize("name", IN_SHEAR)
def test_all_around_a_core_the_plate_is_stressed_as_in_fe(name: str) -> None:
    mm = SHIPPED[name]["mm"]
    size = mm["rotor_thickness"] * MM, mm["core_radius"] * MM, MM
    mean = structure.mises(plate_beside_core.shear_beside_core(1.0, *size)) * fillet_beside(name) * 1e-6
    fe = SHIPPED[name]["found"]["plate_mises_mean"]
    assert mean * plate_beside_core.ENTERS == pytest.approx(fe, rel=0.035)
    if name in ("finger", "wrist_joint"):  # thin plates, whose fillets bear most: what stood here
        assert mean / fillet_beside(name) > 1.1 * fe


@pytest.mark.parametrize("fillet", [0.5, 1.0])
def test_a_fillet_bears_what_stands_on_the_plate_there(fillet: float) -> None:
    # A plate that is thick against the fillet: the fillet's section (1 - pi/4) q^2 makes it thicker by its mean height.
    found = plate_beside_core.thicker_by_fillet(50.0, fillet, 1.0)
    assert found == pytest.approx(1.0 - (1.0 - 0.25 * np.pi) * fillet**2 / 50.0, rel=2e-4)
    assert plate_beside_core.thicker_by_fillet(4.0, 0.0, 1.0) == 1.0
