"""The plane that judges the heat against finite elements of drawings of their own; shipped parts as FE found them."""

import csv
import importlib.util
import sys
from collections import defaultdict
from itertools import pairwise
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from random_designs import FRESH
from support import ROOT, study_path

from tvimdesign.solve.result import answer
from tvimdesign.study import read_study

sys.path.insert(0, str(ROOT / "validation" / "heat_sector"))

from compare import Judge, model_of, plane_of, product_times, studies
from fe_drawings import DRAWINGS, SHEET, Drawing, graded
from fresh import designs, intervals
from outside_judge import CASES, PADS, case_of
from warm_joint import WarmJoint

from tvimdesign.simulation.working_cycle.device_functions import resolve_study

with (ROOT / "validation/heat_sector/outside_judge.csv").open(newline="", encoding="utf-8") as file:
    ROWS = list(csv.DictReader(file))
named = pytest.mark.parametrize("study", list(studies()))


def test_finite_elements_bear_the_plane_out():
    assert {row["case"] for row in ROWS} == set(CASES)
    assert {row["pads"] for row in ROWS} == set(PADS)
    assert {read_study(study_path(row["study"])).mode for row in ROWS} == {"shear", "compression"}
    for row in ROWS:
        plane, elements = float(row["plane [s]"]), float(row["fe [s]"])
        assert plane == pytest.approx(elements, rel=0.01), (row["case"], row["time"])
        assert abs(float(row["warmer by [K]"])) < 0.4


@pytest.mark.gate
@pytest.mark.parametrize("case", ["paper_shear", "paper_compression"])
def test_the_plane_that_was_judged_is_today_s(case):
    model = model_of(study_path(CASES[case].study))
    judge = Judge(model, plane_of(model))
    switch = judge.heated(CASES[case].seconds, 100)
    judged = {row["time"]: float(row["plane [s]"]) for row in ROWS if row["case"] == case}
    assert {name: judge.time(name, switch) for name in judged} == pytest.approx(judged, rel=2e-3)


FRESH_ROWS = list(csv.DictReader((ROOT / "validation/heat_sector/fresh.csv").read_text().splitlines()))
"""Random modules that nobody optimized, by the product and by the plane, with the interval that the product states."""


def test_random_modules_switch_as_in_the_plane_within_a_twentieth():
    assert len({(row["study"], row["design"]) for row in FRESH_ROWS}) == sum(FRESH.values()) == 50
    for judged in (("softening_time", "mean_time"), ("far_face_time",)):
        errors = [abs(float(row["difference [%]"])) for row in FRESH_ROWS if row["time"] in judged]
        assert np.mean(np.array(errors) < 5.0) >= 0.9
    for row in FRESH_ROWS:
        assert float(row["least [s]"]) <= float(row["plane [s]"]) <= float(row["greatest [s]"])


@pytest.mark.gate
@pytest.mark.parametrize("study", ["wrist_joint_own_pins", "wrist_compression_own_pins"])
def test_random_modules_that_were_judged_are_today_s(study):
    last = [row["design"] for row in FRESH_ROWS if row["study"] == study][-1]
    rows = {row["time"]: row for row in FRESH_ROWS if (row["study"], row["design"]) == (study, last)}
    ((_, model, module),) = designs(study, {int(last.removeprefix("draw "))})
    times, bounds = product_times(model), intervals(study, module)
    assert rows
    for time, row in rows.items():
        assert float(row["product [s]"]) == pytest.approx(times[time], rel=2e-3)
        assert (float(row["least [s]"]), float(row["greatest [s]"])) == pytest.approx(bounds[time], rel=1e-2)


@pytest.mark.slow
def test_the_ring_takes_as_long_with_half_as_many_cells_again():
    model = model_of(study_path("wrist_compression"))
    coarse, fine = (Judge(model, plane_of(model, cells)) for cells in (1.0, 1.5))
    times = [judge.time("softening_time", judge.heated(150.0, 60)) for judge in (coarse, fine)]
    assert times[0] == pytest.approx(times[1], rel=0.01)


