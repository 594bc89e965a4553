"""Bodies of one temperature in place of strips, fins and slabs, against what the heat equation says of these."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

from tvimdesign.physics.heat_flow import lumps, shape_factors


@pytest.mark.parametrize("over", [0.01, 0.03, 0.1, 0.3, 1.0, 3.0])
def test_a_strip_in_three_bodies_takes_as_much_from_an_edge_that_warms_up_as_the_series_says(over: float) -> None:
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


def test_a_strip_conducts_across_its_whole_width_as_it_is_long() -> None:
    ways = sum(1.0 / body.conductance for body in lumps.strip_bodies(2.0, 3.0, 5.0, lumps.NOWHERE))
    assert ways + lumps.BEYOND / 5.0 == pytest.approx(1.0 / 5.0, rel=1e-12)
    assert sum(lumps.STRIP) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("slenderness", [0.05, 0.7, 1.5, 4.0])
def test_the_mean_of_a_heated_fin_lies_as_far_from_its_root_as_its_cells_say(slenderness: float) -> None:
    cells = 2000
    step = 1.0 / cells
    heated = np.full(cells, slenderness**2 * step**2)
    inside = np.diag(2.0 + heated) - np.diag(np.ones(cells - 1), 1) - np.diag(np.ones(cells - 1), -1)
    inside[0, 0] -= 1.0
    inside[-1, -1] += 1.0  # half a cell to the root, which is at 0
    profile = np.linalg.solve(inside, heated)
    flux = profile[-1] / (0.5 * step)
    assert np.mean(profile) / flux == pytest.approx(shape_factors.way_in_fin(slenderness), rel=1e-4)


def test_a_slab_that_is_heated_evenly_gives_to_both_ends_what_a_parabola_gives() -> None:
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


def test_a_face_before_its_body_loses_what_comes_to_it() -> None:
    body, air, behind = 380.0, 295.0, 6e-3

    def lost(face: float) -> float:
        return 5.0 * (face - air) + 0.9 * lumps.STEFAN_BOLTZMANN * (face**4 - air**4)

    face = brentq(lambda at: (body - at) / behind - lost(at), air, body)
    surface = lumps.Surface(2.0, 5.0, 0.9, behind)
    assert lumps.surface_heat(surface, body, air) == pytest.approx(2.0 * lost(face), rel=1e-3)
