"""The heat equation of the stack, cut down to problems with analytic solutions, within 0.5 % at the default cells.

A temperature is held as a share of its own rise; that of a back face, which is nothing at first, as a share of the
heated face's. A front is held three times: at every moment as a share of the layer; its mean on the way as a share of
itself; and as a share of itself where an enthalpy method knows it, at the middle of a cell that is half molten (Voller
and Cross, Int. J. Heat Mass Transfer 24 (1981) 545), once it is a quarter through.

Sources: Carslaw and Jaeger, Conduction of Heat in Solids, 2nd ed., sections 2.14, 3.8 and 11.2 (Neumann's two phases);
Incropera, Fundamentals of Heat and Mass Transfer, section 5.5 (slab with convection).
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import erf, erfc
from support import cases_of

from tvimdesign.physics.heat_flow import heat, lumps
from tvimdesign.physics.polymers import polymer
from tvimdesign.study.study import SolverOptions

Array = NDArray[np.float64]
CELLS = SolverOptions().cells
HALF_PERCENT = 5e-3
COLD = 295.15
FOURIER_TIME = 1e-3**2 / (0.2 / (1145.0 * 1900.0))  # s
Make = Callable[..., heat.Stack]
Run = Callable[..., Any]


def flux_slab(make: Make, run: Run, cells: int, fourier: list[float]) -> tuple[Array, Array]:
    """theta k/(q L) at the front and the back of a slab under constant flux with an insulated back."""
    stack = make()  # at 2 A half of I^2 R = 4 W goes to the hot side: 2000 W/m^2
    begin = heat.initial_state(stack, cells, COLD)
    profiles = run(stack, begin, [fo * FOURIER_TIME for fo in fourier], current=2.0).profiles()
    near, far = (np.array([getattr(p, face) - COLD for p in profiles]) for face in ("near", "far"))
    return near / (2000.0 * 1e-3 / 0.2), far / (2000.0 * 1e-3 / 0.2)


def test_constant_flux_heats_both_faces_as_tabulated(bare_stack, integrate):
    front, back = np.array([0.25231, 0.35683, 0.83188, 1.33332]), np.array([0.00027, 0.00789, 0.33479, 0.83333])
    near, far = flux_slab(bare_stack, integrate, CELLS, [0.05, 0.1, 0.5, 1.0])
    assert near == pytest.approx(front, rel=HALF_PERCENT)
    assert np.all(np.abs(far - back) < HALF_PERCENT * front)


@pytest.mark.parametrize("biot", [0.5, 2.0, 10.0])
def test_slab_with_convection_warms_through_as_the_series_says(biot, bare_stack, integrate):
    # The insulated face of a slab of L with convection on the other is the mid-plane of one of 2 L.
    fourier = np.array([0.1, 0.2, 0.5, 1.0, 2.0])
    stack = bare_stack(hot_capacity=1e12, hot_contact=biot * 0.2 / 1e-3)
    begin = heat.initial_state(stack, CELLS, COLD)
    begin[1] += 0.5
    seen = integrate(stack, begin, list(fourier * FOURIER_TIME)).profiles()
    roots = np.array(
        [brentq(lambda z: z * np.tan(z) - biot, k * np.pi + 1e-9, (k + 0.5) * np.pi - 1e-9) for k in range(60)]
    )
    weights = 4.0 * np.sin(roots) / (2.0 * roots + np.sin(2.0 * roots))
    decays = np.exp(-np.outer(fourier, roots**2))
    assert [1.0 - (p.far - COLD) / 50.0 for p in seen] == pytest.approx(decays @ weights, rel=HALF_PERCENT)
    faces = decays @ (weights * np.cos(roots))
    assert [1.0 - (p.near - COLD) / 50.0 for p in seen] == pytest.approx(faces, rel=HALF_PERCENT)


MELTING_POINT, SPECIFIC_HEAT, LATENT = 330.0, 2000.0, 80e3
ALL_BUT_ISOTHERMAL = polymer.Melting(SPECIFIC_HEAT, SPECIFIC_HEAT, LATENT, MELTING_POINT, MELTING_POINT + 0.02, 5.0)


class Front(NamedTuple):
    """Compare a front that goes through the first millimetre with 2 l sqrt(a t)."""

    mean: float
    """Its depth over the exact one, on the mean from a quarter of the millimetre on."""
    wobble: float
    """How far it is ever off there, as a share of the millimetre: a cell that melts stays at one temperature."""
    in_cells: float
    """How far it is off, as a share of its depth, when it is in the middle of a cell."""
    time: float
    """Time after which it is in the middle of the last of these cells, over the exact one."""


def front_over_exact(
    stack: heat.Stack, begin: Array, run: Run, speed: float, diffusivity: float, per_millimetre: int
) -> Front:
    """Follow a front from a quarter of the first millimetre on."""
    depths = np.linspace(0.23e-3, 0.97e-3, 371)
    times = (depths / (2.0 * speed)) ** 2 / diffusivity
    fractions = np.array([p.fractions for p in run(stack, begin, list(times), tolerance=1e-7).profiles()])
    depth = stack.thickness * (1.0 - np.mean(fractions, axis=1))
    middles = (np.arange(per_millimetre) + 0.5) * 1e-3 / per_millimetre
    passed = [
        np.interp(-0.5, -fractions[:, cell], depths) / middle - 1.0
        for cell, middle in enumerate(middles)
        if 0.25e-3 < middle < 0.95e-3
    ]
    return Front(
        mean=float(np.mean(depth / depths)),
        wobble=float(np.max(np.abs(depth - depths)) / 1e-3),
        in_cells=float(np.max(np.abs(passed))),
        time=(1.0 + passed[-1]) ** 2,
    )


@pytest.mark.gate
@pytest.mark.parametrize("stefan", [0.5, *(pytest.param(number, marks=pytest.mark.slow) for number in (0.1, 1.0, 2.0))])
def test_front_of_one_phase_advances_as_stefan_found(stefan, bare_stack, integrate):
    speed = brentq(lambda x: np.sqrt(np.pi) * x * np.exp(x**2) * erf(x) - stefan, 1e-3, 3.0)
    stack = bare_stack(hot_capacity=1e12, melting=ALL_BUT_ISOTHERMAL)
    ratios = {}
    for cells in (CELLS, 2 * CELLS):
        begin = heat.initial_state(stack, cells, MELTING_POINT)
        begin[1] += stefan * LATENT / SPECIFIC_HEAT / heat.TEMPERATURE_SCALE
        diffusivity = 0.2 / (1145.0 * SPECIFIC_HEAT)
        ratios[cells] = front_over_exact(stack, begin, integrate, speed, diffusivity, cells)
    assert ratios[CELLS].mean == pytest.approx(1.0, abs=HALF_PERCENT)
    assert ratios[CELLS].wobble < HALF_PERCENT
    assert ratios[CELLS].in_cells < HALF_PERCENT
    assert ratios[2 * CELLS].wobble < 0.6 * ratios[CELLS].wobble


def neumann(solid: float, melt: float, far: float, face: float) -> float:
    """Neumann's l of a melt between a face above and a solid below the melting point: Carslaw and Jaeger, 11.2 (6)."""
    ratio = np.sqrt(melt / solid)
    above, below = (SPECIFIC_HEAT * difference / LATENT for difference in (face - MELTING_POINT, MELTING_POINT - far))

    def balance(x: float) -> float:
        into = above / (np.exp(x**2) * erf(x))
        away = below / (ratio * np.exp((ratio * x) ** 2) * erfc(ratio * x))
        return float(into - away - x * np.sqrt(np.pi))

    return brentq(balance, 1e-3, 2.0)


