"""A block of which a part is molten: like a whole block where all is alike, like a film where the rest is rigid."""

import numpy as np
import pytest

from tvimdesign.physics.layers import block, layer


@pytest.mark.parametrize("modulus", [1e4, 1e8])
def test_a_block_that_is_alike_all_through_is_soft_all_through(modulus: float) -> None:
    assert block.soft_share(np.full(12, modulus), np.full(12, 0.3 * modulus)) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("molten", [1, 3, 9])
def test_a_molten_film_in_a_rigid_block_is_as_stiff_as_a_block_of_its_own_depth(molten: int) -> None:
    storage, loss = np.full(12, 1e12), np.zeros(12)
    storage[:molten], loss[:molten] = 2e4, 3e4
    width, height, depth = 11e-3, 12e-3, 4e-3
    series = complex(*layer.series_modulus(storage, loss))
    share = block.soft_share(storage, loss)
    assert share == pytest.approx(molten / 12.0, rel=1e-6)
    shape = block.shape_factor(width, height, depth) / share
    found = block.stiffness(3.0 * series * block.shape_stiffening(shape), 6, width * height, 18.5e-3, depth)
    # By hand: 3 G (1 + 2 S^2) A r^2 over the film's own thickness, S = w h/(2 t (w + h)).
    thick = depth * molten / 12.0
    own = width * height / (2.0 * thick * (width + height))
    alone = 6 * 3.0 * complex(2e4, 3e4) * (1.0 + 2.0 * own**2) * width * height * 18.5e-3**2 / thick
    assert found == pytest.approx(alone, rel=1e-5)


def test_where_the_film_lies_does_not_matter() -> None:
    storage = np.geomspace(1e4, 1e8, 12)
    assert block.soft_share(storage, 0.1 * storage) == pytest.approx(
        block.soft_share(storage[::-1], 0.1 * storage[::-1])
    )


def test_slices_that_give_way_alike_count_alike_whether_they_store_or_lose() -> None:
    # |G| is 5 in every slice: 3-4-5 either way round, and 0-5.
    storage, loss = np.array([3.0, 4.0, 0.0, 5.0]), np.array([4.0, 3.0, 5.0, 0.0])
    assert block.soft_share(storage, loss) == pytest.approx(1.0, rel=1e-12)
