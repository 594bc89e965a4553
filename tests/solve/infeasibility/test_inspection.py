"""The deep check finds what is wrong with a problem, and nothing where nothing is."""

import numpy as np
import pytest
from small_studies import FOUR_SIZES_IN_SHEAR

from tvimdesign.solve.infeasibility.inspection import Inspection
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.study import read_study_text

TIMED = (
    FOUR_SIZES_IN_SHEAR
    + """
require:
  spring_stiffness: ">= 2 N.m/rad"
  peak_power: "<= 12 W"
  envelope_diameter: "<= 400 mm"
  pcl_area: ">= 100 mm^2"
minimize: {module_mass: 1, response_time: 1}
solver: {starts: 1, cells: 6, fineness: 0.67}
"""
)


@pytest.fixture(scope="module")
def inspection() -> Inspection:
    return Inspection(Optimizer(read_study_text(TIMED)))


def test_exact_derivatives_agree_with_differences(inspection: Inspection) -> None:
    found = inspection.derivatives()
    assert found.right
    assert 0.0 < found.worst[0][2] <= 1e-7


def test_a_wrong_derivative_is_found_and_named() -> None:
    spoilt = Inspection(Optimizer(read_study_text(TIMED)))
    names = spoilt._rows
    row = names.index("spring_stiffness >=")
    spoilt._jacobian[row, 0] *= 1.001
    found = spoilt.derivatives()
    assert not found.right
    assert found.worst[0][:2] == ("spring_stiffness >=", "wire_diameter")
    assert found.worst[0][2] == pytest.approx(1e-3, rel=0.5)


def test_a_driven_phase_s_time_follows_from_current_and_free_numbers() -> None:
    """Conditioning is by the free numbers alone: the time of the pieces is what the equation makes it."""
    text = TIMED.replace("minimize:", "profile: {softening: 3}\nminimize:")
    driven = Inspection(Optimizer(read_study_text(text)))
    decided, along, equations = driven._along()
    assert len(decided) == len(driven.problem.free) == 3
    assert 1.0 <= equations < 1e4
    assert driven._jacobian[0] @ along == pytest.approx(np.zeros(3), abs=1e-9)
    assert np.all(along[-1] != 0.0)
    assert driven.derivatives().right


def test_numbers_that_only_count_together_are_named() -> None:
    """With nothing but the diameter left, the springs' radius and the wall only add up."""
    text = """
mode: shear
vary: {placement_radius: [40 mm, 45 mm], wall_thickness: [2 mm, 6 mm]}
require: {envelope_diameter: "<= 400 mm"}
minimize: envelope_diameter
solver: {starts: 1}
"""
    found = Inspection(Optimizer(read_study_text(text)))
    rows = [i for i, name in enumerate(found._rows) if not name.startswith(("envelope", "goal"))]
    found._jacobian[rows, :] = 0.0
    conditioning = found.conditioning()
    assert {name for names in conditioning.objectives for name in names} == {"placement_radius", "wall_thickness"}


def test_effects_of_free_numbers_on_limits_match_differences() -> None:
    """Over the whole of the ranges, in logarithms, every row scaled to one; rows nothing changes are left out."""
    text = """
mode: shear
vary: {wire_diameter: [2 mm, 3 mm], coil_diameter: [20 mm, 26 mm]}
require: {spring_stiffness: ">= 2 N.m/rad", springs_mass: "<= 100 g"}
minimize: springs_mass
solver: {starts: 1}
"""
    optimizer = Optimizer(read_study_text(text))
    model = optimizer.model
    outputs = [*(limit.output for limit in optimizer.problem.limits), "springs_mass"]
    scales = np.array([*(limit.scale for limit in optimizer.problem.limits), 1.0])
    never = dict.fromkeys(model.switch_names, np.inf)
    columns = []
    for free in optimizer.free:
        place, step = model.index[free.name], 1e-5
        ends = [model.start.copy(), model.start.copy()]
        ends[0][place], ends[1][place] = (model.start[place] * np.exp(sign * step) for sign in (1.0, -1.0))
        above, below = (model.some_values(outputs, end, never) for end in ends)
        slopes = [(above[name] - below[name]) / (2.0 * step) for name in outputs]
        columns.append(np.array(slopes) / scales * np.log(free.upper / free.lower))
    matrix = np.column_stack(columns)
    sizes = np.linalg.norm(matrix, axis=1)
    seen = sizes > 1e-9
    expected = np.linalg.cond(matrix[seen] / sizes[seen, None])
    assert Inspection(optimizer).conditioning().decisions == pytest.approx(expected, rel=1e-4)


def test_a_limit_that_nothing_varied_changes_is_told(inspection: Inspection) -> None:
    structure = inspection.structure()
    assert structure.unchangeable == ("pcl_area >= 100 mm²",)
    assert structure.idle == ()
