"""Heat of a liner sideways to the walls of its recess, in the links of a whole module."""

from math import log, pi, tan
from typing import Any

import pytest
from device_values import all_of

MM = 1e-3


def found(*names: str, **module: Any) -> dict[str, Any]:
    """Values of a milled module with a liner, but for what is said (SI, records by name), beside its inputs."""
    milled = {"process": "machine_6061", "key_count": 0.0, "liner_material": "pei_1010"}
    return all_of(names, **{**milled, **module})


def rim_of(one: dict[str, Any]) -> float:
    """Conductance of all links from the liner [W/m K]."""
    links = [link for link in one["side_links"] if ("liner", 0) in (link.first, link.second)]
    return sum(float(link.conductance) for link in links) / one["edge_length"]


def test_a_liner_in_metal_gives_by_film_and_cold_wall() -> None:
    thin = {"liner_film": 0.02 * MM, "hot_contact": 1e9, "rotor_contact": 1e9}
    one = found("side_links", "edge_length", "liner_to_wall", "liner_sheet", "pcl_area", **thin)
    k = 0.5 * (one["pcl_conductivity_solid"] + one["pcl_conductivity_melt"])
    liner, film = (k * one["pcl_area"] * way for way in (one["liner_sheet"].resistance, one["liner_sheet"].bond))
    whole = one["pcl_thickness"] + liner + film
    # A wall from the liner's lower face on takes 2/pi ln cot(pi f/4) of an even fall, of which the liner has the end.
    wall = -2.0 / pi * log(tan(0.25 * pi * one["pcl_thickness"] / whole))
    excess = (0.5 * liner + film) / whole
    assert 1.0 < one["liner_to_wall"] * excess / (k * wall) < 1.25
    around = one["liner_film_conductivity"] * one["liner_thickness"] / one["liner_film"]
    assert rim_of(one) == pytest.approx(1.0 / (1.0 / one["liner_to_wall"] + 1.0 / around), rel=0.01)


def test_liners_keep_heat_and_lips_take_less_below_them() -> None:
    names = ("side_links", "edge_length")
    bare, filmed, plastic = (
        rim_of(found(*names, **more)) for more in ({}, {"liner_film": 0.5 * MM}, {"structure_conductivity": 0.2})
    )
    assert filmed < 0.75 * bare
    assert plastic < 0.9 * bare
    names = ("cold_end", "side_links", "edge_length")
    lips = {"melt_lip": "rings", "pcl_thickness": 0.6 * MM, "running_clearance": 0.1 * MM}
    lined, bare = (found(*names, **lips, liner_material=liner) for liner in ("pei_1010", "none"))
    assert 0.4 < lined["cold_end"].of_layer / bare["cold_end"].of_layer < 0.8
    # A lip below takes some of what the liner would give.
    assert rim_of(bare) == 0.0
    assert 0.2 < rim_of(lined) / rim_of(found(*names, pcl_thickness=0.6 * MM)) < 1.5
    one = found("side_links", "edge_length", "plate_to_edge", "rotor_beside")
    by_place = {link.second: float(link.conductance) for link in one["side_links"] if link.first == ("liner", 0)}
    to_plate, to_beside = by_place["plate", 0], by_place["beside", 0]
    onward = 1.0 / (1.0 / one["rotor_beside"][0].conductance - 1.0 / one["plate_to_edge"])
    assert to_plate / to_beside == pytest.approx(one["plate_to_edge"] / onward, rel=1e-9)
