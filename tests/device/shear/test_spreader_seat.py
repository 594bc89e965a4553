"""Seats of spreaders, and the rim around a liner."""

from __future__ import annotations

from math import cos, log, pi, sin, tan
from typing import Any

import numpy as np
import pytest
from device_values import all_of, inputs_of, values_of

from tvimdesign.device import table_for

MM = 1e-3
TABLE = table_for("shear")
TILES = {
    "heater_module": "ma10_063_05_1", "tiles_per_arc": 2.0, "arc_count": 3.0, "arc_span": 1.7,
    "floor_thickness": 6.5 * MM,
}  # fmt: skip


@pytest.mark.parametrize(("process", "strength"), [("machine_6061", 24e6), ("print_petg", 6e6)])
def test_a_seat_bears_what_its_adhesive_does_on_metal_or_plastic(process, strength):
    names = "outer_seat_holding_torque inner_seat_holding_torque seat_path pcl_outer_radius"
    values = values_of(names, **TILES, process=process)
    # T = tau 2 pi s r^2 t of the share that the rim takes, by `holding_safety` of 1.25.
    area = 3 * 1.7 * 40 * MM * 1 * MM
    expected = strength / 1.25 * area * 40 * MM / (1.0 - values["seat_path"].inward)
    assert values["outer_seat_holding_torque"] == pytest.approx(expected, rel=1e-6)
    assert values["inner_seat_holding_torque"] > values["outer_seat_holding_torque"]


def test_thin_spreaders_and_pads_limit_what_the_joint_holds():
    thin = values_of("holding_torque outer_seat_holding_torque", **TILES, spreader_thickness=0.2 * MM)
    assert thin["holding_torque"] == thin["outer_seat_holding_torque"]
    assert TABLE.output("holding_torque").least_of.count("outer_seat_holding_torque") == 1
    record = inputs_of()["heater_shear_limit"]
    values = values_of("heater_holding_torque layer_holding_torque pcl_bond_strength")
    assert values["heater_holding_torque"] == pytest.approx(values["layer_holding_torque"] * record / 2e6)
    assert values_of("holding_torque", heater_shear_limit=0.0)["holding_torque"] == 0.0


def test_a_spreader_leaks_heat_and_bends_as_a_strip():
    # k/g t L of the rims, slots of air at the ends, in series with the way along the spreader.
    known = inputs_of(**TILES)
    values = TABLE.evaluate(known, ["pad_edge", "heater_along"])
    rims, ends = 3 * 1.7 * (26 + 40) * MM, 6 * 14 * MM
    contact = (0.2 / (0.5 * MM) * rims + known["pad_edge_contact"] * ends) * 1 * MM
    assert values["pad_edge"] == pytest.approx(1.0 / (1.0 / contact + 1.0 / values["heater_along"]), rel=1e-6)
    # Roark, table 8.1: simply supported, evenly loaded, mean deflection q w^4/(120 D).
    rigidity = 71.7e9 * MM**3 / 12 / (1 - (71.7 / 2 / 26.9 - 1) ** 2)
    x = np.linspace(0.0, 1.0, 2001)
    mean = float(np.trapezoid((x - 2 * x**3 + x**4) / 24.0, x)) * (14 * MM) ** 4 / rigidity
    assert TABLE.evaluate(known, ["pad_foundation"])["pad_foundation"] == pytest.approx(1.0 / mean, rel=1e-4)


GAPS = ["thermistor_window_gap", "thermistor_arc_gap"]


def test_the_floor_lacks_the_half_beside_the_pad_and_all_of_it_below():
    names = ["housing_volume", "housing_inertia", "pad_depth", "floor_web"]
    names += ["thermistor_seat_diameter", "thermistor_seat_radius"]
    bare, known = (inputs_of(thermistor_diameter=diameter) for diameter in (0.0, 1.8 * MM))
    without, has = (TABLE.evaluate(inputs, names) for inputs in (bare, known))
    side = np.linspace(-1.0, 1.0, 2001) * 0.5 * has["thermistor_seat_diameter"]
    x, y = np.meshgrid(side, side)  # y along the arc, beyond the pocket's end where it is above zero
    inside = np.hypot(x, y) < 0.5 * has["thermistor_seat_diameter"]
    r2, cell = (has["thermistor_seat_radius"] + x) ** 2 + y**2, (side[1] - side[0]) ** 2
    depth = np.where(y > 0.0, has["pad_depth"] + has["floor_web"], has["floor_web"]) * inside * cell
    assert without["housing_volume"] - has["housing_volume"] == pytest.approx(depth.sum(), rel=1e-3)
    taken = known["structure_density"] * (depth * r2).sum()
    assert without["housing_inertia"] - has["housing_inertia"] == pytest.approx(taken, rel=1e-3)


