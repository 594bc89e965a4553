"""Where a polymer of two conductivities has a share of its potential, against the root of that by bisection."""

from __future__ import annotations

import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from tvimdesign.physics.heat_flow.conduction import Conductivities, shared
from tvimdesign.physics.polymers.polymer import Melting

MELTING = Melting(1850.0, 2100.0, 76.75e3, 323.15, 338.15, 500.0)


def passed(conductivities: Conductivities, low: float, high: float) -> float:
    """Integral of the conductivity over temperature [W/m], straight within the window, by quadrature."""

    def at(temperature: float) -> float:
        molten = min(max((temperature - MELTING.start) / (MELTING.end - MELTING.start), 0.0), 1.0)
        return conductivities.solid + molten * (conductivities.melt - conductivities.solid)

    return float(quad(at, low, high, points=[MELTING.start, MELTING.end], limit=200)[0])


@pytest.mark.parametrize("share", [0.2, 0.5, 0.9])
def test_one_conductivity_shares_the_temperature_itself(share: float) -> None:
    assert shared(share, 363.0, 303.0, Conductivities(0.2, 0.2), MELTING) == pytest.approx(303.0 + 60.0 * share)


@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
@pytest.mark.parametrize(("place", "wall"), [(365.0, 305.0), (350.0, 318.0), (330.0, 300.0)])
def test_two_conductivities_share_the_potential_within_a_fiftieth_of_the_rise(
    share: float, place: float, wall: float
) -> None:
    both = Conductivities(0.20, 0.16)  # about PCL's
    whole = passed(both, wall, place)
    exact = brentq(lambda one: passed(both, wall, one) - share * whole, wall, place)
    found = shared(share, place, wall, both, MELTING)
    assert found == pytest.approx(exact, abs=0.02 * (place - wall))
    even = wall + share * (place - wall)
    assert abs(found - exact) <= max(0.25 * abs(even - exact), 0.02)  # the step takes most of what the share misses
