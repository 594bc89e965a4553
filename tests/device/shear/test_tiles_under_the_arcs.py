"""Rectangular modules and keys of the arcs."""

from itertools import combinations
from math import cos, hypot, sin
from typing import Any

import numpy as np
import pytest
from cad_designs import TILES
from device_values import inputs_of
from device_values import values_of as of_default
from heat_sector.spreader import mean_rise
from random_designs import FRESH_SEED, Draws, Tally
from support import cases_of, study_path

from tvimdesign.base.errors import InputError
from tvimdesign.base.record import Record
from tvimdesign.catalog import Catalog
from tvimdesign.device import table_for
from tvimdesign.physics.heat_flow import heat, peltier
from tvimdesign.study import given, read_study

MM = 1e-3
TABLE = table_for("shear")


def values_of(rows: str, **module: Any) -> dict[str, Any]:
    return of_default(rows, **{**TILES, **module})


def corners(values: dict[str, Any], known: dict[str, Any], index: int) -> np.ndarray:
    """Corners of a tile of an arc in plan view [m], the arc's middle on the x axis; drawn without the table's rules."""
    along, across = known["heater_length"], known["heater_width"]
    turn = values["tile_pitch"] * (index - 0.5 * (known["tiles_per_arc"] - 1.0))
    points = [
        (values["tile_radius"] + 0.5 * x * across, 0.5 * y * along) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))
    ]
    return np.array([(x * cos(turn) - y * sin(turn), x * sin(turn) + y * cos(turn)) for x, y in points])


def apart(first: np.ndarray, other: np.ndarray) -> float:
    """Distance of two rectangles [m], by points along their outlines; the corners are nearest."""

    def outline(points: np.ndarray) -> np.ndarray:
        return np.concatenate(
            [a + np.linspace(0, 1, 400)[:, None] * (b - a) for a, b in zip(points, np.roll(points, -1, 0), strict=True)]
        )

    a, b = outline(first), outline(other)
    return float(min(np.min(np.hypot(*(b - point).T)) for point in a))


@pytest.mark.parametrize("tiles", [1.0, 2.0, 3.0])
def test_margins_are_the_gaps_of_the_rectangles_beyond_the_clearance(tiles):
    known = inputs_of(**TILES | {"tiles_per_arc": tiles, "arc_span": 0.9 * tiles})
    values = TABLE.evaluate(known, ["tile_pitch", "tile_radius", "tile_radial_margin", "tile_side_margin"])
    drawn = [corners(values, known, index) for index in range(int(tiles))]
    inner = min(min(hypot(*(0.5 * (a + b))) for a, b in combinations(points, 2)) for points in drawn)
    outer = max(hypot(*point) for points in drawn for point in points)
    gaps = (inner - known["pcl_inner_radius"], known["pcl_outer_radius"] - outer)
    assert gaps[0] - known["tile_clearance"] == pytest.approx(values["tile_radial_margin"], rel=1e-6)
    assert gaps[1] == pytest.approx(gaps[0], rel=0.05)  # the same along x; at the corner slightly less
    if tiles > 1:
        assert apart(drawn[0], drawn[1]) - known["tile_clearance"] == pytest.approx(
            values["tile_side_margin"], abs=2e-6
        )


@cases_of("tiles_under_the_arcs", "without_room")
def test_a_module_without_room_breaks_its_rule(rule, module):
    assert values_of(rule)[rule] >= 0.0
    assert values_of(rule, **module)[rule] < 0.0


def test_they_cover_weigh_and_cost_height_as_the_sheet_says():
    rows = "heater_count heater_coverage pcl_area heater_mass pad_depth spreader_mass spreader_volume heater_scale"
    values = values_of(rows)
    record = Catalog().record("heaters", "ma10_063_05_1")
    assert values["heater_count"] == values["heater_scale"] == 6.0
    assert values["heater_coverage"] * values["pcl_area"] == pytest.approx(6 * 20 * 10 * MM**2)
    assert values["heater_mass"] == pytest.approx(6 * record.value("mass"))
    assert values["pad_depth"] == pytest.approx(4.2 * MM)
    assert values["spreader_mass"] == pytest.approx(2700.0 * values["spreader_volume"])
    assert values_of("module_mass", spreader_material="copper")["module_mass"] > values_of("module_mass")["module_mass"]


@pytest.mark.parametrize(("wiring", "strings"), [("series", 1), ("arcs_parallel", 3), ("all_parallel", 6)])
def test_as_wired_they_are_six_modules_that_share_current_and_voltage(wiring, strings):
    # Heats, voltage and power of six modules one by one, against the one the stack is given.
    values = values_of("pads heater_strings", heater_wiring=wiring)
    record = Catalog().record("heaters", "ma10_063_05_1")
    alone = peltier.PeltierModule(*(record.value(name) for name in ("seebeck", "resistance", "conductance")))
    current, hot, cold = 2.4, 370.0, 320.0
    assert values["heater_strings"] == strings
    for heat_of in (peltier.hot_side_heat, peltier.cold_side_heat):
        assert heat_of(values["pads"], current, hot, cold) == pytest.approx(
            6 * heat_of(alone, current / strings, hot, cold)
        )
    in_series = 6 / strings * peltier.voltage(alone, current / strings, hot, cold)
    assert peltier.voltage(values["pads"], current, hot, cold) == pytest.approx(in_series)


