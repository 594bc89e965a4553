"""What a lip of the rotor plate takes from the layer's edge, in the links of a whole module."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
import pytest

from tvimdesign.device import table_for
from tvimdesign.physics.heat_flow.lumps import STRIP
from tvimdesign.study import given, read_study_text

MM = 1e-3
TABLE = table_for("shear")


def found(*names: str, **module: Any) -> dict[str, Any]:
    """Values of a milled module with lips, but for what is said (SI, records by name), beside its inputs."""
    milled = {"process": "machine_6061", "melt_lip": "rings", "pcl_thickness": 1.5 * MM, "running_clearance": 0.1 * MM}
    inputs = given(read_study_text("mode: shear\n", "a test").model_copy(update={"module": {**milled, **module}}))
    return {**inputs, **TABLE.evaluate(inputs, list(names))}


def test_the_slices_and_the_pads_give_a_metal_lip_what_a_cold_wall_takes_beyond_an_even_fall() -> None:
    one = found("cold_end", hot_contact=1e9, rotor_contact=1e9)
    conductivity = 0.5 * (one["pcl_conductivity_solid"] + one["pcl_conductivity_melt"])
    # Slices that fall evenly from a kelvin to none are half a kelvin above it; a cold wall takes 2/pi ln cot(pi f/4).
    wall = -2.0 / pi * np.log(np.tan(0.25 * pi * 0.1 / 1.5))
    given_heat = 0.5 * one["cold_end"].of_layer + one["cold_end"].of_pads
    # Slices keep less than an even fall leaves them, so that they are asked for more by that.
    assert conductivity * wall < given_heat < 1.2 * conductivity * wall
    assert one["cold_end"].share == pytest.approx(1.0, abs=0.01)


def test_a_plastic_lip_takes_less_than_a_metal_one() -> None:
    metal = found("cold_end")["cold_end"]
    plastic = found("cold_end", structure_conductivity=0.2)["cold_end"]
    assert plastic.of_layer < 0.5 * metal.of_layer
    assert plastic.share < 0.5


def test_the_lips_stand_over_the_floor_for_their_width_and_no_more() -> None:
    one = found("below_lips", "beside_area", "edge_length")
    thin = 1.0 / (0.1 * MM / one["air_conductivity"] + 1.4 * MM / one["structure_conductivity"])
    more = (thin - one["air_conductivity"] / (1.5 * MM)) * one["edge_length"]
    assert 0.9 * one["rotor_rim"] < sum(one["below_lips"]) / more <= one["rotor_rim"] * (1.0 + 1e-9)
    widths = np.array(STRIP) * one["beside_area"] / one["edge_length"]
    assert np.all(np.array(one["below_lips"]) / more < widths)


def test_without_lips_nothing_is_taken() -> None:
    one = found("cold_end", "below_lips", melt_lip="none")
    assert one["cold_end"] is None
    assert sum(one["below_lips"]) == 0.0


@pytest.mark.parametrize("thickness", [0.05, 0.3, 0.4, 0.45])
def test_a_lip_that_has_no_room_has_finite_numbers_and_a_rule_that_says_so(thickness: float) -> None:
    one = found("cold_end", "melt_lip_margin", pcl_thickness=thickness * MM, running_clearance=0.4 * MM)
    assert one["melt_lip_margin"] < 0.0
    assert all(np.isfinite(value) for value in one["cold_end"])
    assert one["cold_end"].near > 0.0