def test_webs_and_tiles_beside_a_thermistor():
    tight = inputs_of(window_ledge=0.5 * MM, arc_span=1.57, minimum_wall=3.0 * MM)
    assert all(TABLE.evaluate(tight, GAPS)[name] >= 0.0 for name in GAPS)
    known = inputs_of(thermistor_diameter=1.0 * MM, window_ledge=2.2 * MM)
    seat = TABLE.evaluate(known, ["thermistor_seat_radius", "thermistor_seat_diameter", *GAPS])
    pad = 0.5 * known["arc_span"]
    end = pad + known["slip_clearance"] / known["pcl_inner_radius"]  # the pocket's, on which the seat has its middle
    middle = seat["thermistor_seat_radius"] * np.array([cos(end), sin(end)])
    edge = pad - known["window_ledge"] / known["pcl_inner_radius"]  # the window's end points to the axis as well
    web = abs(middle @ np.array([-sin(edge), cos(edge)])) - 0.5 * seat["thermistor_seat_diameter"]
    assert seat["thermistor_window_gap"] == pytest.approx(web - known["minimum_wall"] - 0.15 * MM, rel=1e-9)
    next_end = 2.0 * pi / known["arc_count"] - end
    web = abs(middle @ np.array([-sin(next_end), cos(next_end)])) - 0.5 * seat["thermistor_seat_diameter"]
    assert seat["thermistor_arc_gap"] == pytest.approx(web - known["minimum_wall"] - 0.15 * MM, rel=1e-9)
    known = inputs_of(
        heater_module="ma10_063_05_1", arc_count=3.0, thermistor_diameter=1.8 * MM, floor_thickness=6.5 * MM
    )
    values = TABLE.evaluate(known, ["thermistor_count", "thermistor_seat_diameter", "thermistor_volume"])
    assert (values["thermistor_count"], values["thermistor_seat_diameter"]) == (3.0, 0.0)
    assert values["thermistor_volume"] == pytest.approx(3.0 * 0.25 * pi * 1.8**2 * 4.0 * 1e-9)


def evaluated(*names: str, **module: Any) -> dict[str, Any]:
    """Values of a milled module with a liner and some inputs changed (SI, records by name), beside its inputs."""
    milled = {"process": "machine_6061", "key_count": 0.0, "liner_material": "pei_1010"}
    return all_of(names, **{**milled, **module})


def rim_of(values: dict[str, Any]) -> float:
    """Conductance of all links from the liner [W/m K]."""
    links = [link for link in values["side_links"] if ("liner", 0) in (link.first, link.second)]
    return sum(float(link.conductance) for link in links) / values["edge_length"]


def test_a_liner_in_metal_gives_by_film_and_cold_wall():
    thin = {"liner_film": 0.02 * MM, "hot_contact": 1e9, "rotor_contact": 1e9}
    values = evaluated("side_links", "edge_length", "liner_to_wall", "liner_sheet", "pcl_area", **thin)
    k = 0.5 * (values["pcl_conductivity_solid"] + values["pcl_conductivity_melt"])
    liner, film = (
        k * values["pcl_area"] * way for way in (values["liner_sheet"].resistance, values["liner_sheet"].bond)
    )
    whole = values["pcl_thickness"] + liner + film
    # A wall from the liner's lower face on takes 2/pi ln cot(pi f/4) of an even fall; the liner has its end.
    wall = -2.0 / pi * log(tan(0.25 * pi * values["pcl_thickness"] / whole))
    excess = (0.5 * liner + film) / whole
    assert 1.0 < values["liner_to_wall"] * excess / (k * wall) < 1.25
    around = values["liner_film_conductivity"] * values["liner_thickness"] / values["liner_film"]
    assert rim_of(values) == pytest.approx(1.0 / (1.0 / values["liner_to_wall"] + 1.0 / around), rel=0.01)


def test_liners_keep_heat_and_lips_take_less_below_them():
    names = ("side_links", "edge_length")
    bare, filmed, plastic = (
        rim_of(evaluated(*names, **more)) for more in ({}, {"liner_film": 0.5 * MM}, {"structure_conductivity": 0.2})
    )
    assert filmed < 0.75 * bare
    assert plastic < 0.9 * bare
    names = ("cold_end", "side_links", "edge_length")
    lips = {"melt_lip": "rings", "pcl_thickness": 0.6 * MM, "running_clearance": 0.1 * MM}
    lined, bare = (evaluated(*names, **lips, liner_material=liner) for liner in ("pei_1010", "none"))
    assert 0.4 < lined["cold_end"].of_layer / bare["cold_end"].of_layer < 0.8
    # A lip below takes some of what the liner would give.
    assert rim_of(bare) == 0.0
    assert 0.2 < rim_of(lined) / rim_of(evaluated(*names, pcl_thickness=0.6 * MM)) < 1.5
    values = evaluated("side_links", "edge_length", "plate_to_edge", "rotor_beside")
    by_place = {link.second: float(link.conductance) for link in values["side_links"] if link.first == ("liner", 0)}
    to_plate, to_beside = by_place["plate", 0], by_place["beside", 0]
    onward = 1.0 / (1.0 / values["rotor_beside"][0].conductance - 1.0 / values["plate_to_edge"])
    assert to_plate / to_beside == pytest.approx(values["plate_to_edge"] / onward, rel=1e-9)
