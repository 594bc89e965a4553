"""What a lip of the rotor plate takes from the layer's edge, in the links of a whole module."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import Any

import numpy as np
import pytest
from support import ROOT

from tvimdesign.device import table_for
from tvimdesign.physics.heat_flow import star
from tvimdesign.physics.heat_flow.lumps import STRIP, Place
from tvimdesign.study import given, read_study, read_study_text

MM = 1e-3
TABLE = table_for("shear")
STUDIES = ROOT / "studies"


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


def at_the_edge(excess: float) -> Callable[[Place], float]:
    """Pads an excess above a plate of one temperature, the layer halfway between them."""
    return lambda place: {"hot": excess, "layer": 0.5 * excess}.get(place[0], 0.0)


def test_a_metal_lip_is_as_cold_as_the_plate_and_a_plastic_one_is_between_plate_and_layer() -> None:
    metal, plastic = (found("lip_arms", structure_conductivity=k)["lip_arms"] for k in (167.0, 0.2))
    assert star.temperature(metal, at_the_edge(1.0)) == pytest.approx(0.0, abs=0.01)
    assert 0.1 < star.temperature(plastic, at_the_edge(1.0)) < 0.4


@pytest.mark.parametrize(
    ("study", "warm", "given_heat"),
    [
        # Pads, layer, the plate's lowest eighth above the arcs, plate beside them; 94 s, 107 s, 1095 s, 56 s from the
        # start by `validation/heat_sector/plane.py`, and what the layer's end gives to lip and clearance [W/m].
        ("compare_shear", (59.08, 52.75, 45.64, 34.23), 1.387),
        ("wrist_joint", (58.17, 52.40, 46.54, 38.33), 1.169),
        ("finger", (69.61, 65.67, 61.88, 56.47), 1.047),
        ("elbow_printed", (84.18, 68.19, 52.29, 34.25), 2.949),
    ],
)
def test_a_plastic_lip_takes_what_the_plane_says(study: str, warm: tuple[float, ...], given_heat: float) -> None:
    inputs = given(read_study(STUDIES / f"{study}.yaml"))
    one = TABLE.evaluate(inputs, ["lip_arms", "edge_length"])
    at = dict(zip(("hot", "layer", "face", "beside"), warm, strict=True))
    lip = star.temperature(one["lip_arms"], lambda place: at[place[0]])
    taken = sum(
        arm.conductance * (sum(weight * at[group] for (group, _), weight in arm.ends) - lip)
        for arm in one["lip_arms"]
        if "face" not in dict(place for place, _ in arm.ends)
    )
    assert taken / one["edge_length"] == pytest.approx(given_heat, rel=0.12)


def test_what_the_links_of_a_lip_pass_is_what_the_lip_takes_and_gives() -> None:
    one = found("lip_arms", "lip_links", structure_conductivity=0.2)
    at = {("hot", 0): 90.0, ("layer", 0): 70.0, ("face", 0): 60.0, ("beside", 0): 45.0}
    lip = star.temperature(one["lip_arms"], at.__getitem__)
    for place in at:
        given_heat = sum(
            weight * arm.conductance * (sum(w * at[p] for p, w in arm.ends) - lip)
            for arm in one["lip_arms"]
            for end, weight in arm.ends
            if end == place
        )
        passed = sum(
            sign * link.conductance * (at[link.first] - at[link.second])
            for link in one["lip_links"]
            for sign, end in ((1.0, link.first), (-1.0, link.second))
            if end == place
        )
        assert passed == pytest.approx(given_heat, rel=1e-9)


def test_the_plate_beside_is_as_heavy_as_with_its_lips_and_conducts_better_where_they_stand() -> None:
    names = ("rotor_beside", "melt_lip_moments", "beside_area")
    lips, bare = (found(*names, melt_lip=kind) for kind in ("rings", "none"))
    more = sum(a.capacity - b.capacity for a, b in zip(lips["rotor_beside"], bare["rotor_beside"], strict=True))
    volumetric = lips["structure_density"] * lips["structure_specific_heat"]
    assert more == pytest.approx(lips["melt_lip_moments"].area * volumetric, rel=0.05)
    deeper = (lips["rotor_thickness"] + 1.4 * MM) / lips["rotor_thickness"]
    second = [one["rotor_beside"][1].conductance for one in (lips, bare)]
    assert 1.0 < second[0] / second[1] < deeper


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
