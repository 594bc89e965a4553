"""The wall at a layer's end, and still air beside it."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from plane_conduction import conducted, given_off
from scipy.integrate import quad
from scipy.optimize import brentq, root

from tvimdesign.device.shear.layer_end import AT_CORNER
from tvimdesign.physics.heat_flow import layer_end
from tvimdesign.physics.heat_flow.conduction import Conductivities, shared
from tvimdesign.physics.heat_flow.lumps import Place
from tvimdesign.physics.heat_flow.shape_factors import beyond_constriction, ledge_across, ledge_ways
from tvimdesign.physics.polymers.polymer import Melting

ACROSS, LONG = 120, 4.0
"""Cells over the layer's thickness; its length, beyond which the wall is not felt."""


def walled_layer(free: float, contact: float = 0.0, lost: float = 0.0) -> NDArray[np.float64]:
    """Temperatures of a layer by column from its end on: near face (first) at 1, far one and wall at 0.

    Each behind a contact as thick as so much of the layer. With `lost` both faces are at 0, and that heat leaves the
    free end, as cos(pi y) falls over it.
    """
    inside = np.zeros((int(LONG * ACROSS) + 1, ACROSS + 2), dtype=bool)
    inside[1:, 1:-1] = True
    held, source = np.full(inside.shape, np.nan), np.zeros(inside.shape)
    held[1:, 0], held[1:, -1] = 0.0 if lost else 1.0, 0.0
    held[0, 1:-1][heights() > free] = 0.0
    passed = 1.0 - np.cos(np.pi * np.minimum(np.arange(ACROSS + 1) / ACROSS, free))
    source[1, 1:-1] = -lost * np.diff(passed) / passed[-1]
    return conducted(inside, held, source, contact * ACROSS)[1:, 1:-1]


def heights() -> NDArray[np.float64]:
    return (np.arange(ACROSS) + 0.5) / ACROSS


@pytest.mark.parametrize("free", [0.1, 0.25, 0.5])
def test_the_wall_takes_what_conduction_in_two_dimensions_says(free):
    rises, ours = walled_layer(free), layer_end.walled_end(free)
    assert ours.near == pytest.approx(np.sum(2.0 * (1.0 - rises[:, 0])) - LONG, rel=0.02)
    into = 2.0 * rises[0, heights() > free]
    assert ours.wall == pytest.approx(np.sum(into), rel=0.02)
    even = 1.0 - heights()
    assert ours.deep == pytest.approx(np.sum(even - rises) / ACROSS**2, rel=0.015)
    for column in (3, 20, 60):
        lost = 1.0 - rises[column] / even
        assert layer_end.fallen(free, (column + 0.5) / ACROSS, heights()) == pytest.approx(lost, abs=0.02)


@pytest.mark.parametrize(("free", "contact"), [(0.1, 0.02), (0.2, 0.02), (0.1, 0.04)])
def test_contacts_are_more_free_height_as_in_two_dimensions(free, contact):
    into = walled_layer(free, contact)[0, heights() > free] / (0.5 + contact * ACROSS)
    ours = layer_end.walled_end((free + 2.0 * AT_CORNER * contact) / (1.0 + 2.0 * contact))
    assert ours.wall == pytest.approx(np.sum(into), rel=0.025)


@pytest.mark.parametrize(("free", "layer"), [(0.1, 0.4), (0.2, 0.5), (0.15, 0.25)])
def test_layer_and_sheet_give_the_wall_as_in_two_dimensions(free, layer):
    rises, ours = walled_layer(free), layer_end.sheeted_end(free, layer)
    own, above = heights() < layer, heights() > layer
    assert ours.wall == pytest.approx(np.sum(2.0 * rises[0, own & (heights() > free)]), rel=0.03)
    assert ours.rim == pytest.approx(np.sum(2.0 * rises[0, above]), rel=0.01)
    missed = (1.0 - heights() - rises) / ACROSS**2
    mean = 1.0 - 0.5 * layer
    assert 2.0 * mean * ours.colder == pytest.approx(np.sum(missed[:, own]) / layer, rel=0.03)
    assert ours.sheet_colder == pytest.approx(np.sum(missed[:, above]) / (1.0 - layer), rel=0.08)