@cases_of("heat_against_analytic_solutions", "neumann")
def test_front_between_two_phases_advances_as_neumann_found(solid, melt, far, face, bare_stack, integrate):
    # Solid below its melting point, in a layer four times as deep that the heat does not get through; cells as deep
    # as the default in a millimetre. Its first cells warm up in one piece, which puts the front behind while it is some
    # cells deep, with phases that conduct alike as well.
    speed, capacity = neumann(solid, melt, far, face), 1145.0 * SPECIFIC_HEAT
    stack = bare_stack(
        hot_capacity=1e12, melting=ALL_BUT_ISOTHERMAL, conductivity_solid=solid, conductivity_melt=melt, thickness=4e-3
    )
    begin = heat.initial_state(stack, 4 * CELLS, far)
    begin[1] = (face - 273.15) / heat.TEMPERATURE_SCALE
    ratio = front_over_exact(stack, begin, integrate, speed, melt / capacity, CELLS)
    assert ratio.mean == pytest.approx(1.0, abs=2.0 * HALF_PERCENT)
    assert ratio.time == pytest.approx(1.0, abs=2.0 * HALF_PERCENT)


def test_two_bodies_that_touch_meet_by_their_effusivities(bare_stack, integrate):
    # Aluminium at 100 degC on polycaprolactone at 22 degC. Once the heat is some cells deep, and not yet through.
    stack = bare_stack(
        conductivity_solid=0.225, conductivity_melt=0.225, hot_contact=1e-12, plate_contact=1e12, plate_thickness=60e-3,
        plate_conductivity=167.0, plate_heat_capacity=2700.0 * 896.0, plate_cells=200,
    )  # fmt: skip
    begin = heat.initial_state(stack, CELLS, COLD)
    begin[-200:] = 1.0
    seen = integrate(stack, begin, [0.5, 1.0, 2.0], tolerance=1e-7).profiles()
    metal, plastic = np.sqrt(167.0 * 2700.0 * 896.0), np.sqrt(0.225 * 1145.0 * 1900.0)
    exact = (100.0 * metal + 22.0 * plastic) / (metal + plastic)
    assert [p.far - 273.15 for p in seen] == pytest.approx([exact] * 3, rel=HALF_PERCENT)


