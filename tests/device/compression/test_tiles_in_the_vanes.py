"""Rectangular Peltier modules in the vanes: where they fit, what they weigh, pass, bear and give, by hand."""

from typing import Any

import numpy as np
import pytest
from cad_designs import VANE_TILE_ROWS, VANE_TILES
from device_values import inputs_of
from device_values import values_of as of_default
from plane_conduction import conducted
from support import cases_of

from tvimdesign.catalog import Catalog
from tvimdesign.device import table_for
from tvimdesign.physics.heat_flow import heat, lumps

MM = 1e-3
TABLE = table_for("compression")


def values_of(rows: str, of: dict[str, Any] = VANE_TILES, **module: Any) -> dict[str, Any]:
    return of_default(rows, "compression", **{**of, **module})


@cases_of("tiles_in_the_vanes", "without_room")
def test_a_module_without_room_breaks_its_rule(rule, rows, module):
    of = VANE_TILES if rows == 1 else VANE_TILE_ROWS

    def is_valid(**changes: float) -> bool:
        return bool(values_of(rule, of, **changes)[rule] >= TABLE.output(rule).rules[0].value)

    assert is_valid()
    assert not is_valid(**module)


def test_they_cover_weigh_and_take_depth_as_the_sheet_says():
    rows = "heater_count heater_coverage pcl_area heater_mass heater_scale pad_depth spreader_mass module_mass"
    values, record = values_of(rows), Catalog().record("heaters", "cp30138")
    assert values["heater_count"] == values["heater_scale"] == 8.0
    assert values["heater_coverage"] * values["pcl_area"] == pytest.approx(8 * 15 * 15 * MM**2)
    assert values["heater_mass"] == pytest.approx(8 * record.value("mass"))
    assert values["pad_depth"] == pytest.approx(4.8 * MM)
    assert values["spreader_mass"] == pytest.approx(2700.0 * 8 * 16 * 15.5 * 1.0 * MM**3)
    of_copper = values_of("spreader_mass module_mass", spreader_material="copper")
    heavier = of_copper["spreader_mass"] - values["spreader_mass"]
    assert of_copper["module_mass"] - values["module_mass"] == pytest.approx(heavier)
    assert heavier > 0.0
    for wiring, strings in (("series", 1), ("vanes_parallel", 4), ("all_parallel", 16)):
        assert values_of("heater_strings", VANE_TILE_ROWS, heater_wiring=wiring)["heater_strings"] == strings


def test_the_stack_has_the_spreader_between_modules_and_blocks():
    stack: heat.Stack = values_of("stack")["stack"]
    values = values_of("spreader_mass spreader_resistance")
    covered = 15 * 15 / (16 * 15.5)
    # 1/h + t/k + 1/(f h_m) + what spreading costs, by hand
    expected = 1e-4 + 1e-3 / 167.0 + 1e-4 / covered + values["spreader_resistance"]
    assert stack.spreader is not None
    through = 1.0 / stack.hot_contact + stack.area / stack.spreader.conductance
    assert through == pytest.approx(expected, rel=1e-9)
    assert stack.spreader.capacity == pytest.approx(896.0 * values["spreader_mass"])
    # Half of each tile's length is open, from its lower edge to 2 mm below its upper one.
    assert stack.cold_surface.area == pytest.approx(8 * 7.5 * 13 * MM**2)


def link_between(stack: heat.Stack, first: lumps.Place, second: lumps.Place) -> float:
    """Conductance of all links from one place to another [W/K]."""
    return float(sum(link.conductance for link in stack.links if (link.first, link.second) == (first, second)))


def test_spreaders_lose_heat_at_their_edges_and_backs():
    # What a spreader of twice the thickness passes more to floor and plate, through the air of 0.3 mm clearances.
    low, two = (values_of("stack ring_places", spreader_thickness=t)["stack"] for t in (1 * MM, 2 * MM))
    floor, above, walls, housing = values_of("ring_places")["ring_places"]
    known = inputs_of("compression", **VANE_TILES)
    gap = known["air_conductivity"] * 8 * 16 * 1.0 * MM**2 / known["running_clearance"]
    for face in (floor, above):
        assert link_between(two, ("spreader", 0), face) - link_between(low, ("spreader", 0), face) == pytest.approx(gap)
    # Beside the tiles 3.8 mm of air lie behind the spreaders.
    backs = known["air_conductivity"] * 8 * (16 * 15.5 - 15 * 15) * MM**2 / (3.8 * MM)
    assert link_between(low, ("spreader", 0), walls) == pytest.approx(backs)
    assert link_between(two, ("spreader", 0), housing) > link_between(low, ("spreader", 0), housing)


