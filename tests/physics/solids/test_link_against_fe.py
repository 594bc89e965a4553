"""The closed form of the lever on top against FE of the drawn links in validation/fe_link."""

import pytest
import yaml
from support import ROOT

from tvimdesign.physics.solids import structure

LINKS = yaml.safe_load((ROOT / "validation/fe_link/results.yaml").read_text())


@pytest.mark.parametrize("name", LINKS)
def test_the_link_bends_as_in_fe(name: str) -> None:
    case = LINKS[name]
    mm = {length: value * 1e-3 for length, value in case["mm"].items()}
    youngs = case["youngs_modulus"] * 1e9
    shear = structure.shear_modulus(youngs, case["poissons_ratio"])
    sizes = 2.0 * mm["link_half_width"], mm["link_thickness"], mm["link_length"], mm["core_radius"]
    assert structure.lever_stiffness(youngs, shear, *sizes) == pytest.approx(case["link"], rel=0.03)
