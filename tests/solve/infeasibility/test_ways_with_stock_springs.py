"""Advice where a spring is bought whole: another spring, as none of its numbers can be varied."""

import pytest

from tvimdesign.base.errors import InfeasibleError
from tvimdesign.solve.infeasibility.arithmetic_conflict import refuse_infeasible
from tvimdesign.study import read_study_text

FINGER = """
mode: shear
module: {{
  stock_spring: central_t10160, process: print_pc, placement_radius: 18 mm,
  pcl_inner_radius: 8 mm, pcl_outer_radius: 13 mm, core_radius: 5 mm,
  pin_diameter: 2 mm, leg_overhang: 1.5 mm, key_count: 0}}
vary: {{{vary}}}
require: {{{limit}}}
minimize: module_mass
solver: {{starts: 1}}
"""


@pytest.mark.parametrize(
    ("vary", "limit"),
    [
        ("preload_angle: [0.2 rad, 0.8 rad]", 'spring_stiffness: ">= 5 N.m/rad"'),
        ("pcl_thickness: [0.5 mm, 1 mm]", 'spring_rate: ">= 1 N.m/rad"'),  # nothing that is varied changes it
    ],
)
def test_another_spring_is_named_and_no_number_of_it(vary: str, limit: str) -> None:
    with pytest.raises(InfeasibleError) as caught:
        refuse_infeasible(read_study_text(FINGER.format(vary=vary, limit=limit), "test"))
    said = str(caught.value)
    assert "choose another `stock_spring`" in said, said
    assert "vary wire_diameter" not in said
    assert "wire_diameter," not in said