@pytest.mark.parametrize("layer", [0.25, 0.5])
def test_a_sheet_alone_gives_the_wall_as_in_two_dimensions(layer):
    rises, ours = walled_layer(layer), layer_end.sheet_end(layer)
    assert ours.rim == pytest.approx(np.sum(2.0 * rises[0, heights() > layer]), rel=0.015)
    missed = (1.0 - heights() - rises)[:, heights() > layer] / ACROSS**2
    assert ours.sheet_colder == pytest.approx(np.sum(missed) / (1.0 - layer), rel=0.08)


def test_a_layer_below_a_sheet_is_as_cold_in_the_mean():
    layer = 0.4
    ours = layer_end.sheeted_end(0.1, layer)
    height = (np.arange(4000) + 0.5) / 4000
    # Green's function of a fall that is held at both faces; the layer's mean of it.
    mean = np.where(height < layer, height * (1.0 - 0.5 * layer) - 0.5 * height**2 / layer, 0.0)
    by_slices = 24.0 * ours.deep * np.mean(mean * (1.0 - height))
    from_sheet = ours.rim * layer * (1.0 - layer) / 3.0
    assert by_slices + from_sheet == pytest.approx(ours.colder * (2.0 - layer), rel=1e-3)


def test_heat_from_the_free_end_cools_as_in_two_dimensions():
    free = 0.15
    rises = -walled_layer(free, lost=1.0)
    # What leaves rises with the height, as in sin a near the corner; the near face gives half of it.
    for column in (3, 8, 16):
        ours = 0.5 * layer_end.cooled_end(free, (column + 0.5) / ACROSS, heights())
        assert rises[column] == pytest.approx(ours, abs=0.05 * np.max(rises[0]))


Array = NDArray[np.float64]
AIR, PLATE = ("air", 0), ("plate", 0)
conductances = st.floats(1e-3, 0.5)
temperatures = st.floats(280.0, 400.0)


@st.composite
def lips(draw: st.DrawFn) -> tuple[layer_end.Lip, Array, dict[Place, float]]:
    """Return a lip, the cells beside it and the temperatures of its other neighbours."""
    arms = (
        layer_end.Arm(draw(conductances), ((AIR, 1.0),)),
        layer_end.Arm(draw(conductances), ((AIR, 0.3), (PLATE, 0.5)), 0.8),
    )
    cells = np.array(draw(st.lists(temperatures, min_size=1, max_size=6)))
    places = {("spreader", 0): draw(temperatures), AIR: draw(temperatures), PLATE: draw(temperatures)}
    return layer_end.Lip(draw(conductances), draw(conductances), arms), cells, places


def melting(cells: Array, pads: float) -> Any:
    """Return how well a polymer conducts that conducts a fifth less once it is warmer than 330 K, as a smooth
    function."""

    def share(other: Any, temperature: Any) -> Any:
        return 1.0 - 0.1 * np.tanh((0.5 * (other + temperature) - 330.0) / 15.0)

    def at(temperature: Any) -> tuple[Any, Any]:
        return share(cells, temperature), share(pads, temperature)

    return at


@given(case=lips())
def test_temperatures_that_leave_no_residual_are_those_of_the_closed_form(case):
    lip, cells, places = case
    conducting = melting(cells, places["spreader", 0])
    closed = layer_end.warm_lip(lip, cells, places.__getitem__, conducting)
    assert closed.residuals == (0.0, 0.0)

    def residuals(given: Array) -> Array:
        warmed = layer_end.warm_lip(lip, cells, places.__getitem__, conducting, (given[0], given[1]))
        return np.array(warmed.residuals)

    solved = root(residuals, np.array([340.0, 300.0]), tol=1e-12)
    assert solved.success
    joined = layer_end.warm_lip(lip, cells, places.__getitem__, conducting, tuple(solved.x))
    assert joined.temperature == pytest.approx(closed.temperature, rel=1e-10)
    assert joined.from_layer == pytest.approx(closed.from_layer, rel=1e-7, abs=1e-9)
    assert joined.from_places == pytest.approx(closed.from_places, rel=1e-7, abs=1e-9)
    assert sum(joined.from_layer) + joined.from_places["spreader", 0] + _through_arms(
        lip, joined, places
    ) == pytest.approx(0.0, abs=1e-9)


