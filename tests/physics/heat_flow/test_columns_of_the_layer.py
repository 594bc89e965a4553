"""Columns of the layer, and the ways of heat at its edges."""

import numpy as np
import pytest
from numpy.typing import NDArray
from plane_conduction import along_a_row, conducted, in_rectangle
from scipy.integrate import solve_bvp

from tvimdesign.physics.heat_flow import columns, lumps, shape_factors
from tvimdesign.physics.heat_flow.lumps import Link, Slope

Array = NDArray[np.float64]


def layer_that_loses(flux: Array, width: float, across: int) -> Array:
    """Temperatures of a layer of depth and conductivity one, faces at 0, that loses a flux over its end, by column."""
    source = np.zeros((across, len(flux)))
    source[-1] = -flux * across / width
    return in_rectangle(source, (width, 0.0, 0.0), (1.0, 2.0, 2.0))


@pytest.mark.parametrize("width", [0.7, 1.5, 5.0])
def test_a_layer_is_below_its_mean_as_in_two_dimensions(width):
    across, deep = 300, 60
    heights = (np.arange(deep) + 0.5) / deep
    waves = np.pi * np.arange(1, columns.SINES + 1)
    flux = 2.0 * np.sum(np.sin(np.outer(waves, heights)), axis=0)
    rises = layer_that_loses(flux, width, across)
    below = np.mean(rises, axis=0) - rises
    places = (np.arange(across) + 0.5) / across
    for column, place in enumerate(places):
        if place < 0.97:
            ours = columns.at_end(float(place), heights, width, 0.0)
            assert ours == pytest.approx(below[column], abs=0.01)


def test_evenly_falling_heat_cools_the_mean_as_the_end_does():
    across, deep, width = 200, 200, 1.2
    heights = (np.arange(deep) + 0.5) / deep
    flux = 1.0 / np.tan(0.5 * np.pi * heights)
    mean = np.mean(layer_that_loses(flux, width, across))
    share = shape_factors.FALLING * shape_factors.gap_end_depth(0.0)
    sink = 2.0 * (1.0 - heights) * share / width
    column = np.linalg.solve(along_a_row(deep, 1.0, 2.0, 2.0), -sink)
    assert np.mean(column) == pytest.approx(mean, rel=0.01)


@pytest.mark.parametrize("slenderness", [0.04, 0.5, 1.9, 4.0])
def test_a_sheet_is_below_its_mean_as_a_fin_whose_edge_is_cooled(slenderness):
    # t'' = x^2 (t - 1) over the half width, nothing passes its middle, the edge is at 0.
    solved = solve_bvp(
        lambda _, t: np.array([t[1], slenderness**2 * (t[0] - 1.0)]),
        lambda at_middle, at_edge: np.array([at_middle[1], at_edge[0]]),
        np.linspace(0.0, 1.0, 401),
        np.zeros((2, 401)),
        tol=1e-8,
    )
    fine = np.linspace(0.0, 1.0, 4001)
    mean = np.trapezoid(solved.sol(fine)[0], fine)
    for place in columns.DENSE.places:
        assert columns.in_sheet(place, slenderness) == pytest.approx((mean - solved.sol(place)[0]) / mean, abs=2e-4)
    if slenderness < 0.1:
        for place in columns.DENSE.places:
            assert columns.fed_evenly(place) == pytest.approx(columns.in_sheet(place, slenderness), abs=1e-3)


@pytest.mark.parametrize("them", [columns.EVEN, columns.DENSE])
def test_columns_have_no_mean_of_their_own(them):
    heights = np.array([0.2, 0.5, 0.8])
    for shape in (columns.fed_evenly, lambda place: columns.in_sheet(place, 1.5)):
        assert np.dot(them.shares, [shape(place) for place in them.places]) == pytest.approx(0.0, abs=1e-3)
    ends = np.array([columns.at_end(place, heights, 3.0, 0.1) for place in them.places])
    assert them.shares @ ends == pytest.approx(np.zeros(3), abs=0.02)
    lost, _ = columns.wall_profile(columns.wall_places(heights, 3.0, 0.01, 0.98, 0.1))
    beside = np.array(columns.beside_wall(lost))
    assert columns.DENSE.shares @ beside == pytest.approx(np.ones(3))
    assert np.all(np.diff(beside, axis=0) < 0.0)


