"""The stack of the shear module as its sizes and records make it, and what a phase sees of it at an instant."""

from typing import Any

import numpy as np
import pytest
from stiff_when_warm import STIFF_WHEN_WARM

from tvimdesign.device import table_for
from tvimdesign.device.core import softening
from tvimdesign.device.table import Module
from tvimdesign.device.table.quantity import EQUILIBRIUM_STIFFENING, SOFTENING, STIFFENING
from tvimdesign.physics.heat_flow import heat, lumps

TABLE = table_for("shear")
SPAN, INNER, OUTER = 0.85, 26e-3, 40e-3
AREA = 4 * 0.5 * SPAN * (OUTER**2 - INNER**2)
PLATE = np.pi * 41.5e-3**2


@pytest.fixture(scope="module")
def known(inputs: dict[str, Any]) -> dict[str, Any]:
    return {**inputs, "arc_span": SPAN}


@pytest.fixture(scope="module")
def stack(known: dict[str, Any]) -> heat.Stack:
    layers: heat.Stack = TABLE.evaluate(known, ["stack"])["stack"]
    return layers


def test_pads_and_windows_scale_the_catalogue_s_module(stack):
    # 25 mV/K, 3 ohm, 0.12 W/K, 6 g and 500 J/kg K on 1600 mm^2; either side is a twelfth of the pads.
    share = AREA / 1600e-6
    assert (stack.area, stack.thickness, stack.density) == pytest.approx((AREA, 1e-3, 1145.0), rel=1e-9)
    assert stack.peltier == pytest.approx((0.025 * share, 3.0 * share, 0.12 * share), rel=1e-9)
    # The corners of the pads, of 0.2 mm, take a ten-thousandth of their volume.
    capacities = [stack.cold_capacity, stack.hot_capacity, stack.legs_capacity]
    assert capacities == pytest.approx([0.25 * share, 0.25 * share, 2.5 * share], rel=2e-4)
    # A ledge of 2 mm all around each pad, and corners of 0.2 mm in the four windows.
    open_span = 4 * (SPAN - 4e-3 / INNER)
    window = 0.5 * open_span * (38e-3**2 - 28e-3**2) - 4 * (4.0 - np.pi) * 0.2e-3**2
    assert stack.cold_surface[:3] == pytest.approx((window, 10.0, 0.9), rel=1e-5)
    assert stack.plate_surface[:3] == pytest.approx((AREA, 5.0, 0.9), rel=1e-9)
    assert (stack.plate_thickness, stack.plate_heat_capacity) == pytest.approx((4e-3, 1270.0 * 1200.0), rel=1e-9)
    assert stack.sink is None


EDGE = 4 * (2 * (OUTER - INNER) + SPAN * (INNER + OUTER))
FIRST, SECOND, LAST = 0.087, 0.247, 0.666
"""Shares of a strip's width that its three bodies have."""
TO_FIRST, TO_LAST, TO_END = 0.029, 0.153 + 0.395, 0.423
"""Ways from its edge to the first, from there to the last and to its end, as shares of its width."""
TO_EDGE = AREA / EDGE / 3.0
"""Way of what is heated evenly; of the plate, which 1 mm of 0.2025 W/m K heat: cosh's mean before its end."""
SLIM = AREA / EDGE * np.sqrt(0.2025 / 1e-3 / (0.24 * 4e-3))
PLATE_TO_EDGE = AREA / EDGE * (np.cosh(SLIM) - np.sinh(SLIM) / SLIM) / (SLIM * np.sinh(SLIM))
PAD, WEB = 1.5e-3, 2.5e-3
BESIDE = PLATE - AREA