def flux_slab_series(fourier: float, depth: float) -> float:
    """Carslaw and Jaeger, section 3.8 (3); `depth` counts from the insulated face, in thicknesses."""
    n = np.arange(1, 200)
    terms = (-1.0) ** n / n**2 * np.exp(-((n * np.pi) ** 2) * fourier) * np.cos(n * np.pi * depth)
    return float(fourier + (3.0 * depth**2 - 1.0) / 6.0 - 2.0 / np.pi**2 * np.sum(terms))


def test_error_falls_with_the_square_of_the_cell(bare_stack, integrate):
    exact = np.array([flux_slab_series(0.2, 1.0), flux_slab_series(0.2, 0.0)])
    errors = []
    for cells in (8, 16, 32):
        front, back = flux_slab(bare_stack, integrate, cells, [0.2])
        errors.append(np.abs(np.array([front[0], back[0]]) - exact))
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert orders == pytest.approx(2.0, abs=0.15)


def test_part_molten_layer_conducts_between_solid_and_melt(bare_stack):
    stack = bare_stack(melting=polymer.Melting(1850.0, 2100.0, 76.75e3, 323.15, 338.15, 500.0), conductivity_melt=0.1)
    for celsius, conductivity in ((22.0, 0.2), (57.5, 0.15), (100.0, 0.1)):
        state = heat.initial_state(stack, 2, 273.15 + celsius)
        state[2] += 1e-9
        seen = heat.profile(state, stack)
        gradient = (seen.cells[0] - seen.cells[1]) / 0.5e-3
        assert seen.through_layer[1] == pytest.approx(conductivity * 1e-3 * gradient, rel=2e-3)


def test_a_switched_off_stack_at_ambient_temperature_stays_as_it_is(bare_stack):
    warm = lumps.Surface(1e-3, 10.0, 0.9)
    stack = bare_stack(hot_contact=1e4, plate_contact=1e4, plate_surface=warm, cold_surface=warm)
    state = heat.initial_state(stack, 10, COLD)
    assert np.max(np.abs(heat.rates(state, stack, 0.0))) < 1e-12


def test_a_wall_at_rest_has_the_drops_of_its_resistances(bare_stack, integrate):
    # 2 W (half of I^2 R) through 1000 mm^2: a drop is the flux over k/L, or over the coefficient of a joint or surface.
    stack = bare_stack(
        hot_contact=4000.0, plate_contact=500.0, plate_conductivity=0.8, plate_thickness=3e-3, plate_cells=3,
        plate_surface=lumps.Surface(1e-3, 40.0),
    )  # fmt: skip
    profile = integrate(stack, heat.initial_state(stack, 5, COLD), [6000.0], current=2.0).profiles()[-1]
    flux = 2000.0
    temperatures = [profile.hot, profile.near, profile.far, profile.plate_face, *profile.plate, COLD]
    third = flux * 1e-3 / 0.8
    drops = [flux / 4000, flux * 1e-3 / 0.2, flux / 500, 0.5 * third, third, third, 0.5 * third + flux / 40]
    assert -np.diff(temperatures) == pytest.approx(drops, rel=1e-5)
    assert [*profile.through_layer, *profile.through_plate] == pytest.approx(10 * [2.0], rel=1e-5)