def test_what_leaves_below_a_wall_cools_the_end_and_moves_no_mean():
    heights = (np.arange(12) + 0.5) / 12
    _, cooled = columns.wall_profile(columns.wall_places(heights, 3.0, 0.01, 0.98, 0.1))
    falls = np.array(columns.below_wall(cooled))
    assert np.abs(np.array(columns.DENSE.shares) @ falls).max() < 1e-12
    at_end, away = falls[-1], falls[0]
    assert at_end[0] > at_end[-1]  # the heat leaves next to the pads
    assert np.all(at_end >= away)
    assert np.abs(away).max() < 0.05 * at_end[0]


@pytest.mark.parametrize("onward", [0.005, 0.02, 0.08, 0.5])
@pytest.mark.parametrize("coefficient", [3.0, 10.0, 25.0])
def test_a_strip_that_goes_on_at_its_end_takes_the_heat_of_a_fin(onward, coefficient):
    # A fin of 10 mm that gives heat to the air and at its end onwards, both at 0; its edge at 1.
    sheet, width = 5e-4, 10e-3
    steep = np.sqrt(coefficient / sheet)
    tanh, wave = np.tanh(steep * width), np.sqrt(coefficient * sheet)
    exact = wave * (onward / wave + tanh) / (1.0 + onward / wave * tanh)
    air = lumps.Surface(1.0, coefficient)
    bodies = lumps.strip_bodies(width, 1.0, sheet / width, air)
    last, to_end, at_end = lumps.strip_end(bodies[-1].surface, sheet / width / lumps.BEYOND, onward, 300.0)
    # What counts at the end meets the same air as the end itself, which takes all at 0.
    assert last.area + at_end < bodies[-1].surface.area
    taken = to_end + coefficient * last.area
    for body, before in zip(bodies[::-1], (*bodies[-2::-1], None), strict=True):
        taken = lumps.in_series(body.conductance, taken)
        taken += coefficient * before.surface.area if before else 0.0
    assert taken == pytest.approx(exact, rel=0.007)


def test_what_the_layer_gives_in_place_of_the_hot_side_is_the_same_heat():
    cells = np.array([350.0, 340.0, 330.0, 320.0])
    places = {"hot": [360.0], "around": [310.0]}
    link = lumps.Link(("hot", 0), ("around", 0), 0.2)
    flows = lumps.linked([link._replace(of_layer=0.7)], places, {"layer": cells})
    assert flows["around"][0] == pytest.approx(10.0)
    assert flows["hot"][0] == pytest.approx(-3.0)
    # Seven, five, three and one sixteenth: it falls evenly to nothing at the far face.
    assert flows["layer"][0] == pytest.approx(-7.0 * np.array([7.0, 5.0, 3.0, 1.0]) / 16.0)


@pytest.mark.parametrize("slenderness", [0.8, 2.0, 6.0])
def test_a_row_is_below_the_mean_by_what_conduction_in_two_dimensions_says(slenderness):
    # Half the height and the conductivity are one; both ends are held, the faces lose 1.5 and 0.6.
    deep, high, lost = 120, 120, (1.5, 0.6)
    source = np.zeros((deep, high))
    source[:, 0], source[:, -1] = -lost[0] * high / 2.0, -lost[1] * high / 2.0
    rises = in_rectangle(source, (slenderness, 2.0, 2.0), (2.0, 0.0, 0.0))
    below = np.mean(rises, axis=1)[:, None] - rises
    depths = (np.arange(deep) + 0.5) / deep
    for row, place in enumerate((np.arange(high) + 0.5) / high * 2.0 - 1.0):
        if abs(place) < 0.93:
            ours = columns.row_below_mean(float(place), depths, slenderness, lost)
            assert ours == pytest.approx(below[:, row], abs=0.025)


