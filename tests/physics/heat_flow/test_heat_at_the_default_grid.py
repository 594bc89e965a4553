"""The textbook problems again, at the cells a study has unless it says otherwise: within 0.5 %.

A temperature is held as a share of its own rise; that of a back face, which is nothing at first, as a share of the
heated face's. A front is held three times: at every moment as a share of the layer; its mean on the way as a share of
itself; and as a share of itself where an enthalpy method knows it, at the middle of a cell that is half molten (Voller
and Cross, Int. J. Heat Mass Transfer 24 (1981) 545), once it is a quarter through.

Sources: Carslaw and Jaeger, Conduction of Heat in Solids, 2nd ed., sections 2.14, 3.8 and 11.2 (Neumann's two phases);
Incropera, Fundamentals of Heat and Mass Transfer, section 5.5 (slab with convection).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import erf, erfc

from tvimdesign.physics.heat_flow import heat
from tvimdesign.physics.polymers import polymer
from tvimdesign.study.study import SolverOptions

Array = NDArray[np.float64]
CELLS = SolverOptions().cells
HALF_PERCENT = 5e-3
COLD = 295.15
FOURIER_TIME = 1e-3**2 / (0.2 / (1145.0 * 1900.0))  # s
Make = Callable[..., heat.Stack]
Run = Callable[..., Any]


def test_constant_flux_heats_both_faces_as_tabulated(bare_stack: Make, integrate: Run) -> None:
    fourier = [0.05, 0.1, 0.5, 1.0]
    stack = bare_stack()  # half of I^2 R = 4 W goes to the hot side: 2000 W/m^2
    begin = heat.initial_state(stack, CELLS, COLD)
    seen = integrate(stack, begin, [fo * FOURIER_TIME for fo in fourier], current=2.0).profiles()
    scale = 2000.0 * 1e-3 / 0.2
    front, back = np.array([0.25231, 0.35683, 0.83188, 1.33332]), np.array([0.00027, 0.00789, 0.33479, 0.83333])
    assert [(p.near - COLD) / scale for p in seen] == pytest.approx(front, rel=HALF_PERCENT)
    assert np.all(np.abs([(p.far - COLD) / scale for p in seen] - back) < HALF_PERCENT * front)


@pytest.mark.parametrize("biot", [0.5, 2.0, 10.0])
def test_slab_with_convection_warms_through_as_the_series_says(biot: float, bare_stack: Make, integrate: Run) -> None:
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
    """How a front that goes through the first millimetre compares with 2 l sqrt(a t)."""

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
    found = stack.thickness * (1.0 - np.mean(fractions, axis=1))
    middles = (np.arange(per_millimetre) + 0.5) * 1e-3 / per_millimetre
    passed = [
        np.interp(-0.5, -fractions[:, cell], depths) / middle - 1.0
        for cell, middle in enumerate(middles)
        if 0.25e-3 < middle < 0.95e-3
    ]
    return Front(
        mean=float(np.mean(found / depths)),
        wobble=float(np.max(np.abs(found - depths)) / 1e-3),
        in_cells=float(np.max(np.abs(passed))),
        time=(1.0 + passed[-1]) ** 2,
    )


@pytest.mark.gate
@pytest.mark.parametrize("stefan", [0.5, *(pytest.param(one, marks=pytest.mark.slow) for one in (0.1, 1.0, 2.0))])
def test_front_of_one_phase_advances_as_stefan_found(stefan: float, bare_stack: Make, integrate: Run) -> None:
    speed = brentq(lambda x: np.sqrt(np.pi) * x * np.exp(x**2) * erf(x) - stefan, 1e-3, 3.0)
    stack = bare_stack(hot_capacity=1e12, melting=ALL_BUT_ISOTHERMAL)
    found = {}
    for cells in (CELLS, 2 * CELLS):
        begin = heat.initial_state(stack, cells, MELTING_POINT)
        begin[1] += stefan * LATENT / SPECIFIC_HEAT / heat.TEMPERATURE_SCALE
        diffusivity = 0.2 / (1145.0 * SPECIFIC_HEAT)
        found[cells] = front_over_exact(stack, begin, integrate, speed, diffusivity, cells)
    assert found[CELLS].mean == pytest.approx(1.0, abs=HALF_PERCENT)
    assert found[CELLS].wobble < HALF_PERCENT
    assert found[CELLS].in_cells < HALF_PERCENT
    assert found[2 * CELLS].wobble < 0.6 * found[CELLS].wobble


def neumann(solid: float, melt: float, far: float, face: float) -> float:
    """Neumann's l of a melt between a face above and a solid below the melting point: Carslaw and Jaeger, 11.2 (6)."""
    ratio = np.sqrt(melt / solid)
    above, below = (SPECIFIC_HEAT * difference / LATENT for difference in (face - MELTING_POINT, MELTING_POINT - far))

    def balance(x: float) -> float:
        into = above / (np.exp(x**2) * erf(x))
        away = below / (ratio * np.exp((ratio * x) ** 2) * erfc(ratio * x))
        return float(into - away - x * np.sqrt(np.pi))

    return brentq(balance, 1e-3, 2.0)


@pytest.mark.parametrize(
    ("solid", "melt", "far", "face"),
    [
        (0.225, 0.18, 310.0, 370.0), (0.225, 0.18, 320.0, 390.0),
        # Four and 62 times as much in one phase as in the other; 28 cells with half cells in series are 4 to 8 % off.
        (0.2, 0.8, 310.0, 370.0), (0.2, 12.4, 310.0, 370.0), (0.8, 0.2, 326.0, 370.0),
    ],
)  # fmt: skip
def test_front_between_two_phases_advances_as_neumann_found(
    solid: float, melt: float, far: float, face: float, bare_stack: Make, integrate: Run
) -> None:
    # Solid below its melting point, in a layer four times as deep that the heat does not get through; cells as deep
    # as the default in a millimetre. Its first cells warm up in one piece, which puts the front behind while it is some
    # cells deep, with phases that conduct alike as well.
    speed, capacity = neumann(solid, melt, far, face), 1145.0 * SPECIFIC_HEAT
    stack = bare_stack(
        hot_capacity=1e12, melting=ALL_BUT_ISOTHERMAL, conductivity_solid=solid, conductivity_melt=melt, thickness=4e-3
    )
    begin = heat.initial_state(stack, 4 * CELLS, far)
    begin[1] = (face - 273.15) / heat.TEMPERATURE_SCALE
    found = front_over_exact(stack, begin, integrate, speed, melt / capacity, CELLS)
    assert found.mean == pytest.approx(1.0, abs=2.0 * HALF_PERCENT)
    assert found.time == pytest.approx(1.0, abs=2.0 * HALF_PERCENT)


def test_two_bodies_that_touch_meet_by_their_effusivities(bare_stack: Make, integrate: Run) -> None:
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