def along_cold_sides(share: float) -> float:
    """Resistance [K/W] from cold sides at their mean to a share of them: Carslaw and Jaeger, ch. V, legs that conduct
    6 W/m K along and 75 W/m2 K up through 1.5 mm, below a sheet of a twelfth of that."""
    up, width = 75.0 * 1.5e-3, AREA / EDGE
    mean = np.sqrt(6.0 * up)
    sheet, depth = 6.0 * 1.5e-3 / 12.0 / (mean * width), 10.0 / 12.0 * 1.5e-3 * np.sqrt(6.0 / up) / width
    waves = np.arange(1, 401) * np.pi
    fall = 2.0 * np.sin(waves * share) ** 2 / (waves**3 * share**2 * (np.tanh(waves * depth) + waves * sheet))
    return float(np.sum(fall)) / (mean * EDGE)


def between(stack: heat.Stack, first: lumps.Place, second: lumps.Place) -> lumps.Link:
    """Return the first link from one place to the other."""
    return next(link for link in stack.links if (link.first, link.second) == (first, second))


def test_plate_beside_the_arcs_is_a_strip_heated_at_its_edge(stack):
    bodies = stack.beside[:-1]
    assert sum(lump.capacity for lump in bodies) == pytest.approx(1270.0 * 1200.0 * 4e-3 * BESIDE, rel=1e-9)
    assert sum(lump.surface.area for lump in bodies) == pytest.approx(BESIDE, rel=1e-9)
    middles = TO_LAST * BESIDE / EDGE
    along = sum(1.0 / lump.conductance for lump in bodies[1:])
    assert 1.0 / along == pytest.approx(0.24 * 4e-3 * EDGE / middles, rel=1e-9)
    to_first = TO_FIRST * BESIDE / EDGE
    assert stack.beside[0].conductance == pytest.approx(0.24 * 4e-3 * EDGE / (PLATE_TO_EDGE + to_first), rel=1e-9)
    # A plate that warms up evenly is colder at its face by a third of its depth.
    assert all(lump.surface.behind == pytest.approx(4e-3 / 3.0 / 0.24, rel=1e-9) for lump in bodies)
    # What differs over the depth dies down within the depth over pi.
    assert stack.uneven_conductance == pytest.approx(0.24 * 4e-3 * EDGE / (PLATE_TO_EDGE + 4e-3 / np.pi), rel=1e-9)


def test_floor_beside_the_pockets_is_two_strips_one_above_the_other(stack):
    bodies = stack.around
    volumes = [body.capacity / (1270.0 * 1200.0) for body in bodies[:6]]
    upper, lower = ([share * BESIDE * depth for share in (FIRST, SECOND, LAST)] for depth in (PAD, WEB))
    upper[0] *= 0.5  # the other half is the corner next to the hot sides
    assert volumes == pytest.approx(upper + lower, rel=1e-9)
    assert sum(body.surface.area for body in bodies[3:5]) == pytest.approx((FIRST + SECOND) * BESIDE, rel=1e-9)
    # What of the last one's face is not its own counts at the housing.
    assert 0.0 < bodies[5].surface.area < LAST * BESIDE
    # A side of the pads conducts with 6 W/m K in its plane; its edge of 0.75 mm touches the wall with 150 W/m2 K, and
    # behind that is the way to the first body of the floor.
    edge = TO_EDGE / (6.0 * 0.75e-3) + 1.0 / (150.0 * 0.75e-3) + TO_FIRST * BESIDE / EDGE / (0.24 * 0.75e-3)
    # A twelfth of the pads is a side, so a sixth of their half; the rest of that is half of the legs.
    for side, half, place in (("hot", 1, 7), ("cold", 2, 0)):
        for first, share in (((side, 0), 1.0 / 6.0), (("legs", half), 5.0 / 6.0)):
            conductance = between(stack, first, ("around", place)).conductance
            assert conductance == pytest.approx(share * EDGE / edge, rel=1e-9)
    area = LAST * BESIDE
    onto, across = (0.5 * PAD + WEB / 3.0) / (0.24 * area), WEB / 6.0 / (0.24 * area)
    assert taken(stack, ("around", 2), 5) == pytest.approx(heat_into_slab(stack, 5, onto, across), rel=1e-9)


def taken(stack: heat.Stack, above: lumps.Place, body: int) -> float:
    """Return what a place gives to a body below it a kelvin colder, and the air as cold as that [W/K]."""
    below = (("around", body), ("ambient", 0))
    return float(sum(between(stack, above, place).conductance for place in below))


