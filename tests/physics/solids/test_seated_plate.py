"""Plates that adhesive sets in a floor: statics and elasticity of two ways out of them, by hand."""

from __future__ import annotations

import numpy as np
import pytest

from tvimdesign.physics.heat_flow.shape_factors import constriction
from tvimdesign.physics.solids import seated_plate

RADII, AROUND = (15e-3, 27.5e-3), 3 * 1.9


def seat(floor: float = 0.85e9) -> seated_plate.Seat:
    return seated_plate.Seat(0.5e-3, 0.9e-3, constriction(0.9 / 6.5), 0.72e9, floor)


def test_in_a_stiff_floor_adhesive_is_sheared_as_the_radius() -> None:
    # Volkersen's layer without stretch: tau = G theta r/g on the areas 2 pi s r t, so T = G theta t s (a^3 + b^3)/g.
    path = seated_plate.path(seat(1e16), AROUND, RADII, 0.0)
    turned = 0.5e-3 / (0.72e9 * 0.9e-3 * AROUND * (RADII[0] ** 3 + RADII[1] ** 3))
    assert path.adhesive == pytest.approx(turned, rel=1e-6)
    assert path.floor == pytest.approx(0.0, abs=1e-6 * turned)
    for traction, radius in ((path.inner_traction, RADII[0]), (path.outer_traction, RADII[1])):
        assert traction == pytest.approx(0.72e9 * turned * radius / 0.5e-3, rel=1e-6)


@pytest.mark.parametrize("between", [0.0, 1e-5, 1e-3])
def test_both_rims_together_bear_the_torque(between: float) -> None:
    path = seated_plate.path(seat(), AROUND, RADII, between)
    areas = [AROUND * radius * 0.9e-3 for radius in RADII]
    borne = path.inner_traction * areas[0] * RADII[0] + path.outer_traction * areas[1] * RADII[1]
    assert borne == pytest.approx(1.0, rel=1e-12)
    assert path.inward == pytest.approx(path.inner_traction * areas[0] * RADII[0], rel=1e-12)


def test_the_torque_takes_the_ways_that_give_least() -> None:
    # Castigliano: of all shares the one that is taken stores the least energy.
    between, bonded = 2e-5, seat()
    path = seated_plate.path(bonded, AROUND, RADII, between)
    inner, outer = (sum(seated_plate.slips(bonded)) / (AROUND * radius**3) for radius in RADII)

    def stored(share: float) -> float:
        return share**2 * (inner + between) + (1.0 - share) ** 2 * outer

    shares = np.linspace(0.0, 1.0, 2001)
    assert path.inward == pytest.approx(shares[np.argmin([stored(share) for share in shares])], abs=5e-4)
    assert path.adhesive + path.floor == pytest.approx(stored(path.inward), rel=1e-12)
