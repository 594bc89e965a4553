"""Heat at the end of a gap over a slot, and through a ledge to its root, against conduction in two dimensions."""

import numpy as np
import pytest
from plane_conduction import conducted, in_rectangle

from tvimdesign.physics.heat_flow import shape_factors


@pytest.mark.parametrize(("cells", "slot"), [(48, 4), (48, 12)])
def test_the_end_of_a_gap_gives_as_in_two_dimensions(cells: int, slot: int) -> None:
    # A gap of `cells` over its height; left of it a wall at 1 that falls to 0 from the slot's mouth to the upper wall,
    # below it a floor at 0, which a slot keeps apart from that wall.
    long, deep = 3 * cells, 3 * slot
    inside = np.zeros((long + 2, deep + cells + 2), dtype=bool)
    inside[1:-1, deep + 1 : -1] = True
    inside[1 : slot + 1, 1 : deep + 1] = True
    kept = np.full(inside.shape, np.nan)
    height = (np.arange(cells) + 0.5) / cells
    kept[0, 1 : deep + 1], kept[0, deep + 1 : -1] = 1.0, 1.0 - height
    kept[slot + 1 :, deep] = kept[slot + 1, 1 : deep + 1] = kept[:, -1] = 0.0
    found = conducted(inside, kept)
    flux = 2.0 * (1.0 - height - found[1, deep + 1 : -1])
    assert sum(shape_factors.gap_end(slot / cells)) == pytest.approx(np.sum(flux), rel=0.01)
    # And how deep it lies in what ends there.
    assert shape_factors.gap_end_depth(slot / cells) == pytest.approx(
        np.sum(0.5 * flux * height * (1.0 - height)), rel=0.01
    )


@pytest.mark.parametrize("slenderness", [0.3, 0.6, 1.0, 1.7])
def test_a_ledge_conducts_as_two_dimensions_say(slenderness: float) -> None:
    # A slab of 30 cells, heated evenly over its upper face up to `wide` from its free end; a long way on it is cold.
    high, wide = 30, round(30 * slenderness)
    inside = np.zeros((wide + 3 * high + 1, high), dtype=bool)
    inside[:-1] = True
    kept, source = np.full(inside.shape, np.nan), np.zeros(inside.shape)
    kept[-1], source[:wide, -1] = 0.0, 1.0 / wide
    found = conducted(inside, kept, source)
    face = np.mean(found[:wide, -1]) + 0.5 / wide
    ledge = np.mean(found[:wide])
    root = 0.5 * np.mean(found[wide - 1] + found[wide])
    onto, onward = shape_factors.ledge_ways(wide / high)
    assert onto == pytest.approx(face - ledge, rel=0.02)
    assert onward == pytest.approx(ledge - root, rel=0.02)


@pytest.mark.parametrize("share", [0.4, 0.7, 0.9, 1.0])
def test_a_partly_heated_slab_resists_as_conduction_says(share: float) -> None:
    high, deep = 60, 90
    inside = np.zeros((deep + 2, high + 2), dtype=bool)
    inside[1:-1, 1:-1] = True
    kept = np.full(inside.shape, np.nan)
    kept[-1, 1:-1] = 0.0
    source = np.zeros(inside.shape)
    heated = slice(1, 1 + round(share * high))
    source[1, heated] = 1.0 / (share * high)
    found = conducted(inside, kept, source)
    # Half a cell lies between the face and the first row, which the heated share passes in less width.
    onto = np.mean(found[1, heated]) - np.mean(found[1, 1:-1]) + 0.5 / high * (1.0 / share - 1.0)
    assert shape_factors.constriction(share) == pytest.approx(onto, rel=0.01, abs=1e-3)


@pytest.mark.parametrize("share", [0.25, 0.7])
def test_a_step_in_a_sheet_resists_what_conduction_in_two_dimensions_says(share: float) -> None:
    deep, long = 40, 100
    low = round(share * deep)
    inside = np.zeros((2 * long + 2, deep + 2), dtype=bool)
    inside[1 : long + 1, 1 : low + 1] = inside[long + 1 : -1, 1:-1] = True
    kept = np.full(inside.shape, np.nan)
    kept[0], kept[-1] = 1.0, 0.0
    found = conducted(inside, kept)
    passed = np.nansum(2.0 * (1.0 - found[1]))
    assert shape_factors.step(share) == pytest.approx(1.0 / passed - long / low - long / deep, rel=0.02)


@pytest.mark.parametrize(("plate", "lip", "wide"), [(20, 8, 26), (40, 6, 15), (30, 6, 12)])
def test_heat_from_a_lip_s_side_spreads_as_in_two_dimensions(plate: int, lip: int, wide: int) -> None:
    # The lip's side is heated evenly; plate above the layer to the left, plate beside it to the right, both ends at 0.
    long = 3 * plate
    inside = np.zeros((2 * long + 2, plate + lip + 2), dtype=bool)
    inside[1:-1, lip + 1 : -1] = inside[long + 1 : long + wide + 1, 1 : lip + 1] = True
    kept = np.full(inside.shape, np.nan)
    kept[0] = kept[-1] = 0.0
    source = np.zeros(inside.shape)
    source[long + 1, 1 : lip + 1] = 1.0 / lip
    found = conducted(inside, kept, source)
    side = np.mean(found[long + 1, 1 : lip + 1]) + 0.5 / lip
    # What the plate's mean over its depth, falling evenly far from the lip, comes to at the lip's side.
    mean = np.mean(found[:, lip + 1 : -1], axis=1)
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
    found = in_rectangle(lost, (slenderness, 2.0, 2.0), (1.0, 0.0, 0.0))
    face = found[:, -1] - 0.5 / across
    return float(np.mean(found) - np.mean(face))


@pytest.mark.parametrize("slenderness", [0.7, 1.3, 2.0, 4.0])
def test_faces_are_as_far_from_the_mean_as_in_two_dimensions(slenderness: float) -> None:
    assert shape_factors.way_to_faces(slenderness) == pytest.approx(in_two_dimensions(slenderness), rel=0.01)


def test_a_long_bar_has_its_mean_a_third_from_the_middle() -> None:
    assert shape_factors.way_to_faces(1e4) == pytest.approx(1.0 / 3.0, rel=1e-3)
