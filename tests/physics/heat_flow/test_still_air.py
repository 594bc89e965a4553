"""Shape factors of still air beside tiles and below a lip, against conduction in two dimensions by finite volumes."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import csr_matrix, diags
from scipy.sparse.linalg import spsolve

from tvimdesign.physics.heat_flow.layer_end import below_lip, room
from tvimdesign.physics.heat_flow.shape_factors import beyond_constriction, ledge_across, ledge_ways

Array = NDArray[np.float64]
N = 48
"""Cells over the height of a room, of a clearance or of a ledge."""
Wall = Callable[[int, int], float | None]


def solved(inside: NDArray[np.bool_], wall: Wall, sources: Array | None = None) -> tuple[Array, Callable[[int], float]]:
    """Temperatures of square cells where `inside`, whose other neighbours are walls of a temperature, or pass nothing.

    And the heat over the conductivity that comes out of walls with a key: ten times the temperature, rounded.
    """
    number = -np.ones(inside.shape, dtype=int)
    number[inside] = np.arange(np.count_nonzero(inside))
    count = int(number.max()) + 1
    diagonal, right, pairs, faces = np.zeros(count), np.zeros(count), [], []
    for (i, j), own in np.ndenumerate(number):
        if own < 0:
            continue
        for a, b in ((i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)):
            within = 0 <= a < inside.shape[0] and 0 <= b < inside.shape[1]
            if within and number[a, b] >= 0:
                pairs.append((own, number[a, b]))
                diagonal[own] += 1.0
            elif (level := wall(a, b)) is not None:
                diagonal[own] += 2.0
                right[own] += 2.0 * level
                faces.append((own, level, a, b))
    rows, columns = np.array(pairs).T
    if sources is not None:
        right += sources[inside]
    matrix = diags(diagonal) - csr_matrix((np.ones(len(rows)), (rows, columns)), shape=(count, count))
    found = spsolve(matrix.tocsc(), right)
    whole = np.full(inside.shape, np.nan)
    whole[inside] = found

    def given(side: int) -> float:
        return float(sum(2.0 * (level - found[own]) for own, level, a, b in faces if _side(a, b, inside) == side))

    return whole, given


def _side(a: int, b: int, inside: NDArray[np.bool_]) -> int:
    """0 left, 1 right, 2 below, 3 above, 4 a wall within the frame."""
    if a < 0:
        return 0
    if a == inside.shape[0]:
        return 1
    return 2 if b < 0 else 3 if b == inside.shape[1] else 4


@pytest.mark.parametrize("width", [0.5, 1.0, 2.0])
def test_a_room_beside_tiles_gives_what_conduction_in_two_dimensions_says(width: float) -> None:
    slot = 4 / N
    across, gap = int(width * N) + 4, 4
    # The ceiling ends before the wall; above the slot its own edge is as warm as it is.
    inside = np.zeros((across, 2 * N), dtype=bool)
    inside[:, :N] = True
    inside[-gap:, N:] = True

    def wall(a: int, b: int) -> float | None:
        if a == across or b < 0:
            return 0.0
        if a < 0:
            return (b + 0.5) / N
        return None if b == 2 * N else 1.0

    found, given = solved(inside, wall)
    edge = np.sum(2.0 * (1.0 - found[-gap, N:])) - N / gap
    tile, floor = given(0), -given(2)
    ceiling = given(4) - N / gap
    ours = room(width + slot, slot)
    # An even fall brings as much from ceiling to floor as the room is wide below that.
    assert ours.ceiling + width == pytest.approx(ceiling, abs=0.06)
    assert width + slot - ours.floor == pytest.approx(floor, abs=0.02)
    assert ours.tile == pytest.approx(tile, abs=0.02)
    assert edge > 0.0


@pytest.mark.parametrize("slot", [0.25, 0.5, 1.0, 1.75])
def test_a_clearance_gives_lip_and_floor_as_in_two_dimensions(slot: float) -> None:
    n = 24
    gap, deep, long = int(slot * n), 4 * int(max(slot, 1.0) * n), 5 * n
    inside = np.zeros((gap + long, deep + n), dtype=bool)
    inside[:, deep:] = True
    inside[:gap, :deep] = True

    def end(b: int) -> float:
        return 1.0 if b < deep else 1.0 - 2.0 / np.pi * np.arcsin((b - deep + 0.5) / n)

    def wall(a: int, b: int) -> float | None:
        if a < 0:
            return end(b)
        return None if a == gap + long or b < 0 else 0.0

    found, given = solved(inside, wall)
    passed = deep / gap
    into_lip = -given(3)
    warm = np.array([end(b) for b in range(deep + n)])
    from_pads = np.sum(warm * 2.0 * (warm - found[0])) - passed
    to_lip, to_floor = below_lip(slot)
    floor = given(0) - passed - into_lip
    assert to_floor == pytest.approx(floor, abs=0.06)
    assert to_lip == pytest.approx(from_pads - floor, abs=0.06)


@pytest.mark.parametrize("slenderness", [0.5, 0.8, 2.0])
def test_a_ledge_s_lower_face_is_colder_as_in_two_dimensions(slenderness: float) -> None:
    wide = int(slenderness * N)
    inside = np.ones((wide + 3 * N, N), dtype=bool)
    sources = np.zeros(inside.shape)
    sources[:wide, -1] = 1.0 / wide
    found, _ = solved(inside, lambda a, _: 0.0 if a == wide + 3 * N else None, sources)
    ledge = found[:wide]
    top, bottom = (np.mean(ledge[:, k] + 0.5 * (ledge[:, k] - ledge[:, near])) for k, near in ((-1, -2), (0, 1)))
    assert ledge_ways(slenderness)[0] == pytest.approx(top - np.mean(ledge), rel=0.03)
    assert ledge_across(slenderness) == pytest.approx(np.mean(ledge) - bottom, rel=0.03)


@pytest.mark.parametrize(("begin", "width"), [(0.0, 0.3), (0.3, 0.7)])
def test_a_lip_s_lower_face_is_warmer_as_in_two_dimensions(begin: float, width: float) -> None:
    share = 1.0 / 3.0
    inside = np.ones((3 * N, N), dtype=bool)
    sources = np.zeros(inside.shape)
    sources[0, : N // 3] = 3.0 / N
    found, _ = solved(inside, lambda a, _: 0.0 if a == 3 * N else None, sources)
    first, last = round(begin * N), round((begin + width) * N)
    face = found[first:last, 0] + 0.5 * (found[first:last, 0] - found[first:last, 1])
    warmer = np.mean(face - np.mean(found[first:last], axis=1))
    assert beyond_constriction(share, begin, width) == pytest.approx(warmer, rel=0.04)
