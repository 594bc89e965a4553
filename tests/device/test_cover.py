"""The cover on the housing's rim: where it lies, what it and its bosses weigh, and when there is no room for it."""

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
    "cover_reserve", "cover_wall_reserve", "cover_depth_reserve", "cover_spring_gap", "cover_mount_gap",
    "cover_link_gap", "cover_thread_reserve", "cover_corner_reserve",
)  # fmt: skip
ROWS = (
    "envelope_height", "envelope_diameter", "rim_level", "pin_top_level", "cover_height", "link_bottom_level",
    "cover_volume", "cover_mass", "cover_screw_volume", "housing_volume", "housing_mass", "rotor_mass", "module_mass",
    "screws_mass", "cover_boss_radius", "housing_inner_radius", "housing_outer_radius", "parts_inertia",
    "screw_length_misfit", "cover_corner_radius", *RULES,
)  # fmt: skip


def module(cover: str, **more: Any) -> dict[str, Any]:
    text = f"mode: shear\nmodule: {{cover: {cover}}}\n"
    return {**given(read_study_text(text, "a test"), Catalog(), TABLE), **more}


def values_of(cover: str, **more: Any) -> dict[str, float]:
    return {name: float(value) for name, value in TABLE.evaluate(module(cover, **more), ROWS).items()}


@pytest.fixture(scope="module")
def bare() -> dict[str, float]:
    return values_of("none")


@pytest.fixture(scope="module")
def covered() -> dict[str, float]:
    return values_of("plate")


def test_a_cover_lies_a_running_clearance_above_the_pins_and_lifts_the_link(
    bare: dict[str, float], covered: dict[str, float]
) -> None:
    assert bare["rim_level"] == bare["pin_top_level"]
    for name in (*RULES, "cover_height", "cover_volume", "cover_screw_volume"):
        assert bare[name] == 0.0
    assert covered["pin_top_level"] == bare["pin_top_level"]
    assert covered["rim_level"] == pytest.approx(bare["rim_level"] + 0.4 * MM)  # printed PETG turns in 0.4 mm
    assert covered["envelope_height"] == pytest.approx(bare["envelope_height"] + (0.4 + 1.5) * MM)
    assert covered["envelope_diameter"] == bare["envelope_diameter"]


def test_cover_and_bosses_have_the_volume_of_their_points(bare: dict[str, float], covered: dict[str, float]) -> None:
    inner, outer = covered["housing_inner_radius"], covered["housing_outer_radius"]
    boss = 2.4 * MM  # a hole of 2.4 mm in the cover and a printed wall of 1.2 mm around it
    assert covered["cover_boss_radius"] == pytest.approx(boss)
    x, y = np.meshgrid(inner + np.linspace(-boss, boss, 2001), np.linspace(-boss, boss, 2001))
    cell = (2.0 * boss / 2000) ** 2
    inside = cell * np.sum((np.hypot(x - inner, y) < boss) & (np.hypot(x, y) < inner))
    # Printed corners of 0.2 mm: wall and boss meet nearly at right angles, where a fillet fills (1 - pi/4) r^2.
    assert covered["cover_corner_radius"] == pytest.approx(0.2 * MM)
    inside += 2.0 * (1.0 - 0.25 * np.pi) * (0.2 * MM) ** 2
    hole = np.pi * 0.8e-3**2 * (6.0 - 1.5 + 0.5) * MM
    higher = np.pi * (outer**2 - inner**2) * 0.4 * MM
    gained = covered["housing_volume"] - bare["housing_volume"]
    assert gained == pytest.approx(higher + 4 * (inside * covered["rim_level"] - hole), rel=1e-3)
    # A hole of 10.4 mm for the core, four of 2.4 mm for screws and four of 7 mm above the feet.
    plate = np.pi * (outer**2 - (10.4 * MM) ** 2 - 4 * (1.2 * MM) ** 2 - 4 * (3.5 * MM) ** 2) * 1.5 * MM
    assert covered["cover_volume"] == pytest.approx(plate, rel=1e-9)
    assert covered["cover_mass"] == pytest.approx(1270.0 * plate, rel=1e-9)
    screw = 0.25 * np.pi * (1.6**2 * 6.0 + 3.8**2 * 2.0) * 1e-9
    assert covered["cover_screw_volume"] == pytest.approx(4 * screw, rel=1e-9)
    added = sum(covered[name] - bare[name] for name in ("housing_mass", "rotor_mass", "screws_mass", "cover_mass"))
    assert covered["module_mass"] - bare["module_mass"] == pytest.approx(added, rel=1e-9)
    # The cover stands: of what turns only the core is longer.
    core = 0.5 * np.pi * (10.0 * MM) ** 4 * 1.9 * MM * 1270.0
    assert covered["parts_inertia"] - bare["parts_inertia"] == pytest.approx(core, rel=1e-6)


