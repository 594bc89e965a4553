"""Screws and bearings: their sizes by standard, what they weigh, and what they ask of the parts around them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tvimdesign.catalog import Catalog
from tvimdesign.device import table_for
from tvimdesign.study import given, read_study_text

MM = 1e-3
TABLE = table_for("shear")


def inputs_with(**module: str) -> dict[str, Any]:
    """Inputs of the default shear module but for what is said."""
    lines = "\n".join(f"  {name}: {value}" for name, value in module.items())
    return given(read_study_text(f"mode: shear\nmodule:\n{lines}\n", "a test"), Catalog(), TABLE)


def values_of(rows: str, **module: str) -> dict[str, float]:
    found: dict[str, float] = TABLE.evaluate(inputs_with(**module), rows.split())
    return found


def test_holes_are_those_of_the_standard() -> None:
    small = inputs_with(link_screw="iso_4762_m2", retainer_screw="iso_7380_m3", mount_screw="iso_4762_m4")
    # ISO 2306 and ISO 273, medium.
    assert small["link_screw_pilot"] == pytest.approx(1.6 * MM)
    assert small["link_screw_clearance"] == pytest.approx(2.4 * MM)
    assert small["retainer_screw_pilot"] == pytest.approx(2.5 * MM)
    assert small["mount_hole"] == pytest.approx(4.5 * MM)


def test_a_screw_weighs_what_its_maker_says_to_a_sixth() -> None:
    values = values_of("link_screw_volume", link_screw="iso_4762_m3", link_screw_length="10 mm")
    # DIN 912 M3 x 10: 0.88 g a piece (tables of weights of fasteners).
    assert 7850.0 * values["link_screw_volume"] / 4 == pytest.approx(0.88e-3, rel=1 / 6)


def test_a_hole_takes_its_screw_with_room_for_the_tip() -> None:
    values = values_of(
        "link_screw_depth link_thread_reserve retainer_screw_depth retainer_thread_reserve",
        link_screw_length="12 mm", link_thickness="5 mm", retainer_screw_length="10 mm", retainer_thickness="2.5 mm",
    )  # fmt: skip
    assert values["link_screw_depth"] == pytest.approx(7.5 * MM)
    assert values["link_thread_reserve"] == pytest.approx((7.0 - 1.75 * 3.0) * MM)  # M3 in plastic
    assert values["retainer_screw_depth"] == pytest.approx(8.0 * MM)
    assert values["retainer_thread_reserve"] == pytest.approx((7.5 - 1.75 * 4.0) * MM)  # M4


def test_a_length_that_is_not_sold_is_told() -> None:
    assert values_of("screw_length_misfit")["screw_length_misfit"] == pytest.approx(0.0, abs=1e-12)
    odd = values_of("screw_length_misfit", link_screw_length="11.3 mm", retainer_screw_length="8.1 mm")
    assert odd["screw_length_misfit"] == pytest.approx(0.8 * MM)
    (advice,) = TABLE.output("screw_length_misfit").advice
    assert odd["screw_length_misfit"] > advice.value


def test_screws_and_bearings_are_in_the_mass_and_the_inertia_of_the_module() -> None:
    rows = "module_mass parts_inertia screws_mass screws_inertia bearings_mass bearings_inertia"
    plain = values_of(rows)
    heavy = TABLE.evaluate(inputs_with() | {"link_screw_density": 10 * 7850.0}, rows.split())
    assert heavy["module_mass"] - plain["module_mass"] == pytest.approx(heavy["screws_mass"] - plain["screws_mass"])
    assert heavy["screws_mass"] > 2.0 * plain["screws_mass"]
    added = heavy["screws_inertia"] - plain["screws_inertia"]
    assert heavy["parts_inertia"] - plain["parts_inertia"] == pytest.approx(added)
    assert plain["bearings_mass"] == 0.0
    assert plain["bearings_inertia"] == 0.0
    turning = values_of(rows, bearing="ball_6702", hub_depth="5 mm")
    assert turning["bearings_mass"] == pytest.approx(2 * 3.5e-3)  # two of 3.5 g
    # Half of the ring 15 to 21 mm turns: from 15 to 18 mm, 3.5 g (18^2 - 15^2)/(21^2 - 15^2) each, at (d1^2 + d2^2)/8.
    share = (18.0**2 - 15.0**2) / (21.0**2 - 15.0**2)
    expected = 2 * 3.5e-3 * share * (15.0**2 + 18.0**2) / 8.0 * 1e-6
    assert turning["bearings_inertia"] == pytest.approx(expected, rel=1e-6)


def test_the_hub_has_the_volume_of_its_rings() -> None:
    values = values_of("hub_volume hub_radius", bearing="ball_6702", hub_depth="5 mm")
    # A layer of 1 mm, a floor of 4 mm and 5 mm below it, 0.4 mm short of the plate; seats of 4 mm at either end.
    wall = 10.5 + 0.05 + 3.0
    assert values["hub_radius"] == pytest.approx(wall * MM)
    seats = np.pi * (wall**2 - 10.55**2) * 8.0
    lip = np.pi * (wall**2 - 9.7**2) * (10.0 - 0.4 - 8.0)  # 21 mm less 0.8 mm of shoulder on either side
    assert values["hub_volume"] == pytest.approx((seats + lip) * 1e-9, rel=1e-9)


def test_two_bearings_need_a_hub_that_holds_them_and_a_lip() -> None:
    rows = "bearing_lip_reserve retainer_gap"
    assert values_of(rows)["bearing_lip_reserve"] > 0.0
    # A plain floor and layer are 5 mm, less 0.4 mm; two bearings of 4 mm and a lip of 1.2 mm want 9.2 mm.
    flat = values_of(rows, bearing="ball_6702")
    assert flat["bearing_lip_reserve"] == pytest.approx((4.6 - 9.2) * MM)
    deep = values_of(rows, bearing="ball_6702", hub_depth="5 mm")
    assert deep["bearing_lip_reserve"] == pytest.approx((9.6 - 9.2) * MM)
    # Below the hub hangs the retainer of 2.5 mm and a head of 2.2 mm: the foot of 6 mm is too low for that.
    assert deep["retainer_gap"] == pytest.approx((6.0 - 5.0 - 2.5 - 2.2) * MM)


def test_the_upper_bearing_bears_the_tilt_of_a_force_at_the_link() -> None:
    rows = "bearing_load bearing_load_reserve holding_torque link_length link_bottom_level link_thickness"
    values = values_of(rows, bearing="ball_6702", hub_depth="5 mm")
    force = values["holding_torque"] / values["link_length"]
    # Moments about the lower bearing, whose middle is 9.6 - 4 = 5.6 mm below that of the upper one at -1.4 mm.
    upper, lower = (0.6 - 2.0) * MM, (0.6 - 9.6 + 2.0) * MM
    middle = values["link_bottom_level"] + 0.5 * values["link_thickness"]
    assert values["bearing_load"] == pytest.approx(force * (middle - lower) / (upper - lower))
    assert values["bearing_load_reserve"] == pytest.approx(585.0 - values["bearing_load"])


def test_no_bearing_is_a_word_and_no_record() -> None:
    plain = inputs_with(bearing="none")
    assert plain["bearing"] == "none"
    assert inputs_with(bearing="ball_6803")["bearing"].value("bore") == pytest.approx(17 * MM)


@pytest.mark.parametrize("name", Catalog().names("bearings"))
def test_a_bearing_weighs_half_to_all_of_its_ring_of_steel(name: str) -> None:
    value = Catalog().record("bearings", name).value
    ring = 0.25 * np.pi * (value("outer_diameter") ** 2 - value("bore") ** 2) * value("width")
    assert 0.5 < value("mass") / (7800.0 * ring) < 1.0