def heat_into_slab(stack: heat.Stack, body: int, onto: float, across: float) -> float:
    """Return the same by its two faces: 1 = onto q + across p of the upper one, p = U (0 - across q) of the lower."""
    surface = stack.around[body].surface
    outside = surface.area * lumps.surface_coefficient(surface, stack.ambient, stack.ambient)
    matrix = np.array([[onto, across], [outside * across, 1.0]])
    return float(np.linalg.solve(matrix, [1.0, 0.0])[0])


def test_cold_sides_heat_ledges_evenly_which_conduct_to_their_roots(stack):
    ledges = AREA - stack.cold_surface.area
    assert stack.around[6].capacity == pytest.approx(1270.0 * 1200.0 * ledges * WEB, rel=1e-9)
    # Carslaw and Jaeger, ch. V: a strip heated over its upper face up to its root, beyond which it goes on.
    width = ledges / EDGE
    waves = np.arange(1, 4001) * np.pi
    reach = waves * width / WEB
    above_mean = np.sum(2.0 / waves**2 * (1.0 - (1.0 - np.exp(-2.0 * reach)) / (2.0 * reach)))
    # The lower face is colder than the mean by the same terms with alternating signs.
    signs = -((-1.0) ** np.arange(1, 4001))
    below_mean = np.sum(signs * 2.0 / waves**2 * (1.0 - (1.0 - np.exp(-2.0 * reach)) / (2.0 * reach)))
    onto, across = (mean * WEB / (0.24 * ledges) for mean in (above_mean, below_mean))
    onto += along_cold_sides(ledges / AREA)
    assert taken(stack, ("cold", 0), 6) == pytest.approx(heat_into_slab(stack, 6, onto, across), rel=1e-3)
    to_root = between(stack, ("around", 6), ("around", 3)).conductance
    beyond = TO_FIRST * BESIDE / EDGE
    assert to_root == pytest.approx(0.24 * WEB * EDGE / (width / 3.0 + beyond), rel=1e-9)


def test_air_walls_and_core_take_heat_by_their_sizes(known, stack):
    # 0.028 W/m K over 1 mm and, from 80 to 40 degC, parallel grey plates of 0.9 each (Incropera, ch. 13), between walls
    # that conduct so well that they do not count.
    conducting = TABLE.evaluate({**known, "structure_conductivity": 1e9}, ["stack"])["stack"]
    gaps = [link for link in conducting.links if link.first[0] == "beside"]
    warm, cool = 353.15, 313.15
    through = BESIDE * (0.028 / 1e-3 * 40.0 + 5.670374419e-8 * (warm**4 - cool**4) / (1.0 / 0.9 + 1.0 / 0.9 - 1.0))
    assert sum(lumps.link_heat(gap, warm, cool) for gap in gaps) == pytest.approx(through, rel=1e-6)
    mass = TABLE.evaluate(known, ["housing_mass"])["housing_mass"]
    assert sum(lump.capacity for lump in stack.around) == pytest.approx(1200.0 * mass, rel=1e-9)
    core = stack.beside[-1]
    radii = np.linspace(10e-3, INNER, 20001)
    ring = np.trapezoid(1.0 / (2.0 * np.pi * radii * 4e-3 * 0.24), radii)
    strip = TO_END * BESIDE / EDGE / (0.24 * 4e-3 * EDGE)
    assert core.conductance == pytest.approx(1.0 / (ring + strip))
    masses = TABLE.evaluate(known, ["rotor_mass", "link_mass", "retainer_mass"]).values()
    plate = stack.plate_heat_capacity * stack.area * stack.plate_thickness
    assert plate + sum(lump.capacity for lump in stack.beside) == pytest.approx(1200.0 * sum(masses), rel=1e-9)
    assert core.surface == lumps.NOWHERE
    sink = TABLE.evaluate({**known, "cold_side": "sink"}, ["stack"])["stack"].sink
    contact = 1.0 / (5000.0 * stack.cold_surface.area)
    assert 1.0 / sink.conductance == pytest.approx(contact + along_cold_sides(stack.cold_surface.area / AREA), rel=1e-3)
    assert sink.capacity == 50.0
    assert sink.surface == (15000e-6, 10.0, 0.9, None)