def test_the_stack_has_the_spreader_between_modules_and_layer():
    stack: heat.Stack = values_of("stack")["stack"]
    values = values_of("pcl_area spreader_mass heater_mass spreader_resistance")
    # 1/h + t/k + 1/(f h_m) + the fin's, by hand
    covered = 6 * 200 * MM**2 / values["pcl_area"]
    expected = 1e-4 + 1e-3 / 167.0 + 1e-4 / covered + values["spreader_resistance"]
    assert stack.spreader is not None
    through = 1.0 / stack.hot_contact + stack.area / stack.spreader.conductance
    assert through == pytest.approx(expected, rel=1e-9)
    assert stack.spreader.capacity == pytest.approx(896.0 * values["spreader_mass"])
    assert 0.0 < values["spreader_resistance"] < 0.2 * expected


@pytest.mark.parametrize("study", ["elbow_printed", "ankle"])
def test_spreading_below_random_arcs_is_that_of_a_thin_plate(study):
    read = read_study(study_path(study))
    for design in Draws(read, FRESH_SEED).keeping_rules(8, Tally()):
        # What goes around the tiles' corners into the plate's thickness has a test of its own: thin, it is little.
        known = {**given(read), **{name: design.values[name] for name in read.vary}, "spreader_thickness": 2e-5}
        values = TABLE.evaluate(known, ["spreader_resistance", "tile_pitch", "tile_radius"])
        model = values.pop("spreader_resistance") * known["spreader_conductivity"] * known["spreader_thickness"]
        assert model == pytest.approx(mean_rise(known, **values), rel=0.25), design.name


def foil(resistance: float = 5.0) -> Record:
    """Return a foil heater of the shelf's form: a rigid module's record without Seebeck coefficient."""
    known = Catalog().record("heaters", "ma10_063_05_1")
    entries = dict(known.entries)
    entries["seebeck"] = type(entries["seebeck"])(0.0, "V/K", "a test", "measured")
    entries["resistance"] = type(entries["resistance"])(resistance, "ohm", "a test", "measured")
    return Record("heaters", "foil", "A foil heater", entries, {}, known.words)


def test_foils_and_shared_currents_go_through_the_same_equations():
    known = {**inputs_of(**TILES), "heater_module": foil(), "heater_seebeck": 0.0, "heater_resistance": 5.0}
    pads = TABLE.evaluate(known, ["pads"])["pads"]
    both = [heat_of(pads, current, 350.0, 350.0) for current in (1.0, -1.0) for heat_of in (peltier.hot_side_heat,)]
    assert both == pytest.approx([15.0, 15.0])  # half of I^2 R to either side, whichever way the current flows
    assert peltier.cold_side_heat(pads, 1.0, 350.0, 350.0) == pytest.approx(-15.0)
    known = {**inputs_of(**TILES, heater_wiring="arcs_parallel"), "peak_current": 9.0, "stiffening_peak_current": 6.0}
    values = TABLE.evaluate(known, ["current_margin", "cooling_current_margin"])
    assert values["current_margin"] == pytest.approx(8.6 - 3.0)
    assert values["cooling_current_margin"] == pytest.approx(8.6 - 2.0)


def test_modules_are_not_cut_and_sheets_are_as_they_were():
    with pytest.raises(InputError, match="ma10_063_05_1 is rigid"):
        values_of("module_mass", heater_form="flexible")
    # The cut pad has no spreader, no tiles and no holes, and its numbers are those of the area it has.
    rows = "heater_count heater_coverage spreader_mass spreader_depth tile_side_margin pad_depth"
    assert list(of_default(rows).values()) == [4.0, 1.0, 0.0, 0.0, 0.0, inputs_of()["heater_thickness"]]
    # They lie in grease: neither stiffness nor strength of the joint depends on how they bear shear or tension.
    names = "holding_torque structure_stiffness layer_edge_rise freezing_traction"
    soft, stiff = values_of(names, heater_shear_modulus=1e5), values_of(names, heater_shear_modulus=1e10)
    assert soft == stiff


