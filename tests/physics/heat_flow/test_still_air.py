"""Shape factors of still air beside tiles and below a lip, against conduction in two dimensions by finite volumes."""

import numpy as np
import pytest
from numpy.typing import NDArray
from plane_conduction import conducted, given_off

from tvimdesign.physics.heat_flow.layer_end import below_lip, room
from tvimdesign.physics.heat_flow.shape_factors import beyond_constriction, ledge_across, ledge_ways

Array = NDArray[np.float64]
N = 48
"""Cells over the height of a room, of a clearance or of a ledge."""


def framed(shape: tuple[int, int], inside: float = np.nan) -> tuple[NDArray[np.bool_], Array]:
    """A frame around so many cells: of no cell yet, and walls that let no heat pass, those within of a temperature."""
    kept = np.pad(np.full(shape, inside), 1, constant_values=np.nan)
    return np.zeros(kept.shape, dtype=bool), kept


@pytest.mark.parametrize("width", [0.5, 1.0, 2.0])
def test_a_room_beside_tiles_gives_what_conduction_in_two_dimensions_says(width: float) -> None:
    slot, gap = 4 / N, 4
    # The ceiling, at one, ends before the wall; above the slot its own edge is as warm as it is. The tile's side falls
    # evenly; floor and wall are at nothing.
    inside, kept = framed((int(width * N) + gap, 2 * N), 1.0)
    inside[1:-1, 1 : N + 1] = inside[-gap - 1 : -1, N + 1 : -1] = True
    kept[0, 1:-1] = (np.arange(2 * N) + 0.5) / N
    kept[-1] = kept[:, 0] = 0.0
    found = conducted(inside, kept)
    edge = np.sum(2.0 * (1.0 - found[-gap - 1, N + 1 : -1])) - N / gap
    tile, floor, ceiling = (np.zeros(inside.shape, dtype=bool) for _ in range(3))
    tile[0] = floor[:, 0] = ceiling[1:-1, 1:-1] = True
    ours = room(width + slot, slot)
    # An even fall brings as much from ceiling to floor as the room is wide below that.
    assert ours.ceiling + width == pytest.approx(given_off(ceiling, found, kept) - N / gap, abs=0.06)
    assert width + slot - ours.floor == pytest.approx(-given_off(floor, found, kept), abs=0.02)
    assert ours.tile == pytest.approx(given_off(tile, found, kept), abs=0.02)
    assert edge > 0.0


@pytest.mark.parametrize("slot", [0.25, 0.5, 1.0, 1.75])
def test_a_clearance_gives_lip_and_floor_as_in_two_dimensions(slot: float) -> None:
    n = 24
    gap, deep, long = int(slot * n), 4 * int(max(slot, 1.0) * n), 5 * n
    inside, kept = framed((gap + long, deep + n), 0.0)
    inside[1:-1, deep + 1 : -1] = inside[1 : gap + 1, 1:-1] = True
    warm = np.append(np.ones(deep), 1.0 - 2.0 / np.pi * np.arcsin((np.arange(n) + 0.5) / n))
    kept[0, 1:-1] = warm
    kept[1:-1, -1] = 0.0
    found = conducted(inside, kept)
    pads, lip = (np.zeros(inside.shape, dtype=bool) for _ in range(2))
    pads[0] = lip[1:-1, -1] = True
    passed = deep / gap
    from_pads = np.sum(warm * 2.0 * (warm - found[1, 1:-1])) - passed
    to_lip, to_floor = below_lip(slot)
    floor = given_off(pads, found, kept) - passed + given_off(lip, found, kept)
    assert to_floor == pytest.approx(floor, abs=0.06)
    assert to_lip == pytest.approx(from_pads - floor, abs=0.06)


def heated_strip(sources: Array) -> Array:
    """Temperatures of a strip that is heated in some cells and kept at nothing beyond its end."""
    inside, kept = framed(sources.shape)
    inside[1:-1, 1:-1] = True
    kept[-1] = 0.0
    return conducted(inside, kept, np.pad(sources, 1))[1:-1, 1:-1]


@pytest.mark.parametrize("slenderness", [0.5, 0.8, 2.0])
def test_a_ledge_s_lower_face_is_colder_as_in_two_dimensions(slenderness: float) -> None:
    wide = int(slenderness * N)
    sources = np.zeros((wide + 3 * N, N))
    sources[:wide, -1] = 1.0 / wide
    found = heated_strip(sources)
    ledge = found[:wide]
    top, bottom = (np.mean(ledge[:, k] + 0.5 * (ledge[:, k] - ledge[:, near])) for k, near in ((-1, -2), (0, 1)))
    assert ledge_ways(slenderness)[0] == pytest.approx(top - np.mean(ledge), rel=0.03)
    assert ledge_across(slenderness) == pytest.approx(np.mean(ledge) - bottom, rel=0.03)


@pytest.mark.parametrize(("begin", "width"), [(0.0, 0.3), (0.3, 0.7)])
def test_a_lip_s_lower_face_is_warmer_as_in_two_dimensions(begin: float, width: float) -> None:
    share = 1.0 / 3.0
    sources = np.zeros((3 * N, N))
    sources[0, : N // 3] = 3.0 / N
    found = heated_strip(sources)
    first, last = round(begin * N), round((begin + width) * N)
    face = found[first:last, 0] + 0.5 * (found[first:last, 0] - found[first:last, 1])
    warmer = np.mean(face - np.mean(found[first:last], axis=1))
    assert beyond_constriction(share, begin, width) == pytest.approx(warmer, rel=0.04)
