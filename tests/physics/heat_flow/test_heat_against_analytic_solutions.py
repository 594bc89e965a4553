"""The heat equation of the stack, cut down to problems with analytic solutions, within 0.5 %.

Sources: Carslaw and Jaeger, Conduction of Heat in Solids, 2nd ed., sections 2.4, 3.3, 3.8 and 11.2.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import erf

from tvimdesign.physics.heat_flow import heat, lumps
from tvimdesign.physics.polymers import polymer

HALF_PERCENT = 5e-3
COLD = 295.15
DIFFUSIVITY = 0.2 / (1145.0 * 1900.0)
FOURIER_TIME = 1e-3**2 / DIFFUSIVITY  # s in which the Fourier number of the bare 1 mm layer grows by one
Make = Callable[..., heat.Stack]
Run = Callable[..., Any]


def flux_slab(make: Make, run: Run, cells: int, fourier: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """theta k/(q L) at the front and the back of a slab under constant flux with an insulated back."""
    stack = make()  # at 2 A half of I^2 R = 4 W goes to the hot side: 2000 W/m^2
    begin = heat.initial_state(stack, cells, COLD)
    history = run(stack, begin, [fo * FOURIER_TIME for fo in fourier], current=2.0)
    scale = 2000.0 * 1e-3 / 0.2
    profiles = history.profiles()
    return np.array([(p.near - COLD) / scale for p in profiles]), np.array([(p.far - COLD) / scale for p in profiles])


def flux_slab_series(fourier: float, depth: float) -> float:
    """Carslaw and Jaeger, section 3.8 (3); `depth` counts from the insulated face, in thicknesses."""
    n = np.arange(1, 200)
    terms = (-1.0) ** n / n**2 * np.exp(-((n * np.pi) ** 2) * fourier) * np.cos(n * np.pi * depth)
    return float(fourier + (3.0 * depth**2 - 1.0) / 6.0 - 2.0 / np.pi**2 * np.sum(terms))


def test_error_falls_with_the_square_of_the_cell(bare_stack: Make, integrate: Run) -> None:
    exact = np.array([flux_slab_series(0.2, 1.0), flux_slab_series(0.2, 0.0)])
    errors = []
    for cells in (8, 16, 32):
        front, back = flux_slab(bare_stack, integrate, cells, [0.2])
        errors.append(np.abs(np.array([front[0], back[0]]) - exact))
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert orders == pytest.approx(2.0, abs=0.15)


def test_slab_with_its_face_at_a_new_temperature_follows_as_tabulated(bare_stack: Make, integrate: Run) -> None:
    # The insulated face of a slab of L is the mid-plane of one of 2 L with both faces stepped.
    fourier = [0.1, 0.2, 0.5, 1.0]
    stack = bare_stack(hot_capacity=1e12)
    begin = heat.initial_state(stack, 60, COLD)
    begin[1] += 0.5
    history = integrate(stack, begin, [fo * FOURIER_TIME for fo in fourier])
    left = [1.0 - (p.far - COLD) / 50.0 for p in history.profiles()]
    assert left == pytest.approx([0.94931, 0.77231, 0.37078, 0.10798], rel=HALF_PERCENT)


@pytest.mark.parametrize(("stefan", "expected"), [(0.1, 0.220016), (0.5, 0.464786), (1.0, 0.620063), (2.0, 0.800601)])
def test_melting_front_advances_as_stefan_and_neumann_found(
    bare_stack: Make, integrate: Run, stefan: float, expected: float
) -> None:
    # One phase: solid at its melting point, face at T_w. The front is at 2 l sqrt(a t) with
    # sqrt(pi) l exp(l^2) erf l = c (T_w - T_m)/L.
    root = brentq(lambda x: np.sqrt(np.pi) * x * np.exp(x**2) * erf(x) - stefan, 1e-3, 3.0)
    assert root == pytest.approx(expected, rel=1e-5)
    melting_point, specific_heat, latent = 330.0, 2000.0, 80e3
    window = 0.02  # K: as good as isothermal
    melting = polymer.Melting(specific_heat, specific_heat, latent, melting_point, melting_point + window, 5.0)
    stack = bare_stack(hot_capacity=1e12, melting=melting)
    begin = heat.initial_state(stack, 40, melting_point)
    begin[1] += stefan * latent / specific_heat / heat.TEMPERATURE_SCALE
    diffusivity = 0.2 / (1145.0 * specific_heat)
    depth = np.array([0.4, 0.6, 0.8])  # mm
    times = (1e-3 * depth / (2.0 * expected)) ** 2 / diffusivity
    history = integrate(stack, begin, list(times), tolerance=1e-6)
    molten = [1e-3 * (1.0 - np.mean(p.fractions)) for p in history.profiles()]
    found = np.array(molten) / (2.0 * np.sqrt(diffusivity * times))
    assert found == pytest.approx([expected] * 3, rel=HALF_PERCENT)


def test_part_molten_layer_conducts_between_solid_and_melt(bare_stack: Make) -> None:
    stack = bare_stack(melting=polymer.Melting(1850.0, 2100.0, 76.75e3, 323.15, 338.15, 500.0), conductivity_melt=0.1)
    for celsius, conductivity in ((22.0, 0.2), (57.5, 0.15), (100.0, 0.1)):
        state = heat.initial_state(stack, 2, 273.15 + celsius)
        state[2] += 1e-9
        seen = heat.profile(state, stack)
        gradient = (seen.cells[0] - seen.cells[1]) / 0.5e-3
        assert seen.through_layer[1] == pytest.approx(conductivity * 1e-3 * gradient, rel=2e-3)


def test_a_switched_off_stack_at_ambient_temperature_stays_as_it_is(bare_stack: Make) -> None:
    warm = lumps.Surface(1e-3, 10.0, 0.9)
    stack = bare_stack(hot_contact=1e4, plate_contact=1e4, plate_surface=warm, cold_surface=warm)
    state = heat.initial_state(stack, 10, COLD)
    assert np.max(np.abs(heat.rates(state, stack, 0.0))) < 1e-12


def test_a_wall_at_rest_has_the_drops_of_its_resistances(bare_stack: Make, integrate: Run) -> None:
    # 2 W (half of I^2 R) through 1000 mm^2: a drop is the flux over k/L, or over the coefficient of a joint or surface.
    stack = bare_stack(
        hot_contact=4000.0, plate_contact=500.0, plate_conductivity=0.8, plate_thickness=3e-3, plate_cells=3,
        plate_surface=lumps.Surface(1e-3, 40.0),
    )  # fmt: skip
    profile = integrate(stack, heat.initial_state(stack, 5, COLD), [6000.0], current=2.0).profiles()[-1]
    flux = 2000.0
    found = [profile.hot, profile.near, profile.far, profile.plate_face, *profile.plate, COLD]
    third = flux * 1e-3 / 0.8
    drops = [flux / 4000, flux * 1e-3 / 0.2, flux / 500, 0.5 * third, third, third, 0.5 * third + flux / 40]
    assert -np.diff(found) == pytest.approx(drops, rel=1e-5)
    assert [*profile.through_layer, *profile.through_plate] == pytest.approx(10 * [2.0], rel=1e-5)