def _through_arms(lip: layer_end.Lip, warm: Any, places: dict[Place, float]) -> float:
    """Heat [W] that comes to the lip itself through its arms: each arm's, times its share of the lip."""
    return float(sum(
        arm.share * arm.conductance * (sum(w * places[end] for end, w in arm.ends) - arm.share * warm.temperature)
        for arm in lip.arms
    ))  # fmt: skip


@given(case=lips(), off=st.tuples(st.floats(-20.0, 20.0), st.floats(-20.0, 20.0)))
def test_residuals_say_how_far_given_temperatures_are_off(case, off):
    lip, cells, places = case
    alike = layer_end.warm_lip(lip, cells, places.__getitem__, lambda _: (np.ones(len(cells)), 1.0)).temperature
    closed = layer_end.warm_lip(lip, cells, places.__getitem__, melting(cells, places["spreader", 0])).temperature
    first, _ = layer_end.warm_lip(
        lip, cells, places.__getitem__, melting(cells, places["spreader", 0]), (alike + off[0], closed)
    ).residuals
    _, second = layer_end.warm_lip(
        lip, cells, places.__getitem__, melting(cells, places["spreader", 0]), (alike, closed + off[1])
    ).residuals
    assert first == pytest.approx(-off[0], abs=1e-9)
    assert second == pytest.approx(-off[1], abs=1e-9)


MELTING = Melting(1850.0, 2100.0, 76.75e3, 323.15, 338.15, 500.0)


def passed(conductivities: Conductivities, low: float, high: float) -> float:
    """Integral of the conductivity over temperature [W/m], straight within the window, by quadrature."""

    def at(temperature: float) -> float:
        molten = min(max((temperature - MELTING.start) / (MELTING.end - MELTING.start), 0.0), 1.0)
        return conductivities.solid + molten * (conductivities.melt - conductivities.solid)

    return float(quad(at, low, high, points=[MELTING.start, MELTING.end], limit=200)[0])


@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
@pytest.mark.parametrize(("place", "wall"), [(365.0, 305.0), (350.0, 318.0), (330.0, 300.0)])
def test_two_conductivities_share_the_potential(share, place, wall):
    both = Conductivities(0.20, 0.16)  # about PCL's
    whole = passed(both, wall, place)
    exact = brentq(lambda middle: passed(both, wall, middle) - share * whole, wall, place)
    shown = shared(share, place, wall, both, MELTING)
    assert shown == pytest.approx(exact, abs=0.02 * (place - wall))
    even = wall + share * (place - wall)
    assert abs(shown - exact) <= max(0.25 * abs(even - exact), 0.02)  # the step takes most of what the share misses


N = 48
"""Cells over the height of a room, of a clearance or of a ledge."""


def framed(shape: tuple[int, int], inside: float = np.nan) -> tuple[NDArray[np.bool_], Array]:
    """Return a frame of so many cells, none of them solid, and insulated walls; those within are at a temperature."""
    fixed = np.pad(np.full(shape, inside), 1, constant_values=np.nan)
    return np.zeros(fixed.shape, dtype=bool), fixed


