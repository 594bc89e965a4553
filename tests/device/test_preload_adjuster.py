"""Posts that turn: what they take of the floor, weigh and grip, and that they take out the springs' spread."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.catalog import Catalog
from tvimdesign.device import MODES, table_for
from tvimdesign.solve.nlp.constraints import limits_of, refuse_impossible
from tvimdesign.study import given, read_study_text

MM = 1e-3
TABLE = table_for("shear")
RULES = (
    "adjuster_wall_gap", "adjuster_pcl_gap", "adjuster_mount_gap", "adjuster_post_reserve", "adjuster_thread_reserve",
    "adjuster_top_reserve", "adjuster_grip_reserve",
)  # fmt: skip
ROWS = (
    "preload_adjustment", "adjuster_radius", "adjuster_thickness", "tang_length", "adjuster_volume",
    "adjuster_screw_volume", "adjusters_mass", "module_mass", "housing_mass", "springs_mass", "post_radius",
    "post_height", "spring_reach", "free_angle_over_preload", "free_angle_tolerance", "adjuster_wall_gap",
    "adjuster_grip_reserve", "spring_rate", "spring_winding", "adjuster_post_reserve", "adjuster_thread_reserve",
    "adjuster_top_reserve", "housing_volume",
)  # fmt: skip


def module(adjuster: str) -> dict[str, Any]:
    text = f"mode: shear\nmodule:\n  preload_adjuster: {adjuster}\n  radial_clearance: 1.7 mm\n"
    return given(read_study_text(text, "a test"), Catalog(), TABLE)


@pytest.fixture(scope="module")
def fixed() -> dict[str, float]:
    return {name: float(value) for name, value in TABLE.evaluate(module("fixed"), ROWS).items()}


@pytest.fixture(scope="module")
def rotary() -> dict[str, float]:
    return {name: float(value) for name, value in TABLE.evaluate(module("rotary"), ROWS).items()}


def test_a_post_that_turns_takes_out_what_springs_differ_by(fixed: dict[str, float], rotary: dict[str, float]) -> None:
    assert fixed["preload_adjustment"] == 0.0
    assert fixed["free_angle_over_preload"] > 1.0  # the paper's spring
    assert rotary["preload_adjustment"] > 2.0 * rotary["free_angle_tolerance"]
    assert rotary["free_angle_over_preload"] == 0.0


def test_the_flange_has_a_wall_around_the_tang_and_leaves_the_floor_one(rotary: dict[str, float]) -> None:
    assert rotary["adjuster_radius"] == pytest.approx(rotary["spring_reach"] + (0.25 + 1.2) * MM)
    assert rotary["adjuster_thickness"] == pytest.approx((4.0 - 1.2) * MM)
    assert rotary["tang_length"] == pytest.approx((2.8 - 0.5) * MM)
    # Clearance of the springs less what the flange, 1.45 mm wider, and its slip of 0.2 mm take of it.
    assert rotary["adjuster_wall_gap"] == pytest.approx((1.7 - 1.45 - 0.2) * MM, abs=1e-9)


def test_four_adjusters_have_the_volume_of_their_levels(rotary: dict[str, float]) -> None:
    p = rotary
    radius, post, height = p["adjuster_radius"], p["post_radius"], p["post_height"]
    flange = np.pi * (radius**2 - (0.5 * 2.413e-3 + 0.25e-3) ** 2) * 2.8e-3
    hole = 0.25 * np.pi * 2.5e-3**2 * (10.0 - 1.2 + 0.5) * MM
    y = np.linspace(-0.6e-3, 0.6e-3, 20001)
    slot = np.trapezoid(2.0 * np.sqrt(post**2 - y**2), y) * 1.5e-3
    assert p["adjuster_volume"] == pytest.approx(4 * (flange + np.pi * post**2 * height - hole - slot), rel=1e-7)
    screw = 0.25 * np.pi * (2.5**2 * 10.0 + 5.7**2 * 1.65) * 1e-9
    assert p["adjuster_screw_volume"] == pytest.approx(4 * screw, rel=1e-9)


def test_what_the_floor_loses_the_adjusters_are(fixed: dict[str, float], rotary: dict[str, float]) -> None:
    post = np.pi * fixed["post_radius"] ** 2 * fixed["post_height"]
    tang = np.pi * (0.5 * 2.413e-3 + 0.25e-3) ** 2 * 4e-3
    pocket = np.pi * (rotary["adjuster_radius"] + 0.2e-3) ** 2 * 2.8e-3
    through = 0.25 * np.pi * 3.4e-3**2 * 1.2e-3
    lost = 4 * (post - tang + pocket + through)
    assert fixed["housing_volume"] - rotary["housing_volume"] == pytest.approx(lost, rel=1e-9)
    change = rotary["module_mass"] - fixed["module_mass"]
    parts = ("housing_mass", "springs_mass", "adjusters_mass")
    assert change == pytest.approx(sum(rotary[name] - fixed[name] for name in parts), rel=1e-9)
    assert fixed["adjusters_mass"] == 0.0


def test_a_clamped_post_holds_its_spring_by_friction(rotary: dict[str, float]) -> None:
    outer, inner = rotary["adjuster_radius"], 1.7e-3
    grip = 0.25 * 400.0 * 2.0 / 3.0 * (outer**3 - inner**3) / (outer**2 - inner**2)
    spring = rotary["spring_rate"] * rotary["spring_winding"]
    assert rotary["adjuster_grip_reserve"] == pytest.approx(grip - spring, rel=1e-9)
    slack = TABLE.evaluate({**module("rotary"), "adjuster_clamp_force": 20.0}, ["adjuster_grip_reserve"])
    assert slack["adjuster_grip_reserve"] < 0.0


def test_a_fixed_tang_is_held_by_no_rule_of_the_adjusters(fixed: dict[str, float], rotary: dict[str, float]) -> None:
    for name in ("adjuster_post_reserve", "adjuster_thread_reserve", "adjuster_top_reserve", "adjuster_grip_reserve"):
        assert fixed[name] == 0.0
        assert rotary[name] > 0.0
    for adjuster, held in (("fixed", set()), ("rotary", set(RULES))):
        study = read_study_text(f"mode: shear\nmodule: {{preload_adjuster: {adjuster}}}\n", "a test")
        assert {limit.output for limit in limits_of(study, TABLE)} & set(RULES) == held
    free = read_study_text("mode: shear\nvary: {preload_adjuster: {choose: [fixed, rotary]}}\n"
                           "minimize: module_mass\n", "a test")  # fmt: skip
    assert set(RULES) <= {limit.output for limit in limits_of(free, TABLE)}


@pytest.mark.parametrize("mode", MODES)
def test_what_only_adjusters_have_is_refused_without_them(mode: str) -> None:
    study = read_study_text(f"mode: {mode}\nmodule:\n  adjuster_friction: 0.3\n", "a test")
    with pytest.raises(InputError, match="add `preload_adjuster: rotary` under `module`"):
        refuse_impossible(study, Catalog(), table_for(mode))
