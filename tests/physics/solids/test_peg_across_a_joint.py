"""The forces at which a peg gives way, against a worked example and each other."""

import numpy as np
import pytest

from tvimdesign.physics.solids.fasteners import peg_bearing_force as bearing_force
from tvimdesign.physics.solids.fasteners import peg_shear_force as shear_force


def test_a_peg_of_20_mm_in_single_shear_bears_what_the_textbook_says() -> None:
    # Area 314.16 mm^2, 100 MPa: 31.4 kN; on 15 mm of plate at 240 MPa: 72 kN.
    assert shear_force(100e6, 20e-3) == pytest.approx(31.416e3, rel=1e-4)
    assert bearing_force(240e6, 20e-3, 15e-3) == pytest.approx(72e3)


def test_a_peg_in_its_own_material_shears_off_first_where_it_is_deeper_than_half_its_diameter() -> None:
    # sigma/sqrt(3) pi d^2/4 = sigma d h at h = pi d/(4 sqrt(3)) = 0.45345 d.
    depth = 0.45345 * 3e-3
    assert bearing_force(16e6, 3e-3, depth) == pytest.approx(shear_force(16e6 / np.sqrt(3.0), 3e-3), rel=1e-4)