@pytest.mark.parametrize("slenderness", [0.1, 0.4, 1.5])
def test_uneven_heat_passes_an_edge_as_in_two_dimensions(slenderness):
    # Height and conductivity one; the edge is held at a cosine over the height, whose end nothing passes.
    along, high = 400, 80
    edge = np.cos(np.pi * (np.arange(high) + 0.5) / high)
    source = np.zeros((along, high))
    source[0] = 2.0 * (along / slenderness) ** 2 * edge
    rises = in_rectangle(source, (slenderness, 2.0, 0.0), (1.0, 0.0, 0.0))
    passed = 2.0 * along / slenderness * (edge - rises[0])
    way = shape_factors.uneven_way(slenderness)
    assert passed == pytest.approx(edge / way, abs=0.01 / way)


def test_a_layer_gives_each_place_of_what_falls_before_it_its_own_heat():
    # A face at 40 K that is 6 K warmer at the layer's near end than at its far one: 42, 40, 38 K before three cells.
    cells = np.array([90.0, 70.0, 50.0])
    slope = Slope(((("around", 1), 0.25), (("around", 3), 0.75)), ("around", 2), 0.5)
    link = Link(("layer", 0), ("around", 0), 3.0, slope=slope)
    flows = lumps.linked([link], {"around": np.array([40.0, 50.0, 35.0, 46.0])}, {"layer": cells})
    assert flows["layer"][0] == pytest.approx(np.array([42.0, 40.0, 38.0]) - cells)
    assert flows["around"] == pytest.approx([90.0, 0.0, 0.0, 0.0])


@pytest.mark.parametrize(("cells", "slot"), [(48, 4), (48, 12)])
def test_the_end_of_a_gap_gives_as_in_two_dimensions(cells, slot):
    # A gap of `cells` over its height; left of it a wall at 1 that falls to 0 from the slot's mouth to the upper wall,
    # below it a floor at 0, which a slot keeps apart from that wall.
    long, deep = 3 * cells, 3 * slot
    inside = np.zeros((long + 2, deep + cells + 2), dtype=bool)
    inside[1:-1, deep + 1 : -1] = True
    inside[1 : slot + 1, 1 : deep + 1] = True
    fixed = np.full(inside.shape, np.nan)
    height = (np.arange(cells) + 0.5) / cells
    fixed[0, 1 : deep + 1], fixed[0, deep + 1 : -1] = 1.0, 1.0 - height
    fixed[slot + 1 :, deep] = fixed[slot + 1, 1 : deep + 1] = fixed[:, -1] = 0.0
    rises = conducted(inside, fixed)
    flux = 2.0 * (1.0 - height - rises[1, deep + 1 : -1])
    assert sum(shape_factors.gap_end(slot / cells)) == pytest.approx(np.sum(flux), rel=0.01)
    # And how deep it lies in what ends there.
    assert shape_factors.gap_end_depth(slot / cells) == pytest.approx(
        np.sum(0.5 * flux * height * (1.0 - height)), rel=0.01
    )


@pytest.mark.parametrize("slenderness", [0.3, 0.6, 1.0, 1.7])
def test_a_ledge_conducts_as_two_dimensions_say(slenderness):
    # A slab of 30 cells, heated evenly over its upper face up to `wide` from its free end; a long way on it is cold.
    high, wide = 30, round(30 * slenderness)
    inside = np.zeros((wide + 3 * high + 1, high), dtype=bool)
    inside[:-1] = True
    fixed, source = np.full(inside.shape, np.nan), np.zeros(inside.shape)
    fixed[-1], source[:wide, -1] = 0.0, 1.0 / wide
    rises = conducted(inside, fixed, source)
    face = np.mean(rises[:wide, -1]) + 0.5 / wide
    ledge = np.mean(rises[:wide])
    root = 0.5 * np.mean(rises[wide - 1] + rises[wide])
    onto, onward = shape_factors.ledge_ways(wide / high)
    assert onto == pytest.approx(face - ledge, rel=0.02)
    assert onward == pytest.approx(ledge - root, rel=0.02)


