"""The optimum of a compression module: the same from anywhere, and kept by a simulation of its own."""

import numpy as np
import pytest
from small_studies import COMPRESSION_BLOCKS

from tvimdesign.solve.nlp.solution import Solution
from tvimdesign.solve.search import optimize
from tvimdesign.study import read_study_text

SMALL = (
    """
mode: compression
module:
  response_criterion: mean
  core_radius: 8 mm
  link_dowel: iso_8734_2
  rotor_rim: 8 mm
  pcl_inner_radius: 13 mm
  block_height: 11 mm
  block_depth: 4 mm
  vane_thickness: 4 mm
  coil_diameter: 12 mm
  coil_count: 6.7
vary:
  coil_diameter: [10 mm, 16 mm]
  coil_count: [4, 9]
"""
    + COMPRESSION_BLOCKS
    + "solver: {starts: 7, seed: 1}\n"
)


@pytest.mark.slow
def test_six_random_starts_come_to_one_optimum_that_keeps_every_limit() -> None:
    solution = optimize(read_study_text(SMALL, "test"), lambda _: None)
    assert solution.status == "optimal"
    assert solution.feasible
    assert all(start.converged for start in solution.starts)
    objectives = [start.objective for start in solution.starts]
    assert max(objectives) - min(objectives) <= 1e-4 * min(objectives)
    for name, value in solution.starts[0].end.items():
        assert np.allclose([start.end[name] for start in solution.starts], value, rtol=1e-3), name
    # The mode's own price: the stroke squeezes the block, so its depth cannot be less than twice the way of the vane.
    assert 0.49 < solution.values["block_strain"] < 0.5005


@pytest.mark.slow
@pytest.mark.parametrize(("row", "most"), [("backlash@cold", "<= 0.000008 rad"), ("relaxation_loss@cold", "<= 0.003")])
def test_what_a_hold_leaves_can_be_limited_and_costs_size_or_time(row: str, most: str) -> None:
    def solved(more: str) -> Solution:
        text = SMALL.replace("accept:", f"{more}accept:").replace("starts: 7", "starts: 2")
        return optimize(read_study_text(text, "test"), lambda _: None)

    free, held = solved(""), solved(f'  {row}: "{most}"\n')
    limit = float(most.split()[1])
    assert held.status == "optimal"
    assert all(start.converged for start in held.starts)
    assert free.values[row] > 1.5 * limit
    assert held.values[row] == pytest.approx(limit, rel=1e-4)
    assert held.objective > 1.01 * free.objective
    assert next(one.shadow_price for one in held.held if one.name == f"{row} <=") > 0.0
