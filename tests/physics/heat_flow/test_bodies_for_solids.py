"""Bodies of one temperature in place of strips, fins and slabs, against what the heat equation says of these."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

from tvimdesign.physics.heat_flow import heat, lumps, peltier, ring_sheet, shape_factors
from tvimdesign.physics.polymers import polymer


@pytest.mark.parametrize("over", [0.01, 0.03, 0.1, 0.3, 1.0, 3.0])
def test_three_bodies_take_the_heat_of_a_strip(over):
    # Carslaw and Jaeger, ch. III: a slab, one face at the rate of one, the other insulated; all of it of one.
    bodies = lumps.strip_bodies(1.0, 1.0, 1.0, lumps.NOWHERE)
    size = len(bodies)
    system = np.zeros((size + 2, size + 2))
    for i, body in enumerate(bodies):
        before = size if i == 0 else i - 1
        system[i, before] += body.conductance / body.capacity
        system[i, i] -= body.conductance / body.capacity
        if i:
            system[before, i] += body.conductance / bodies[before].capacity
            system[before, before] -= body.conductance / bodies[before].capacity
    system[size, size + 1] = 1.0
    end = expm(over * system) @ np.append(np.zeros(size + 1), 1.0)
    taken = sum(body.capacity * warm for body, warm in zip(bodies, end[:size], strict=True))
    roots = (np.arange(1, 400) - 0.5) * np.pi
    series = over - 1.0 / 3.0 + np.sum(2.0 / roots**4 * np.exp(-(roots**2) * over))
    assert taken == pytest.approx(series, rel=0.008)


def test_a_strip_conducts_across_its_whole_width_as_it_is_long():
    ways = sum(1.0 / body.conductance for body in lumps.strip_bodies(2.0, 3.0, 5.0, lumps.NOWHERE))
    assert ways + lumps.BEYOND / 5.0 == pytest.approx(1.0 / 5.0, rel=1e-12)
    assert sum(lumps.STRIP) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("slenderness", [0.05, 0.7, 1.5, 4.0])
def test_the_way_in_a_fin_is_that_of_its_cells(slenderness):
    cells = 2000
    step = 1.0 / cells
    heated = np.full(cells, slenderness**2 * step**2)
    inside = np.diag(2.0 + heated) - np.diag(np.ones(cells - 1), 1) - np.diag(np.ones(cells - 1), -1)
    inside[0, 0] -= 1.0
    inside[-1, -1] += 1.0  # half a cell to the root, which is at 0
    profile = np.linalg.solve(inside, heated)
    flux = profile[-1] / (0.5 * step)
    assert np.mean(profile) / flux == pytest.approx(shape_factors.way_in_fin(slenderness), rel=1e-4)


def test_an_evenly_heated_slab_gives_by_a_parabola():
    # k A/H = 0.4 W/K; 3 W made evenly; 0.7 and 0.2 W/K on from its faces, to 30 and 10 degC; solved by its cells.
    across, ways, ends, cells, made = 0.4, (0.7, 0.2), (30.0, 10.0), 1000, 3.0
    between = across * cells
    inside = between * (np.diag(np.full(cells, 2.0)) - np.diag(np.ones(cells - 1), 1) - np.diag(np.ones(cells - 1), -1))
    source = np.full(cells, made / cells)
    for place, way, end in ((0, ways[0], ends[0]), (-1, ways[1], ends[1])):
        onward = lumps.in_series(2.0 * between, way)
        inside[place, place] += onward - between
        source[place] += onward * end
    profile = np.linalg.solve(inside, source)
    given = lumps.in_series(2.0 * between, ways[0]) * (profile[0] - ends[0])
    first, second, straight = lumps.heated_between(across, *ways)
    mean = np.mean(profile)
    assert first * (mean - ends[0]) + straight * (ends[1] - ends[0]) == pytest.approx(given, rel=1e-5)
    assert second * (mean - ends[1]) + straight * (ends[0] - ends[1]) == pytest.approx(made - given, rel=1e-5)


def test_a_face_before_its_body_loses_what_comes_to_it():
    body, air, behind = 380.0, 295.0, 6e-3

    def lost(face: float) -> float:
        return 5.0 * (face - air) + 0.9 * lumps.STEFAN_BOLTZMANN * (face**4 - air**4)

    face = brentq(lambda at: (body - at) / behind - lost(at), air, body)
    surface = lumps.Surface(2.0, 5.0, 0.9, behind)
    assert lumps.surface_heat(surface, body, air) == pytest.approx(2.0 * lost(face), rel=1e-3)


MELTING = polymer.Melting(1850.0, 2100.0, 76.75e3, 323.15, 338.15, 500.0)
CELLS, CURRENT = 6, 2.0


def stack(resistance: float) -> heat.Stack:
    return heat.Stack(
        area=1e-3, thickness=1e-3, density=1145.0, conductivity_solid=0.22, conductivity_melt=0.18, melting=MELTING,
        peltier=peltier.PeltierModule(0.0, 0.5, 0.1), cold_capacity=3.0, hot_capacity=2.0, cold_surface=lumps.NOWHERE,
        hot_contact=1e4, plate_contact=500.0, plate_thickness=3e-3, plate_conductivity=0.2, plate_heat_capacity=1.5e6,
        plate_surface=lumps.Surface(1e-3, 5.0), ambient=295.15, plate_cells=3, layer_resistance=resistance,
    )  # fmt: skip


def test_all_that_the_terminals_give_is_stored_where_nothing_is_lost():
    losing = stack(1.5)._replace(plate_surface=lumps.Surface(1e-3, 1e-9))
    state = heat.initial_state(losing, CELLS, 310.0)
    state = state + 0.05 * np.sin(np.arange(len(state)))
    step = 1e-6
    rate = heat.rates(state, losing, CURRENT)
    stored = (heat.stored_energy(state + step * rate, losing) - heat.stored_energy(state - step * rate, losing)) / (
        2.0 * step
    )
    power = heat.electrical_power(heat.profile(state, losing), losing, CURRENT)
    assert power == pytest.approx(CURRENT**2 * (0.5 + 1.5), rel=1e-12)
    assert stored == pytest.approx(power, rel=1e-6)


def test_a_layer_heated_by_current_is_heated_evenly_for_either_sign():
    state = heat.initial_state(stack(0.0), CELLS, 310.0)
    more = heat.rates(state, stack(1.5), CURRENT) - heat.rates(state, stack(0.0), CURRENT)
    each = CURRENT**2 * 1.5 / (1145.0 * 1e-3 * 1e-3) / heat.ENTHALPY_SCALE
    assert more[2 : 2 + CELLS] == pytest.approx(each)
    assert np.all(np.delete(more, range(2, 2 + CELLS)) == 0.0)
    state = heat.initial_state(stack(1.5), CELLS, 310.0)
    assert heat.rates(state, stack(1.5), -CURRENT) == pytest.approx(heat.rates(state, stack(1.5), CURRENT))
    assert heat.voltage(heat.profile(state, stack(1.5)), stack(1.5), -CURRENT) == pytest.approx(-4.0)


def test_electrodes_of_a_comb_by_hand():
    # 2 ln 2/pi = 0.441271 of the depth for a foot much wider than the depth.
    assert shape_factors.electrode_foot(8e-3, 1e-3) == pytest.approx(0.441271e-3, rel=1e-5)
    feet = [shape_factors.electrode_foot(width, 1e-3) for width in (0.1e-3, 0.25e-3, 0.5e-3, 1e-3, 2e-3)]
    assert np.all(np.diff(feet) < 0.0)
    # Wide gaps: 10 mm long, 1 mm deep, 12 mm from finger to finger on 1200 mm2: 100 mm of gaps, 0.1 ohm m.
    foot = 1e-3 - 2e-3 / np.pi * np.log(np.sinh(0.5 * np.pi))
    by_hand = 0.1 * (10e-3 + 2.0 * foot) / (1e-3 * 0.1)
    assert shape_factors.comb_resistance(0.1, 1e-3, 1200e-6, 10e-3, 2e-3) == pytest.approx(by_hand)
    assert by_hand == pytest.approx(10.94, abs=0.01)


def above_vanes(fed: str, depths: ring_sheet.Depths, sheet: float) -> float:
    """Return by the bodies' links how much warmer what is fed one watt is than the vanes, which take it [K]."""
    rows = {name: tuple((name, k) for k in range(3)) for name in ("blocks", "pads", "walls")}
    places = [place for row in rows.values() for place in row]
    links = ring_sheet.sheet_links(sheet / 4e-3, 4e-3, depths, **rows, vanes=("vanes", 0))
    matrix = np.zeros((len(places), len(places)))
    for link in links:
        ends = [places.index(end) for end in (link.first, link.second) if end in places]
        for i in ends:
            matrix[i, i] += link.conductance
            for j in ends:
                matrix[i, j] -= link.conductance * (i != j)
    watts = [share if place[0] == fed else 0.0 for place, share in zip(places, 3 * lumps.STRIP, strict=True)]
    return float(np.dot(np.linalg.solve(matrix, watts), watts))


@pytest.mark.parametrize(("fed", "within"), [("blocks", 1e-4), ("pads", 0.05)])
def test_heat_along_the_ring_is_that_of_an_evenly_fed_rod(fed, within):
    # Heat that comes evenly into one stretch of an insulated rod and leaves evenly from the vanes', in 3,000 volumes.
    depths, sheet, count = ring_sheet.Depths(blocks=6e-3, pads=3e-3, vanes=2e-3, walls=5e-3), 0.2 * 4e-3, 1000
    stretches = np.repeat(["vanes", "blocks", "pads"], count)
    lengths = np.repeat([depths.vanes, depths.blocks, depths.pads], count) / count
    sources = (stretches == fed) * lengths / getattr(depths, fed) - (stretches == "vanes") * lengths / depths.vanes
    passed = np.cumsum(sources)[:-1]  # watts from each volume to the next
    drops = passed * 0.5 * (lengths[1:] + lengths[:-1]) / sheet
    temperatures = np.concatenate([[0.0], -np.cumsum(drops)])
    means = {name: np.mean(temperatures[stretches == name]) for name in ("vanes", fed)}
    assert above_vanes(fed, depths, sheet) == pytest.approx(means[fed] - means["vanes"], rel=within)
