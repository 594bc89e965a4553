"""A lip whose temperatures are given: those that follow leave no residual, and heat what the closed form heats."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import brentq, root

from tvimdesign.physics.heat_flow.conduction import Conductivities, shared
from tvimdesign.physics.heat_flow.layer_end import Arm, Lip, warm_lip
from tvimdesign.physics.heat_flow.lumps import Place
from tvimdesign.physics.polymers.polymer import Melting

Array = NDArray[np.float64]
AIR, PLATE = ("air", 0), ("plate", 0)
conductances = st.floats(1e-3, 0.5)
temperatures = st.floats(280.0, 400.0)


@st.composite
def lips(draw: st.DrawFn) -> tuple[Lip, Array, dict[Place, float]]:
    """A lip, cells beside it and temperatures of what else is there."""
    arms = (Arm(draw(conductances), ((AIR, 1.0),)), Arm(draw(conductances), ((AIR, 0.3), (PLATE, 0.5)), 0.8))
    cells = np.array(draw(st.lists(temperatures, min_size=1, max_size=6)))
    places = {("hot", 0): draw(temperatures), AIR: draw(temperatures), PLATE: draw(temperatures)}
    return Lip(draw(conductances), draw(conductances), arms), cells, places


def melting(cells: Array, pads: float) -> Any:
    """Return how well a polymer conducts that conducts a fifth less once it is warmer than 330 K, as a smooth
    function."""

    def at(temperature: Any) -> tuple[Any, Any]:
        mean = [0.5 * (one + temperature) for one in (cells, pads)]
        return tuple(1.0 - 0.1 * np.tanh((one - 330.0) / 15.0) for one in mean)  # type: ignore[return-value]  # two places, two shares

    return at


@given(case=lips())
def test_temperatures_that_leave_no_residual_are_those_of_the_closed_form(
    case: tuple[Lip, Array, dict[Place, float]],
) -> None:
    lip, cells, places = case
    conducting = melting(cells, places["hot", 0])
    closed = warm_lip(lip, cells, places.__getitem__, conducting)
    assert closed.residuals == (0.0, 0.0)

    def residuals(given: Array) -> Array:
        found = warm_lip(lip, cells, places.__getitem__, conducting, (given[0], given[1]))
        return np.array(found.residuals)

    solved = root(residuals, np.array([340.0, 300.0]), tol=1e-12)
    assert solved.success
    joined = warm_lip(lip, cells, places.__getitem__, conducting, tuple(solved.x))
    assert joined.temperature == pytest.approx(closed.temperature, rel=1e-10)
    assert joined.from_layer == pytest.approx(closed.from_layer, rel=1e-7, abs=1e-9)
    assert joined.from_places == pytest.approx(closed.from_places, rel=1e-7, abs=1e-9)
    assert sum(joined.from_layer) + joined.from_places["hot", 0] + _through_arms(lip, joined, places) == pytest.approx(
        0.0, abs=1e-9
    )


def _through_arms(lip: Lip, warm: Any, places: dict[Place, float]) -> float:
    """Heat [W] that comes to the lip itself through its arms: each arm's, times its share of the lip."""
    return float(sum(
        arm.share * arm.conductance * (sum(w * places[end] for end, w in arm.ends) - arm.share * warm.temperature)
        for arm in lip.arms
    ))  # fmt: skip


@given(case=lips(), off=st.tuples(st.floats(-20.0, 20.0), st.floats(-20.0, 20.0)))
def test_residuals_say_how_far_given_temperatures_are_off(
    case: tuple[Lip, Array, dict[Place, float]], off: tuple[float, float]
) -> None:
    lip, cells, places = case
    alike = warm_lip(lip, cells, places.__getitem__, lambda _: (np.ones(len(cells)), 1.0)).temperature
    closed = warm_lip(lip, cells, places.__getitem__, melting(cells, places["hot", 0])).temperature
    first, _ = warm_lip(
        lip, cells, places.__getitem__, melting(cells, places["hot", 0]), (alike + off[0], closed)
    ).residuals
    _, second = warm_lip(
        lip, cells, places.__getitem__, melting(cells, places["hot", 0]), (alike, closed + off[1])
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


@pytest.mark.parametrize("share", [0.2, 0.5, 0.9])
def test_one_conductivity_shares_the_temperature_itself(share: float) -> None:
    assert shared(share, 363.0, 303.0, Conductivities(0.2, 0.2), MELTING) == pytest.approx(303.0 + 60.0 * share)


@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
@pytest.mark.parametrize(("place", "wall"), [(365.0, 305.0), (350.0, 318.0), (330.0, 300.0)])
def test_two_conductivities_share_the_potential(share: float, place: float, wall: float) -> None:
    both = Conductivities(0.20, 0.16)  # about PCL's
    whole = passed(both, wall, place)
    exact = brentq(lambda one: passed(both, wall, one) - share * whole, wall, place)
    found = shared(share, place, wall, both, MELTING)
    assert found == pytest.approx(exact, abs=0.02 * (place - wall))
    even = wall + share * (place - wall)
    assert abs(found - exact) <= max(0.25 * abs(even - exact), 0.02)  # the step takes most of what the share misses