def test_only_a_layer_with_a_history_freezes_in_time(known):
    for phase, model, kinetic in (
        (SOFTENING, "kinetic", SOFTENING.history), (STIFFENING, "kinetic", True), (STIFFENING, "equilibrium", False),
        (EQUILIBRIUM_STIFFENING, "kinetic", False),
    ):  # fmt: skip
        now = TABLE.evaluate({**known, "phase": phase, "phase_model": model}, ["stack_now"])["stack_now"]
        assert (now.freezing is not None) == kinetic, (phase.name, model)


@pytest.mark.parametrize(("phase", "point"), [(SOFTENING, "hot"), (STIFFENING, "cold")])
def test_slices_are_tested_at_the_frequency_of_where_the_phase_leads(phase, point, known):
    # A layer that is everywhere at one temperature is as soft as at an operating point of that temperature.
    stack = TABLE.evaluate(known, ["stack"])["stack"]
    state = heat.initial_state(stack, 5, 368.15)
    given = {**known, **STIFF_WHEN_WARM, "frequency@hot": 0.3, "frequency@cold": 7.0, f"temperature@{point}": 368.15,
             "phase": phase, "phase_model": "equilibrium", "state": state}  # fmt: skip
    if phase is STIFFENING:  # a melt that cools has no memory of its crystals
        given["melt_memory"] = 1.0
    names = ["layer_moduli", "impedance_now", f"storage_modulus@{point}", f"loss_modulus@{point}",
             f"joint_impedance@{point}", "mean_temperature"]  # fmt: skip
    layer, impedance, storage, loss, joint, mean = TABLE.evaluate(given, names).values()
    # The rounded corners of the melting curve leave a few millikelvin between the two.
    assert mean == pytest.approx(368.15, abs=0.01)
    assert layer == pytest.approx((storage, loss), rel=1e-4)
    assert impedance == pytest.approx(joint, rel=1e-4)


def test_the_supply_gives_volts_in_size_and_takes_nothing_back(known, stack):
    profile = heat.profile(heat.initial_state(stack, 5, 300.0), stack)._replace(hot=340.0, cold=310.0)
    pads = stack.peltier
    for current in (1.5, -1.5):
        given = {**known, "stack_profile": profile, "drive_current": current, "phase": STIFFENING}
        volts, power = TABLE.evaluate(given, ["supply_voltage", "terminal_power"]).values()
        signed = pads.seebeck * 30.0 + pads.resistance * current
        assert volts == pytest.approx(abs(signed), rel=1e-9)
        assert power == pytest.approx(signed * current, rel=1e-9)
    for at_terminals, given_by_supply in ((8.0, 8.0), (-8.0, 0.0), (0.0, 0.005)):
        watts = TABLE.evaluate({**known, "terminal_power": at_terminals}, ["electrical_power"])["electrical_power"]
        assert watts == pytest.approx(given_by_supply, abs=1e-5)  # a corner of 0.01 W, half as high in the middle


def test_a_switch_ends_by_the_criterion_that_was_chosen(stack):
    # Faces at 95 and 75 degC, the mean at 85, on the way to 100: what is left of each, over 100 K.
    profile = heat.profile(heat.initial_state(stack, 5, 300.0), stack)._replace(near=368.15, far=348.15)
    impedances = {"impedance_now": 30.0, "soft_threshold": 15.0}
    m = Module(stack_profile=profile, mean_temperature=358.15, target_temperature=373.15, **impedances)
    left = {"near_face": -0.05, "mean": -0.15, "far_face": -0.25, "softening": np.log(15.0 / 30.0)}
    for criterion, expected in left.items():
        m.response_criterion = criterion
        time = softening.response_time(m)
        assert time == pytest.approx(expected, rel=1e-9), criterion