@pytest.mark.parametrize("width", [0.5, 1.0, 2.0])
def test_a_room_beside_tiles_gives_what_conduction_in_two_dimensions_says(width):
    slot, gap = 4 / N, 4
    # The ceiling, at one, ends before the wall; above the slot its own edge is as warm as it is. The tile's side falls
    # evenly; floor and wall are at nothing.
    inside, fixed = framed((int(width * N) + gap, 2 * N), 1.0)
    inside[1:-1, 1 : N + 1] = inside[-gap - 1 : -1, N + 1 : -1] = True
    fixed[0, 1:-1] = (np.arange(2 * N) + 0.5) / N
    fixed[-1] = fixed[:, 0] = 0.0
    rises = conducted(inside, fixed)
    edge = np.sum(2.0 * (1.0 - rises[-gap - 1, N + 1 : -1])) - N / gap
    tile, floor, ceiling = (np.zeros(inside.shape, dtype=bool) for _ in range(3))
    tile[0] = floor[:, 0] = ceiling[1:-1, 1:-1] = True
    ours = layer_end.room(width + slot, slot)
    # An even fall brings as much from ceiling to floor as the room is wide below that.
    assert ours.ceiling + width == pytest.approx(given_off(ceiling, rises, fixed) - N / gap, abs=0.06)
    assert width + slot - ours.floor == pytest.approx(-given_off(floor, rises, fixed), abs=0.02)
    assert ours.tile == pytest.approx(given_off(tile, rises, fixed), abs=0.02)
    assert edge > 0.0


@pytest.mark.parametrize("slot", [0.25, 0.5, 1.0, 1.75])
def test_a_clearance_gives_lip_and_floor_as_in_two_dimensions(slot):
    n = 24
    gap, deep, long = int(slot * n), 4 * int(max(slot, 1.0) * n), 5 * n
    inside, fixed = framed((gap + long, deep + n), 0.0)
    inside[1:-1, deep + 1 : -1] = inside[1 : gap + 1, 1:-1] = True
    warm = np.append(np.ones(deep), 1.0 - 2.0 / np.pi * np.arcsin((np.arange(n) + 0.5) / n))
    fixed[0, 1:-1] = warm
    fixed[1:-1, -1] = 0.0
    rises = conducted(inside, fixed)
    pads, lip = (np.zeros(inside.shape, dtype=bool) for _ in range(2))
    pads[0] = lip[1:-1, -1] = True
    passed = deep / gap
    from_pads = np.sum(warm * 2.0 * (warm - rises[1, 1:-1])) - passed
    to_lip, to_floor = layer_end.below_lip(slot)
    floor = given_off(pads, rises, fixed) - passed + given_off(lip, rises, fixed)
    assert to_floor == pytest.approx(floor, abs=0.06)
    assert to_lip == pytest.approx(from_pads - floor, abs=0.06)


def heated_strip(sources: Array) -> Array:
    """Temperatures of a strip that is heated in some cells and kept at nothing beyond its end."""
    inside, fixed = framed(sources.shape)
    inside[1:-1, 1:-1] = True
    fixed[-1] = 0.0
    return conducted(inside, fixed, np.pad(sources, 1))[1:-1, 1:-1]


@pytest.mark.parametrize("slenderness", [0.5, 0.8, 2.0])
def test_a_ledge_s_lower_face_is_colder_as_in_two_dimensions(slenderness):
    wide = int(slenderness * N)
    sources = np.zeros((wide + 3 * N, N))
    sources[:wide, -1] = 1.0 / wide
    rises = heated_strip(sources)
    ledge = rises[:wide]
    top, bottom = (np.mean(ledge[:, k] + 0.5 * (ledge[:, k] - ledge[:, near])) for k, near in ((-1, -2), (0, 1)))
    assert ledge_ways(slenderness)[0] == pytest.approx(top - np.mean(ledge), rel=0.03)
    assert ledge_across(slenderness) == pytest.approx(np.mean(ledge) - bottom, rel=0.03)


@pytest.mark.parametrize(("begin", "width"), [(0.0, 0.3), (0.3, 0.7)])
def test_a_lip_s_lower_face_is_warmer_as_in_two_dimensions(begin, width):
    share = 1.0 / 3.0
    sources = np.zeros((3 * N, N))
    sources[0, : N // 3] = 3.0 / N
    rises = heated_strip(sources)
    first, last = round(begin * N), round((begin + width) * N)
    face = rises[first:last, 0] + 0.5 * (rises[first:last, 0] - rises[first:last, 1])
    warmer = np.mean(face - np.mean(rises[first:last], axis=1))
    assert beyond_constriction(share, begin, width) == pytest.approx(warmer, rel=0.04)