def test_heat_of_closed_modules_is_stored():
    # First law: along the rates the stored energy grows by the electrical power, whatever the links pass within.
    surfaces = ("rotor_coefficient", "housing_coefficient", "cold_side_coefficient", "surface_emissivity")
    closed = dict.fromkeys(surfaces, 1e-12)
    known = {**inputs_of("compression", **VANE_TILES), **closed}
    stack: heat.Stack = TABLE.evaluate(known, ["stack"])["stack"]
    begin = heat.initial_state(stack, 8, 295.15)
    state = begin + 0.05 * np.random.default_rng(3).random(len(begin))
    rates, step = np.asarray(heat.rates(state, stack, 1.5)), 1e-4
    stored = (heat.stored_energy(state + step * rates, stack) - heat.stored_energy(state - step * rates, stack)) / (
        2.0 * step
    )
    power = heat.electrical_power(heat.profile(state, stack), stack, 1.5)
    assert power > 5.0
    assert stored == pytest.approx(power, rel=1e-6)


def in_the_plane(width: float, height: float, row: int, tile: tuple[float, float], depth: float, k: float) -> float:
    """Mean rise over its fed parts of a thin plate that gives off 1 W/m^2, tiles at its lower edge held at 0 K."""
    step = 0.25 * MM
    columns, rows = round(width / step), round(height / step)
    x, z = (np.arange(columns) + 0.5) * step, (np.arange(rows) + 0.5) * step
    pitch = width / row
    fed = (np.abs(x % pitch - 0.5 * pitch) < 0.5 * tile[0])[:, None] & (z < tile[1])[None, :]
    # A fed cell is at one temperature up to its side, as a wall is.
    rises = conducted(~fed, np.where(fed, 0.0, np.nan), step**2 / (k * depth))
    return float(np.nansum(rises)) / rises.size


@pytest.mark.parametrize(
    ("row", "width", "height"), [(1, 24 * MM, 15.5 * MM), (1, 16 * MM, 24 * MM), (2, 40 * MM, 20 * MM)]
)
def test_spreading_in_two_directions_costs_no_less_than_a_thin_plate_does(row, width, height):
    module = {"pcl_outer_radius": 16 * MM + width, "block_height": height, "tiles_per_block": row}
    # What goes around the tiles' corners into the plate's thickness is in the plate's own test: thin, it is little.
    module["spreader_thickness"] = 0.2 * MM
    resistance = values_of("spreader_resistance", VANE_TILES, **module)["spreader_resistance"]
    plane = in_the_plane(width, height, row, (15 * MM, 15 * MM), 0.2 * MM, 167.0)
    assert plane < resistance < 1.3 * plane


@pytest.mark.parametrize("of", [VANE_TILES, VANE_TILE_ROWS], ids=["one a block", "two a block"])
def test_they_bear_what_their_sheet_says_where_they_lie_on_the_vane(of):
    side, row, height = (15.0, 1, 15.5) if of is VANE_TILES else (11.4, 2, 12.0)
    radius = 24.0 if row == 1 else 28.2
    seat = side * side - 0.5 * side * (side - 2.0)
    rise = 1.0 + 6.0 * 0.5 * (height - side) / side  # eccentric by half of what the block is taller
    force = 1.5 * row * seat / rise  # N at 1.5 MPa
    expected = 4 * force * radius * MM
    rows = "heater_holding_torque holding_torque"
    values = values_of(rows, of)
    assert values["heater_holding_torque"] == pytest.approx(expected, rel=1e-9)
    # Where they bear least, they say what the joint holds; pads cut to the blocks limit nothing.
    weak = values_of(rows, of, heater_pressure_limit=0.2e6)
    assert weak["holding_torque"] == weak["heater_holding_torque"] == pytest.approx(expected * 0.2 / 1.5, rel=1e-9)


def test_tiles_and_spreaders_bear_the_block_in_series():
    # Young's modulus three times the shear modulus of 1 GPa on 15 by 15 mm, 3.8 mm thick; 1 mm of aluminium, 71.7 GPa.
    tile, sheet = 3e9 * 225e-6 / 3.8e-3, 71.7e9 * 16 * 15.5e-6 / 1e-3
    squeezed = values_of("pad_press_stiffness structure_compliances leaned_on_compliance")
    assert squeezed["pad_press_stiffness"] == pytest.approx(1.0 / (1.0 / tile + 1.0 / sheet), rel=1e-9)
    about_the_axis = 4 * squeezed["pad_press_stiffness"] * (24e-3) ** 2
    pads = squeezed["structure_compliances"].pads - squeezed["leaned_on_compliance"]
    assert pads == pytest.approx(1.0 / about_the_axis, rel=1e-9)
    values = values_of("vane_webs slot_width housing_vane_angle", VANE_TILE_ROWS)
    along = 24.4 * MM * np.cos(0.5 * values["housing_vane_angle"])
    assert values["vane_webs"] == pytest.approx(along - 2 * values["slot_width"], rel=1e-9)


def test_a_pad_is_as_it_was():
    flat = inputs_of("compression")
    rows = "heater_count heater_coverage spreader_mass pad_depth pad_seat slot_width slot_web heater_holding_torque"
    values = TABLE.evaluate(flat, rows.split())
    # The corner's arc ends half a tenth of a millimetre beside the slot above, at the mean radius of 33 mm.
    pad = flat["heater_thickness"]
    seat = pad - flat["corner_radius"] * (1.0 + pad / 33e-3) - 0.05e-3
    assert list(values.values()) == pytest.approx([12.0, 1.0, 0.0, pad, seat, 7e-3, 3.5e-3, 0.0])