@pytest.mark.parametrize(
    ("rule", "more"),
    [
        ("cover_reserve", {"cover_thickness": 1.1 * MM}),
        ("cover_wall_reserve", {"wall_thickness": 2.3 * MM}),
        ("cover_depth_reserve", {"cover_screw_length": 16.0 * MM}),
        (
            "cover_spring_gap",
            {
                "spring_pairs": 6.0,
                "pin_radius_ratio": 0.2,
                "placement_radius": 20.0 * MM,
                "core_radius": 2.0 * MM,
                "stroke": 0.01,
            },
        ),
        ("cover_mount_gap", {"mount_boss_radius": 12.3 * MM}),
        ("cover_corner_reserve", {"corner_radius": 15.0 * MM}),
        ("cover_link_gap", {"core_radius": 46.0 * MM}),
        ("cover_thread_reserve", {"cover_screw_length": 4.0 * MM}),
    ],
)
def test_a_cover_that_has_no_room_is_refused(rule: str, more: dict[str, float], covered: dict[str, float]) -> None:
    assert min(covered[name] for name in RULES) > 0.0
    broken = values_of("plate", **more)
    assert [name for name in RULES if broken[name] < 0.0] == [rule]


def test_a_cutter_reaches_the_floor_in_the_corners_beside_the_bosses() -> None:
    rows = ["cover_corner_radius", "rim_level", "corner_depth_ratio"]
    text = "mode: shear\nmodule: {cover: plate, process: machine_6061}\n"
    milled = TABLE.evaluate(given(read_study_text(text, "a test"), Catalog(), TABLE), rows)
    assert milled["cover_corner_radius"] == pytest.approx(milled["rim_level"] / 3.0)  # a cutter cuts three radii deep
    wide = TABLE.evaluate(module("plate", corner_radius=9.0 * MM), rows)
    assert wide["cover_corner_radius"] == 9.0 * MM
    assert TABLE.evaluate(module("none"), rows)["cover_corner_radius"] == 0.0


def test_the_link_passes_the_screws_by_what_a_drawing_says(covered: dict[str, float]) -> None:
    # Head of 3.8 mm at 45 degrees on the wall's inner radius, the stroke nearer to the link of 24 mm.
    at = np.radians(45.0) - 0.104
    expected = covered["housing_inner_radius"] * np.sin(at) - 1.9 * MM - 12.0 * MM - 1.0 * MM
    assert covered["cover_link_gap"] == pytest.approx(expected)


def test_rules_of_a_cover_are_limits_where_there_is_one() -> None:
    for cover, held in (("none", set()), ("plate", set(RULES))):
        study = read_study_text(f"mode: shear\nmodule: {{cover: {cover}}}\n", "a test")
        assert {limit.output for limit in limits_of(study, TABLE)} & set(RULES) == held


def test_a_length_that_is_not_sold_is_told_of_covers_that_there_are() -> None:
    assert values_of("plate")["screw_length_misfit"] == pytest.approx(0.0, abs=1e-12)
    assert values_of("plate", cover_screw_length=6.7 * MM)["screw_length_misfit"] == pytest.approx(0.7 * MM)
    assert values_of("none", cover_screw_length=6.7 * MM)["screw_length_misfit"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("mode", MODES)
def test_what_only_a_cover_has_is_refused_without_one(mode: str) -> None:
    study = read_study_text(f"mode: {mode}\nmodule:\n  cover_thickness: 2 mm\n", "a test")
    with pytest.raises(InputError, match="add `cover: plate` under `module`"):
        refuse_impossible(study, Catalog(), table_for(mode))