def areas(drawing: Drawing) -> dict[str, float]:
    """Area of each material [m2]."""
    by_part: dict[str, float] = defaultdict(float)
    for a, b in pairwise(drawing.x):
        for c, d in pairwise(drawing.y):
            if name := drawing.what(0.5 * (a + b), 0.5 * (c + d)):
                by_part[name] += (b - a) * (d - c)
    return by_part


def drawn_twice(study: str) -> tuple[Any, Drawing]:
    """Return a study's start in the plane, and its drawing for finite elements."""
    model = model_of(study_path(study))
    plane = plane_of(model)
    case = case_of(model, plane.middle)
    return plane, DRAWINGS[case["drawing"]](case["numbers"], 0.5)


@named
def test_both_draw_parts_of_the_same_size_and_conductivity(study):
    plane, drawing = drawn_twice(study)
    drawn_areas = areas(drawing)
    sheets = 4.0 * SHEET * (np.ptp(drawing.x) + np.ptp(drawing.y))
    for name in set(plane.material):
        assert drawn_areas.pop(name) == pytest.approx(np.sum(plane.volume[plane.cells(name)]), abs=sheets), name
        if name != "layer":
            theirs, ours = drawing.materials[name], plane.materials[name]
            wanted = ours.along, ours.up, ours.heat_capacity, ours.radiates_over
            assert (theirs.along, theirs.up, theirs.heat_capacity, theirs.shines) == pytest.approx(wanted, rel=1e-9)
    assert set(drawn_areas) <= {"near", "far", "joint", "side", "bond", "bond beside"}


@named
def test_both_have_the_same_bodies_and_currents(study):
    plane, drawing = drawn_twice(study)
    for theirs, ours in zip(drawing.bodies, plane.bodies, strict=True):
        wanted = ours.capacity, ours.surface, ours.coefficient, ours.emissivity
        # Radiation and air count where there is a surface alone.
        count = 4 if ours.surface else 2
        surfaces = theirs.capacity, theirs.surface, theirs.coefficient, theirs.emissivity
        assert surfaces[:count] == pytest.approx(wanted[:count], rel=1e-3)
    pump = plane.pump
    assert (drawing.joule, drawing.pumped) == pytest.approx(
        (pump.current**2 * pump.resistance, pump.current * pump.seebeck), rel=1e-9
    )


def test_lines_of_a_grid_keep_to_their_places_and_widen_between_them():
    lines = graded([(0.0, 0.1), (1.0, 0.01), (3.0, 0.2)], 1.0)
    widths = np.diff(lines)
    assert {0.0, 1.0, 3.0} <= set(lines)
    assert np.all(widths > 0.0)
    assert widths[np.searchsorted(lines, 1.0)] < 0.015
    assert len(graded([(0.0, 0.1), (1.0, 0.01)], 2.0)) == pytest.approx(2 * len(lines[lines <= 1.0]), abs=2)


NAMES = ("paper_reconstructed", "paper_compression")


def joint_of(name: str) -> WarmJoint:
    module = resolve_study(read_study(study_path(name)))
    return WarmJoint(module.table, module.values)


@pytest.mark.parametrize("name", NAMES)
def test_alike_columns_are_one_and_molten_ones_are_soft(name):
    joint = joint_of(name)
    parts = joint.parts(23.0, 23.0, np.full(8, 23.0), 100.0, 23.0)
    column = joint.stiffness(np.full((1, 4), 100.0), np.ones(1), np.full(4, 0.25), parts)
    many = joint.stiffness(np.full((3, 8), 100.0), np.array([0.2, 0.3, 0.5]), np.full(8, 0.125), parts)
    assert many == pytest.approx(column, rel=1e-12)
    parts = joint.parts(23.0, 23.0, np.full(8, 23.0), 23.0, 23.0)
    alone = float(joint.quantity["spring_stiffness"])
    frozen, molten = (joint.stiffness(np.full((1, 4), at), np.ones(1), np.full(4, 0.25), parts) for at in (23.0, 120.0))
    held = 1.0 / sum(joint.quantity["structure_compliances"]) if name == NAMES[0] else frozen
    assert frozen == pytest.approx(alone + held, rel=0.05)
    assert alone < molten < 0.2 * frozen


