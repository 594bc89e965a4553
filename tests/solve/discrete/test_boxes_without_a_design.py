"""Boxes that the search leaves as infeasible, compared with every combination solved alone from several starts.

All combinations are requested, so that no box is left for its bound.
"""

import itertools
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from choosing import listed, with_each_record

from tvimdesign.solve.discrete.discrete_choices import Box, discrete_sizes, is_one
from tvimdesign.solve.discrete.relaxation import Relaxation
from tvimdesign.solve.infeasibility.feasibility_screen import NOWHERE
from tvimdesign.solve.nlp.solution import SolverEffort
from tvimdesign.solve.nlp.solver_run import NO_DESIGN, NO_MODULE, Run
from tvimdesign.solve.optimizer.optimizer import Optimizer
from tvimdesign.solve.search import optimize
from tvimdesign.study import read_study_text

SHEAR = """
mode: shear
module:
  axial_preload: wave_21x25
  melt_lip: rings
  preload_adjuster: rotary
  tang_hold: hole
  radial_clearance: 1.7 mm
  cover: plate
  window_ledge: 1.5 mm
  floor_thickness: 8 mm
  spreader_material: aluminum_6061
  target_temperature: 80 degC
  stroke: 0.104 rad
  moving_inertia: 415.6 kg.mm^2
  thermistor_diameter: 1.8 mm
  process: print_pc
vary:
  peltier_module: {choose: [ma10_063_05_1, ma10_063_03, pc_128_10_05, pc_072]}
  wire_diameter: {choose: [1.6 mm, 1.7018 mm, 1.8034 mm]}
  spring_pairs: {choose: [2, 3]}
  arc_count: {choose: [3, 4]}
  coil_diameter: {from: 8 mm, to: 32 mm, start: 11 mm}
  coil_count: [3, 8]
  placement_radius: {from: 20 mm, to: 70 mm, start: 42 mm}
  core_radius: [6 mm, 16 mm]
  link_thickness: [3 mm, 8 mm]
  pcl_inner_radius: {from: 10 mm, to: 45 mm, start: 18 mm}
  pcl_outer_radius: {from: 15 mm, to: 60 mm, start: 30 mm}
  arc_span: {from: 20 deg, to: 110 deg, start: 78 deg}
  pcl_thickness: [0.6 mm, 2 mm]
  spreader_thickness: [0.5 mm, 2 mm]
  current: {from: 0.5 A, to: 5 A, start: 2 A}
  preload_angle: {from: 0.12 rad, to: 0.5 rad, start: 0.3 rad}
  pin_radius_ratio: {from: 0.3, to: 0.8, start: 0.65}
require:
  spring_stiffness: [">= 5.2 N.m/rad", "<= 5.8 N.m/rad"]
  stiffness_over_stroke: ">= 0.9"
  impedance_range: ">= 30"
  holding_torque: ">= 12 N.m"
  spring_fatigue_safety: ">= 1.2"
  peak_voltage: "<= 24 V"
  peltier_temperature_margin: ">= 5 K"
minimize: {envelope_volume: 1, module_mass: 1, response_time: 1}
operating_points:
  cold: {temperature: 30 degC, frequency: 1 Hz}
  hot: {temperature: 80 degC, frequency: 1 Hz}
solver: {starts: 2, seed: 1, cells: 6, fineness: 0.67, alternatives: 32}
"""
"""`benchmarks/shelf.yaml` with four of its heaters; two are too large for three arcs."""
COMPRESSION = """
mode: compression
module: {response_criterion: mean, core_radius: 8 mm, link_dowel: iso_8734_2, rotor_rim: 8 mm, pcl_inner_radius: 13 mm,
         block_height: 11 mm, spring_material: chrome_silicon}
vary:
  peltier_module: {choose: [silicone_9ar_02_24v, silicone_9ar_08_24v, polyimide_foil_24v, silicone_9ar_04_12v]}
  process: {choose: [print_abs, print_pc]}
  wire_diameter: {choose: [2.1 mm, 2.4 mm]}
  vane_count: {choose: [5, 6]}
  coil_count: [3, 5]
  coil_diameter: [10 mm, 16 mm]
  pcl_outer_radius: [18 mm, 30 mm]
  block_height: [4 mm, 14 mm]
  block_depth: [2 mm, 8 mm]
  vane_thickness: [2 mm, 6 mm]
  current: [0.05 A, 2.5 A]
require:
  spring_stiffness: ">= 5 N.m/rad"
  holding_torque: ">= 5 N.m"
  peak_voltage: "<= 9 V"
  peltier_temperature_margin: ">= 0 K"
accept: [structure_temperature_margin, stiffening_structure_margin]
minimize: {envelope_volume: 1, module_mass: 1, response_time: 1}
solver: {starts: 2, seed: 1, cells: 6, fineness: 0.67, alternatives: 32}
"""
"""The same of `benchmarks/shelf_compression.yaml`: wire too thin, and heaters that the cycle alone rules out."""
SEVERAL = 3
"""Starts of each combination alone."""


