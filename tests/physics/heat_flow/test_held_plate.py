"""The plate behind a polymer that is kept warm, against a steady balance of many cells written once more."""

from typing import Any

import numpy as np
import pytest
from scipy.optimize import fsolve

from tvimdesign.physics.heat_flow.held_plate import BehindPolymer, held_plate
from tvimdesign.physics.heat_flow.lumps import Lump, Surface
from tvimdesign.physics.heat_flow.stack import Liner

AIR, POLYMER = 295.15, 373.15
CELLS = 60


def behind(conductivity: float) -> BehindPolymer:
    """A plate of 4 mm on 1500 mm^2, a rim that loses heat, and a core with a link beyond it."""
    lumps = (
        Lump(1000.0 * conductivity / 7000.0, 1.0, Surface(9e-3, 5.0, 0.9)),
        Lump(0.024 * conductivity, 1.0, Surface(2.4e-3, 5.0, 0.9)),
    )
    return BehindPolymer(1.5e-3, 4e-3, conductivity, Surface(1.5e-3, 5.0, 0.9), AIR, lumps)


def lost(surface: Surface, temperature: float) -> float:
    grey = surface.emissivity * 5.670374419e-8 * (temperature**4 - AIR**4)
    return float(surface.area * (surface.coefficient * (temperature - AIR) + grey))


def balanced(stack: BehindPolymer) -> Any:
    """Temperatures of all cells and of both lumps where the heat of each sums to zero."""
    through = stack.plate_conductivity * stack.area / (stack.plate_thickness / CELLS)
    first, second = stack.beside

    def left(all_of_them: Any) -> Any:
        plate, (rim, core) = all_of_them[:CELLS], all_of_them[CELLS:]
        top = fsolve(lambda t: 2.0 * through * (plate[-1] - t[0]) - lost(stack.plate_surface, t[0]), plate[-1])[0]
        before = 0.0 if stack.liner is None else stack.liner.resistance + stack.liner.bond
        into = (POLYMER - plate[0]) / (before + 0.5 / through)
        flows = np.concatenate([[into], -through * np.diff(plate),
                                [2.0 * through * (plate[-1] - top)]])  # fmt: skip
        mean = np.mean(plate)
        uneven = first.conductance if stack.uneven_conductance is None else stack.uneven_conductance
        sideways = (first.conductance * (mean - rim) + uneven * (plate - mean)) / CELLS
        onward = second.conductance * (rim - core)
        rest = [np.sum(sideways) - onward - lost(first.surface, rim), onward - lost(second.surface, core)]
        return np.concatenate([-np.diff(flows) - sideways, rest])

    found = fsolve(left, np.full(CELLS + 2, 340.0))
    return found[:CELLS], found[CELLS:]


@pytest.mark.parametrize("uneven", [None, 0.3])
@pytest.mark.parametrize("conductivity", [0.24, 167.0])
def test_plate_rim_and_core_have_the_temperatures_of_a_steady_balance(
    conductivity: float, uneven: float | None
) -> None:
    stack = behind(conductivity)
    if uneven is not None:
        stack = stack._replace(uneven_conductance=uneven * stack.beside[0].conductance)
    held = held_plate(stack, POLYMER)
    plate, lumps = balanced(stack)
    slices = plate.reshape(4, CELLS // 4).mean(axis=1)
    assert np.array(held.plate) == pytest.approx(slices, abs=0.15)
    assert np.array(held.beside) == pytest.approx(lumps, abs=0.15)


@pytest.mark.parametrize("conductivity", [0.24, 167.0])
def test_a_liner_keeps_all_behind_it_cooler_as_a_steady_balance_says(conductivity: float) -> None:
    stack = behind(conductivity)._replace(liner=Liner(1e-3 / 0.29 / 1.5e-3, 1e-4 / 0.2 / 1.5e-3, 2.3))
    held = held_plate(stack, POLYMER)
    plate, lumps = balanced(stack)
    assert np.array(held.plate) == pytest.approx(plate.reshape(4, CELLS // 4).mean(axis=1), abs=0.15)
    assert np.array(held.beside) == pytest.approx(lumps, abs=0.15)
    assert held.plate[0] < held_plate(behind(conductivity), POLYMER).plate[0] - 2.0


def test_plastic_cools_down_on_the_way_and_metal_does_not() -> None:
    plastic, metal = held_plate(behind(0.24), POLYMER), held_plate(behind(167.0), POLYMER)
    assert plastic.plate[0] - plastic.plate[-1] > 10.0
    assert metal.plate[0] - metal.beside[1] < 15.0
    assert plastic.beside[1] < AIR + 15.0


def test_polymer_as_warm_as_the_air_leaves_all_as_warm_as_that() -> None:
    held = held_plate(behind(0.24), AIR)
    assert [*held.plate, *held.beside] == pytest.approx([AIR] * 6, abs=1e-9)