def test_a_molten_film_is_in_series_and_uneven_blocks_are_refused():
    joint = joint_of(NAMES[0])
    parts = joint.parts(23.0, 23.0, np.full(8, 23.0), 23.0, 23.0)
    shares, slices = np.ones(1), np.array([0.1, 0.9])
    alone = float(joint.quantity["spring_stiffness"])
    whole, film = (joint.stiffness(np.array([[120.0, other]]), shares, slices, parts) for other in (120.0, 23.0))
    # Ten times as stiff as the whole layer molten, but for what structure and frozen rest give.
    assert film - alone == pytest.approx(10.0 * (whole - alone), rel=0.15)
    # `block.soft_share` counts slices: thin ones in the melt would make more of it than there is.
    joint = joint_of(NAMES[1])
    parts = joint.parts(23.0, 23.0, np.full(8, 23.0), 23.0, 23.0)
    with pytest.raises(ValueError, match="alike"):
        joint.stiffness(np.full((1, 2), 100.0), np.ones(1), np.array([0.1, 0.9]), parts)


FOLDER = ROOT / "validation/fe_structure"
WITHIN = 0.10
MOVED = 0.10
"""How far spring rate and stiffness of today's optimum may be from those of the design that FE looked at."""


def _load(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"fe_{name}", FOLDER / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


MODELS = _load("models")
with (FOLDER / "results.csv").open(newline="") as file:
    OF_PARTS: list[dict[str, str]] = list(csv.DictReader(file))
STUDIES = sorted({row["study"] for row in OF_PARTS})
each_study = pytest.mark.parametrize("study", STUDIES)


def design_of(study: str) -> dict[str, Any]:
    rows = [row for row in OF_PARTS if row["study"] == study and row["unit"] in MODELS.DESIGN]
    return {row["quantity"]: MODELS.designed(row["model"], row["unit"]) for row in rows}


def looked_at(study: str) -> dict[str, dict[str, str]]:
    return {row["quantity"]: row for row in OF_PARTS if row["study"] == study and row["fe"]}


def test_fe_looked_at_every_study_and_reports_what_is_beyond_a_tenth():
    every = {path.stem for folder in MODELS.FOLDERS for path in folder.glob("*.yaml")}
    assert set(STUDIES) == every - MODELS.LEFT_OUT
    readme = (FOLDER / "README.md").read_text(encoding="utf-8")
    for study, name in MODELS.BEYOND:
        ratio = float(looked_at(study)[name]["ratio"])
        assert f"`{study}`'s {name} ({ratio:.3f})" in readme


@each_study
def test_a_study_s_spring_joint_and_parts_are_within_a_tenth_of_fe(study):
    today = {name: value for name, (_, value) in MODELS.model_values(study, design_of(study)).items()}
    ratios = looked_at(study)
    assert {"spring_rate", "hub", "core", "core_stress"} <= set(ratios)
    for name, row in ratios.items():
        within = today[name] == pytest.approx(float(row["fe"]), rel=WITHIN)
        assert within == ((study, name) not in MODELS.BEYOND), name
        # The table tells what the model said; it is made anew where that is no longer so.
        assert today[name] == pytest.approx(float(row["model"]), rel=0.02), name


@each_study
def test_fe_looked_at_a_design_that_the_study_still_allows(study):
    varied, design = read_study(MODELS.study_file(study)).vary, design_of(study)
    assert set(varied) == set(design)


@pytest.mark.slow
@each_study
def test_today_s_optimum_is_the_design_that_fe_looked_at(study):
    read = read_study(MODELS.study_file(study))
    if not read.vary:
        return
    design = answer(read).design
    inputs = {**design.values, **design.choices}
    then = MODELS.model_values(study, design_of(study))
    now = MODELS.model_values(study, {name: inputs[name] for name in read.vary})
    for name in ("spring_rate", "hub"):
        assert now[name][1] == pytest.approx(then[name][1], rel=MOVED), name