@pytest.mark.slow
@pytest.mark.parametrize("text", [SHEAR, COMPRESSION], ids=["shear", "compression"])
def test_no_combination_in_them_has_one(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    left: list[tuple[Relaxation, Box]] = []
    searched = Relaxation.best_within

    def watched(self: Relaxation, box: Box, near: Run | None) -> tuple[Run | None, bool]:
        run, certain = searched(self, box, near)
        if run is None and certain:
            left.append((self, box))
        return run, certain

    monkeypatch.setattr(Relaxation, "best_within", watched)
    study = listed(text)
    solution = optimize(study)
    choosing = solution.choosing
    assert choosing is not None
    alone = with_each_record(study, solution.reference, SEVERAL)
    assert 0 < len(alone) < choosing.combinations
    assert any(not is_one(box) for _, box in left)
    assert not {tuple(tree.choices(one).values()) for tree, box in left for one in _each(box)} & alone.keys()
    told = {tuple(one.choices.values()): one.objective for one in choosing.best}
    assert all(told[one] <= objective * (1.0 + 1e-6) for one, objective in alone.items())
    assert choosing.without_design + len(told) == choosing.combinations


def _each(box: Box) -> list[Box]:
    """Return every combination in a box."""
    places = [range(first, last + 1) for first, last in box]
    return [tuple((place, place) for place in one) for one in itertools.product(*places)]


STUDY = """
mode: shear
vary: {coil_count: {from: 3, to: 5, step: 1}, current: [0.5 A, 2.5 A]}
minimize: module_mass
solver: {cells: 6, starts: 1}
"""
OVER = "Maximum_Iterations_Exceeded"


@pytest.fixture(scope="module")
def tree() -> tuple[Relaxation, Run]:
    study = read_study_text(STUDY, "test")
    relaxation = Relaxation(0, Optimizer(study), {}, discrete_sizes(study, study.table), SolverEffort())
    return relaxation, relaxation.optimizer.solve()


@pytest.mark.parametrize(
    ("cold", "box", "certain", "searches"),
    [(NO_DESIGN, ((1, 1),), True, 2), (OVER, ((1, 1),), False, 2), (NO_DESIGN, ((0, 1),), False, 1)],
)  # fmt: skip
def test_a_warm_run_cut_short_leaves_several_combinations_open(
    tree: tuple[Relaxation, Run], monkeypatch: pytest.MonkeyPatch,
    cold: str, box: Box, certain: bool, searches: int,
) -> None:  # fmt: skip
    """Several are searched from one place alone: their halves are asked the same."""
    relaxation, near = tree
    asked: list[str] = []

    def ending(status: str) -> Callable[..., Any]:
        def ended(*_: Any) -> Run:
            asked.append(status)
            return replace(near, start=replace(near.start, status=status, converged=False))

        return ended

    monkeypatch.setattr(relaxation, "_screened", lambda *_: False)
    monkeypatch.setattr(relaxation, "_beside", ending(OVER))
    monkeypatch.setattr(relaxation, "_searched", ending(cold))
    assert relaxation.best_within(box, near) == (None, certain)
    assert asked == [OVER] + [cold] * searches


def test_no_search_starts_without_a_module_if_another_place_has_one(
    tree: tuple[Relaxation, Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    relaxation, near = tree
    here, nowhere = relaxation.optimizer.model.start, near.inputs * 1.5
    monkeypatch.setattr(relaxation._screen, "broken", lambda inputs: np.inf if inputs is nowhere else 0.0)
    assert relaxation._modules([nowhere, here]) == [here]
    assert relaxation._modules([nowhere]) == [nowhere]


def beginning_nowhere(relaxation: Relaxation, monkeypatch: pytest.MonkeyPatch, near: Run) -> list[str]:
    """Let the first run within a box begin at no module; the endings of all runs."""
    solved, endings = relaxation._solved, list[str]()

    def first_fails(*known: Any, **words: Any) -> Run:
        run = solved(*known, **words)
        if not endings:
            run = replace(near, start=replace(near.start, status=NO_MODULE, converged=False))
        endings.append(run.start.status)
        return run

    monkeypatch.setattr(relaxation, "_screened", lambda *_: False)
    monkeypatch.setattr(relaxation, "_solved", first_fails)
    return endings


def test_if_no_run_can_start_differential_evolution_finds_a_module(
    tree: tuple[Relaxation, Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Legs that do not reach their pins, say: the run nearby with another size in it is no module."""
    relaxation, near = tree
    endings = beginning_nowhere(relaxation, monkeypatch, near)
    found, certain = relaxation.best_within(((1, 1),), None)
    assert certain
    assert found is not None
    assert found.start.converged
    assert found.start.end["coil_count"] == pytest.approx(4.0)
    assert len(endings) == 2


def test_no_module_by_differential_evolution_is_certainly_no_design(
    tree: tuple[Relaxation, Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    relaxation, near = tree
    endings = beginning_nowhere(relaxation, monkeypatch, near)
    monkeypatch.setattr(relaxation._screen, "worst", lambda unknowns: np.full(unknowns.shape[1], NOWHERE))
    assert relaxation.best_within(((1, 1),), None) == (None, True)
    assert endings == [NO_MODULE]