def test_spreaders_face_ledges_and_meet_walls_at_edges():
    rows = "stack pcl_area heated_area cold_area edge_length floor_web beside_area"
    known = inputs_of(**TILES | {"tiles_per_arc": 1.0, "arc_span": 1.36})
    values = TABLE.evaluate(known, rows.split())
    links = {(link.first, link.second): link for link in values["stack"].links}
    spreader, cold, ledges, below_walls = ("spreader", 0), ("cold", 0), ("around", 6), ("around", 3)
    bare, length, web = values["pcl_area"] - values["heated_area"], values["edge_length"], values["floor_web"]
    # Still air as thick as the tiles, 3.2 mm, between parallel grey plates of 0.9 (Incropera, ch. 13); the pocket's
    # wall takes some of what would come to the ledge, and more from the spreader next to it.
    to_ledges = links[spreader, ledges]
    even = known["air_conductivity"] * bare / 3.2e-3
    assert 0.2 * even < to_ledges.conductance < even
    assert to_ledges.radiating_area == pytest.approx(bare / (2.0 / 0.9 - 1.0), rel=1e-9)
    # From where the heated part of a ledge has its mean on to its root, along what no tile lies on, into the floor.
    way = (values["heated_area"] - values["cold_area"]) / 3.0 + bare + 0.029 * values["beside_area"]
    onward = known["structure_conductivity"] * web * length / (way / length)
    assert links[ledges, below_walls].conductance == pytest.approx(onward, rel=1e-9)
    # The tiles' own edges stand in air, through which their legs heat the wall.
    assert (cold, ("around", 0)) not in links
    assert {(("legs", 0), ("around", 0)), (("legs", 0), ("around", 7))} <= links.keys()


RULES = ("key_margin", "key_depth_margin", "key_width_margin", "key_pitch_margin")


def test_keys_hold_by_their_section():
    values = of_default("key_holding_torque key_depth", key_count=3, key_diameter=2.5 * MM)
    yielding = Catalog().record("polymers", "pcl_80k").value("tensile_yield")
    # Twelve of 2.5 mm on a radius of 33 mm.
    expected = 12 * yielding / np.sqrt(3.0) * 0.25 * np.pi * 2.5e-3**2 * 33e-3
    assert values["key_holding_torque"] == pytest.approx(expected, rel=1e-9)
    assert values["key_depth"] == pytest.approx(2.8 * MM)
    shallow = of_default("key_holding_torque", rotor_thickness=2.0 * MM, key_diameter=2.5 * MM)
    # 0.8 mm deep they press into their pockets before they shear off.
    assert shallow["key_holding_torque"] == pytest.approx(12 * yielding * 2.5e-3 * 0.8e-3 * 33e-3, rel=1e-9)
    values = TABLE.evaluate(inputs_of(), ["layer_torque@cold", "hold_torque"])
    assert 0.9 * values["hold_torque"] < values["layer_torque@cold"] < values["hold_torque"]  # the springs are soft


def test_no_keys_weigh_hold_and_forbid_nothing():
    rows = "pcl_volume pcl_area key_depth key_holding_torque rotor_volume rotor_inertia " + " ".join(RULES)
    # Arcs no key would fit in, and a plate as thin as can be printed.
    none = of_default(rows, key_count=0, key_diameter=8 * MM, rotor_thickness=1.2 * MM)
    assert none["pcl_volume"] == pytest.approx(none["pcl_area"] * 1e-3, rel=1e-12)
    assert none["key_depth"] == none["key_holding_torque"] == 0.0
    assert min(none[name] for name in RULES) > 0.0
    full = of_default(rows, key_count=0)
    keyed = of_default(rows)
    section = np.pi * 1.25e-3**2
    assert full["rotor_volume"] - keyed["rotor_volume"] == pytest.approx(12 * section * 2.8e-3, rel=1e-9)
    about_axis = 12 * section * 2.8e-3 * 1270.0 * (33e-3**2 + 0.5 * 1.25e-3**2)
    assert full["rotor_inertia"] - keyed["rotor_inertia"] == pytest.approx(about_axis, rel=1e-9)


def test_each_margin_of_the_keys_is_what_its_drawing_gives():
    # In mm: three keys of 2.5 on 33 in each arc from 26 to 40, walls of 1.2 and pins of 2.0 as printed, and holes
    # that are printed 0.3 wider.
    span = 0.854548
    drawn = {
        "key_margin": 2.5 - 2.0, "key_depth_margin": 4.0 - 1.2 - 0.625, "key_width_margin": 14.0 - 2.5 - 1.2,
        "key_pitch_margin": abs(33.0 - 33.0 * np.exp(1j * span / 3.0)) - 2.8 - 1.2,
    }  # fmt: skip
    margins = of_default(" ".join(RULES), arc_span=span)
    assert {name: value / MM for name, value in margins.items()} == pytest.approx(drawn)
    # One key in an arc has half of it to either end.
    alone = of_default("key_pitch_margin", arc_span=span, key_count=1)["key_pitch_margin"]
    assert alone / MM == pytest.approx(abs(33.0 - 33.0 * np.exp(1j * span)) - 2.8 - 1.2)
