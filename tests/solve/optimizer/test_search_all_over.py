"""Searches from designs all over the ranges, where no start satisfies the limits."""

import pytest

from tvimdesign.solve.discrete.discrete_choices import discrete_sizes
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.infeasibility.feasibility_screen import designs_all_over
from tvimdesign.solve.nlp.solution import SolverEffort, same_optimum
from tvimdesign.solve.nlp.solver_run import Array
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.optimizer.verify_optimum import CYCLE_TOLERANCE
from tvimdesign.study import read_study_text

STUDY = """
mode: compression
module: {process: machine_6061, pcl_grade: pcl_50k, peltier_module: silicone_9ar_08_24v, target_temperature: 80 degC,
  running_clearance: 1 mm, link_dowel: iso_8734_2, link_dowel_count: 2, corner_radius: 1 mm, corner_depth_ratio: 10,
  slot_corner_offset: -0.5 mm, pocket_depth_ratio: 5, bearing: ball_6802, axial_preload: wave_22_2x23_8,
  hub_depth: 2 mm, foot_height: 8 mm, preload_adjuster: rotary, radial_clearance: 1.7 mm, cover: plate,
  stroke: 0.104 rad, moving_inertia: 415.6 kg*mm^2, vane_count: 6, response_criterion: softening}
vary:
  pin_radius_ratio: {from: 0.3, to: 0.8, start: 0.65}
  preload_angle: {from: 0.12 rad, to: 0.5 rad, start: 0.3 rad}
  pcl_outer_radius: {from: 15 mm, to: 48 mm, start: 32 mm}
  block_height: {from: 3 mm, to: 20 mm, start: 14 mm}
  vane_thickness: {from: 2 mm, to: 8 mm, start: 4 mm}
  current: {from: 0.1 A, to: 3 A, start: 0.52 A}
  pcl_inner_radius: {from: 9 mm, to: 40 mm, start: 16 mm}
  coil_diameter: {from: 8 mm, to: 32 mm, start: 12 mm}
  core_radius: {from: 7 mm, to: 16 mm, start: 7.8 mm}
  rotor_rim: {from: 1 mm, to: 12 mm, start: 4.3 mm}
  placement_radius: [45.0717519 mm, 45.7030827 mm]
  coil_count: {from: 3, to: 14, start: 8}
  link_thickness: [3 mm, 8 mm]
  block_depth: {from: 1.5 mm, to: 10 mm, start: 5 mm}
require:
  stiffness_over_stroke: ">= 0.85"
  impedance_range: ">= 105"
  response_time: "<= 1518 s"
minimize: envelope_height
operating_points:
  cold: {temperature: 30 degC, frequency: 1 Hz}
  hot: {temperature: 80 degC, frequency: 1 Hz}
solver: {cells: 10, starts: 1, seed: 20261232}
"""


@pytest.fixture(scope="module")
def optimizer() -> Optimizer:
    return Optimizer(read_study_text(STUDY, "test"))


@pytest.fixture(scope="module")
def design(optimizer: Optimizer) -> Array:
    return designs_all_over(optimizer)[0]


def broken(optimizer: Optimizer, inputs: Array) -> float:
    """Return the most by which a design, simulated, violates a limit."""
    cycle = optimizer.problem.simulated(inputs)
    values = optimizer.model.values(inputs, cycle)
    return max(float(limit.residual(values[limit.output])) for limit in optimizer.problem.limits)


@pytest.mark.gate
def test_a_design_leads_to_an_optimum(optimizer: Optimizer, design: Array) -> None:
    assert broken(optimizer, design) <= 0.0
    run = optimizer.solve(begin=design)
    assert run.start.converged
    assert broken(optimizer, run.inputs) <= CYCLE_TOLERANCE
    heights = [optimizer.model.values(x, optimizer.multistart.cycle)["envelope_height"] for x in (design, run.inputs)]
    assert heights[1] < 0.95 * heights[0]


@pytest.mark.gate
def test_what_is_to_be_within_ends_stays_there(optimizer: Optimizer, design: Array) -> None:
    run = optimizer.solve({"placement_radius": (0.0452, 0.0452), "coil_diameter": (0.012, 0.02)}, begin=design)
    assert run.start.converged
    assert run.start.end["placement_radius"] == pytest.approx(0.0452, rel=1e-7)
    assert run.start.end["coil_diameter"] == pytest.approx(0.02, rel=1e-6)  # without the ends it goes to 32 mm
    assert broken(optimizer, run.inputs) <= CYCLE_TOLERANCE


@pytest.mark.gate
def test_a_study_without_a_feasible_start_is_searched_all_over(optimizer: Optimizer) -> None:
    """From designs all over the ranges, until two come to the same optimum."""
    study = optimizer.study
    tree = Relaxation(0, optimizer, {}, discrete_sizes(study, study.table), SolverEffort())
    runs = tree.from_all_over()
    assert [run.start.converged for run in runs] == [True, True]
    assert same_optimum(runs[0].start, runs[1].start)
    assert len(tree.optima) == 1
    assert broken(optimizer, tree.optima[0].inputs) <= CYCLE_TOLERANCE