@pytest.mark.parametrize("share", [0.4, 0.7, 0.9, 1.0])
def test_a_partly_heated_slab_resists_as_conduction_says(share):
    high, deep = 60, 90
    inside = np.zeros((deep + 2, high + 2), dtype=bool)
    inside[1:-1, 1:-1] = True
    fixed = np.full(inside.shape, np.nan)
    fixed[-1, 1:-1] = 0.0
    source = np.zeros(inside.shape)
    heated = slice(1, 1 + round(share * high))
    source[1, heated] = 1.0 / (share * high)
    rises = conducted(inside, fixed, source)
    # Half a cell lies between the face and the first row, which the heated share passes in less width.
    onto = np.mean(rises[1, heated]) - np.mean(rises[1, 1:-1]) + 0.5 / high * (1.0 / share - 1.0)
    assert shape_factors.constriction(share) == pytest.approx(onto, rel=0.01, abs=1e-3)


@pytest.mark.parametrize("share", [0.25, 0.7])
def test_a_step_in_a_sheet_resists_what_conduction_in_two_dimensions_says(share):
    deep, long = 40, 100
    low = round(share * deep)
    inside = np.zeros((2 * long + 2, deep + 2), dtype=bool)
    inside[1 : long + 1, 1 : low + 1] = inside[long + 1 : -1, 1:-1] = True
    fixed = np.full(inside.shape, np.nan)
    fixed[0], fixed[-1] = 1.0, 0.0
    rises = conducted(inside, fixed)
    passed = np.nansum(2.0 * (1.0 - rises[1]))
    assert shape_factors.step(share) == pytest.approx(1.0 / passed - long / low - long / deep, rel=0.02)


@pytest.mark.parametrize(("plate", "lip", "wide"), [(20, 8, 26), (40, 6, 15), (30, 6, 12)])
def test_heat_from_a_lip_s_side_spreads_as_in_two_dimensions(plate, lip, wide):
    # The lip's side is heated evenly; plate above the layer to the left, plate beside it to the right, both ends at 0.
    long = 3 * plate
    inside = np.zeros((2 * long + 2, plate + lip + 2), dtype=bool)
    inside[1:-1, lip + 1 : -1] = inside[long + 1 : long + wide + 1, 1 : lip + 1] = True
    fixed = np.full(inside.shape, np.nan)
    fixed[0] = fixed[-1] = 0.0
    source = np.zeros(inside.shape)
    source[long + 1, 1 : lip + 1] = 1.0 / lip
    rises = conducted(inside, fixed, source)
    side = np.mean(rises[long + 1, 1 : lip + 1]) + 0.5 / lip
    # What the plate's mean over its depth, falling evenly far from the lip, comes to at the lip's side.
    mean = np.mean(rises[:, lip + 1 : -1], axis=1)
    away = np.arange(2 * long + 2) - long - 0.5
    before, behind = away < -plate, (away > wide + plate) & (away < long)
    before[0] = False
    at_side = [np.polyfit(away[places], mean[places], 1)[1] for places in (before, behind)]
    assert shape_factors.constriction(lip / (lip + plate)) == pytest.approx(side - np.mean(at_side), rel=0.2)


def in_two_dimensions(slenderness: float, across: int = 60) -> float:
    """Mean of half a bar above that of its face where it loses 1 W/m^2 at k = 1 W/(m K), half its height 1 m.

    Finite volumes; its ends are kept at no temperature, no heat passes its middle.
    """
    lost = np.zeros((round(across * slenderness), across))
    lost[:, -1] = -across
    rises = in_rectangle(lost, (slenderness, 2.0, 2.0), (1.0, 0.0, 0.0))
    face = rises[:, -1] - 0.5 / across
    return float(np.mean(rises) - np.mean(face))


@pytest.mark.parametrize("slenderness", [0.7, 1.3, 2.0, 4.0])
def test_faces_are_as_far_from_the_mean_as_in_two_dimensions(slenderness):
    assert shape_factors.way_to_faces(slenderness) == pytest.approx(in_two_dimensions(slenderness), rel=0.01)


def test_a_long_bar_has_its_mean_a_third_from_the_middle():
    assert shape_factors.way_to_faces(1e4) == pytest.approx(1.0 / 3.0, rel=1e-3)
